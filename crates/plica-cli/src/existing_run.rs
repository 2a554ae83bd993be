//! An existing run: its plan, history and saved states.

use crate::case_file;
use crate::console;
use crate::failure::Failure;
use plica::run_directory::{RunDirectory, write_file};
use plica::saved_state::SavedState;
use plica::study::{Plan, Row};
use plica_view::report::FieldScales;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Refuses an output file in a missing directory or with another extension, so that files of other kinds are not overwritten.
pub fn check_out(path: &Path, extensions: &[&str]) -> Result<(), Failure> {
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    if let Some(folder) = folder.filter(|folder| !folder.is_dir()) {
        return Err(Failure::Files(format!(
            "--out {}: there is no directory {}",
            path.display(),
            folder.display()
        )));
    }
    if path.is_dir() {
        return Err(Failure::Usage(format!(
            "--out {}: is a directory; name a file in it",
            path.display()
        )));
    }
    if let Ok(target) = std::fs::read_link(path)
        && !path.exists()
    {
        return Err(Failure::Files(format!(
            "--out {}: is a symbolic link to {}, which does not exist; remove it, or choose another file",
            path.display(),
            target.display()
        )));
    }
    let extension = path.extension().unwrap_or_default();
    if extensions.iter().any(|e| extension.eq_ignore_ascii_case(e)) {
        return Ok(());
    }
    let named: Vec<String> = extensions.iter().map(|e| format!(".{e}")).collect();
    Err(Failure::Usage(format!(
        "--out {}: must end in {}",
        path.display(),
        named.join(" or ")
    )))
}

/// Writes an output file that the user has named.
pub fn write_out(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let written = write_file(path, bytes);
    written.map_err(|error| Failure::Files(format!("--out {}: {error}", path.display())))
}

/// Returns a number of bytes with a unit.
pub fn size(bytes: usize) -> String {
    match bytes {
        0..1_000 => format!("{bytes} bytes"),
        1_000..100_000 => format!("{:.1} kB", bytes as f64 * 1e-3),
        100_000..1_000_000 => format!("{:.0} kB", bytes as f64 * 1e-3),
        _ => format!("{:.1} MB", bytes as f64 * 1e-6),
    }
}

/// An existing run.
pub struct ExistingRun {
    /// Its directory.
    pub directory: RunDirectory,
    /// Its plan.
    pub plan: Plan,
    /// Its accepted states.
    pub rows: Vec<Row>,
    /// Reason why the rest of `history.csv` could not be read.
    pub unreadable: Option<String>,
    /// Files of its saved states by number.
    pub saved: BTreeMap<usize, PathBuf>,
}

impl ExistingRun {
    /// Opens the directory of a run.
    pub fn open(path: &Path) -> Result<Self, Failure> {
        let directory = RunDirectory::open(path)?;
        let mut saved = directory.numbered("states", "safetensors")?;
        let plan = case_file::of_run(&directory)?;
        let history = directory.checked_history()?;
        for fault in &history.faults {
            console::message(&format!("warning: {fault}"));
        }
        let rows = history.rows;
        if rows.is_empty() {
            return Err(Failure::Usage(format!(
                "{}: the run has not reached its first state",
                path.display()
            )));
        }
        // States without a row are ignored.
        let last = rows[rows.len() - 1].step;
        saved.retain(|&number, _| number <= last);
        let unreadable = history.unreadable.map(|why| {
            format!(
                "{} beyond state {}: {why}",
                path.join("history.csv").display(),
                rows.len() - 1
            )
        });
        if let Some(unreadable) = &unreadable {
            console::message(&format!("warning: not read: {unreadable}"));
        }
        Ok(Self {
            directory,
            plan,
            rows,
            unreadable,
            saved,
        })
    }

    /// Returns the number of the last saved state.
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
    pub fn check_saved(&self, states: &[usize]) -> Result<(), Failure> {
        if states.is_empty() {
            return Ok(());
        }
        self.last()?;
        match states.iter().find(|state| !self.saved.contains_key(state)) {
            None => Ok(()),
            Some(state) => Err(Failure::Usage(format!(
                "--state {state}: not saved in {}; choose from {}",
                self.directory.path().display(),
                self.list_saved()
            ))),
        }
    }

    /// Reads a saved state and its row.
    pub fn state(&self, number: usize) -> Result<(SavedState, Row), Failure> {
        self.try_state(number).map_err(Failure::Files)
    }

    /// Reads a saved state and its row, or returns the error as text.
    pub fn try_state(&self, number: usize) -> Result<(SavedState, Row), String> {
        let path = &self.saved[&number];
        let message = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
        let state = SavedState::read(path).map_err(|error| message(&error))?;
        self.plan.accepts(&state).map_err(|error| message(&error))?;
        let row = self.rows.iter().find(|row| row.step == number);
        let row = row.ok_or_else(|| message(&"history.csv has no such state"))?;
        Ok((state, row.clone()))
    }

    /// Returns the scales of the fields in all saved states, except those that cannot be read.
    pub fn field_scales(&self) -> FieldScales {
        let states = self.saved.par_iter();
        let states = states.filter_map(|(&number, _)| Some(self.try_state(number).ok()?.0));
        FieldScales::of_states(&self.plan, states)
    }

    /// Writes a picture to a file, by default to `pictures/` of the run, and prints its path.
    pub fn write_picture(
        &self,
        out: Option<&Path>,
        default: &str,
        bytes: &[u8],
    ) -> Result<(), Failure> {
        let path = match out {
            Some(path) => {
                write_out(path, bytes)?;
                path.to_owned()
            }
            None => {
                let name = format!("pictures/{default}");
                self.directory.write(&name, bytes)?;
                self.directory.path().join(name)
            }
        };
        console::print(&format!(
            "written to {} ({})\n",
            path.display(),
            size(bytes.len())
        ))
    }

    /// Lists the numbers of saved states briefly.
    fn list_saved(&self) -> String {
        let numbers: Vec<String> = self.saved.keys().map(ToString::to_string).collect();
        match numbers.as_slice() {
            [first, .., last] if numbers.len() > 12 => {
                format!("{} states from {first} to {last}", numbers.len())
            }
            _ => numbers.join(", "),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::size;

    #[test]
    fn sizes_have_the_unit_that_fits() {
        let sizes = [0, 999, 1_000, 4_321, 99_900, 654_321, 1_000_000, 15_000_000];
        assert_eq!(
            sizes.map(size),
            [
                "0 bytes",
                "999 bytes",
                "1.0 kB",
                "4.3 kB",
                "99.9 kB",
                "654 kB",
                "1.0 MB",
                "15.0 MB"
            ]
        );
    }
}
