//! Descriptions of the keys of the case file: type, unit, default, range and meaning.

use std::borrow::Cow;

/// A key of a table of the case file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Key {
    /// Its name, without the tables around it.
    pub name: &'static str,
    /// Its doc comment, with the blank before the first word.
    pub doc: &'static str,
    /// The type of its value.
    pub kind: Kind,
    /// Its default, unit and range.
    pub rule: Rule,
}

/// The type of a value.
#[derive(Clone, Copy, Debug)]
pub(super) enum Kind {
    /// One line of text.
    Text,
    /// `["a", "b", …]`
    Texts,
    /// `true` or `false`.
    Boolean,
    /// A whole number.
    Integer,
    /// A number.
    Number,
    /// `[from, to]`
    Zone,
    /// `[x, y, z]`
    Position,
    /// `[[x, s], …]`
    Points,
    /// `{ name = number, … }`; the user chooses the names.
    Numbers,
    /// A number, or `[[time, value], …]`
    Course,
    /// As many numbers, as `[x, y]` or `[x, y, z]`, or a list of such with the time first, `[[time, x, y], …]`
    VectorCourse(usize),
    /// A table with these keys.
    Table(&'static [Key]),
    /// A list of tables with these keys.
    List(&'static [Key]),
    /// A table of tables with these keys; the user chooses their names.
    Named(&'static [Key]),
    /// One of some words, or a table with exactly one of some keys.
    Choice(&'static [&'static str], &'static [Key]),
    /// A table with exactly one of the first keys, as many as the number says, or one with the keys after them.
    Either(&'static [Key], usize),
}

/// The default, unit and range of a key.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rule {
    /// The value of a key that is left out.
    pub default: Default,
    /// The unit; empty if there is none. [`LENGTH`], [`STRESS`] and [`STIFFNESS`] are those of
    /// the case.
    pub unit: &'static str,
    /// The range of a number.
    pub range: Range,
}

pub(super) const LENGTH: &str = "length";
pub(super) const STRESS: &str = "stress";
pub(super) const STIFFNESS: &str = "stress per length";

/// The value of a key that is left out.
#[derive(Clone, Copy, Debug)]
pub(super) enum Default {
    /// The key must be given; an example.
    Required(&'static str),
    /// This value, written as in a case file (words and texts without quotes).
    Value(&'static str),
    /// The default in words (empty for one of several choices), and an example.
    Described(&'static str, &'static str),
}

/// The range of a number.
#[derive(Clone, Copy, Debug)]
pub(super) struct Range {
    pub low: Limit,
    pub high: Limit,
    /// The reason for the upper limit; may be empty.
    pub reason: &'static str,
}

/// One end of a range.
#[derive(Clone, Copy, Debug)]
pub(super) enum Limit {
    None,
    /// The number itself is allowed.
    Inclusive(f64),
    /// The number itself is not allowed.
    Exclusive(f64),
}

/// A key that must be given, with an example.
pub(super) const fn required(example: &'static str) -> Rule {
    Rule::with(Default::Required(example))
}

/// A key with a default.
pub(super) const fn default(value: &'static str) -> Rule {
    Rule::with(Default::Value(value))
}

/// A key with a default that depends on other keys, described in words, and an example.
pub(super) const fn described(words: &'static str, example: &'static str) -> Rule {
    Rule::with(Default::Described(words, example))
}

impl Rule {
    const fn with(default: Default) -> Self {
        let range = Range {
            low: Limit::None,
            high: Limit::None,
            reason: "",
        };
        Self {
            default,
            unit: "",
            range,
        }
    }

    pub const fn unit(mut self, unit: &'static str) -> Self {
        self.unit = unit;
        self
    }

    pub const fn from(mut self, low: f64) -> Self {
        self.range.low = Limit::Inclusive(low);
        self
    }

    pub const fn above(mut self, low: f64) -> Self {
        self.range.low = Limit::Exclusive(low);
        self
    }

    pub const fn to(mut self, high: f64) -> Self {
        self.range.high = Limit::Inclusive(high);
        self
    }

    pub const fn because(mut self, reason: &'static str) -> Self {
        self.range.reason = reason;
        self
    }
}

impl Range {
    /// Returns the rule that a number breaks, if it is out of the range.
    pub fn broken_by(&self, x: f64) -> Option<String> {
        let rule = match (self.low, self.high) {
            (Limit::Inclusive(low), _) if x < low => format!("must be at least {}", plain(low)),
            (Limit::Exclusive(low), _) if x <= low => format!("must be above {}", plain(low)),
            (_, Limit::Inclusive(high)) if x > high => format!("must be at most {}", plain(high)),
            (_, Limit::Exclusive(high)) if x >= high => format!("must be below {}", plain(high)),
            _ => return None,
        };
        Some(match self.reason {
            "" => rule,
            reason => format!("{rule} ({reason})"),
        })
    }

    /// Returns the range in words; empty if it has no limits.
    pub fn words(&self) -> String {
        let low = match self.low {
            Limit::None => None,
            Limit::Inclusive(x) => Some(format!("at least {}", plain(x))),
            Limit::Exclusive(x) => Some(format!("above {}", plain(x))),
        };
        let high = match self.high {
            Limit::None => None,
            Limit::Inclusive(x) => Some(format!("at most {}", plain(x))),
            Limit::Exclusive(x) => Some(format!("below {}", plain(x))),
        };
        let limits: Vec<String> = [low, high].into_iter().flatten().collect();
        match self.reason {
            "" => limits.join(", "),
            reason => format!("{} ({reason})", limits.join(", ")),
        }
    }
}

impl Key {
    /// Returns its meaning, in whole sentences.
    pub fn meaning(&self) -> &'static str {
        self.doc.trim()
    }

    pub fn is_required(&self) -> bool {
        matches!(self.rule.default, Default::Required(_))
    }

    /// Returns its default as it would be written, if that is one value.
    pub fn default(&self) -> Option<Cow<'static, str>> {
        match self.rule.default {
            Default::Value(value) => Some(self.kind.literal(value)),
            _ => None,
        }
    }

    /// Returns a value that may be written: the default if it is one value.
    pub fn example(&self) -> Cow<'static, str> {
        let (Default::Required(x) | Default::Value(x) | Default::Described(_, x)) =
            self.rule.default;
        self.kind.literal(x)
    }
}

impl Kind {
    /// Returns the keys of its table or tables.
    pub const fn keys(&self) -> &'static [Key] {
        match self {
            Self::Table(keys)
            | Self::List(keys)
            | Self::Named(keys)
            | Self::Choice(_, keys)
            | Self::Either(keys, _) => keys,
            _ => &[],
        }
    }

    /// Returns the pattern of the path of a key in its table or tables, given its own.
    pub fn pattern(&self, path: &str, key: &Key) -> String {
        let name = key.name;
        match self {
            Self::List(_) => format!("{path}[].{name}"),
            Self::Named(_) => format!("{path}.<name>.{name}"),
            _ => join(path, name),
        }
    }

    /// Puts words and texts in quotes.
    fn literal(&self, value: &'static str) -> Cow<'static, str> {
        let quoted = match self {
            Self::Text => true,
            Self::Choice(words, _) => words.contains(&value),
            _ => false,
        };
        match quoted {
            true => format!("\"{value}\"").into(),
            false => value.into(),
        }
    }
}

/// Returns the path of a key in a table. A name is quoted where TOML demands it.
pub(super) fn join(path: &str, name: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_".contains(c);
    let name = match !name.is_empty() && name.chars().all(plain) {
        true => Cow::from(name),
        false => Cow::from(format!("\"{name}\"")),
    };
    match path {
        "" => name.into_owned(),
        _ => format!("{path}.{name}"),
    }
}

/// Calls `visit` with every key below some keys, and with the pattern of its path: `<name>` stands
/// for a name that the user chooses, `[]` for a member of a list.
pub(super) fn visit(keys: &'static [Key], visitor: &mut dyn FnMut(&str, &'static Key)) {
    fn below(kind: Kind, path: &str, visitor: &mut dyn FnMut(&str, &'static Key)) {
        for key in kind.keys() {
            let path = kind.pattern(path, key);
            visitor(&path, key);
            below(key.kind, &path, visitor);
        }
    }
    below(Kind::Table(keys), "", visitor);
}

/// Writes a number as a person would.
fn plain(x: f64) -> String {
    match x.abs() {
        0.0 => "0".to_owned(),
        size if (1e-3..1e6).contains(&size) => format!("{x}"),
        _ => format!("{x:e}"),
    }
}
