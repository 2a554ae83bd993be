//! Parses TOML, and reports its syntax errors in words that need no knowledge of TOML.

use super::key::Kind;
use super::problem::Problems;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Parses a text. Reports all syntax errors and returns none if there are any.
///
/// A mistake can cause further errors in the same line, and behind a bracket, brace or text that is
/// not closed. Only its own error is reported.
pub(super) fn parse<'t>(text: &'t str, problems: &mut Problems) -> Option<DeTable<'t>> {
    let (root, errors) = DeTable::parse_recoverable(text);
    if errors.is_empty() {
        return Some(root.into_inner());
    }
    let mut values = vec![];
    spans_of_values(root.get_ref(), &mut values);
    let mut errors: Vec<(Range<usize>, &str)> = errors
        .iter()
        .map(|error| (error.span().unwrap_or(0..0), error.message()))
        .collect();
    // All other errors are consequences of one of nesting.
    if let Some(&(ref span, message)) = errors.iter().find(|(_, message)| is_of_nesting(message)) {
        report(text, span.clone(), message, problems);
        return None;
    }
    // The error of a value that is not closed is at its end; the mistake is where it begins.
    let mut unclosed = vec![];
    for (span, message) in &mut errors {
        let starts = ["unclosed array", "unclosed inline", "invalid multi-line"];
        let own = values
            .iter()
            .find(|value| value.contains(&span.start) || value.end == span.start);
        if let Some(value) = own.filter(|_| starts.iter().any(|start| message.starts_with(start))) {
            *span = value.start..value.start + 1;
            unclosed.push(value.clone());
        }
    }
    errors.sort_by_key(|(span, _)| span.start);
    let mut last_line = None;
    let mut header_is_broken = false;
    for (span, message) in errors {
        let start = text[..span.start].rfind('\n').map_or(0, |end| end + 1);
        let inside = |value: &Range<usize>| value.start < span.start && span.start <= value.end;
        // Behind a broken header, tables and keys seem to be there twice.
        let is_consequence = header_is_broken
            && (message == "duplicate key" || message.starts_with("cannot extend"));
        if last_line == Some(start) || unclosed.iter().any(inside) || is_consequence {
            continue;
        }
        last_line = Some(start);
        header_is_broken |= message.starts_with("unclosed table");
        report(text, span, message, problems);
    }
    None
}

/// Returns whether a message of the parser is of too many tables or lists in each other.
fn is_of_nesting(message: &str) -> bool {
    message.contains("recurs")
}

fn report(text: &str, span: Range<usize>, message: &str, problems: &mut Problems) {
    let word = &text[span.clone()];
    let (before, after) = text.split_at(span.start);
    let line = after.lines().next().unwrap_or_default();
    let digit = |c: Option<char>| c.is_some_and(|c| c.is_ascii_digit());
    if is_of_nesting(message) {
        let rule = "tables and lists are nested too deeply";
        let help = "no key of a case has more than five names";
        let one = span.start
            ..after
                .chars()
                .next()
                .map_or(span.start, |c| span.start + c.len_utf8());
        return problems.syntax(one, rule, help);
    }
    let is_bare = [
        "invalid boolean",
        "invalid float",
        "string values must be quoted",
    ];
    if message == "duplicate key" {
        let is_list = |key: &super::key::Key| key.name == word && matches!(key.kind, Kind::List(_));
        let help = match problems.keys.iter().any(is_list) {
            true => format!("write [[{word}]] each time"),
            false => String::new(),
        };
        problems.syntax(span.clone(), &format!("{word} is defined twice"), help);
    } else if is_bare.iter().any(|start| message.starts_with(start)) {
        let is_word = |c: char| c.is_alphanumeric() || c == '-' || c == '_';
        let numbers = [
            "nan", "inf", "infinity", "none", "null", "on", "off", "yes", "no",
        ];
        let help = match word.to_lowercase().as_str() {
            "" => return problems.syntax(span, "a value is missing", ""),
            boolean @ ("true" | "false") => format!("write {boolean}"),
            word if numbers.contains(&word) => String::new(),
            word if !word.starts_with(char::is_alphabetic) || !word.chars().all(is_word) => {
                String::new()
            }
            _ => format!("write \"{word}\" if it is text"),
        };
        problems.syntax(
            span,
            "not a value: text needs quotes, numbers and booleans do not",
            help,
        );
    } else if message.starts_with("key with no value") || message.starts_with("invalid unquoted") {
        let has_colon = line.starts_with(':') || before.trim_end().ends_with(':');
        let help = match has_colon {
            true => "write = instead of the colon",
            false if line.contains('=') => "a key has no blanks; write _ instead",
            false => "write key = value",
        };
        problems.syntax(span, "a key without a value", help);
    } else if line.starts_with(',')
        && digit(before.chars().next_back())
        && digit(line.chars().nth(1))
    {
        problems.syntax(span, message, "write the number with a decimal point");
    } else {
        problems.syntax(span, message, "");
    }
}

/// Collects the places of all values that are written in one piece, unlike tables with headers.
fn spans_of_values(table: &DeTable, spans: &mut Vec<Range<usize>>) {
    for (name, value) in table {
        let in_one_piece = name.span().end <= value.span().start;
        match value.get_ref() {
            DeValue::Table(inner) if !in_one_piece => spans_of_values(inner, spans),
            DeValue::Array(list) if !in_one_piece => {
                for inner in list
                    .iter()
                    .map(Spanned::get_ref)
                    .filter_map(DeValue::as_table)
                {
                    spans_of_values(inner, spans);
                }
            }
            _ => spans.push(value.span()),
        }
    }
}
