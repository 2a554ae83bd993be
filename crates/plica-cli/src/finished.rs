//! A run that is there: its plan, its history and its saved states.

use crate::case_file;
use crate::console;
use crate::failure::Failure;
use plica::run_directory::RunDirectory;
use plica::saved_state::SavedState;
use plica::study::{Plan, Row};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Refuses to write to a file that does not end as what is written does, lest something else is written over.
pub fn endings(path: &Path, endings: &[&str]) -> Result<(), Failure> {
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    if let Some(folder) = folder.filter(|folder| !folder.is_dir()) {
        return Err(Failure::Files(format!(
            "--out {}: there is no folder {}",
            path.display(),
            folder.display()
        )));
    }
    let ending = path.extension().and_then(|ending| ending.to_str());
    let is = |wanted: &str| ending.is_some_and(|ending| ending.eq_ignore_ascii_case(wanted));
    if endings.iter().any(|wanted| is(wanted)) {
        return Ok(());
    }
    let named: Vec<String> = endings.iter().map(|ending| format!(".{ending}")).collect();
    Err(Failure::Usage(format!(
        "--out {}: must end in {}",
        path.display(),
        named.join(" or ")
    )))
}

/// A run that is there.
pub struct Finished {
    /// Its directory.
    pub directory: RunDirectory,
    /// What was computed.
    pub plan: Plan,
    /// Its accepted states.
    pub rows: Vec<Row>,
    /// What is wrong with the rest of `history.csv`, if not all of it could be read.
    pub broken: Option<String>,
    /// The files of its saved states, by their numbers.
    pub saved: BTreeMap<usize, PathBuf>,
}

impl Finished {
    /// Opens the directory of a run.
    pub fn open(path: &Path) -> Result<Self, Failure> {
        let directory = RunDirectory::open(path).map_err(Failure::Study)?;
        let mut saved = directory
            .numbered("states", "safetensors")
            .map_err(Failure::Study)?;
        let plan = case_file::of_run(&directory)?;
        let (rows, broken) = directory.readable_history().map_err(Failure::Study)?;
        if rows.is_empty() {
            return Err(Failure::Usage(format!(
                "{}: the run has not come to its first state",
                path.display()
            )));
        }
        // Of what has no row nothing could be said.
        let last = rows[rows.len() - 1].step;
        saved.retain(|&number, _| number <= last);
        let broken = broken.map(|why| {
            format!(
                "{} beyond state {}: {why}",
                path.join("history.csv").display(),
                rows.len() - 1
            )
        });
        if let Some(broken) = &broken {
            console::tell(&format!("warning: not read: {broken}"));
        }
        Ok(Self {
            directory,
            plan,
            rows,
            broken,
            saved,
        })
    }

    /// The number of the last saved state.
    ///
    /// # Errors
    /// [`Failure::Usage`] if there is none.
    pub fn last(&self) -> Result<usize, Failure> {
        let last = self.saved.last_key_value().map(|(&number, _)| number);
        last.ok_or_else(|| {
            Failure::Usage(format!(
                "{}: the run has saved no states; set output.states_every in its case and run it again",
                self.directory.path().display()
            ))
        })
    }

    /// Refuses numbers of states that are not saved.
    pub fn has(&self, states: &[usize]) -> Result<(), Failure> {
        if states.is_empty() {
            return Ok(());
        }
        self.last()?;
        match states.iter().find(|state| !self.saved.contains_key(state)) {
            None => Ok(()),
            Some(state) => Err(Failure::Usage(format!(
                "state {state} is not saved in {}; these are: {}",
                self.directory.path().display(),
                self.listed()
            ))),
        }
    }

    /// A saved state, and its row.
    pub fn state(&self, number: usize) -> Result<(SavedState, Row), Failure> {
        self.try_state(number).map_err(Failure::Files)
    }

    /// As [`Finished::state`], or in words why not.
    pub fn try_state(&self, number: usize) -> Result<(SavedState, Row), String> {
        let path = &self.saved[&number];
        let trouble = |why: &dyn std::fmt::Display| format!("{}: {why}", path.display());
        let state = SavedState::read(path).map_err(|error| trouble(&error))?;
        self.plan.accepts(&state).map_err(|error| trouble(&error))?;
        let row = self.rows.iter().find(|row| row.step == number);
        let row = row.ok_or_else(|| trouble(&"history.csv has no such state"))?;
        Ok((state, row.clone()))
    }

    /// Writes a picture where it was asked for, or else beside the run's own.
    pub fn leave(&self, out: Option<&Path>, usual: &str, bytes: &[u8]) -> Result<(), Failure> {
        let path = match out {
            Some(path) => {
                std::fs::write(path, bytes)
                    .map_err(|error| Failure::Files(format!("{}: {error}", path.display())))?;
                path.to_owned()
            }
            None => {
                let name = format!("pictures/{usual}");
                self.directory.write(&name, bytes).map_err(Failure::Study)?;
                self.directory.path().join(name)
            }
        };
        console::say(&format!(
            "written to {} ({:.1} MB)\n",
            path.display(),
            bytes.len() as f64 * 1e-6
        ))
    }

    /// The numbers of saved states, in few words.
    fn listed(&self) -> String {
        let numbers: Vec<String> = self.saved.keys().map(ToString::to_string).collect();
        match numbers.as_slice() {
            [first, .., last] if numbers.len() > 12 => {
                format!("{} of them from {first} to {last}", numbers.len())
            }
            _ => numbers.join(", "),
        }
    }
}
