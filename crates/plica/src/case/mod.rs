//! The case file: from what a person wrote to a checked [`Plan`], or to everything that is wrong
//! with it.
//!
//! A case passes four doors, each in its own file:
//!
//! 1. `toml` reads the text, as it is meant where that leaves no doubt (`mended`); what it cannot
//!    read is told once each (`unreadable`);
//! 2. `shape` holds every key, type and range against the table [`KEYS`], and has something sound stand
//!    in for what is wrong, so that one mistake does not hide another;
//! 3. `spec` is the case as written, in plain structs;
//! 4. `check` looks at what several keys must fulfil together and makes everything
//!    dimensionless (lengths in D, stresses in E).
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
mod difference;
mod edit;
mod keys;
mod leaf;
mod lines;
mod locate;
mod meant;
mod mended;
mod problem;
mod reference;
mod schema;
mod shape;
mod spec;
mod spelling;
mod stand_in;
mod starter;
mod table;
mod unreadable;

pub use advice::advice;
pub use difference::{Difference, differences};
pub use edit::{EditError, edited};
pub use keys::{Given, Key, Kind, Limit, Range};
pub use problem::{CaseError, Problem};
pub use reference::reference;
pub use schema::schema;
pub use starter::STARTER;
pub use table::KEYS;

use crate::saved_state::{SavedState, SavedStateError};
use crate::study::Plan;
use problem::Problems;
use serde::Deserialize;
use toml::de::{DeTable, Deserializer};

/// Opens a file that a case names.
pub type Open<'a> = dyn Fn(Wanted<'_>) -> Result<SavedState, SavedStateError> + 'a;

/// A file that a case names: its path as it stands there, which is meant from the folder of the case
/// file on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted<'a> {
    /// The state that it starts from.
    State(&'a str),
    /// The mode that an imperfection has the shape of, with its number from 1.
    Mode(usize, &'a str),
}

impl<'a> Wanted<'a> {
    /// The path.
    pub fn path(self) -> &'a str {
        match self {
            Self::State(path) | Self::Mode(_, path) => path,
        }
    }
}

/// Reads and checks the text of a case file that names no other files. `name` is its title if it gives
/// none: the name of the file without its ending.
///
/// # Errors
/// All problems that were found, in the order of the text. Of a text that is not TOML, where keys cannot be told, what can be read is
/// held against the table of keys, and no further.
pub fn read(text: &str, name: &str) -> Result<Plan, CaseError> {
    let none = |_: Wanted<'_>| Err(std::io::Error::from(std::io::ErrorKind::NotFound).into());
    read_with(text, name, &none)
}

/// The same of a case that may start from a saved state, or have the shape of modes, which `open`
/// gives.
///
/// # Errors
/// As [`read`]; a file that cannot be opened, or is not one of the case's tube, is a problem too.
pub fn read_with(text: &str, name: &str, open: &Open<'_>) -> Result<Plan, CaseError> {
    let mut problems = Problems::default();
    let (mut root, mut errors) = DeTable::parse_recoverable(text);
    let mended = mended::mended(text, &errors, &mut problems);
    if let Some(mended) = &mended {
        (root, errors) = DeTable::parse_recoverable(mended);
    }
    let unreadable = unreadable::tell(text, root.get_ref(), &errors, &mut problems);
    // From here on the tree has the shape of a case, whatever is written.
    let mut shaped = root.clone();
    shape::check(shaped.get_mut(), &unreadable, &mut problems);
    if unreadable.keys_lost {
        return Err(problems.located(text, &root));
    }
    let plan = match spec::Spec::deserialize(Deserializer::from(shaped)) {
        Ok(spec) => check::plan(&spec, name, open, &mut problems),
        Err(error) => {
            let place = error.span().unwrap_or(0..0);
            problems.not_toml(error.message(), None, place);
            return Err(problems.located(text, &root));
        }
    };
    if problems.is_empty() {
        Ok(plan)
    } else {
        Err(problems.located(text, &root))
    }
}

#[cfg(test)]
mod slips;
#[cfg(test)]
mod tests;
