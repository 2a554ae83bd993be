//! What of a text is not TOML: one mistake, one message.

use super::keys::{Kind, key};
use super::lines::Lines;
use super::problem::Problems;
use std::collections::BTreeMap;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Error};

/// The places in a text that are not TOML.
#[derive(Debug, Default)]
pub(super) struct Unreadable {
    /// In their order, and apart.
    places: Vec<Range<usize>>,
    /// Whether it is not known which keys they belong to, so that any key may be there or not.
    pub keys_lost: bool,
    /// Whether a header is broken, so that what follows seems to be of other tables.
    pub headers_lost: bool,
}

impl Unreadable {
    /// Whether one of them lies in a place, or beside it.
    pub fn touches(&self, place: &Range<usize>) -> bool {
        let next = self.places.partition_point(|one| one.end < place.start);
        self.places
            .get(next)
            .is_some_and(|one| one.start <= place.end)
    }

    fn add(&mut self, place: Range<usize>) {
        match self.places.last_mut() {
            Some(last) if place.start <= last.end => last.end = last.end.max(place.end),
            _ => self.places.push(place),
        }
    }
}

/// Tells what is not TOML, and returns the places of all that cannot be used.
///
/// The reader stumbles over what follows a mistake, too. Of a value that does not end, that alone is told, where it begins; of another
/// every word that stands for a value, and of other errors the first. Of the errors in one line outside of values the first is told.
/// What follows a broken header would be read as another table's.
pub(super) fn tell(
    text: &str,
    root: &DeTable,
    errors: &[Error],
    problems: &mut Problems,
) -> Unreadable {
    if errors.is_empty() {
        return Unreadable::default();
    }
    let mut values = vec![];
    whole_values(root, &mut values);
    values.sort_by_key(|value| value.start);
    let lines = Lines::of(text, &values);
    let mut errors: Vec<(Range<usize>, &str)> = errors
        .iter()
        .map(|error| (error.span().unwrap_or(0..0), error.message()))
        .collect();
    errors.sort_by_key(|(place, _)| place.start);
    let mut unreadable = Unreadable::default();
    // What is told of every value, or line, that has errors, by its place.
    let mut told: BTreeMap<usize, (Range<usize>, &str)> = BTreeMap::new();
    // As far as what is said within a table is only a consequence of its header.
    let mut hidden = 0;
    for (place, message) in errors {
        let twice = message == "duplicate key";
        let header = lines.is_header(place.start);
        let is_list = || {
            let name = text.get(place.clone()).unwrap_or_default();
            key(name).is_some_and(|key| key.kind == Kind::Tables)
        };
        // Of a table that is there twice all can be read.
        if !(twice && header) || is_list() {
            unreadable.add(lines.unusable(&place));
        }
        let next = values.partition_point(|value| value.start <= place.start);
        let within = |value: &&Range<usize>| place.end <= value.end;
        let value = next.checked_sub(1).and_then(|k| values.get(k));
        if let Some(value) = value.filter(within) {
            let opens = text[value.start..].starts_with(['[', '{']);
            let is_endless = ["unclosed array,", "unclosed inline table,"]
                .iter()
                .any(|start| message.starts_with(start));
            unreadable.keys_lost |= is_endless || message.contains("multi-line");
            if opens && is_endless {
                // What was found in it so far is what follows it in the text.
                told.retain(|at, _| !value.contains(at));
                told.insert(value.start, (value.start..value.start + 1, message));
            } else if is_bare(message) {
                told.insert(place.start, (place, message));
            } else {
                told.entry(value.start).or_insert((place, message));
            }
            continue;
        }
        // A header that does not end takes the next one's place, which then seems to be there already.
        let follows = twice || message.starts_with("cannot extend");
        let line = lines.start(place.start);
        let consequence = place.start < hidden || header && unreadable.headers_lost;
        if !(follows && consequence) {
            told.entry(line).or_insert((place.clone(), message));
        }
        if header {
            hidden = lines.unusable(&place).end;
            unreadable.headers_lost |= !follows;
        }
        let first = values.partition_point(|value| value.start < line);
        let of_line = values.get(first).map(|value| lines.start(value.start));
        unreadable.keys_lost |= !twice && of_line != Some(line);
    }
    // A value and the rest of its line are one mistake.
    let mut last = None;
    for (place, message) in told.into_values() {
        let line = lines.start(place.start);
        if last != Some(line) || is_bare(message) {
            tell_one(text, place, message, problems);
        }
        last = Some(line);
    }
    unreadable
}

/// Whether a word stands for a value, which leaves no doubt where the next one begins.
fn is_bare(message: &str) -> bool {
    ["invalid boolean", "invalid float", "string values"]
        .iter()
        .any(|start| message.starts_with(start))
}

/// Tells one error, in words that a person who does not know TOML understands.
fn tell_one(text: &str, place: Range<usize>, message: &str, problems: &mut Problems) {
    if message == "duplicate key" {
        let name = text.get(place.clone()).unwrap_or_default();
        let cure = key(name)
            .filter(|key| key.kind == Kind::Tables)
            .map(|_| format!("write [[{name}]], each time"));
        return problems.not_toml(&format!("{name} is there already"), cure, place);
    }
    let (before, there) = text.split_at_checked(place.start).unwrap_or((text, ""));
    let is_digit = |c: Option<char>| c.is_some_and(|c| c.is_ascii_digit());
    let mut there = there.chars();
    let first = there.next();
    let bare_word = first.is_some_and(char::is_alphabetic) && is_bare(message);
    if bare_word || message.starts_with("string values must be quoted") {
        let word = text.get(place.clone()).unwrap_or_default();
        if word.is_empty() {
            return problems.not_toml("a value is missing", None, place);
        }
        let rule = "not a value: texts stand in quotes, numbers and true or false do not";
        let cure = match word.to_lowercase().as_str() {
            switch @ ("true" | "false") => Some(format!("write {switch}")),
            "nan" | "inf" | "infinity" | "none" | "null" | "on" | "off" | "yes" | "no" => None,
            word if !word
                .chars()
                .all(|c| c.is_alphanumeric() || "-_".contains(c)) =>
            {
                None
            }
            _ if !bare_word => None,
            _ => Some(format!("write \"{word}\" if it is a text")),
        };
        problems.not_toml(rule, cure, place);
    } else if first == Some(',')
        && is_digit(before.chars().next_back())
        && is_digit(there.clone().next())
        && there.take_while(char::is_ascii_digit).count() != 3
    {
        let cure = "write the number with a point";
        problems.not_toml(message, Some(cure.into()), place);
    } else {
        problems.not_toml(message, None, place);
    }
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
