//! Problems of a case, each with its place in the text.

use super::key::{Key, join};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::ops::Range;

/// A case that cannot be run, with every problem that was found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub struct CaseError {
    /// At least one problem, in the order of the text.
    pub problems: Vec<Problem>,
}

/// One problem of a case.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// The key as a dotted path, members of lists counted from one (`stages[2].steps`); empty for an
    /// error of TOML syntax.
    pub key: String,
    /// The value as written, if it is the value that is wrong, and short.
    pub value: Option<String>,
    /// The rule that is broken, with the reason where there is one to give.
    pub rule: String,
    /// A suggestion of what to write instead.
    pub help: Option<String>,
    /// The bytes of the text that the problem is about.
    pub span: Range<usize>,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.key.is_empty() {
            write!(f, "{}", self.key)?;
            if let Some(value) = &self.value {
                write!(f, " = {value}")?;
            }
            write!(f, ": ")?;
        }
        write!(f, "{}", self.rule)?;
        match &self.help {
            Some(help) => write!(f, "; {help}"),
            None => Ok(()),
        }
    }
}

impl fmt::Display for CaseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, problem) in self.problems.iter().enumerate() {
            let line_break = if i > 0 { "\n" } else { "" };
            write!(f, "{line_break}{problem}")?;
        }
        Ok(())
    }
}

/// Collects the problems of one text.
#[derive(Debug, Default)]
pub(super) struct Problems<'t> {
    text: &'t str,
    /// All keys of a case, for suggestions.
    pub keys: &'static [Key],
    found: Vec<Problem>,
    /// The places of the keys that were read: of the key itself, and of its value.
    places: BTreeMap<String, [Range<usize>; 2]>,
    /// The keys that problems were found with.
    wrong: BTreeSet<String>,
    /// The names of the unknown keys, by the index of their problem.
    unknown: BTreeMap<usize, String>,
    /// The keys whose values a default or an example replaces.
    replaced: BTreeSet<String>,
}

impl<'t> Problems<'t> {
    pub fn of(text: &'t str, keys: &'static [Key]) -> Self {
        Self {
            text,
            keys,
            ..Self::default()
        }
    }

    /// Records the place of a key and of its value (of a table with a header: the header).
    pub fn place(&mut self, key: &str, place: [Range<usize>; 2]) {
        self.places.insert(key.to_owned(), place);
    }

    /// Adds an error of TOML syntax. Empty help is none.
    pub fn syntax(&mut self, span: Range<usize>, rule: &str, help: impl Into<String>) {
        self.add("", None, span, rule.to_owned(), help.into());
    }

    /// Adds a value that breaks a rule. Empty help is none.
    pub fn value(&mut self, key: &str, rule: impl Into<String>, help: impl Into<String>) {
        let Some([_, span]) = self.places.get(key) else {
            return self.key(key, rule, help);
        };
        let span = span.clone();
        let value = self.text.get(span.clone()).filter(|value| is_short(value));
        self.add(key, value, span, rule.into(), help.into());
    }

    /// Adds a key that should not be there, or should be. Empty help is none.
    pub fn key(&mut self, key: &str, rule: impl Into<String>, help: impl Into<String>) {
        // A key that is not there has the place of the table that it is missing from.
        let mut path = key;
        let span = loop {
            if let Some([span, _]) = self.places.get(path) {
                break span.clone();
            }
            match path.rfind(['.', '[']) {
                Some(end) => path = &path[..end],
                None => break 0..0,
            }
        };
        self.add(key, None, span, rule.into(), help.into());
    }

    /// Adds a key that its table does not have.
    pub fn unknown(&mut self, key: &str, name: &str, help: String) {
        self.unknown.insert(self.found.len(), name.to_owned());
        self.key(key, "unknown key", help);
    }

    /// Replaces the help of all unknown keys of a table by that for their names.
    pub fn advise_unknown(&mut self, table: &str, help: impl Fn(&str) -> String) {
        for (&i, name) in &self.unknown {
            let problem = &mut self.found[i];
            if problem.key == join(table, name) {
                problem.help = Some(help(name));
            }
        }
    }

    /// Marks a key whose value is not used: a default or an example replaces it, and rules that
    /// compare it with others do not apply.
    pub fn replaced(&mut self, key: impl Into<String>) {
        self.replaced.insert(key.into());
    }

    fn add(
        &mut self,
        key: &str,
        value: Option<&str>,
        span: Range<usize>,
        rule: String,
        help: String,
    ) {
        self.wrong.insert(key.to_owned());
        self.found.push(Problem {
            key: key.to_owned(),
            value: value.map(Into::into),
            rule,
            help: Some(help).filter(|help| !help.is_empty()),
            span,
        });
    }

    pub fn len(&self) -> usize {
        self.found.len()
    }

    pub fn is_empty(&self) -> bool {
        self.found.is_empty()
    }

    /// Returns whether no problem was found with these keys, or below them, and none of them is
    /// replaced. A rule that compares several keys is checked only then.
    pub fn are_sound(&self, keys: &[&str]) -> bool {
        let is_wrong = |key: &&str| any_within(&self.wrong, key) || !self.is_as_written(key);
        !keys.iter().any(is_wrong)
    }

    /// Returns whether a key is in the text.
    pub fn is_given(&self, key: &str) -> bool {
        self.places.contains_key(key)
    }

    /// Returns whether neither a key, nor one below it, nor a table around it is replaced.
    pub fn is_as_written(&self, key: &str) -> bool {
        let mut tables = key.match_indices(['.', '[']).map(|(end, _)| &key[..end]);
        !any_within(&self.replaced, key) && !tables.any(|table| self.replaced.contains(table))
    }

    /// Returns all problems in the order of the text.
    ///
    /// # Errors
    /// If there are any.
    pub fn into_result(self) -> Result<(), CaseError> {
        let mut problems = self.found;
        problems.sort_by_key(|problem| problem.span.start);
        match problems.is_empty() {
            true => Ok(()),
            false => Err(CaseError { problems }),
        }
    }
}

/// Returns whether one of some keys is this one, or below it.
fn any_within(keys: &BTreeSet<String>, table: &str) -> bool {
    let below = |mark: char| {
        let start = format!("{table}{mark}");
        let next = keys.range(start.clone()..).next();
        next.is_some_and(|key| key.starts_with(&start))
    };
    keys.contains(table) || below('.') || below('[')
}

/// Returns whether a value fits into a message: one line, and not the header of a table.
fn is_short(value: &str) -> bool {
    value.chars().count() <= 60 && !value.contains('\n') && !value.starts_with("[[")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_problem_affects_the_tables_around_it_and_a_replaced_table_what_is_below() {
        let mut problems = Problems::default();
        problems.value("muscles.a.zone", "", "");
        problems.key("stages[2].drive.b", "", "");
        problems.replaced("mesh");
        problems.replaced("imperfections[1].of");
        for (key, sound) in [
            ("muscles.a.zone", false),
            ("muscles.a", false),
            ("muscles", false),
            ("muscles.b", true),
            ("muscles.a.zones", true),
            // Wrong, but not replaced: what is below is as written.
            ("muscles.a.zone.below", true),
            ("stages", false),
            ("stages[1]", true),
            ("stages[2].drive", false),
            ("stages[2].drive.b.length_ratio", true),
            ("mesh.degree", false),
            ("meshes", true),
            ("imperfections[1].of.muscle", false),
            ("imperfections[1].amplitude", true),
            ("imperfections[1]", false),
            ("imperfections[10].of", true),
        ] {
            assert_eq!(problems.are_sound(&[key]), sound, "{key}");
        }
    }
}
