//! What a key of the case file is: its type, its default, its range, its meaning.

use super::table::KEYS;
use std::borrow::Cow;

/// One key of the case file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Key {
    /// Dotted path; `<name>` stands for a name of the user's, `[]` for any member of a list.
    pub path: &'static str,
    /// What may be written.
    pub kind: Kind,
    /// Its unit; empty if it has none.
    pub unit: &'static str,
    /// What holds if it is not given.
    pub given: Given,
    /// The range of a number.
    pub range: Range,
    /// What it means, as a sentence.
    pub meaning: &'static str,
}

/// What may be written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// One line of text.
    Text,
    /// `true` or `false`.
    Switch,
    /// A whole number.
    Count,
    /// A number.
    Number,
    /// One of some words, in quotes.
    Word(&'static [&'static str]),
    /// `[from, to]`.
    Zone,
    /// `[[x, s], …]`.
    Points,
    /// A list of tables.
    Tables,
    /// A table that stands for one of several choices.
    Choice,
}

/// What holds if a key is not given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Given {
    /// It must be given, wherever the table around it is; with an example.
    Always(&'static str),
    /// It need not be given; this value is the default, as it would be written.
    Or(&'static str),
    /// It need not be given; the default in words, and an example.
    OrElse(&'static str, &'static str),
}

/// The range of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Its lower end.
    pub low: Limit,
    /// Its upper end.
    pub high: Limit,
    /// Why it ends there; may be empty.
    pub reason: &'static str,
}

/// One end of a range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Limit {
    /// It is open.
    None,
    /// The number itself is allowed.
    At(f64),
    /// The number itself is not allowed.
    Beyond(f64),
}

impl Range {
    /// Whether a number is in the range; if not, the rule it breaks.
    pub fn broken_by(&self, x: f64) -> Option<String> {
        let rule = match (self.low, self.high) {
            (Limit::At(low), _) if x < low => format!("must be at least {}", plain(low)),
            (Limit::Beyond(low), _) if x <= low => format!("must be above {}", plain(low)),
            (_, Limit::At(high)) if x > high => format!("must be at most {}", plain(high)),
            (_, Limit::Beyond(high)) if x >= high => format!("must be below {}", plain(high)),
            _ => return None,
        };
        Some(match self.reason {
            "" => rule,
            reason => format!("{rule} ({reason})"),
        })
    }

    /// The range in words; empty if it has no ends.
    pub fn words(&self) -> String {
        let low = match self.low {
            Limit::None => None,
            Limit::At(x) => Some(format!("at least {}", plain(x))),
            Limit::Beyond(x) => Some(format!("above {}", plain(x))),
        };
        let high = match self.high {
            Limit::None => None,
            Limit::At(x) => Some(format!("at most {}", plain(x))),
            Limit::Beyond(x) => Some(format!("below {}", plain(x))),
        };
        let ends: Vec<String> = [low, high].into_iter().flatten().collect();
        match self.reason {
            "" => ends.join(", "),
            reason => format!("{} ({reason})", ends.join(", ")),
        }
    }
}

impl Key {
    /// A value that may be written: the default if it is one.
    pub fn example(&self) -> &'static str {
        match self.given {
            Given::Always(example) | Given::Or(example) | Given::OrElse(_, example) => example,
        }
    }

    /// The name of the key without the tables around it.
    pub fn name(&self) -> &'static str {
        self.path.rsplit('.').next().unwrap_or(self.path)
    }
}

/// A number as a person would write it.
fn plain(x: f64) -> String {
    match x.abs() {
        0.0 => "0".to_owned(),
        size if (1e-3..1e6).contains(&size) => format!("{x}"),
        _ => format!("{x:e}"),
    }
}

/// The key with a path.
pub(super) fn key(path: &str) -> Option<&'static Key> {
    KEYS.iter().find(|key| key.path == path)
}

/// The names that may follow a path, each once; `<name>` where the user chooses.
pub(super) fn children(path: &str) -> Vec<&'static str> {
    let mut names = Vec::new();
    for key in KEYS {
        let rest = match path {
            "" => Some(key.path),
            _ => key
                .path
                .strip_prefix(path)
                .and_then(|r| r.strip_prefix('.')),
        };
        let name = rest.and_then(|r| r.split('.').next());
        if let Some(name) = name.map(|n| n.trim_end_matches("[]"))
            && !names.contains(&name)
        {
            names.push(name);
        }
    }
    names
}

/// The path of a key below another. A name stands in quotes where it must in TOML.
pub(super) fn join(path: &str, name: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_<>".contains(c);
    let name = match !name.is_empty() && name.chars().all(plain) {
        true => Cow::from(name),
        false => Cow::from(format!("\"{name}\"")),
    };
    match path {
        "" => name.into_owned(),
        _ => format!("{path}.{name}"),
    }
}
