//! The shape of a case: every key known, every value of its type and in its range, nothing
//! missing. One walk along the text, against the table of keys.
//!
//! What is found wrong is told, and makes place for what can stand there, so that everything else can be looked at too.

use super::keys::{Given, Key, Kind, children, join, key};
use super::leaf::{Wrong, leaf, one_of};
use super::meant::{Meant, meant};
use super::problem::Problems;
use super::stand_in::{stand_in, stand_in_table};
use super::unreadable::Unreadable;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Finds everything that is wrong with single keys, and leaves a table that has the shape of a case.
///
/// `unreadable` are the places in the text that are not TOML. Values around them are not looked at; where keys are lost, nothing is
/// called missing.
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
        // Whether a name was told already; whether what nobody knows is a table.
        let (mut told, mut unknown) = (false, vec![]);
        for (key, value) in table.iter_mut() {
            let name = key.get_ref().as_ref();
            if self.unreadable.touches(&key.span()) || self.unreadable.touches(&value.span()) {
                self.problems.replaced(join(path, name));
                there.push(name.to_owned());
                unsound.push(name.to_owned());
                told = true;
                continue;
            }
            let below = if name != "<name>" && names.contains(&name) {
                name
            } else if names.contains(&"<name>") {
                "<name>"
            } else {
                unsound.push(name.to_owned());
                told = true;
                match self.stranger(name, pattern, path, &names) {
                    Meant::Here(near) => {
                        // What it holds is looked at as if it was spelt right.
                        self.value(&join(pattern, near), &join(path, name), value);
                        there.push(near.to_owned());
                    }
                    Meant::Elsewhere(owners) => {
                        let below =
                            |owner: &&String| !pattern.is_empty() && owner.starts_with(pattern);
                        let only = owners.first().filter(|_| owners.len() == 1);
                        if let Some(owner) = owners.iter().find(below).or(only) {
                            self.value(&join(owner, name), &join(path, name), value);
                        }
                        there.extend(self.belongs(name, pattern, path, &owners));
                    }
                    Meant::Unknown => unknown.push(matches!(
                        value.get_ref(),
                        DeValue::Table(_) | DeValue::Array(_)
                    )),
                }
                continue;
            };
            there.push(name.to_owned());
            let path = join(path, name);
            if !self.value(&join(pattern, below), &path, value) {
                self.problems.replaced(path);
                unsound.push(name.to_owned());
            }
        }
        for is_table in &unknown {
            self.may_be_meant(*is_table, pattern, path, &there);
        }
        for name in unsound {
            table.remove(name.as_str());
        }
        if chooses(pattern) {
            // What is no choice at all has been told.
            if written != 1 && !told {
                let rule = match key(pattern) {
                    Some(key) => one_of(key),
                    None => format!("must be exactly one of {}", names.join(", ")),
                };
                self.problems.key(path, rule, None);
            }
            return written == 1 && table.len() == 1;
        }
        for name in names {
            if let Some(key) = key(&join(pattern, name))
                && let Given::Always(example) = key.given
                && !table.contains_key(name)
            {
                let replaced = !self.problems.is_as_written(&join(path, name));
                let there = replaced || there.iter().any(|one| one == name);
                if !self.unreadable.keys_lost && !there {
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

    /// A name that is no key of a table, and what was meant by it.
    fn stranger(&mut self, name: &str, pattern: &str, path: &str, names: &[&'static str]) -> Meant {
        let (cure, meant) = meant(name, pattern, names);
        let rule = "not a key of a case";
        self.problems.key(&join(path, name), rule, cure);
        if let Meant::Here(near) = meant {
            self.problems.replaced(join(path, near));
        }
        meant
    }

    /// What a name stands for that belongs to other tables: if one of them is below this table, the key that leads there, which is then
    /// not missing (`wave` for `shape.wave`).
    fn belongs(
        &mut self,
        name: &str,
        pattern: &str,
        path: &str,
        owners: &[String],
    ) -> Option<String> {
        let names = children(pattern);
        let below = |owner: &String| {
            let rest = owner.strip_prefix(pattern)?;
            let first = rest
                .trim_start_matches(['.', '[', ']'])
                .split(['.', '['])
                .next()?;
            names.contains(&first).then(|| first.to_owned())
        };
        let own = owners.iter().find_map(below);
        if let Some(own) = own.filter(|_| !pattern.is_empty()) {
            self.problems.replaced(path.to_owned());
            return Some(own);
        }
        for owner in owners {
            // Of which member, or name, nobody knows.
            let table = owner.split(['<', '[']).next().unwrap_or_default();
            self.problems.replaced(match table == owner {
                true => join(owner, name),
                false => table.trim_end_matches('.').to_owned(),
            });
        }
        None
    }

    /// Any key of a table that is not there may be what was meant by a name that is near none of them.
    fn may_be_meant(&mut self, is_table: bool, pattern: &str, path: &str, there: &[String]) {
        for name in children(pattern) {
            let pattern = join(pattern, name);
            let alike = match is_table {
                true => !children(&pattern).is_empty(),
                false => key(&pattern).is_some(),
            };
            if alike && !there.iter().any(|one| one == name) {
                self.problems.replaced(join(path, name));
            }
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
            // A header that is not read makes one table out of many.
            (
                DeValue::Table(_),
                Some(Key {
                    kind: Kind::Tables, ..
                }),
            ) if self.unreadable.headers_lost => {
                return false;
            }
            (value, Some(key)) => leaf(key, path, value),
            (_, None) if pattern == "muscles.<name>" && is_below(pattern, path) => {
                if self.problems.is_as_written("muscles") {
                    let cure = "write [muscles.NAME]";
                    self.problems
                        .key("muscles", "a muscle needs a name", Some(cure.into()));
                    self.problems.replaced("muscles".to_owned());
                }
                return false;
            }
            (value, None) => {
                let many = matches!(value, DeValue::Array(_));
                Err(Wrong::new(
                    "must be a table",
                    Some(as_table(pattern, path, many)),
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

/// Whether the last name of a path is a key of a table, and not of the one around it.
fn is_below(pattern: &str, path: &str) -> bool {
    let name = path.rsplit('.').next().unwrap_or(path);
    children(pattern).contains(&name)
}

/// How a table is written, in the place of a value or of `many` tables.
fn as_table(pattern: &str, path: &str, many: bool) -> String {
    let below = children(pattern);
    let name = path.rsplit('.').next().unwrap_or(path);
    // A member of a list has no header of its own.
    let header = !path.contains('[');
    match below[..] {
        _ if many && header => format!("write [{path}]"),
        _ if pattern.ends_with(".<name>") && below.contains(&name) => {
            format!("write NAME.{name}, with the name of what it is for")
        }
        ["<name>"] if header => format!("write [{path}.NAME]"),
        ["<name>"] => format!("write {name}.NAME = {{ ... }}"),
        [only, ..] if key(&join(pattern, only)).is_some() && !pattern.is_empty() => {
            format!("write {name} = {{ {only} = ... }}, say")
        }
        [only] if header => format!("write [{path}.{only}]"),
        _ => format!("write {name} = {{ ... }}"),
    }
}

/// Whether a table stands for one of several choices.
fn chooses(pattern: &str) -> bool {
    let choice = |key: &Key| matches!(key.kind, Kind::Word(_) | Kind::Choice);
    pattern == "material" || key(pattern).is_some_and(choice)
}
