//! What can be wrong with a case.

use super::locate::locate;
use std::fmt;
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
    pub span: Option<std::ops::Range<usize>>,
    /// Whether it is the key that is wrong, and not its value.
    pub(super) on_key: bool,
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

impl CaseError {
    /// A text that is not TOML, and why, in the order of the text.
    pub(super) fn not_toml(errors: &[toml::de::Error]) -> Self {
        let problem = |error: &toml::de::Error| Problem {
            key: String::new(),
            value: None,
            rule: error.message().to_owned(),
            cure: None,
            span: error.span(),
            on_key: false,
        };
        let mut problems: Vec<Problem> = errors.iter().map(problem).collect();
        problems.sort_by_key(|problem| problem.span.clone().map(|span| span.start));
        Self { problems }
    }
}

/// Problems as they are found.
#[derive(Debug, Default)]
pub(super) struct Problems(Vec<Problem>);

impl Problems {
    /// A value breaks a rule.
    pub fn value(&mut self, key: &str, rule: impl Into<String>, cure: Option<String>) {
        self.add(key, rule.into(), cure, false);
    }

    /// A key should not be there, or should be.
    pub fn key(&mut self, key: &str, rule: impl Into<String>, cure: Option<String>) {
        self.add(key, rule.into(), cure, true);
    }

    fn add(&mut self, key: &str, rule: String, cure: Option<String>, on_key: bool) {
        self.0.push(Problem {
            key: key.to_owned(),
            value: None,
            rule,
            cure,
            span: None,
            on_key,
        });
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether nothing was found about these keys so far; a rule about several keys is worth
    /// looking at only then.
    pub fn none_about(&self, keys: &[&str]) -> bool {
        let about = |problem: &Problem| keys.contains(&problem.key.as_str());
        !self.0.iter().any(about)
    }

    /// All of them, with their places in the text.
    pub fn located(self, text: &str, root: &Spanned<DeTable>) -> CaseError {
        let mut problems = self.0;
        for problem in &mut problems {
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

/// Whether a value is worth repeating: one line, and not the header of a table.
fn short(value: &str) -> bool {
    value.chars().count() <= 60 && !value.contains('\n') && !value.starts_with("[[")
}
