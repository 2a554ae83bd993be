//! Files as they come to the disk: aside first, then under their name, and never a number that is none.

use super::{CASE, HISTORY, MANIFEST, PROGRAM, RunDirectory, START, STATE_ENDING, imperfection};
use crate::study::{NamedMode, Row, SavedState, SavedStateError, StudyError};
use serde::Serialize;
use std::fs::{self, File};
use std::io::Write;

impl RunDirectory {
    /// Writes the case, in the place of another if there is one, and its title, which a case may have from its file.
    pub fn write_case(&mut self, case_text: &str, title: &str) -> Result<(), StudyError> {
        // The manifest first: so it holds no case to be another, and no run of it to be complete.
        let mut about = self.about();
        about.remove("case_hash");
        about.remove("verdict");
        about.insert("title".into(), title.into());
        self.write_manifest(&about)?;
        self.write(CASE, case_text.as_bytes())?;
        self.case_hash = blake3::hash(case_text.as_bytes()).to_string();
        Ok(())
    }

    /// What its manifest says; no more than whose it is where there is none.
    pub(super) fn about(&self) -> serde_json::Map<String, serde_json::Value> {
        let mut about = match self.manifest() {
            serde_json::Value::Object(about) => about,
            _ => serde_json::Map::new(),
        };
        about.insert("program".into(), PROGRAM.into());
        about
    }

    /// Adds a row to `history.csv`; it is on its way to the disk when this returns.
    pub fn record(&mut self, row: &Row) -> Result<(), StudyError> {
        let path = self.path.join(HISTORY);
        let trouble = |source| StudyError::File {
            path: path.clone(),
            source,
        };
        let mut table = csv::Writer::from_writer(vec![]);
        let written = table.serialize(row);
        written.map_err(|e| trouble(std::io::Error::other(e)))?;
        let table = table.into_inner().map_err(|e| trouble(e.into_error()))?;
        self.only_numbers(HISTORY, &table)?;
        let header = table.iter().position(|byte| *byte == b'\n').unwrap_or(0) + 1;
        let (history, begin) = match &mut self.history {
            Some(history) => (history, header),
            none => (none.insert(File::create(&path).map_err(trouble)?), 0),
        };
        history.write_all(&table[begin..]).map_err(trouble)?;
        // A checkpoint, which comes to the disk for certain, is of no use without its row.
        history.sync_data().map_err(trouble)
    }

    /// Refuses a table in which a number is none.
    fn only_numbers(&self, name: &str, table: &[u8]) -> Result<(), StudyError> {
        let mut table = csv::Reader::from_reader(table);
        let header = table.headers().cloned().unwrap_or_default();
        for row in table.records().flatten() {
            let mut cells = header.iter().zip(&row);
            // A stage may have any name.
            let none = |(column, cell): &(&str, &str)| {
                *column != "stage" && ["NaN", "inf", "-inf"].contains(cell)
            };
            if let Some((column, number)) = cells.find(none) {
                return Err(StudyError::NoNumber {
                    path: self.path.join(name),
                    what: format!("`{column}` of row {}", &row[0]),
                    number: number.to_owned(),
                });
            }
        }
        Ok(())
    }

    /// Writes `manifest.json`.
    pub fn write_manifest(&self, manifest: &impl Serialize) -> Result<(), StudyError> {
        let mut text = serde_json::to_string_pretty(manifest).map_err(|e| StudyError::File {
            path: self.path.join(MANIFEST),
            source: std::io::Error::other(e),
        })?;
        text.push('\n');
        self.write(MANIFEST, text.as_bytes())
    }

    /// Writes a table of numbers under a relative path.
    pub fn write_table(
        &self,
        name: &str,
        header: &[&str],
        rows: impl Iterator<Item = Vec<f64>>,
    ) -> Result<(), StudyError> {
        let mut text = header.join(",") + "\n";
        for row in rows {
            let numbers: Vec<String> = row.iter().map(|x| format!("{x:.9e}")).collect();
            text += &(numbers.join(",") + "\n");
        }
        self.only_numbers(name, text.as_bytes())?;
        self.write(name, text.as_bytes())
    }

    /// Saves a state in full, under the number of its row.
    pub fn write_state(&self, state: &SavedState) -> Result<(), StudyError> {
        self.write_saved(&Self::name_of_state(state.row), state)
    }

    /// Saves a mode, under a name without an ending; gives its relative path.
    pub fn write_mode(&self, name: &str, mode: &SavedState) -> Result<String, StudyError> {
        let name = format!("modes/{name}.{STATE_ENDING}");
        self.write_saved(&name, mode)?;
        Ok(name)
    }

    /// Keeps the state that the run begins from.
    pub fn write_start(&self, state: &SavedState) -> Result<(), StudyError> {
        self.write_saved(START, state)
    }

    /// Keeps the mode that an imperfection has the shape of.
    pub fn write_imperfection(&self, mode: &NamedMode) -> Result<(), StudyError> {
        self.write_saved(&imperfection(mode.imperfection), &mode.state)
    }

    /// Writes a state, or what has the form of one, under a relative path.
    pub(super) fn write_saved(&self, name: &str, state: &SavedState) -> Result<(), StudyError> {
        let path = || self.path.join(name);
        let bytes = state.to_bytes().map_err(|source| match source {
            SavedStateError::Array { name, .. } => StudyError::NoNumber {
                path: path(),
                what: format!("the array `{name}`"),
                number: "no number in places".into(),
            },
            source => StudyError::State {
                path: path(),
                source,
            },
        })?;
        self.write(name, &bytes)
    }

    /// Writes a table of texts under a relative path, its first row the names of the columns.
    pub fn write_records(&self, name: &str, rows: Vec<Vec<String>>) -> Result<(), StudyError> {
        let trouble = |source| StudyError::File {
            path: self.path.join(name),
            source,
        };
        let mut table = csv::Writer::from_writer(vec![]);
        for row in rows {
            table
                .write_record(row)
                .map_err(|e| trouble(std::io::Error::other(e)))?;
        }
        let bytes = table.into_inner().map_err(|e| trouble(e.into_error()))?;
        self.only_numbers(name, &bytes)?;
        self.write(name, &bytes)
    }

    /// Writes a file under a relative path: aside first, then renamed, so that a reader never
    /// sees half of it.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), StudyError> {
        let path = self.path.join(name);
        let trouble = |source| StudyError::File {
            path: path.clone(),
            source,
        };
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent).map_err(trouble)?;
        }
        let aside = path.with_extension("part");
        let mut file = File::create(&aside).map_err(trouble)?;
        let written = file
            .write_all(bytes)
            .and_then(|()| file.sync_all())
            .and_then(|()| fs::rename(&aside, &path));
        if let (Ok(()), Some(parent)) = (&written, path.parent()) {
            // The new name, too; where folders cannot be flushed, the system does it in time.
            let _ = File::open(parent).and_then(|folder| folder.sync_all());
        }
        if written.is_err() {
            // On a full disk it would only stand in the way.
            let _ = fs::remove_file(&aside);
        }
        written.map_err(trouble)
    }
}

#[cfg(test)]
mod tests {
    use super::super::scratch;
    use super::*;

    #[test]
    fn a_number_that_is_none_is_not_written() {
        let path = scratch("no-number");
        let directory = RunDirectory::create(&path, "case", "", false).unwrap();
        let refused = directory.write_table(
            "profiles/state-0001.csv",
            &["z", "r"],
            [vec![0.0, 1.0], vec![0.5, f64::NAN]].into_iter(),
        );
        let told = refused.unwrap_err().to_string();
        assert!(told.contains("`r` of row 5.000000000e-1"), "{told}");
        assert!(!path.join("profiles/state-0001.csv").exists());
        let cells =
            ["state,critical", "3,inf"].map(|row| row.split(',').map(String::from).collect());
        let refused = directory.write_records("stability.csv", cells.to_vec());
        assert!(matches!(refused, Err(StudyError::NoNumber { .. })));
        let mut state = crate::study::fixture::state(
            &crate::study::fixture::plan(crate::tube::Symmetry::Axisymmetric),
            2,
        );
        state.u[5] = f64::INFINITY;
        assert!(matches!(
            directory.write_state(&state),
            Err(StudyError::NoNumber { .. })
        ));
        fs::remove_dir_all(path).unwrap();
    }
}
