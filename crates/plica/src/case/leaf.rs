//! A single value: of its type, and in its range.

use super::keys::{Given, Key, Kind, children};
use super::spelling::nearest;
use toml::de::DeValue;

/// The rule that a value breaks, and a cure.
pub(super) struct Wrong {
    pub rule: String,
    pub cure: Option<String>,
}

impl Wrong {
    pub fn new(rule: impl Into<String>, cure: Option<String>) -> Self {
        let rule = rule.into();
        Self { rule, cure }
    }
}

/// A value that is no table, or should be none.
pub(super) fn leaf(key: &Key, path: &str, value: &DeValue) -> Result<(), Wrong> {
    match (key.kind, value) {
        (Kind::Text, DeValue::String(text)) => {
            let plain = !text.trim().is_empty() && !text.chars().any(char::is_control);
            if !plain || text.chars().count() > 200 {
                let rule = "must be one line of text without tabs or other control characters, not empty, of at most 200 characters";
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
            } else if let Some(wrong) = too_long(value) {
                return Err(wrong);
            }
        }
        (Kind::Word(words), DeValue::String(word)) => {
            if !words.contains(&word.as_ref()) {
                return Err(Wrong::new(one_of(key), word_meant(key, words, word)));
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
        _ => return Err(wrong_type(key, path, value)),
    }
    Ok(())
}

fn finite<'v, 'i: 'v>(
    mut values: impl Iterator<Item = &'v DeValue<'i>>,
    form: &str,
) -> Result<(), Wrong> {
    let mut long = None;
    let is_finite = |x: &DeValue| {
        long = long.take().or_else(|| too_long(x));
        number(x).is_some_and(f64::is_finite)
    };
    if values.all(is_finite) {
        return long.map_or(Ok(()), Err);
    }
    Err(Wrong::new(format!("must be finite numbers {form}"), None))
}

fn wrong_type(key: &Key, path: &str, value: &DeValue) -> Wrong {
    let rule = match key.kind {
        Kind::Text => "must be text, in quotes".to_owned(),
        Kind::Switch => "must be true or false".to_owned(),
        Kind::Count => "must be a whole number".to_owned(),
        Kind::Number => "must be a number".to_owned(),
        Kind::Word(_) => one_of(key),
        Kind::Zone => "must be [from, to], two numbers".to_owned(),
        Kind::Points => "must be a list of points [x, s]".to_owned(),
        Kind::Tables => "must be a list of tables".to_owned(),
        Kind::Choice => one_of(key),
    };
    let quoted = match (key.kind, value) {
        (Kind::Number | Kind::Count, DeValue::String(text)) => {
            let text = text.trim();
            let whole = |x: &f64| key.kind == Kind::Number || x.fract() == 0.0;
            let number = text.parse().ok().filter(|x: &f64| x.is_finite());
            number
                .filter(whole)
                .map(|_| format!("write {text}, without quotes"))
        }
        (Kind::Count, DeValue::Float(_)) => number(value)
            .filter(|x| x.fract() == 0.0 && x.abs() < 1e9)
            .map(|x| format!("write {x}")),
        _ => None,
    };
    let cure = match key.kind {
        _ if quoted.is_some() => quoted,
        Kind::Tables if !path.contains('[') => Some(format!("write [[{path}]]")),
        _ => try_default(key).or_else(|| Some(format!("such as {}", key.example()))),
    };
    Wrong::new(rule, cure)
}

/// A whole number with too many digits to be read as one.
fn too_long(value: &DeValue) -> Option<Wrong> {
    let DeValue::Integer(n) = value else {
        return None;
    };
    let rule = "has too many digits for a whole number";
    let cure = match n.radix() {
        10 => "write it with a point",
        _ => "write it in decimal, with a point",
    };
    let wrong = || Wrong::new(rule, Some(cure.into()));
    i64::from_str_radix(n.as_str(), n.radix())
        .is_err()
        .then(wrong)
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

/// All that a key may be, words and tables that stand for a choice.
pub(super) fn one_of(key: &Key) -> String {
    let words = match key.kind {
        Kind::Word(words) => words,
        _ => &[],
    };
    let words = words.iter().map(|word| format!("\"{word}\""));
    let choices = children(key.path).into_iter();
    let choices = choices.map(|name| format!("{{ {name} = ... }}"));
    let all: Vec<String> = words.chain(choices).collect();
    format!("must be one of {}", all.join(", "))
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
