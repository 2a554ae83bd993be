//! Slips of TOML that leave no doubt of what is meant.

use super::lines::Lines;
use super::problem::Problems;
use std::collections::BTreeSet;
use std::ops::Range;
use toml::de::Error;

/// So many lines are taken out, at most.
const MANY: usize = 200;

/// The text as it is meant, byte for byte in its place: with `=` for a colon, or before what is plainly a value; and without lines that
/// have a key alone, of which the reader would lose the rest of the text. All that is told.
pub(super) fn mended(text: &str, errors: &[Error], problems: &mut Problems) -> Option<String> {
    let mut mended = text.as_bytes().to_vec();
    let mut signs = BTreeSet::new();
    for error in errors {
        if let Some((at, place, cure)) = sign(text, error) {
            mended[at] = b'=';
            if signs.insert(at) {
                problems.not_toml("a key without =", Some(cure.into()), place);
            }
        }
    }
    let no_value = |error: &&Error| error.message().starts_with("key with no value");
    let places = errors.iter().filter(no_value).filter_map(Error::span);
    let (mut lines, mut taken_out) = (None, 0);
    for place in places.take(MANY) {
        let lines = lines.get_or_insert_with(|| Lines::of(text, &[]));
        let line = lines.of_place(place.start);
        if signs.range(line.clone()).next().is_some() {
            continue;
        }
        let words = &text[line.clone()];
        let whole = blank_key(words);
        let first = words.split_whitespace().next().unwrap_or_default();
        problems.replaced(lines.path(place.start, whole.as_deref().unwrap_or(first)));
        match whole.map(|key| format!("write {key}")) {
            None => problems.not_toml("key with no value, expected `=`", None, place),
            cure => problems.not_toml("a key has no blanks", cure, place),
        }
        mended[line].fill(b' ');
        taken_out += 1;
    }
    let changed = taken_out > 0 || !signs.is_empty();
    changed.then(|| String::from_utf8(mended).ok()).flatten()
}

/// Where a `=` belongs, the place that is told of, and the cure.
fn sign(text: &str, error: &Error) -> Option<(usize, Range<usize>, &'static str)> {
    let place = error.span()?;
    let (before, there) = text.split_at_checked(place.start)?;
    let key = before.trim_end_matches([' ', '\t']);
    let no_value = error.message().starts_with("key with no value");
    let unquoted = error.message().starts_with("invalid unquoted key");
    let colon = there.starts_with(':') && !there.starts_with(":=");
    let (at, cure) = if colon && (no_value || unquoted) {
        (place.start, "write = for the colon")
    } else if no_value && key.ends_with(':') {
        (key.len() - 1, "write = for the colon")
    } else if no_value && key.len() < before.len() && is_plainly_a_value(there) {
        (place.start - 1, "write = before the value")
    } else {
        return None;
    };
    Some((at, place, cure))
}

/// Whether what comes next in a line is a value, and not the rest of a key or of a sentence.
fn is_plainly_a_value(there: &str) -> bool {
    let line = there.lines().next().unwrap_or_default();
    let begins = |c: char| c.is_ascii_digit() || "+-.\"'[{".contains(c);
    let is_value = line.starts_with(begins) && !line.starts_with("->");
    (is_value || ["true", "false"].contains(&line.trim_end()))
        && !line.trim_start_matches(['"', '\'']).contains('=')
        || line.starts_with(['[', '{'])
}

/// The key of a line that has blanks in it, without them.
fn blank_key(line: &str) -> Option<String> {
    let (key, _) = line.split_once('=')?;
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_. \t".contains(c);
    let words: Vec<&str> = key.split_whitespace().collect();
    (key.chars().all(plain) && words.len() > 1).then(|| words.join("_"))
}
