//! The shape of a case: every key known, every value of its type and in its range, nothing
//! missing. One walk along the text, against the table of keys.
//!
//! What is found wrong is told, and makes place for what can stand there, so that everything else can be looked at too.

use super::keys::{Given, Key, Kind, children, join, key};
use super::problem::Problems;
use super::spelling::nearest;
use super::stand_in::{stand_in, stand_in_table};
use super::table::KEYS;
use super::unreadable::Unreadable;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Finds everything that is wrong with single keys, and leaves a table that has the shape of a case.
///
/// `unreadable` are the places in the text that are not TOML. Values around them are not looked at, and since what stands there may
/// be anything, nothing is called missing.
pub(super) fn check(root: &mut DeTable, unreadable: &Unreadable, problems: &mut Problems) {
    let mut walk = Walk {
        unreadable,
        problems,
    };
    walk.table("", "", root);
}

struct Walk<'a> {
    unreadable: &'a Unreadable,
    problems: &'a mut Problems,
}

impl Walk<'_> {
    /// A table; whether it can stay. `pattern` is its path with `<name>` and `[]`, as in the table of keys, `path` its path in this
    /// case.
    fn table(&mut self, pattern: &str, path: &str, table: &mut DeTable) -> bool {
        let names = children(pattern);
        let written = table.len();
        // The keys that are there, if perhaps misspelt; and what cannot stay.
        let (mut there, mut unsound) = (vec![], vec![]);
        for (key, value) in table.iter_mut() {
            let name = key.get_ref().as_ref();
            if self.unreadable.touches(&key.span()) || self.unreadable.touches(&value.span()) {
                unsound.push(name.to_owned());
                continue;
            }
            let below = if name != "<name>" && names.contains(&name) {
                name
            } else if names.contains(&"<name>") {
                "<name>"
            } else {
                there.extend(self.stranger(name, pattern, path, &names));
                unsound.push(name.to_owned());
                continue;
            };
            there.push(name.to_owned());
            let path = join(path, name);
            if !self.value(&join(pattern, below), &path, value) {
                self.problems.replaced(path);
                unsound.push(name.to_owned());
            }
        }
        for name in unsound {
            table.remove(name.as_str());
        }
        if chooses(pattern) {
            if written != 1 {
                let rule = format!("must be exactly one of {}", names.join(", "));
                self.problems.key(path, rule, None);
            }
            return written == 1 && table.len() == 1;
        }
        for name in names {
            if let Some(key) = key(&join(pattern, name))
                && let Given::Always(example) = key.given
                && !table.contains_key(name)
            {
                if self.unreadable.is_empty() && !there.iter().any(|one| one == name) {
                    let cure = match key.kind {
                        Kind::Tables => format!("write [[{name}]]"),
                        _ => format!("write {name} = {example}, say"),
                    };
                    let path = join(path, name);
                    self.problems.key(&path, "missing", Some(cure));
                    self.problems.replaced(path);
                }
                stand_in(table, key);
            }
        }
        true
    }

    /// A name that is no key of a table; the key of that table that was meant, if there is one.
    fn stranger(
        &mut self,
        name: &str,
        pattern: &str,
        path: &str,
        names: &[&'static str],
    ) -> Option<String> {
        let (cure, meant) = meant(name, pattern, names);
        // What was meant by it, one of the table's own keys, another table's, or anything here: it is not known what that would be.
        let about = match meant {
            Meant::Here(near) => join(path, near),
            Meant::Elsewhere(owner) if !owner.contains(['<', '[']) => join(owner, name),
            Meant::Elsewhere(_) | Meant::Unknown => path.to_owned(),
        };
        let rule = "not a key of a case";
        self.problems.key(&join(path, name), rule, cure);
        self.problems.replaced(about);
        match meant {
            Meant::Here(near) => Some(near.to_owned()),
            _ => None,
        }
    }

    /// A value: a table, a list of tables, or what its key says. Whether it can stay.
    fn value(&mut self, pattern: &str, path: &str, value: &mut Spanned<DeValue>) -> bool {
        let members = format!("{pattern}[]");
        let key = key(pattern);
        let wrong = match (value.get_mut(), key) {
            (DeValue::Table(inner), _) if !children(pattern).is_empty() => {
                return self.table(pattern, path, inner);
            }
            (DeValue::Array(list), Some(key)) if key.kind == Kind::Tables => {
                for (i, member) in list.iter_mut().enumerate() {
                    let path = format!("{path}[{}]", i + 1);
                    if let DeValue::Table(inner) = member.get_mut() {
                        self.table(&members, &path, inner);
                    } else {
                        self.problems.value(&path, "must be a table", None);
                        *member.get_mut() = stand_in_table(&members);
                        self.problems.replaced(path);
                    }
                }
                return true;
            }
            (value, Some(key)) => leaf(key, path, value),
            (_, None) => {
                let below = children(pattern);
                let example = match below[..] {
                    [only] if only != "<name>" => format!("[{path}.{only}]"),
                    _ => format!("[{path}]"),
                };
                Err(Wrong::new(
                    "must be a table",
                    Some(format!("write {example}")),
                ))
            }
        };
        if let Err(Wrong { rule, cure }) = wrong {
            self.problems.value(path, rule, cure);
            return false;
        }
        true
    }
}

/// Whether a table stands for one of several choices.
fn chooses(pattern: &str) -> bool {
    let choice = |key: &Key| matches!(key.kind, Kind::Word(_) | Kind::Choice);
    pattern == "material" || key(pattern).is_some_and(choice)
}

/// What was meant by a name that is no key.
#[derive(Clone, Copy)]
enum Meant {
    /// A key of the same table.
    Here(&'static str),
    /// A key of that name, of another table.
    Elsewhere(&'static str),
    /// Nobody knows.
    Unknown,
}

/// What was meant by a name that is no key, and a cure.
fn meant(name: &str, pattern: &str, names: &[&'static str]) -> (Option<String>, Meant) {
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
    let elsewhere = KEYS.iter().find(|key| key.name() == name);
    match elsewhere.and_then(|key| key.path.rsplit_once('.')) {
        Some((owner, _)) => {
            let cure = format!("it belongs to {owner}");
            (Some(cure), Meant::Elsewhere(owner))
        }
        None => {
            let cure = format!("known here: {}", names.join(", "));
            (Some(cure), Meant::Unknown)
        }
    }
}

/// The rule that a value breaks, and a cure.
struct Wrong {
    rule: String,
    cure: Option<String>,
}

impl Wrong {
    fn new(rule: impl Into<String>, cure: Option<String>) -> Self {
        let rule = rule.into();
        Self { rule, cure }
    }
}

/// A value that is no table, or should be none.
fn leaf(key: &Key, path: &str, value: &DeValue) -> Result<(), Wrong> {
    match (key.kind, value) {
        (Kind::Text, DeValue::String(text)) => {
            let plain = !text.trim().is_empty() && !text.chars().any(char::is_control);
            if !plain || text.chars().count() > 200 {
                let rule = "must be one line of text, not empty, of at most 200 characters";
                return Err(Wrong::new(rule, None));
            }
        }
        (Kind::Switch, DeValue::Boolean(_)) => {}
        (Kind::Count, DeValue::Integer(_)) | (Kind::Number, _) if number(value).is_some() => {
            let x = number(value).unwrap_or_default();
            if !x.is_finite() {
                return Err(Wrong::new("must be a finite number", try_default(key)));
            } else if let Some(rule) = key.range.broken_by(x) {
                return Err(Wrong::new(rule, try_default(key)));
            }
        }
        (Kind::Word(words), DeValue::String(word)) => {
            if !words.contains(&word.as_ref()) {
                return Err(Wrong::new(one_of(words), word_meant(key, words, word)));
            }
        }
        (Kind::Zone, DeValue::Array(ends)) if ends.len() == 2 => {
            finite(ends.iter().map(|x| x.get_ref()), "[from, to]")?;
        }
        (Kind::Points, DeValue::Array(points)) => {
            let pair = |point: &DeValue| point.as_array().is_some_and(|pair| pair.len() == 2);
            if !points.iter().all(|point| pair(point.get_ref())) {
                return Err(Wrong::new("must be a list of points [x, s]", None));
            }
            let pairs = points.iter().filter_map(|point| point.get_ref().as_array());
            let numbers = pairs.flat_map(|pair| pair.iter()).map(|x| x.get_ref());
            finite(numbers, "[[x, s], ...]")?;
        }
        _ => return Err(wrong_type(key, path)),
    }
    Ok(())
}

fn finite<'v, 'i: 'v>(
    mut values: impl Iterator<Item = &'v DeValue<'i>>,
    form: &str,
) -> Result<(), Wrong> {
    if values.all(|x| number(x).is_some_and(f64::is_finite)) {
        return Ok(());
    }
    Err(Wrong::new(format!("must be finite numbers {form}"), None))
}

fn wrong_type(key: &Key, path: &str) -> Wrong {
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
    Wrong::new(rule, cure)
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
