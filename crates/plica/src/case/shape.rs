//! The shape of a case: every key known, every value of its type and in its range, nothing
//! missing. One walk along the text, against the table of keys.

use super::keys::{Given, Key, Kind, children, join, key};
use super::problem::Problems;
use super::spelling::nearest;
use super::table::KEYS;
use toml::de::{DeTable, DeValue};

/// Finds everything that is wrong with single keys.
pub(super) fn check(root: &DeTable, problems: &mut Problems) {
    table("", "", root, problems);
}

/// A table. `pattern` is its path with `<name>` and `[]`, as in the table of keys, `path` its
/// path in this case.
fn table(pattern: &str, path: &str, table: &DeTable, problems: &mut Problems) {
    let names = children(pattern);
    for (name, value) in table {
        let name = name.get_ref().as_ref();
        let path = join(path, name);
        let value = value.get_ref();
        if names.contains(&name) && name != "<name>" {
            self::value(&join(pattern, name), &path, value, problems);
        } else if names.contains(&"<name>") {
            self::value(&join(pattern, "<name>"), &path, value, problems);
        } else {
            problems.key(&path, "not a key of a case", meant(name, pattern, &names));
        }
    }
    if chooses(pattern) {
        if table.len() != 1 {
            let rule = format!("must be exactly one of {}", names.join(", "));
            problems.key(path, rule, None);
        }
        return;
    }
    for name in names {
        if let Some(key) = key(&join(pattern, name))
            && let Given::Always(example) = key.given
            && !table.contains_key(name)
        {
            let cure = match key.kind {
                Kind::Tables => format!("write [[{name}]]"),
                _ => format!("write {name} = {example}, say"),
            };
            problems.key(&join(path, name), "missing", Some(cure));
        }
    }
}

/// Whether a table stands for one of several choices.
fn chooses(pattern: &str) -> bool {
    let choice = |key: &Key| matches!(key.kind, Kind::Word(_) | Kind::Choice);
    pattern == "material" || key(pattern).is_some_and(choice)
}

/// What was meant by a name that is no key.
fn meant(name: &str, pattern: &str, names: &[&str]) -> Option<String> {
    if let Some(Key {
        kind: Kind::Word(words),
        ..
    }) = key(pattern)
        && words.contains(&name)
    {
        return Some(format!("write \"{name}\", without a table"));
    }
    if let Some(near) = nearest(name, names.iter().copied()) {
        return Some(format!("did you mean {near}?"));
    }
    let elsewhere = KEYS.iter().find(|key| key.name() == name);
    match elsewhere.and_then(|key| key.path.rsplit_once('.')) {
        Some((owner, _)) => Some(format!("it belongs to {owner}")),
        None => Some(format!("known here: {}", names.join(", "))),
    }
}

/// A value: a table, a list of tables, or what its key says.
fn value(pattern: &str, path: &str, value: &DeValue, problems: &mut Problems) {
    let members = format!("{pattern}[]");
    match (value, key(pattern)) {
        (DeValue::Table(inner), _) if !children(pattern).is_empty() => {
            return table(pattern, path, inner, problems);
        }
        (DeValue::Array(list), Some(key)) if key.kind == Kind::Tables => {
            for (i, member) in list.iter().enumerate() {
                let path = format!("{path}[{}]", i + 1);
                match member.get_ref() {
                    DeValue::Table(inner) => table(&members, &path, inner, problems),
                    _ => problems.value(&path, "must be a table", None),
                }
            }
            return;
        }
        _ => {}
    }
    match key(pattern) {
        Some(key) => leaf(key, path, value, problems),
        None => {
            let below = children(pattern);
            let example = match below[..] {
                [only] if only != "<name>" => format!("[{path}.{only}]"),
                _ => format!("[{path}]"),
            };
            problems.value(path, "must be a table", Some(format!("write {example}")));
        }
    }
}

/// A value that is no table.
fn leaf(key: &Key, path: &str, value: &DeValue, problems: &mut Problems) {
    match (key.kind, value) {
        (Kind::Text, DeValue::String(text)) => {
            let plain = !text.trim().is_empty() && !text.chars().any(char::is_control);
            if !plain || text.chars().count() > 200 {
                let rule = "must be one line of text, not empty, of at most 200 characters";
                problems.value(path, rule, None);
            }
        }
        (Kind::Switch, DeValue::Boolean(_)) => {}
        (Kind::Count, DeValue::Integer(_)) | (Kind::Number, _) if number(value).is_some() => {
            let x = number(value).unwrap_or_default();
            if !x.is_finite() {
                problems.value(path, "must be a finite number", try_default(key));
            } else if let Some(rule) = key.range.broken_by(x) {
                problems.value(path, rule, try_default(key));
            }
        }
        (Kind::Word(words), DeValue::String(word)) => {
            if !words.contains(&word.as_ref()) {
                problems.value(path, one_of(words), word_meant(key, words, word));
            }
        }
        (Kind::Zone, DeValue::Array(ends)) if ends.len() == 2 => {
            finite(
                ends.iter().map(|x| x.get_ref()),
                path,
                "[from, to]",
                problems,
            );
        }
        (Kind::Points, DeValue::Array(points)) => {
            let pair = |point: &DeValue| point.as_array().is_some_and(|pair| pair.len() == 2);
            if points.iter().all(|point| pair(point.get_ref())) {
                let pairs = points.iter().filter_map(|point| point.get_ref().as_array());
                let numbers = pairs.flat_map(|pair| pair.iter()).map(|x| x.get_ref());
                finite(numbers, path, "[[x, s], ...]", problems);
            } else {
                problems.value(path, "must be a list of points [x, s]", None);
            }
        }
        _ => wrong_type(key, path, problems),
    }
}

fn finite<'v, 'i: 'v>(
    mut values: impl Iterator<Item = &'v DeValue<'i>>,
    path: &str,
    form: &str,
    problems: &mut Problems,
) {
    if !values.all(|x| number(x).is_some_and(f64::is_finite)) {
        problems.value(path, format!("must be finite numbers {form}"), None);
    }
}

fn wrong_type(key: &Key, path: &str, problems: &mut Problems) {
    let rule = match key.kind {
        Kind::Text => "must be text, in quotes".to_owned(),
        Kind::Switch => "must be true or false".to_owned(),
        Kind::Count => "must be a whole number".to_owned(),
        Kind::Number => "must be a number".to_owned(),
        Kind::Word(words) => one_of(words),
        Kind::Zone => "must be [from, to], two numbers".to_owned(),
        Kind::Points => "must be a list of points [x, s]".to_owned(),
        Kind::Tables => "must be a list of tables".to_owned(),
        Kind::Choice => {
            let choices: Vec<String> = children(key.path)
                .iter()
                .map(|name| format!("{{ {name} = ... }}"))
                .collect();
            format!("must be one of {}", choices.join(", "))
        }
    };
    let cure = match key.kind {
        Kind::Tables => Some(format!("write [[{path}]]")),
        _ => try_default(key).or_else(|| Some(format!("such as {}", key.example()))),
    };
    problems.value(path, rule, cure);
}

/// The number that is written, of either type.
fn number(value: &DeValue) -> Option<f64> {
    match value {
        DeValue::Float(x) => x.as_str().parse().ok(),
        DeValue::Integer(n) => i128::from_str_radix(n.as_str(), n.radix())
            .map(|n| n as f64)
            .or(Ok::<f64, ()>(f64::INFINITY))
            .ok(),
        _ => None,
    }
}

fn one_of(words: &[&str]) -> String {
    let quoted: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
    format!("must be one of {}", quoted.join(", "))
}

fn word_meant(key: &Key, words: &[&str], word: &str) -> Option<String> {
    if children(key.path).contains(&word) {
        return Some(format!("write {} = {{ {word} = ... }}", key.name()));
    }
    let near = nearest(word, words.iter().copied())?;
    Some(format!("did you mean \"{near}\"?"))
}

fn try_default(key: &Key) -> Option<String> {
    match key.given {
        Given::Or(default) => Some(format!("try {default}")),
        _ => None,
    }
}
