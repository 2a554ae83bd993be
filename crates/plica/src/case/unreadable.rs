//! What of a text is not TOML: one mistake, one message.

use super::problem::Problems;
use std::collections::BTreeMap;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Error};

/// The places in a text that are not TOML, in their order and apart.
#[derive(Debug, Default)]
pub(super) struct Unreadable(Vec<Range<usize>>);

impl Unreadable {
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether one of them lies in a place, or beside it.
    pub fn touches(&self, place: &Range<usize>) -> bool {
        let next = self.0.partition_point(|one| one.end < place.start);
        self.0.get(next).is_some_and(|one| one.start <= place.end)
    }

    fn add(&mut self, place: Range<usize>) {
        match self.0.last_mut() {
            Some(last) if place.start <= last.end => last.end = last.end.max(place.end),
            _ => self.0.push(place),
        }
    }
}

/// Tells what is not TOML, and returns the places of all that cannot be used.
///
/// A value that does not end makes the reader stumble over all that follows: of the errors within one value the one that says so is
/// told, where the value begins, or else the first. What follows a broken header would be read as another table's.
pub(super) fn tell(
    text: &str,
    root: &DeTable,
    errors: &[Error],
    problems: &mut Problems,
) -> Unreadable {
    let place = |error: &Error| error.span().unwrap_or(0..0);
    let mut errors: Vec<(Range<usize>, &str)> = errors
        .iter()
        .map(|error| (place(error), error.message()))
        .collect();
    errors.sort_by_key(|(place, _)| place.start);
    let mut unreadable = Unreadable::default();
    for (place, _) in &errors {
        let end = end_of_table(text, place.start).unwrap_or(place.end);
        unreadable.add(place.start..end);
    }
    let is_endless = |message: &str| {
        message.starts_with("unclosed array") || message.starts_with("unclosed inline")
    };
    let mut values = vec![];
    whole_values(root, &mut values);
    values.sort_by_key(|value| value.start);
    // What does not end may be found shorter than it is: it goes on to the end of the text.
    if errors.iter().any(|(_, message)| is_endless(message))
        && let Some(last) = values.last_mut()
    {
        last.end = text.len();
    }
    // Of the errors within one value the one that is told, by the place of the value.
    let mut told: BTreeMap<usize, (Range<usize>, &str)> = BTreeMap::new();
    let mut broken_header = false;
    for (place, message) in errors {
        let next = values.partition_point(|value| value.start <= place.start);
        let within = |value: &&Range<usize>| place.end <= value.end;
        let value = next
            .checked_sub(1)
            .and_then(|k| values.get(k))
            .filter(within);
        let Some(value) = value else {
            // A header that does not end takes the next one's place, which then seems to be there already.
            if !broken_header || message != "duplicate key" {
                tell_one(text, place, message, problems);
            }
            broken_header |= message.starts_with("unclosed table");
            continue;
        };
        if is_endless(message) {
            told.insert(value.start, (value.start..value.start + 1, message));
        } else {
            told.entry(value.start).or_insert((place, message));
        }
    }
    for (place, message) in told.into_values() {
        tell_one(text, place, message, problems);
    }
    unreadable
}

/// Tells one error, in words that a person who does not know TOML understands.
fn tell_one(text: &str, place: Range<usize>, message: &str, problems: &mut Problems) {
    let (before, there) = text.split_at_checked(place.start).unwrap_or((text, ""));
    let is_digit = |c: Option<char>| c.is_some_and(|c| c.is_ascii_digit());
    let mut there = there.chars();
    let first = there.next();
    let bare_word = first.is_some_and(char::is_alphabetic)
        && ["invalid boolean", "invalid float", "string values"]
            .iter()
            .any(|start| message.starts_with(start));
    if bare_word {
        let word = text.get(place.clone()).unwrap_or_default();
        match word.to_lowercase().as_str() {
            switch @ ("true" | "false") => {
                let cure = format!("write {switch}");
                problems.not_toml("not a word of TOML", Some(cure), place.clone());
            }
            "nan" | "inf" | "infinity" => {
                problems.not_toml("must be a finite number", None, place.clone());
            }
            _ => {
                let cure = format!("write \"{word}\"");
                problems.not_toml("a word must stand in quotes", Some(cure), place.clone());
            }
        }
    } else if first == Some(',') && is_digit(before.chars().next_back()) && is_digit(there.next()) {
        let cure = "write the number with a point";
        problems.not_toml(message, Some(cure.into()), place);
    } else {
        problems.not_toml(message, None, place);
    }
}

/// If a place lies in the line of a header, where its table ends: before the next header.
fn end_of_table(text: &str, place: usize) -> Option<usize> {
    let start = text.get(..place)?.rfind('\n').map_or(0, |at| at + 1);
    let mut lines = text[start..].split_inclusive('\n');
    let is_header = |line: &&str| line.trim_start().starts_with('[');
    let header = lines.next().filter(is_header)?;
    let below: usize = lines
        .take_while(|line| !is_header(line))
        .map(str::len)
        .sum();
    Some((start + header.len() + below).saturating_sub(1))
}

/// The places of all values that are written in one piece, unlike tables with headers of their own.
fn whole_values(table: &DeTable, values: &mut Vec<Range<usize>>) {
    for (name, value) in table {
        let in_one_piece = name.span().end <= value.span().start;
        match value.get_ref() {
            DeValue::Table(inner) if !in_one_piece => whole_values(inner, values),
            DeValue::Array(list) if !in_one_piece => {
                let members = list.iter().map(Spanned::get_ref);
                for inner in members.filter_map(DeValue::as_table) {
                    whole_values(inner, values);
                }
            }
            _ => values.push(value.span()),
        }
    }
}
