//! What a run leaves so that it can be taken up again: a history that ends where it goes on, checkpoints, and states that pictures
//! may need.

use super::former::{modes, remove};
use super::{
    CHECKPOINTS, HISTORY, IMPERFECTIONS, OF_STATES, RunDirectory, SPARE, START, STATE_ENDING,
    name_of_spare,
};
use crate::study::{Checkpoint, Plan, Row, SavedState, StudyError};
use std::fs::{self, File};
use std::path::PathBuf;

impl RunDirectory {
    /// Makes a former history end with these rows, and goes on after them: files of later states go, too.
    pub fn go_on_after(&mut self, rows: &[Row]) -> Result<(), StudyError> {
        self.history = None;
        let path = self.path.join(HISTORY);
        let trouble = |source| StudyError::File {
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
            // What it begins with is kept when it begins.
            let begun = [path, self.path.join(START)].into_iter();
            return remove(begun.chain(modes(&self.path.join(IMPERFECTIONS))).collect());
        }
        let mut table = csv::Writer::from_writer(vec![]);
        for row in rows {
            let written = table.serialize(row);
            written.map_err(|e| trouble(std::io::Error::other(e)))?;
        }
        let bytes = table.into_inner().map_err(|e| trouble(e.into_error()))?;
        self.write(HISTORY, &bytes)?;
        let file = File::options().append(true).open(&path);
        self.history = Some(file.map_err(trouble)?);
        Ok(())
    }

    /// Leaves a checkpoint; the one before it is kept until this one is safe, and then still.
    pub fn write_checkpoint(&self, checkpoint: Checkpoint) -> Result<(), StudyError> {
        let [now, before] = CHECKPOINTS.map(|name| self.path.join(name));
        let trouble = |source| StudyError::File {
            path: now.clone(),
            source,
        };
        match fs::rename(&now, &before) {
            Err(e) if e.kind() != std::io::ErrorKind::NotFound => return Err(trouble(e)),
            _ => {}
        }
        self.write_saved(CHECKPOINTS[0], &checkpoint.into_state())
    }

    /// The checkpoint to go on from, and what is wrong with a newer one.
    ///
    /// # Errors
    /// [`StudyError::NoCheckpoint`] if there is none that fits the plan and the rows.
    pub fn checkpoint(
        &self,
        plan: &Plan,
        rows: &[Row],
    ) -> Result<(Checkpoint, Vec<String>), StudyError> {
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
            reasons.push("it has left no checkpoint".into());
        }
        Err(StudyError::NoCheckpoint {
            path: self.path.clone(),
            reasons,
        })
    }

    /// Whether the run has not come to its first checkpoint: to no more than one state, and to nothing that would be lost.
    pub fn has_hardly_begun(&self) -> bool {
        let checkpoint = CHECKPOINTS.iter().any(|name| self.path.join(name).exists());
        let history = fs::read(self.path.join(HISTORY)).unwrap_or_default();
        let rows = history.iter().filter(|byte| **byte == b'\n').count();
        let later = OF_STATES.iter().any(|(folder, ending)| {
            let states = self.numbered(folder, ending).unwrap_or_default();
            states.keys().any(|state| *state > 0)
        });
        !checkpoint && rows <= 2 && !later && self.verdict() != "complete"
    }

    /// Takes out a newest checkpoint that is broken, lest it push out the one before it.
    pub fn drop_newest_checkpoint(&self) -> Result<(), StudyError> {
        remove(vec![self.path.join(CHECKPOINTS[0])])
    }

    /// Keeps a state that pictures may need and that is not among the saved ones.
    pub fn write_spare(&self, state: &SavedState) -> Result<(), StudyError> {
        self.write_saved(&name_of_spare(state.row), state)
    }

    /// A state by the number of its row, among the saved ones or else among the spare.
    pub fn state(&self, row: usize) -> Result<SavedState, StudyError> {
        let saved = self.path.join(Self::name_of_state(row));
        let spare = self.path.join(name_of_spare(row));
        let path = if saved.exists() { saved } else { spare };
        SavedState::read(&path).map_err(|source| StudyError::State { path, source })
    }

    /// Takes out what only a run that goes on needs, once its pictures are drawn.
    pub fn tidy(&self) -> Result<(), StudyError> {
        // First of all, so that pictures are not drawn again while states that they need are going.
        if let serde_json::Value::Object(mut about) = self.manifest()
            && about.insert("closed".into(), true.into()) != Some(true.into())
        {
            self.write_manifest(&about)?;
        }
        remove(vec![self.path.join(CHECKPOINTS[1])])?;
        remove(self.numbered(SPARE, STATE_ENDING)?.into_values().collect())?;
        // Empty by now; if not, it holds something that is not a run's.
        let _ = fs::remove_dir(self.path.join(SPARE));
        Ok(())
    }

    /// Whether the run is at its end, its pictures drawn.
    pub fn is_complete(&self) -> bool {
        let closed = self.manifest()["closed"].as_bool();
        // One of before that was told has no checkpoint before its last.
        let closed = closed.unwrap_or_else(|| !self.path.join(CHECKPOINTS[1]).exists());
        closed && self.verdict() == "complete"
    }
}
