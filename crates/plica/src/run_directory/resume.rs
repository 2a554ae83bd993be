//! Files for resuming a run: the truncated history, checkpoints, and temporary states for pictures.

use super::checkpoint::with_recorded;
use super::clear::{libraries, modes, remove};
use super::write::table_of;
use super::{
    CHECKPOINTS, Checkpoint, Fault, HISTORY, IMPERFECTIONS, MATERIALS, OF_STATES, Record,
    RunDirectory, RunError, START, STATE_ENDING, TEMPORARY, Verdict, name_of_temporary_state,
};
use crate::saved_state::SavedState;
use crate::study::{Plan, Row};
use std::fs::{self, File};
use std::path::PathBuf;

/// A checkpoint that a run can be resumed from.
#[derive(Clone, Debug)]
pub struct Resumption {
    /// The checkpoint.
    pub checkpoint: Checkpoint,
    /// The rows of the history up to its state.
    pub rows: Vec<Row>,
    /// Numbers of the states whose rows are damaged or missing in `history.csv`.
    pub restored: Vec<usize>,
    /// True if `history.csv` has rows of later states.
    pub has_later_rows: bool,
    /// Reasons why a newer checkpoint is not used.
    pub faults: Vec<String>,
}

/// The history of a run, and the faults of its files in words.
#[derive(Clone, Debug)]
pub struct CheckedHistory {
    /// The rows; damaged ones come from the checkpoint, if it can be read.
    pub rows: Vec<Row>,
    /// Reason why the rows that follow could not be read; none if there are no others.
    pub unreadable: Option<String>,
    /// Faults of `history.csv`, and of profiles and saved states.
    pub faults: Vec<String>,
}

/// Lists numbers of states, with ranges.
pub(super) fn list(numbers: &[usize]) -> String {
    let mut ranges: Vec<[usize; 2]> = vec![];
    for &number in numbers {
        match ranges.last_mut() {
            Some([_, last]) if *last + 1 == number => *last = number,
            _ => ranges.push([number; 2]),
        }
    }
    let range = |[first, last]: &[usize; 2]| match first == last {
        true => first.to_string(),
        false => format!("{first} to {last}"),
    };
    ranges.iter().map(range).collect::<Vec<_>>().join(", ")
}

impl RunDirectory {
    /// Truncates the history to these rows, ready to append after them, and removes the files of later states.
    pub(super) fn truncate(&mut self, rows: &[Row]) -> Result<(), RunError> {
        self.history = None;
        self.history_length = 0;
        let path = self.path.join(HISTORY);
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
                    .chain(libraries(&self.path.join(MATERIALS)))
                    .collect(),
            );
        }
        self.write_history(rows)
    }

    /// Writes `history.csv` with these rows, ready to append after them.
    pub(super) fn write_history(&mut self, rows: &[Row]) -> Result<(), RunError> {
        self.history = None;
        self.history_length = 0;
        let path = self.path.join(HISTORY);
        if rows.is_empty() {
            return remove(vec![path]);
        }
        let error_at = |source| RunError::File {
            path: path.clone(),
            source,
        };
        let bytes = table_of(rows).map_err(error_at)?;
        self.write(HISTORY, &bytes)?;
        let file = File::options().append(true).open(&path);
        self.history = Some(file.map_err(error_at)?);
        self.history_length = bytes.len() as u64;
        Ok(())
    }

    /// Writes a checkpoint and keeps the one before it.
    pub(super) fn write_checkpoint(&self, checkpoint: Checkpoint) -> Result<(), RunError> {
        self.check_place()?;
        let bytes = self.state_bytes(CHECKPOINTS[0], &checkpoint.into_state())?;
        let [now, before] = CHECKPOINTS.map(|name| self.path.join(name));
        let error_at = |source| RunError::File {
            path: now.clone(),
            source,
        };
        match fs::rename(&now, &before) {
            Err(e) if e.kind() != std::io::ErrorKind::NotFound => return Err(error_at(e)),
            _ => {}
        }
        self.write(CHECKPOINTS[0], &bytes)
    }

    /// Returns the newest checkpoint that can be used, with the rows up to its state.
    ///
    /// # Errors
    /// [`RunError::NoCheckpoint`] if none fits the plan and `history.csv`.
    pub fn checkpoint(&self, plan: &Plan) -> Result<Resumption, RunError> {
        let mut faults = vec![];
        for name in CHECKPOINTS {
            let path = self.path.join(name);
            if !path.exists() {
                continue;
            }
            let read = SavedState::read(&path).and_then(Checkpoint::from_state);
            let fits = read.map_err(|error| error.to_string());
            let fits = fits.and_then(|one| {
                let recorded = self.recorded_rows(one.record.header());
                Ok((one.rows(plan, &recorded)?, one, recorded))
            });
            match fits {
                Ok(((rows, restored), checkpoint, recorded)) => {
                    let later = |row: &Row| row.step >= rows.len();
                    return Ok(Resumption {
                        has_later_rows: recorded.iter().any(later),
                        checkpoint,
                        rows,
                        restored,
                        faults,
                    });
                }
                Err(why) => faults.push(format!("{name}: {why}")),
            }
        }
        if faults.is_empty() {
            faults.push("it has no checkpoint".into());
        }
        Err(RunError::NoCheckpoint {
            path: self.path.clone(),
            reasons: faults,
        })
    }

    /// Returns the record in the newest checkpoint that can be read.
    pub fn record(&self) -> Option<Record> {
        let read = |name| {
            let state = SavedState::read(&self.path.join(name)).ok()?;
            Some(Checkpoint::from_state(state).ok()?.record)
        };
        CHECKPOINTS.into_iter().find_map(read)
    }

    /// Returns the rows of the history, and the faults of `history.csv` and of saved files, in words. Rows that are damaged
    /// come from the checkpoint, if it can be read. A damaged row without such a copy ends the history.
    ///
    /// # Errors
    /// As [`RunDirectory::readable_history`], if there is no copy.
    pub fn checked_history(&self) -> Result<CheckedHistory, RunError> {
        // Before the history, which the run may write right now.
        let record = self.record();
        let recorded = self.recorded_rows(record.as_ref().map_or("", Record::header));
        let own = record.as_ref().and_then(Record::rows).unwrap_or_default();
        let mut faults = vec![];
        if let Some(record) = &record {
            let missing = record.missing(&self.path);
            let fault = |(name, fault)| format!("{} is {fault}", self.path.join(name).display());
            faults.extend(missing.into_iter().map(fault));
        }
        let (mut rows, restored) = with_recorded(own, &recorded);
        let present = recorded.iter().filter(|row| row.step < rows.len()).count();
        let is_foreign = 2 * (rows.len() - restored.len()) < present;
        if rows.is_empty() || restored.is_empty() || is_foreign {
            let (rows, damaged) = self.readable_history()?;
            return Ok(CheckedHistory {
                rows,
                unreadable: damaged,
                faults,
            });
        }
        faults.push(format!(
            "{} is damaged or incomplete at state {}; its copy in the checkpoint is used, and `plica resume` restores it",
            self.path.join(HISTORY).display(),
            list(&restored)
        ));
        for row in recorded {
            if row.step == rows.len() {
                rows.push(row);
            }
        }
        Ok(CheckedHistory {
            rows,
            unreadable: None,
            faults,
        })
    }

    /// Restores `history.csv` of a complete run if it is damaged, and checks all profiles and saved states. Returns the
    /// numbers of the states whose rows were restored.
    ///
    /// # Errors
    /// [`RunError::Incomplete`] with the files that are missing or damaged.
    pub fn mend(&mut self, plan: &Plan) -> Result<Vec<usize>, RunError> {
        let Ok(found) = self.checkpoint(plan) else {
            let name = CHECKPOINTS[0];
            let fault = match self.path.join(name).exists() {
                true => Fault::Damaged,
                false => Fault::Missing,
            };
            return Err(RunError::Incomplete {
                path: self.path.clone(),
                files: vec![(name.into(), fault)],
            });
        };
        if !found.restored.is_empty() {
            self.write_history(&found.rows)?;
        }
        let files = found.checkpoint.record.damaged(&self.path);
        match files.is_empty() {
            true => Ok(found.restored),
            false => Err(RunError::Incomplete {
                path: self.path.clone(),
                files,
            }),
        }
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

    /// Returns whether all stages of the run are complete and its pictures are drawn.
    pub fn is_complete(&self) -> bool {
        let is_whole = self.stopped_at().is_none();
        self.manifest()["closed"] == true && self.verdict() == Verdict::Complete && is_whole
    }

    /// Returns the condition at which the run was asked to stop before the end of its stages, and did.
    pub fn stopped_at(&self) -> Option<String> {
        self.manifest()["until"].as_str().map(String::from)
    }
}
