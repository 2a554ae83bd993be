//! Reads typed values from parsed TOML: checks types and ranges, finds unknown and missing keys.
//!
//! The macros [`table`] and [`choice`] declare the tables of the case file. A value that cannot be
//! used is reported, and its default or example takes its place, so that all problems of a case are
//! found at once.

use super::key::{Default, Key, Kind, join, visit};
use super::problem::Problems;
use super::spelling::nearest;
use std::collections::BTreeMap;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

pub(super) type Value<'i> = Spanned<DeValue<'i>>;

/// A type that can be read from a case file.
pub(super) trait Read: Sized {
    /// The description of its values.
    const KIND: Kind;

    /// Reads a value of a key, or reports the problem. `path` is the key's place in the case.
    fn read(problems: &mut Problems, key: &Key, path: &str, value: &Value) -> Option<Self>;

    /// Returns the value of a key that is left out, or cannot be read.
    fn fallback(key: &Key) -> Self {
        let example = match Self::KIND {
            Kind::Table(_) => "{}".into(),
            _ => key.example(),
        };
        let value = DeValue::parse(&example).ok();
        let read = |value| Self::read(&mut Problems::default(), key, "", &value);
        let Some(value) = value.and_then(read) else {
            unreachable!("the default of {} can be read", key.name)
        };
        value
    }
}

/// A table of the case file.
pub(super) trait Table: Sized {
    /// Its keys.
    const KEYS: &'static [Key];

    /// Reads the values of all keys, in their order.
    fn from_fields(fields: Fields<'_, '_, '_>) -> Self;

    /// Returns the name and the key that another name of a table of this kind stands for.
    fn meant(_name: &str) -> Option<&'static str> {
        None
    }
}

/// The values of the keys of one table.
pub(super) struct Fields<'a, 't, 'i> {
    problems: &'a mut Problems<'t>,
    keys: std::slice::Iter<'static, Key>,
    /// The value of each key that is there, with its path as written.
    values: BTreeMap<&'static str, (String, &'a Value<'i>)>,
}

impl Fields<'_, '_, '_> {
    /// Reads the value of the next key.
    pub fn next<T: Read>(&mut self) -> T {
        let Some(key) = self.keys.next() else {
            unreachable!("a table has as many fields as keys")
        };
        let Some((path, value)) = self.values.get(key.name) else {
            return T::fallback(key);
        };
        T::read(self.problems, key, path, value).unwrap_or_else(|| {
            self.problems.replaced(&**path);
            T::fallback(key)
        })
    }
}

/// Declares a table of the case file. `name: Type = rule;` is a key; its doc comment is its meaning in
/// the reference page and the schema, and the rule its default, unit and range. `meant by f` declares the
/// function f as [`Table::meant`].
macro_rules! table {
    ($(#[doc = $about:literal])* $Table:ident $(meant by $meant:ident)? {
        $($(#[doc = $doc:literal])+ $field:ident: $Type:ty = $rule:expr;)+
    }) => {
        $(#[doc = $about])*
        #[derive(Clone, Debug)]
        pub(super) struct $Table {
            $($(#[doc = $doc])+ pub $field: $Type,)+
        }

        impl Table for $Table {
            const KEYS: &'static [Key] = &[$(Key {
                name: stringify!($field),
                doc: concat!($($doc),+),
                kind: <$Type as Read>::KIND,
                rule: $rule,
            }),+];

            fn from_fields(mut fields: Fields<'_, '_, '_>) -> Self {
                Self { $($field: fields.next(),)+ }
            }

            $(fn meant(name: &str) -> Option<&'static str> {
                $meant(name)
            })?
        }
    };
}

/// Declares the words, and the tables of one key, that a value of an enumeration is written as.
macro_rules! choice {
    ($Choice:ty {
        $($word:literal => $value:expr,)*
        $($(#[doc = $doc:literal])+ $name:literal: $Type:ty = $rule:expr => $make:expr,)*
    }) => {
        impl Read for $Choice {
            const KIND: Kind = {
                const KEYS: &[Key] = &[$(Key {
                    name: $name,
                    doc: concat!($($doc),+),
                    kind: <$Type as Read>::KIND,
                    rule: $rule,
                }),*];
                Kind::Choice(&[$($word),*], KEYS)
            };

            fn read(
                problems: &mut Problems,
                key: &Key,
                path: &str,
                value: &Value,
            ) -> Option<Self> {
                let (chosen, table) = choose(problems, key, path, value)?;
                match (chosen, table) {
                    $(($word, None) => Some($value),)*
                    $(($name, Some((key, path, value))) => {
                        <$Type as Read>::read(problems, key, &path, value).map($make)
                    })*
                    _ => None,
                }
            }
        }
    };
}

pub(super) use {choice, table};

/// A key of a table that stands for a choice, with its path and value.
pub(super) type Chosen<'a, 'i> = (&'static Key, String, &'a Value<'i>);

/// Returns the word, or the only key of the table, that a value is.
pub(super) fn choose<'a, 'i>(
    problems: &mut Problems,
    key: &Key,
    path: &str,
    value: &'a Value<'i>,
) -> Option<(&'static str, Option<Chosen<'a, 'i>>)> {
    let Kind::Choice(words, keys) = key.kind else {
        return None;
    };
    let help = match value.get_ref() {
        DeValue::String(word) => {
            if let Some(word) = words.iter().find(|known| *known == word) {
                return Some((word, None));
            }
            match keys.iter().find(|key| key.name == word) {
                Some(Key { name, kind, .. }) => match kind {
                    Kind::Table(_) if !path.contains(['.', '[']) => {
                        format!("write [{path}.{name}]")
                    }
                    _ => format!("write {} = {{ {name} = ... }}", key.name),
                },
                None => did_you_mean(nearest(word, words.iter().copied()), "\""),
            }
        }
        DeValue::Table(table) => {
            let (values, unknown) = known_keys(problems, key.kind, path, table);
            if values.len() > 1 {
                let names: Vec<&str> = values.into_keys().collect();
                let rule = format!("only one of {} may be given", names.join(" and "));
                problems.key(path, rule, "");
                return None;
            }
            let mut values = values.into_iter();
            if let Some((name, (path, value))) = values.next() {
                let key = keys.iter().find(|key| key.name == name)?;
                return Some((name, Some((key, path, value))));
            }
            if !unknown {
                problems.key(path, one_of(key), "");
            }
            return None;
        }
        _ => suggestion(key),
    };
    problems.value(path, one_of(key), help);
    None
}

/// Returns the known keys of a table with their paths and values, and whether there are unknown ones,
/// which are reported. A misspelt key counts as the one that is nearest.
fn known_keys<'a, 'i>(
    problems: &mut Problems,
    kind: Kind,
    path: &str,
    table: &'a DeTable<'i>,
) -> (BTreeMap<&'static str, (String, &'a Value<'i>)>, bool) {
    let keys = kind.keys();
    let mut values = BTreeMap::new();
    let mut strangers = vec![];
    for (name, value) in table {
        let (path, span) = (join(path, name.get_ref()), name.span());
        problems.place(&path, [span, value.span()]);
        match keys.iter().find(|key| key.name == name.get_ref()) {
            Some(key) => drop(values.insert(key.name, (path, value))),
            None => strangers.push((name.get_ref().as_ref(), path, value)),
        }
    }
    let is_unknown = !strangers.is_empty();
    for (name, own, value) in strangers {
        let near = nearest(name, keys.iter().map(|key| key.name));
        let mut tables = tables_with(name, problems.keys);
        // Those below this table come before others.
        let below = format!("{path}.");
        if tables.iter().any(|table| table.starts_with(&below)) {
            tables.retain(|table| table.starts_with(&below));
        }
        problems.unknown(&own, name, unknown_help(name, near, kind, &tables));
        if let Some(key) = keys.iter().find(|key| Some(key.name) == near) {
            problems.replaced(join(path, key.name));
            values.entry(key.name).or_insert((own, value));
            continue;
        }
        // Any key of the same name elsewhere, or any that is not there, may be meant.
        for table in tables {
            let end = table.find(['<', '[']).unwrap_or(table.len());
            problems.replaced(match table.len() == end {
                true => join(&table, name),
                false => table[..end].trim_end_matches('.').to_owned(),
            });
        }
        for key in keys.iter().filter(|key| !values.contains_key(key.name)) {
            problems.replaced(join(path, key.name));
        }
    }
    (values, is_unknown)
}

fn unknown_help(name: &str, near: Option<&str>, kind: Kind, tables: &[String]) -> String {
    if let Kind::Choice(words, _) = kind
        && words.contains(&name)
    {
        return format!("write \"{name}\", without a table");
    }
    if near.is_some() {
        did_you_mean(near, "")
    } else if tables.is_empty() {
        let names: Vec<&str> = kind.keys().iter().map(|key| key.name).collect();
        format!("the keys here are {}", names.join(", "))
    } else {
        format!("it belongs to {}", tables.join(" or "))
    }
}

/// Returns the patterns of all tables, other than the whole case, that have a key of a name.
fn tables_with(name: &str, keys: &'static [Key]) -> Vec<String> {
    let mut tables = vec![];
    visit(keys, &mut |path, key| {
        if let Some((table, _)) = path.rsplit_once('.').filter(|_| key.name == name) {
            tables.push(table.to_owned());
        }
    });
    tables
}

impl<T: Table> Read for T {
    const KIND: Kind = Kind::Table(T::KEYS);

    fn read(problems: &mut Problems, _: &Key, path: &str, value: &Value) -> Option<Self> {
        let Some(table) = value.get_ref().as_table() else {
            problems.value(path, "must be a table", as_table(Self::KIND, path));
            return None;
        };
        let (values, _) = known_keys(problems, Self::KIND, path, table);
        for key in T::KEYS {
            let path = join(path, key.name);
            if key.is_required() && !values.contains_key(key.name) && problems.is_as_written(&path)
            {
                let help = match key.kind {
                    Kind::List(_) => format!("write [[{path}]]"),
                    _ => format!("for example, {} = {}", key.name, key.example()),
                };
                problems.key(&path, "missing", help);
                problems.replaced(path);
            }
        }
        Some(T::from_fields(Fields {
            problems,
            keys: T::KEYS.iter(),
            values,
        }))
    }
}

impl<T: Table> Read for Vec<T> {
    const KIND: Kind = Kind::List(T::KEYS);

    fn read(problems: &mut Problems, key: &Key, path: &str, value: &Value) -> Option<Self> {
        let Some(list) = value.get_ref().as_array() else {
            return wrong_type(problems, key, path, value);
        };
        let members = list.iter().enumerate().map(|(i, member)| {
            let path = format!("{path}[{}]", i + 1);
            problems.place(&path, [member.span(), member.span()]);
            T::read(problems, key, &path, member).unwrap_or_else(|| {
                problems.replaced(path);
                T::fallback(key)
            })
        });
        Some(members.collect())
    }

    fn fallback(_: &Key) -> Self {
        vec![]
    }
}

impl<T: Table> Read for BTreeMap<String, T> {
    const KIND: Kind = Kind::Named(T::KEYS);

    fn read(problems: &mut Problems, key: &Key, path: &str, value: &Value) -> Option<Self> {
        let Some(table) = value.get_ref().as_table() else {
            problems.value(path, "must be a table", as_table(Self::KIND, path));
            return None;
        };
        let mut members = Self::new();
        for (name, member) in table {
            let own = join(path, name.get_ref());
            problems.place(&own, [name.span(), member.span()]);
            let is_key = T::KEYS.iter().any(|key| key.name == name.get_ref());
            if is_key && !member.get_ref().is_table() {
                let help = format!("write {path}.NAME.{}, with a name", name.get_ref());
                problems.key(&own, "must be a table", help);
                problems.replaced(path);
            } else if let Some(meant) =
                T::meant(name.get_ref()).filter(|_| !member.get_ref().is_table())
            {
                problems.value(&own, "must be a table", format!("write {path}.{meant}"));
                problems.replaced(own);
            } else if let Some(read) = T::read(problems, key, &own, member) {
                members.insert(name.get_ref().clone().into_owned(), read);
            } else {
                problems.replaced(own);
            }
        }
        Some(members)
    }

    fn fallback(_: &Key) -> Self {
        Self::new()
    }
}

impl Read for BTreeMap<String, f64> {
    const KIND: Kind = Kind::Numbers;

    fn read(problems: &mut Problems, key: &Key, path: &str, value: &Value) -> Option<Self> {
        let Some(table) = value.get_ref().as_table() else {
            return wrong_type(problems, key, path, value);
        };
        let mut members = Self::new();
        for (name, member) in table {
            let own = join(path, name.get_ref());
            problems.place(&own, [name.span(), member.span()]);
            let read = match number(member) {
                Some(x) => in_range(problems, key, &own, x),
                None => {
                    problems.value(&own, "must be a number", "");
                    None
                }
            };
            match read {
                Some(x) => drop(members.insert(name.get_ref().clone().into_owned(), x)),
                None => problems.replaced(own),
            }
        }
        Some(members)
    }

    fn fallback(_: &Key) -> Self {
        Self::new()
    }
}

impl<T: Read> Read for Option<T> {
    const KIND: Kind = T::KIND;

    fn read(problems: &mut Problems, key: &Key, path: &str, value: &Value) -> Option<Self> {
        T::read(problems, key, path, value).map(Some)
    }

    fn fallback(_: &Key) -> Self {
        None
    }
}

impl Read for String {
    const KIND: Kind = Kind::Text;

    fn read(problems: &mut Problems, key: &Key, path: &str, value: &Value) -> Option<Self> {
        let Some(text) = value.get_ref().as_str() else {
            return wrong_type(problems, key, path, value);
        };
        let blank = text.trim().is_empty() || text.chars().any(char::is_control);
        if blank || text.chars().count() > 200 {
            let rule = "must be one line of 1 to 200 characters, without control characters";
            problems.value(path, rule, "");
            return None;
        }
        Some(text.to_owned())
    }
}

impl Read for Vec<String> {
    const KIND: Kind = Kind::Texts;

    fn read(problems: &mut Problems, key: &Key, path: &str, value: &Value) -> Option<Self> {
        let texts = value.get_ref().as_array().and_then(|list| {
            let text = |member: &Value| {
                let text = member.get_ref().as_str()?;
                let is_line = text.chars().count() <= 200 && !text.chars().any(char::is_control);
                is_line.then(|| text.to_owned())
            };
            list.iter().map(text).collect::<Option<Self>>()
        });
        match texts {
            Some(texts) => Some(texts),
            None => wrong_type(problems, key, path, value),
        }
    }
}

impl Read for bool {
    const KIND: Kind = Kind::Boolean;

    fn read(problems: &mut Problems, key: &Key, path: &str, value: &Value) -> Option<Self> {
        match value.get_ref() {
            DeValue::Boolean(yes) => Some(*yes),
            _ => wrong_type(problems, key, path, value),
        }
    }
}

impl Read for f64 {
    const KIND: Kind = Kind::Number;

    fn read(problems: &mut Problems, key: &Key, path: &str, value: &Value) -> Option<Self> {
        let Some(x) = number(value) else {
            return wrong_type(problems, key, path, value);
        };
        in_range(problems, key, path, x)
    }
}

impl Read for usize {
    const KIND: Kind = Kind::Integer;

    fn read(problems: &mut Problems, key: &Key, path: &str, value: &Value) -> Option<Self> {
        if !matches!(value.get_ref(), DeValue::Integer(_)) {
            return wrong_type(problems, key, path, value);
        }
        // The ranges of whole numbers are exact in floating point.
        in_range(problems, key, path, number(value)?).map(|x| x as usize)
    }
}

impl Read for [f64; 2] {
    const KIND: Kind = Kind::Zone;

    fn read(problems: &mut Problems, key: &Key, path: &str, value: &Value) -> Option<Self> {
        let list = value.get_ref().as_array();
        let Some([from, to]) = list.and_then(|list| list.get(..2).filter(|_| list.len() == 2))
        else {
            return wrong_type(problems, key, path, value);
        };
        finite(problems, path, [from, to])
    }
}

impl Read for [f64; 3] {
    const KIND: Kind = Kind::Position;

    fn read(problems: &mut Problems, key: &Key, path: &str, value: &Value) -> Option<Self> {
        let list = value.get_ref().as_array();
        let Some([x, y, z]) = list.and_then(|list| list.get(..3).filter(|_| list.len() == 3))
        else {
            return wrong_type(problems, key, path, value);
        };
        let [x, y] = finite(problems, path, [x, y])?;
        let [_, z] = finite(problems, path, [z, z])?;
        Some([x, y, z])
    }
}

impl Read for Vec<[f64; 2]> {
    const KIND: Kind = Kind::Points;

    fn read(problems: &mut Problems, key: &Key, path: &str, value: &Value) -> Option<Self> {
        let Some(list) = value.get_ref().as_array() else {
            return wrong_type(problems, key, path, value);
        };
        let mut points = vec![];
        for point in list {
            let point = point.get_ref().as_array();
            let Some([x, s]) = point.and_then(|point| point.get(..2).filter(|_| point.len() == 2))
            else {
                return wrong_type(problems, key, path, value);
            };
            points.push(finite(problems, path, [x, s])?);
        }
        Some(points)
    }
}

/// Returns the finite numbers of a list; none, with a problem, if it is not a list of so many.
pub(super) fn numbers(
    problems: &mut Problems,
    key: &Key,
    path: &str,
    (value, whole): (&Value, &Value),
    count: usize,
) -> Option<Vec<f64>> {
    let list = value.get_ref().as_array();
    let list = list.filter(|list| list.len() == count);
    let Some(numbers) = list.and_then(|list| list.iter().map(number).collect::<Option<Vec<_>>>())
    else {
        return wrong_type(problems, key, path, whole);
    };
    if numbers.iter().all(|x| x.is_finite()) {
        return Some(numbers);
    }
    problems.value(path, "must consist of finite numbers", "");
    None
}

fn finite(problems: &mut Problems, path: &str, pair: [&Value; 2]) -> Option<[f64; 2]> {
    let pair = pair.map(|x| number(x).filter(|x| x.is_finite()));
    if let [Some(x), Some(y)] = pair {
        return Some([x, y]);
    }
    problems.value(path, "must consist of finite numbers", "");
    None
}

pub(super) fn in_range(problems: &mut Problems, key: &Key, path: &str, x: f64) -> Option<f64> {
    let finite = (!x.is_finite()).then(|| "must be a finite number".to_owned());
    let Some(rule) = finite.or_else(|| key.rule.range.broken_by(x)) else {
        return Some(x);
    };
    let default = key.default();
    problems.value(
        path,
        rule,
        default.map_or(String::new(), |x| format!("try {x}")),
    );
    None
}

/// Returns the number that is written, of either type.
pub(super) fn number(value: &Value) -> Option<f64> {
    match value.get_ref() {
        DeValue::Float(x) => x.as_str().parse().ok(),
        DeValue::Integer(n) => {
            let n = i128::from_str_radix(n.as_str(), n.radix());
            Some(n.map_or(f64::INFINITY, |n| n as f64))
        }
        _ => None,
    }
}

/// Reports a value of the wrong type.
pub(super) fn wrong_type<T>(
    problems: &mut Problems,
    key: &Key,
    path: &str,
    value: &Value,
) -> Option<T> {
    let rule = match key.kind {
        Kind::Text => "must be text, in quotes",
        Kind::Texts => "must be a list of texts, each in quotes",
        Kind::Boolean => "must be true or false",
        Kind::Integer => "must be a whole number",
        Kind::Number => "must be a number",
        Kind::Zone => "must be [from, to], two numbers",
        Kind::Position => "must be [x, y, z], three numbers",
        Kind::Points => "must be a list of points [x, s]",
        Kind::Numbers => "must be a table of numbers",
        Kind::Course => "must be a number, or a list of points [time, value]",
        Kind::VectorCourse(2) => "must be [x, y], or a list of points [time, x, y]",
        Kind::VectorCourse(_) => "must be [x, y, z], or a list of points [time, x, y, z]",
        Kind::List(_) => "must be a list of tables",
        Kind::Table(_) | Kind::Named(_) | Kind::Choice(..) | Kind::Either(..) => "must be a table",
    };
    let is_integer = matches!(key.kind, Kind::Integer);
    let help = match value.get_ref() {
        DeValue::String(text) if is_integer || matches!(key.kind, Kind::Number | Kind::Course) => {
            let number: Option<f64> = text.trim().parse().ok();
            let number = number.filter(|x| x.is_finite() && !(is_integer && x.fract() != 0.0));
            number.map(|_| format!("write {}, without quotes", text.trim()))
        }
        DeValue::Float(_) if is_integer => {
            let whole = number(value).filter(|x| x.fract() == 0.0 && x.abs() < 1e9);
            whole.map(|x| format!("write {x}"))
        }
        _ if matches!(key.kind, Kind::List(_)) && !path.contains('[') => {
            Some(format!("write [[{path}]]"))
        }
        _ => None,
    };
    problems.value(path, rule, help.unwrap_or_else(|| suggestion(key)));
    None
}

/// Returns how a table is written in the place of another value.
fn as_table(kind: Kind, path: &str) -> String {
    let name = path.rsplit('.').next().unwrap_or(path);
    match (kind, kind.keys()) {
        _ if path.ends_with(']') => String::new(),
        (Kind::Named(_), _) if !path.contains('[') => format!("write [{path}.NAME]"),
        (Kind::Named(_), _) => format!("write {name}.NAME = {{ ... }}"),
        _ if !path.contains(['.', '[']) => format!("write [{path}]"),
        (_, [first, ..]) => format!("write {name} = {{ {} = ... }}", first.name),
        _ => String::new(),
    }
}

fn suggestion(key: &Key) -> String {
    match key.rule.default {
        Default::Value(_) => format!("try {}", key.example()),
        _ => format!("for example, {}", key.example()),
    }
}

fn did_you_mean(near: Option<&str>, quote: &str) -> String {
    near.map_or(String::new(), |near| {
        format!("did you mean {quote}{near}{quote}?")
    })
}

/// Returns the rule of a choice: all its words and tables.
fn one_of(key: &Key) -> String {
    let Kind::Choice(words, keys) = key.kind else {
        return String::new();
    };
    let words = words.iter().map(|word| format!("\"{word}\""));
    let tables = keys.iter().map(|key| format!("{{ {} = ... }}", key.name));
    let all: Vec<String> = words.chain(tables).collect();
    match &all[..] {
        [only] => format!("must be {only}"),
        all => format!("must be one of {}", all.join(", ")),
    }
}
