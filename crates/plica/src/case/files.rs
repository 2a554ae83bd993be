//! The files that a case names: saved states and modes.

use crate::saved_state::{SavedState, SavedStateError};

/// A file that a case names, with its path as written there: relative to the folder of the case file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InputFile<'a> {
    /// The state that the case starts from.
    State(&'a str),
    /// The mode that is the shape of an imperfection, with the number of the imperfection from 1.
    Mode(usize, &'a str),
}

impl<'a> InputFile<'a> {
    /// The path.
    pub fn path(self) -> &'a str {
        match self {
            Self::State(path) | Self::Mode(_, path) => path,
        }
    }
}

/// Opens a file that a case names.
pub type OpenInput<'a> = dyn Fn(InputFile<'_>) -> Result<SavedState, SavedStateError> + 'a;
