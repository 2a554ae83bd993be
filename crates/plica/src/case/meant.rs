//! What was meant by a name that is no key of its table.

use super::keys::{Key, Kind, key};
use super::spelling::nearest;
use super::table::KEYS;

/// What was meant by a name that is no key.
pub(super) enum Meant {
    /// A key of the same table.
    Here(&'static str),
    /// A key of that name, of other tables.
    Elsewhere(Vec<String>),
    /// Nobody knows.
    Unknown,
}

/// What was meant by a name that is no key, and a cure.
pub(super) fn meant(name: &str, pattern: &str, names: &[&'static str]) -> (Option<String>, Meant) {
    if let Some(Key {
        kind: Kind::Word(words),
        ..
    }) = key(pattern)
        && words.contains(&name)
    {
        let cure = format!("write \"{name}\", without a table");
        return (Some(cure), Meant::Unknown);
    }
    if let Some(near) = nearest(name, names.iter().copied()) {
        let own = names.iter().find(|own| **own == near);
        let meant = own.map_or(Meant::Unknown, |own| Meant::Here(own));
        return (Some(format!("did you mean {near}?")), meant);
    }
    let owners = owners(name);
    if owners.is_empty() {
        let cure = format!("known here: {}", names.join(", "));
        return (Some(cure), Meant::Unknown);
    }
    let cure = format!("it belongs to {}", owners.join(" or "));
    (Some(cure), Meant::Elsewhere(owners))
}

/// The tables that have a key, or a table, of a name; the case as a whole is none.
fn owners(name: &str) -> Vec<String> {
    let mut owners: Vec<String> = vec![];
    for key in KEYS {
        let steps: Vec<&str> = key.path.split('.').collect();
        let at = steps
            .iter()
            .position(|step| step.trim_end_matches("[]") == name);
        if let Some(at) = at.filter(|at| *at > 0) {
            let owner = steps[..at].join(".");
            if !owners.contains(&owner) {
                owners.push(owner);
            }
        }
    }
    owners
}
