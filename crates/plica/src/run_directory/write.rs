//! Writing files: under a temporary name first, then renamed; never a number that is not finite.

use super::{
    CASE, HISTORY, MANIFEST, PROGRAM, RunDirectory, RunError, START, STATE_ENDING, imperfection,
};
use crate::saved_state::{SavedState, SavedStateError};
use crate::study::{ModeShape, Row};
use serde::Serialize;
use std::fs::{self, File};
use std::io::Write;

impl RunDirectory {
    /// Writes the case and its title, in place of a previous case. The title may be the name of the file of the case.
    pub fn write_case(&mut self, case_text: &str, title: &str) -> Result<(), RunError> {
        // The manifest first, so that it never claims a hash or a verdict of another case.
        let mut about = self.about();
        about.remove("case_hash");
        about.remove("verdict");
        about.insert("title".into(), title.into());
        self.write_manifest(&about)?;
        self.write(CASE, case_text.as_bytes())?;
        self.case_hash = blake3::hash(case_text.as_bytes()).to_string();
        Ok(())
    }

    /// Returns the entries of the manifest; only the name of the program if there is none.
    pub(super) fn about(&self) -> serde_json::Map<String, serde_json::Value> {
        let mut about = match self.manifest() {
            serde_json::Value::Object(about) => about,
            _ => serde_json::Map::new(),
        };
        about.insert("program".into(), PROGRAM.into());
        about
    }

    /// Appends a row to `history.csv` and flushes it to the disk.
    pub(super) fn append_row(&mut self, row: &Row) -> Result<(), RunError> {
        let path = self.path.join(HISTORY);
        let error_at = |source| RunError::File {
            path: path.clone(),
            source,
        };
        let table = table_of(std::slice::from_ref(row)).map_err(error_at)?;
        self.check_finite(HISTORY, &table)?;
        let header = table.iter().position(|byte| *byte == b'\n').unwrap_or(0) + 1;
        let (history, begin) = match &mut self.history {
            Some(history) => (history, header),
            none => (none.insert(File::create(&path).map_err(error_at)?), 0),
        };
        history.write_all(&table[begin..]).map_err(error_at)?;
        // A checkpoint is of no use without its row.
        history.sync_data().map_err(error_at)
    }

    /// Refuses a table with a number that is not finite.
    fn check_finite(&self, name: &str, table: &[u8]) -> Result<(), RunError> {
        let mut table = csv::Reader::from_reader(table);
        let header = table.headers().cloned().unwrap_or_default();
        for row in table.records().flatten() {
            let mut cells = header.iter().zip(&row);
            // A stage can have any name, NaN included.
            let is_not_finite = |(column, cell): &(&str, &str)| {
                *column != "stage" && ["NaN", "inf", "-inf"].contains(cell)
            };
            if let Some((column, number)) = cells.find(is_not_finite) {
                return Err(RunError::NotFinite {
                    path: self.path.join(name),
                    what: format!("`{column}` of row {}", &row[0]),
                    number: number.to_owned(),
                });
            }
        }
        Ok(())
    }

    /// Writes `manifest.json`.
    pub fn write_manifest(&self, manifest: &impl Serialize) -> Result<(), RunError> {
        let mut text = serde_json::to_string_pretty(manifest).map_err(|e| RunError::File {
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
    ) -> Result<(), RunError> {
        let mut text = header.join(",") + "\n";
        for row in rows {
            let numbers: Vec<String> = row.iter().map(|x| format!("{x:.9e}")).collect();
            text += &(numbers.join(",") + "\n");
        }
        self.check_finite(name, text.as_bytes())?;
        self.write(name, text.as_bytes())
    }

    /// Saves a state in full, under the number of its row.
    pub fn write_state(&self, state: &SavedState) -> Result<(), RunError> {
        self.write_saved(&Self::name_of_state(state.row), state)
    }

    /// Saves a mode under a name without extension; returns its relative path.
    pub fn write_mode(&self, name: &str, mode: &SavedState) -> Result<String, RunError> {
        let name = format!("modes/{name}.{STATE_ENDING}");
        self.write_saved(&name, mode)?;
        Ok(name)
    }

    /// Writes the state that the run starts from.
    pub(super) fn write_start(&self, state: &SavedState) -> Result<(), RunError> {
        self.write_saved(START, state)
    }

    /// Writes the mode that gives an imperfection its shape.
    pub(super) fn write_imperfection(&self, mode: &ModeShape) -> Result<(), RunError> {
        self.write_saved(&imperfection(mode.imperfection), &mode.state)
    }

    /// Writes a state under a relative path.
    pub(super) fn write_saved(&self, name: &str, state: &SavedState) -> Result<(), RunError> {
        let path = || self.path.join(name);
        let bytes = state.to_bytes().map_err(|source| match source {
            SavedStateError::Array { name, .. } => RunError::NotFinite {
                path: path(),
                what: format!("the array `{name}`"),
                number: "not finite in places".into(),
            },
            source => RunError::State {
                path: path(),
                source,
            },
        })?;
        self.write(name, &bytes)
    }

    /// Writes a table of texts under a relative path; its first row has the names of the columns.
    pub fn write_records(&self, name: &str, rows: Vec<Vec<String>>) -> Result<(), RunError> {
        let error_at = |source| RunError::File {
            path: self.path.join(name),
            source,
        };
        let mut table = csv::Writer::from_writer(vec![]);
        for row in rows {
            table
                .write_record(row)
                .map_err(|e| error_at(std::io::Error::other(e)))?;
        }
        let bytes = table.into_inner().map_err(|e| error_at(e.into_error()))?;
        self.check_finite(name, &bytes)?;
        self.write(name, &bytes)
    }

    /// Writes a file under a relative path: under a temporary name first, then renamed, so that a reader never sees a part of
    /// it.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), RunError> {
        let path = self.path.join(name);
        let error_at = |source| RunError::File {
            path: path.clone(),
            source,
        };
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent).map_err(error_at)?;
        }
        let temporary = path.with_extension("part");
        let mut file = File::create(&temporary).map_err(error_at)?;
        let written = file
            .write_all(bytes)
            .and_then(|()| file.sync_all())
            .and_then(|()| fs::rename(&temporary, &path));
        if let (Ok(()), Some(parent)) = (&written, path.parent()) {
            // The new name, too; where folders cannot be flushed, the system does it later.
            let _ = File::open(parent).and_then(|folder| folder.sync_all());
        }
        if written.is_err() {
            // It would take room on a full disk.
            let _ = fs::remove_file(&temporary);
        }
        written.map_err(error_at)
    }
}

/// Returns rows as the bytes of a table with a header; nothing without rows.
pub(super) fn table_of(rows: &[Row]) -> std::io::Result<Vec<u8>> {
    let mut table = csv::Writer::from_writer(vec![]);
    let header = rows.first().map(Row::header);
    for record in header.into_iter().chain(rows.iter().map(Row::record)) {
        table.write_record(record)?;
    }
    table.into_inner().map_err(csv::IntoInnerError::into_error)
}

#[cfg(test)]
mod tests {
    use super::super::scratch;
    use super::*;

    #[test]
    fn a_number_that_is_not_finite_is_not_written() {
        let path = scratch("no-number");
        let directory = RunDirectory::create(&path, "case", "", false).unwrap();
        let refused = directory.write_table(
            "profiles/state-0001.csv",
            &["z", "r"],
            [vec![0.0, 1.0], vec![0.5, f64::NAN]].into_iter(),
        );
        let message = refused.unwrap_err().to_string();
        assert!(message.contains("`r` of row 5.000000000e-1"), "{message}");
        assert!(!path.join("profiles/state-0001.csv").exists());
        let cells =
            ["state,critical", "3,inf"].map(|row| row.split(',').map(String::from).collect());
        let refused = directory.write_records("stability.csv", cells.to_vec());
        assert!(matches!(refused, Err(RunError::NotFinite { .. })));
        let mut state = crate::study::fixture::state(
            &crate::study::fixture::plan(crate::tube::Symmetry::Axisymmetric),
            2,
        );
        state.u[5] = f64::INFINITY;
        assert!(matches!(
            directory.write_state(&state),
            Err(RunError::NotFinite { .. })
        ));
        fs::remove_dir_all(path).unwrap();
    }
}
