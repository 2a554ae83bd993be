//! What can be wrong with a case.

use super::locate::locate;
use std::collections::BTreeSet;
use std::fmt;
use std::ops::Range;
use toml::Spanned;
use toml::de::DeTable;

/// A case that cannot be run, and why: every problem that was found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub struct CaseError {
    /// At least one problem, in the order of the text.
    pub problems: Vec<Problem>,
}

/// One thing that is wrong.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// The key as a dotted path, members of lists counted from one (`stages[2].steps`); empty
    /// where the text is not TOML.
    pub key: String,
    /// The value as written, if it is short.
    pub value: Option<String>,
    /// The rule it breaks, with the reason if there is one to give.
    pub rule: String,
    /// What may be written instead.
    pub cure: Option<String>,
    /// The bytes of the text it is about.
    pub span: Option<Range<usize>>,
    /// Whether it is the key that is wrong, and not its value.
    on_key: bool,
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
        match &self.cure {
            Some(cure) => write!(f, "; {cure}"),
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

/// Problems as they are found.
#[derive(Debug, Default)]
pub(super) struct Problems {
    found: Vec<Problem>,
    /// The keys of those.
    keys: BTreeSet<String>,
    /// Keys whose values are not used.
    replaced: BTreeSet<String>,
}

impl Problems {
    /// A place in the text is not TOML.
    pub fn not_toml(&mut self, why: &str, cure: Option<String>, place: Range<usize>) {
        self.add("", why.to_owned(), cure).span = Some(place);
    }

    /// A value breaks a rule.
    pub fn value(&mut self, key: &str, rule: impl Into<String>, cure: Option<String>) {
        self.add(key, rule.into(), cure).on_key = false;
    }

    /// A key should not be there, or should be.
    pub fn key(&mut self, key: &str, rule: impl Into<String>, cure: Option<String>) {
        self.add(key, rule.into(), cure);
    }

    /// The value of a key, or what is meant to be one, is not used. Something stands in for it, and rules that hold it against
    /// others would say nothing.
    pub fn replaced(&mut self, key: String) {
        self.replaced.insert(key);
    }

    fn add(&mut self, key: &str, rule: String, cure: Option<String>) -> &mut Problem {
        self.keys.insert(key.to_owned());
        self.found.push(Problem {
            key: key.to_owned(),
            value: None,
            rule,
            cure,
            span: None,
            on_key: true,
        });
        let last = self.found.len() - 1;
        &mut self.found[last]
    }

    pub fn is_empty(&self) -> bool {
        self.found.is_empty()
    }

    pub fn len(&self) -> usize {
        self.found.len()
    }

    /// Whether nothing was found so far about these keys, or what is below them, and nothing stands in for a table around them; a
    /// rule about several keys is worth looking at only then.
    pub fn none_about(&self, keys: &[&str]) -> bool {
        let about = |key: &&str| any_within(&self.keys, key) || !self.is_as_written(key);
        !keys.iter().any(about)
    }

    /// Whether nothing stands in for a key, for what is below it, or for a table around it.
    pub fn is_as_written(&self, key: &str) -> bool {
        !any_within(&self.replaced, key) && !within_any(key, &self.replaced)
    }

    /// All of them, with their places in the text.
    pub fn located(self, text: &str, root: &Spanned<DeTable>) -> CaseError {
        let mut problems = self.found;
        for problem in problems.iter_mut().filter(|problem| problem.span.is_none()) {
            let place = locate(root, &problem.key);
            if place.exact && !problem.on_key {
                problem.value = text
                    .get(place.value.clone())
                    .filter(|v| short(v))
                    .map(Into::into);
                problem.span = Some(place.value);
            } else {
                problem.span = Some(place.key);
            }
        }
        problems.sort_by_key(|p| p.span.as_ref().map_or(0, |s| s.start));
        CaseError { problems }
    }
}

/// Whether some key is this one or below it. Nothing is below the case as a whole: a key that nobody knows, and that stands in no
/// table, is about nothing else.
fn any_within(keys: &BTreeSet<String>, table: &str) -> bool {
    let below = |mark: char| {
        let start = format!("{table}{mark}");
        let next = keys.range(start.clone()..).next();
        next.is_some_and(|key| key.starts_with(&start))
    };
    keys.contains(table) || !table.is_empty() && (below('.') || below('['))
}

/// Whether a key is one of these, or below one.
fn within_any(key: &str, tables: &BTreeSet<String>) -> bool {
    let mut marks = key.match_indices(['.', '[']);
    tables.contains(key) || marks.any(|(end, _)| end > 0 && tables.contains(&key[..end]))
}

/// Whether a value is worth repeating: one line, and not the header of a table.
fn short(value: &str) -> bool {
    value.chars().count() <= 60 && !value.contains('\n') && !value.starts_with("[[")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_problem_is_about() {
        let mut problems = Problems::default();
        problems.value("muscles.a.zone", "", None);
        problems.key("stages[2].drive.b", "", None);
        problems.replaced("mesh".to_owned());
        problems.replaced("imperfections[1].of".to_owned());
        for (key, none) in [
            ("muscles.a.zone", false),
            ("muscles.a", false),
            ("muscles", false),
            ("muscles.b", true),
            ("muscles.a.zones", true),
            // Found, not replaced: what is below is as written.
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
            ("", true),
        ] {
            assert_eq!(problems.none_about(&[key]), none, "{key}");
        }
    }
}
