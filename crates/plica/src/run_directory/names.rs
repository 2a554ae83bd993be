//! Names and numbers of the files of states, profiles and modes.

use super::clear::modes;
use super::{
    IMPERFECTIONS, MATERIALS, PROFILES, RunDirectory, RunError, START, STATE_ENDING, STATES,
    TEMPORARY,
};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

impl RunDirectory {
    /// Returns the numbers of the saved states.
    ///
    /// # Errors
    /// As [`RunDirectory::states`].
    pub fn state_numbers(&self) -> Result<Vec<usize>, RunError> {
        Ok(self.numbered(STATES, STATE_ENDING)?.into_keys().collect())
    }

    /// Returns the files of the saved states, in the order of their numbers.
    ///
    /// # Errors
    /// [`RunError::File`] if they cannot be listed.
    pub fn states(&self) -> Result<Vec<PathBuf>, RunError> {
        Ok(self.numbered(STATES, STATE_ENDING)?.into_values().collect())
    }

    /// Returns the files `state-N` with an extension in a folder, by their numbers; an absent folder has none.
    ///
    /// # Errors
    /// [`RunError::File`] if they cannot be listed.
    pub fn numbered(
        &self,
        folder: &str,
        ending: &str,
    ) -> Result<BTreeMap<usize, PathBuf>, RunError> {
        let folder = self.path.join(folder);
        let entries = match fs::read_dir(&folder) {
            Ok(entries) => entries,
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Ok(BTreeMap::new()),
            Err(source) => {
                return Err(RunError::File {
                    path: folder,
                    source,
                });
            }
        };
        let files = entries.flatten().map(|entry| entry.path());
        Ok(files
            .filter_map(|file| Some((number_of_state(&file, ending)?, file)))
            .collect())
    }

    /// Returns the relative path of the file of a saved state, by the number of its row.
    pub fn name_of_state(row: usize) -> String {
        format!("{STATES}/state-{row:04}.{STATE_ENDING}")
    }

    /// Returns the files that the run started from: its start state and the modes of its imperfections.
    pub fn inputs(&self) -> Vec<PathBuf> {
        let start = Some(self.start()).filter(|start| start.exists());
        let modes = modes(&self.path.join(IMPERFECTIONS));
        start.into_iter().chain(modes).collect()
    }

    /// Returns the path of the mode that gives an imperfection its shape; imperfections are counted from 1.
    pub fn imperfection(&self, number: usize) -> PathBuf {
        self.path.join(imperfection(number))
    }

    /// Returns the path of the copy of a library of materials that the case names; libraries are counted from 1.
    pub fn materials(&self, number: usize) -> PathBuf {
        self.path.join(materials(number))
    }

    /// Returns the path of the state that the run started from, if not from rest.
    pub fn start(&self) -> PathBuf {
        self.path.join(START)
    }
}

/// Returns the relative path of a state that is kept until the pictures are drawn.
pub(super) fn name_of_temporary_state(row: usize) -> String {
    format!("{TEMPORARY}/state-{row:04}.{STATE_ENDING}")
}

/// Returns the relative path of the walls of a state.
pub(super) fn name_of_profile(row: usize) -> String {
    format!("{PROFILES}/state-{row:04}.csv")
}

/// Returns the relative path of the mode that gives an imperfection its shape.
pub(super) fn imperfection(number: usize) -> String {
    format!("{IMPERFECTIONS}/mode-{number:02}.{STATE_ENDING}")
}

/// Returns the relative path of the copy of a library of materials.
pub(super) fn materials(number: usize) -> String {
    format!("{MATERIALS}/library-{number:02}.toml")
}

/// Returns the number N of a file `state-N` with an extension.
pub(super) fn number_of_state(file: &Path, ending: &str) -> Option<usize> {
    let name = file.file_name()?.to_str()?;
    let number = name.strip_prefix("state-")?.strip_suffix(ending)?;
    let number = number.strip_suffix('.')?;
    let digits = !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit());
    digits.then(|| number.parse().ok())?
}
