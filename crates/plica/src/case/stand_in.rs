//! What stands in for a key of which nothing can be used, so that the rest of a case can be looked at.

use super::keys::{Given, Key, Kind, children, join, key};
use std::borrow::Cow;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Gives a table a key that it must have. A list of tables is empty.
pub(super) fn stand_in(table: &mut DeTable, key: &'static Key) {
    let example = match key.kind {
        Kind::Tables => "[]",
        _ => key.example(),
    };
    if let Ok(value) = DeValue::parse(example) {
        table.insert(Spanned::new(0..0, Cow::Borrowed(key.name())), value);
    }
}

/// A table that has no keys but those that it must have.
pub(super) fn stand_in_table(pattern: &str) -> DeValue<'static> {
    let mut table = DeTable::new();
    for name in children(pattern) {
        if let Some(key) = key(&join(pattern, name))
            && matches!(key.given, Given::Always(_))
        {
            stand_in(&mut table, key);
        }
    }
    DeValue::Table(table)
}
