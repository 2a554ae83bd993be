//! From a dotted key to its place in the text.

use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Where a key stands.
pub(super) struct Place {
    /// The bytes of the key itself.
    pub key: Range<usize>,
    /// The bytes of its value; for a table, its header.
    pub value: Range<usize>,
    /// Whether the whole path was found; if not, this is the place of the table it is missing
    /// from.
    pub exact: bool,
}

/// The place of a path such as `stages[2].drive.circular`, or of the innermost table around it.
pub(super) fn locate(root: &Spanned<DeTable>, path: &str) -> Place {
    let mut place = Place {
        key: 0..0,
        value: 0..0,
        exact: true,
    };
    let mut table = Some(root.get_ref());
    for step in steps(path) {
        let (name, member) = split_member(step);
        let Some((key, value)) = table.and_then(|t| t.get_key_value(name)) else {
            place.exact = false;
            return place;
        };
        let mut value = value;
        place.key = key.span();
        if let Some(n) = member {
            let list = value.get_ref().as_array();
            let Some(found) = list.and_then(|list| list.get(n - 1)) else {
                place.exact = false;
                return place;
            };
            value = found;
            place.key = value.span();
        }
        place.value = value.span();
        table = match value.get_ref() {
            DeValue::Table(inner) => Some(inner),
            _ => None,
        };
    }
    place
}

/// The names on a path; one in quotes may have dots in it.
fn steps(path: &str) -> impl Iterator<Item = &str> {
    let mut quoted = false;
    path.split(move |c| {
        quoted ^= c == '"';
        c == '.' && !quoted
    })
}

/// `stages[2]` is the name `stages` and the member 2.
fn split_member(step: &str) -> (&str, Option<usize>) {
    if let Some(name) = step.strip_prefix('"') {
        return (name.strip_suffix('"').unwrap_or(name), None);
    }
    let member = |step: &str| -> Option<(usize, usize)> {
        let (name, rest) = step.split_once('[')?;
        let n = rest.strip_suffix(']')?.parse().ok()?;
        (n > 0).then_some((name.len(), n))
    };
    match member(step) {
        Some((end, n)) => (&step[..end], Some(n)),
        None => (step, None),
    }
}
