//! The files that a case names: saved states, modes, and libraries of materials.

use crate::run_directory::RunDirectory;
use crate::saved_state::{SavedState, SavedStateError};
use std::path::Path;

/// A file that a case names, with its path as written there: relative to the folder of the case file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InputFile<'a> {
    /// The state that the case starts from.
    State(&'a str),
    /// The mode that is the shape of an imperfection, with the number of the imperfection from 1.
    Mode(usize, &'a str),
    /// A library of materials, with its number from 1 in the order in which the case names such files.
    Materials(usize, &'a str),
}

impl<'a> InputFile<'a> {
    /// The path.
    pub fn path(self) -> &'a str {
        match self {
            Self::State(path) | Self::Mode(_, path) | Self::Materials(_, path) => path,
        }
    }
}

/// The content of a file that a case names.
#[derive(Clone, Debug)]
pub enum Input {
    /// A saved state or a mode.
    State(Box<SavedState>),
    /// Text: a library of materials.
    Text(String),
}

impl From<SavedState> for Input {
    fn from(state: SavedState) -> Self {
        Self::State(Box::new(state))
    }
}

/// Largest size of a file of text, in bytes.
const LARGEST: u64 = 1 << 20;

impl Input {
    /// Reads a file of the kind that a case names.
    ///
    /// # Errors
    /// As [`SavedState::read`]; if a text is not a plain file of at most a megabyte.
    pub fn read(wanted: InputFile<'_>, file: &Path) -> Result<Self, SavedStateError> {
        if !matches!(wanted, InputFile::Materials(..)) {
            return SavedState::read(file).map(Into::into);
        }
        let about = std::fs::metadata(file)?;
        if !about.is_file() || about.len() > LARGEST {
            let why = "not a plain file of at most a megabyte";
            return Err(std::io::Error::new(std::io::ErrorKind::InvalidInput, why).into());
        }
        Ok(Self::Text(std::fs::read_to_string(file)?))
    }

    /// Reads the copy that a run directory keeps of a file that its case names.
    ///
    /// # Errors
    /// As [`Input::read`].
    pub fn kept(wanted: InputFile<'_>, directory: &RunDirectory) -> Result<Self, SavedStateError> {
        let path = match wanted {
            // Older run directories have only their first state.
            InputFile::State(_) if !directory.start().exists() => {
                directory.path().join(RunDirectory::name_of_state(0))
            }
            InputFile::State(_) => directory.start(),
            InputFile::Mode(number, _) => directory.imperfection(number),
            InputFile::Materials(number, _) => directory.materials(number),
        };
        Self::read(wanted, &path)
    }

    /// Returns the saved state.
    pub(super) fn state(self) -> Result<SavedState, SavedStateError> {
        match self {
            Self::State(state) => Ok(*state),
            Self::Text(_) => Err(wrong("not a saved state")),
        }
    }

    /// Returns the text.
    pub(super) fn text(self) -> Result<String, SavedStateError> {
        match self {
            Self::Text(text) => Ok(text),
            Self::State(_) => Err(wrong("not text")),
        }
    }
}

fn wrong(what: &str) -> SavedStateError {
    std::io::Error::new(std::io::ErrorKind::InvalidData, what.to_owned()).into()
}

/// Opens a file that a case names.
pub type OpenInput<'a> = dyn Fn(InputFile<'_>) -> Result<Input, SavedStateError> + 'a;
