//! The case file: reads and checks its text, and returns a [`Plan`] or every problem that was found.
//!
//! A text passes three steps:
//!
//! 1. `syntax` parses the TOML, and reports every syntax error;
//! 2. `read` reads the tables that `keys` declares: it finds unknown and missing keys, and values of
//!    the wrong type or out of range;
//! 3. `check` checks the rules between keys, and makes everything dimensionless (lengths in D,
//!    stresses in E).
//!
//! Steps 2 and 3 report all their problems at once.
//!
//! ```
//! let text = "
//!     [muscles.circular]
//!     direction = 'circular'
//!     zone = [0.5, 1.0]
//!     [[stages]]
//!     drive.circular.diameter_ratio = 0.25
//! ";
//! let plan = plica::case::read(text, "contraction").unwrap();
//! assert_eq!(plan.stages[0].load.muscles, [0.25]);
//!
//! let error = plica::case::read(&text.replace("0.25", "0"), "contraction").unwrap_err();
//! assert_eq!(
//!     error.problems[0].to_string(),
//!     "stages[1].drive.circular.diameter_ratio = 0: must be above 0",
//! );
//! ```

mod advice;
mod check;
mod course;
mod difference;
mod edit;
mod ellipticity;
mod files;
mod key;
mod keys;
mod law_keys;
mod library;
mod problem;
mod read;
mod reference;
mod schema;
mod spelling;
mod syntax;
mod tension_ellipticity;
#[cfg(test)]
mod tests;

pub use advice::advice;
pub use difference::{Difference, differences};
pub use edit::{EditError, edited};
pub use files::{Input, InputFile, OpenInput};
pub use library::{LibraryMaterial, library, materials};
pub use problem::{CaseError, Problem};
pub use reference::reference;
pub use schema::schema;

use crate::study::Plan;
use key::{Key, Kind, default};
use keys::Case;
use problem::Problems;
use read::{Read, Table};
use toml::Spanned;
use toml::de::DeValue;

/// A commented case file to start from: the tube of Okino et al. (2025), which invaginates.
pub const STARTER: &str = include_str!("starter.toml");

/// Checks that a text is TOML.
///
/// # Errors
/// All syntax errors, in the order of the text.
pub fn check_syntax(text: &str) -> Result<(), CaseError> {
    let mut problems = Problems::of(text, Case::KEYS);
    syntax::parse(text, &mut problems);
    problems.into_result()
}

/// Reads and checks the text of a case file that names no other files. `name` is its title if it gives
/// none: the name of the file without the extension.
///
/// # Errors
/// All problems that were found, in the order of the text. If the text is not TOML, these are the
/// syntax errors only.
pub fn read(text: &str, name: &str) -> Result<Plan, CaseError> {
    let none = |_: InputFile<'_>| Err(std::io::Error::from(std::io::ErrorKind::NotFound).into());
    read_with(text, name, &none)
}

/// Reads and checks the text of a case file that may name saved states and modes, which `open` reads.
///
/// # Errors
/// As [`read`]. A file that cannot be read, or does not belong to the case's tube, is a problem too.
pub fn read_with(text: &str, name: &str, open: &OpenInput<'_>) -> Result<Plan, CaseError> {
    let mut problems = Problems::of(text, Case::KEYS);
    let Some(table) = syntax::parse(text, &mut problems) else {
        problems.into_result()?;
        unreachable!("a text that is not TOML has syntax errors")
    };
    let root = Key {
        name: "",
        doc: "",
        kind: Kind::Table(Case::KEYS),
        rule: default("{}"),
    };
    let value = Spanned::new(0..0, DeValue::Table(table));
    let case =
        Case::read(&mut problems, &root, "", &value).unwrap_or_else(|| Case::fallback(&root));
    let plan = check::plan(&case, name, open, &mut problems);
    problems.into_result().map(|()| plan)
}
