//! Files for resuming a run: the truncated history, checkpoints, and temporary states for pictures.

use super::clear::{modes, remove};
use super::write::table_of;
use super::{
    CHECKPOINTS, Checkpoint, HISTORY, IMPERFECTIONS, OF_STATES, RunDirectory, RunError, START,
    STATE_ENDING, TEMPORARY, Verdict, name_of_temporary_state,
};
use crate::saved_state::SavedState;
use crate::study::{Plan, Row};
use std::fs::{self, File};
use std::path::PathBuf;

impl RunDirectory {
    /// Truncates the history to these rows, ready to append after them, and removes the files of later states.
    pub(super) fn truncate(&mut self, rows: &[Row]) -> Result<(), RunError> {
        self.history = None;
        let path = self.path.join(HISTORY);
        let error_at = |source| RunError::File {
            path: path.clone(),
            source,
        };
        let mut later = vec![];
        for (folder, ending) in OF_STATES {
            let beyond = |(number, file): (usize, PathBuf)| (number >= rows.len()).then_some(file);
            later.extend(
                self.numbered(folder, ending)?
                    .into_iter()
                    .filter_map(beyond),
            );
        }
        later.extend(
            ["case.part", "manifest.part", "history.part"].map(|name| self.path.join(name)),
        );
        remove(later)?;
        if rows.is_empty() {
            // A run writes what it starts from when it begins.
            let inputs = [path, self.path.join(START)].into_iter();
            return remove(
                inputs
                    .chain(modes(&self.path.join(IMPERFECTIONS)))
                    .collect(),
            );
        }
        self.write(HISTORY, &table_of(rows).map_err(error_at)?)?;
        let file = File::options().append(true).open(&path);
        self.history = Some(file.map_err(error_at)?);
        Ok(())
    }

    /// Writes a checkpoint and keeps the one before it.
    pub(super) fn write_checkpoint(&self, checkpoint: Checkpoint) -> Result<(), RunError> {
        let [now, before] = CHECKPOINTS.map(|name| self.path.join(name));
        let error_at = |source| RunError::File {
            path: now.clone(),
            source,
        };
        match fs::rename(&now, &before) {
            Err(e) if e.kind() != std::io::ErrorKind::NotFound => return Err(error_at(e)),
            _ => {}
        }
        self.write_saved(CHECKPOINTS[0], &checkpoint.into_state())
    }

    /// Returns the newest checkpoint that can be used, and the faults of a newer one.
    ///
    /// # Errors
    /// [`RunError::NoCheckpoint`] if none fits the plan and the rows.
    pub fn checkpoint(
        &self,
        plan: &Plan,
        rows: &[Row],
    ) -> Result<(Checkpoint, Vec<String>), RunError> {
        let mut reasons = vec![];
        for name in CHECKPOINTS {
            let path = self.path.join(name);
            if !path.exists() {
                continue;
            }
            let read = SavedState::read(&path).and_then(Checkpoint::from_state);
            match read.map_err(|error| error.to_string()) {
                Ok(checkpoint) => match checkpoint.fits(plan, rows) {
                    Ok(()) => return Ok((checkpoint, reasons)),
                    Err(why) => reasons.push(format!("{name}: {why}")),
                },
                Err(why) => reasons.push(format!("{name}: {why}")),
            }
        }
        if reasons.is_empty() {
            reasons.push("it has no checkpoint".into());
        }
        Err(RunError::NoCheckpoint {
            path: self.path.clone(),
            reasons,
        })
    }

    /// Returns whether the run has no checkpoint yet, at most one state, and nothing that would be lost.
    pub fn has_hardly_begun(&self) -> bool {
        let checkpoint = CHECKPOINTS.iter().any(|name| self.path.join(name).exists());
        let history = fs::read(self.path.join(HISTORY)).unwrap_or_default();
        let rows = history.iter().filter(|byte| **byte == b'\n').count();
        let later = OF_STATES.iter().any(|(folder, ending)| {
            let states = self.numbered(folder, ending).unwrap_or_default();
            states.keys().any(|state| *state > 0)
        });
        !checkpoint && rows <= 2 && !later && self.verdict() != Verdict::Complete
    }

    /// Removes a damaged newest checkpoint, so that it does not replace the one before it.
    pub(super) fn remove_newest_checkpoint(&self) -> Result<(), RunError> {
        remove(vec![self.path.join(CHECKPOINTS[0])])
    }

    /// Writes a state that is not saved but that pictures may need.
    pub(super) fn write_temporary_state(&self, state: &SavedState) -> Result<(), RunError> {
        self.write_saved(&name_of_temporary_state(state.row), state)
    }

    /// Reads a saved or temporary state by the number of its row.
    ///
    /// # Errors
    /// [`RunError::State`] if it cannot be read.
    pub fn state(&self, row: usize) -> Result<SavedState, RunError> {
        let saved = self.path.join(Self::name_of_state(row));
        let temporary = self.path.join(name_of_temporary_state(row));
        let path = if saved.exists() { saved } else { temporary };
        SavedState::read(&path).map_err(|source| RunError::State { path, source })
    }

    /// Removes temporary files once the pictures of a complete run are drawn.
    pub fn close(&self) -> Result<(), RunError> {
        // First, so that the pictures are not drawn again from states that are being removed.
        if let serde_json::Value::Object(mut about) = self.manifest()
            && about.insert("closed".into(), true.into()) != Some(true.into())
        {
            self.write_manifest(&about)?;
        }
        remove(vec![self.path.join(CHECKPOINTS[1])])?;
        remove(
            self.numbered(TEMPORARY, STATE_ENDING)?
                .into_values()
                .collect(),
        )?;
        // If the folder is not empty, it holds files that are not a run's.
        let _ = fs::remove_dir(self.path.join(TEMPORARY));
        Ok(())
    }

    /// Returns whether the run is complete and its pictures are drawn.
    pub fn is_complete(&self) -> bool {
        self.manifest()["closed"] == true && self.verdict() == Verdict::Complete
    }
}
