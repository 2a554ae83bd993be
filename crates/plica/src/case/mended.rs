//! Slips of TOML that leave no doubt of what is meant.

use super::problem::Problems;
use std::collections::BTreeMap;
use toml::de::Error;

/// The text as it is meant, byte for byte in its place, if there is a colon in the place of `=`, or nothing before what is plainly a
/// value: that is told, and the rest can be read.
pub(super) fn mended(text: &str, errors: &[Error], problems: &mut Problems) -> Option<String> {
    let mut mended = text.as_bytes().to_vec();
    let mut places = BTreeMap::new();
    for error in errors {
        let Some(place) = error.span() else { continue };
        let (Some(before), Some(there)) = (text.get(..place.start), text.get(place.start..)) else {
            continue;
        };
        let (key, message) = (before.trim_end_matches([' ', '\t']), error.message());
        let no_value = message.starts_with("key with no value");
        let colon = |there: &str| there.starts_with(':') && !there.starts_with(":=");
        let plainly = |c: char| c.is_ascii_digit() || "+-.\"'[{".contains(c);
        let is_value = || {
            let line = there.lines().next().unwrap_or_default();
            let word = line.trim_end();
            (line.starts_with(plainly) && !line.starts_with("->")
                || ["true", "false"].contains(&word))
                && !line.trim_start_matches(['"', '\'']).contains('=')
        };
        let (at, cure) =
            if colon(there) && (no_value || message.starts_with("invalid unquoted key")) {
                (place.start, "write = for the colon")
            } else if no_value && key.ends_with(':') {
                (key.len() - 1, "write = for the colon")
            } else if no_value && key.len() < before.len() && is_value() {
                (place.start - 1, "write = before the value")
            } else {
                continue;
            };
        mended[at] = b'=';
        places.entry(at).or_insert((place, cure));
    }
    let told = !places.is_empty();
    for (place, cure) in places.into_values() {
        problems.not_toml("a key without =", Some(cure.into()), place);
    }
    told.then(|| String::from_utf8(mended).ok()).flatten()
}
