//! Writing files: under a temporary name first, then renamed; never a number that is not finite.

use super::{CASE, HISTORY, MANIFEST, PROGRAM, RunDirectory, RunError, STATE_ENDING};
use crate::saved_state::{SavedState, SavedStateError};
use crate::study::Row;
use serde::Serialize;
use std::fs::{self, File};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

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
        self.case = case_text.as_bytes().to_vec();
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

    /// Returns a row as a table with a header, or refuses a number that is not finite.
    pub(super) fn row_table(&self, row: &Row) -> Result<Vec<u8>, RunError> {
        let error_at = |source| RunError::File {
            path: self.path.join(HISTORY),
            source,
        };
        let table = table_of(std::slice::from_ref(row)).map_err(error_at)?;
        self.check_finite(HISTORY, &table)?;
        Ok(table)
    }

    /// Appends the row of a table with a header to `history.csv` and flushes it to the disk.
    pub(super) fn append_row(&mut self, table: &[u8]) -> Result<(), RunError> {
        let path = self.path.join(HISTORY);
        let error_at = |source| RunError::File {
            path: path.clone(),
            source,
        };
        let header = table.iter().position(|byte| *byte == b'\n').unwrap_or(0) + 1;
        let (history, begin) = match &mut self.history {
            Some(history) => (history, header),
            none => (none.insert(File::create(&path).map_err(error_at)?), 0),
        };
        let row = &table[begin.min(table.len())..];
        history.write_all(row).map_err(error_at)?;
        self.history_length += row.len() as u64;
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

    /// Returns a table of numbers as text, for a relative path.
    pub(super) fn table(
        &self,
        name: &str,
        header: &[&str],
        rows: impl Iterator<Item = Vec<f64>>,
    ) -> Result<Vec<u8>, RunError> {
        let mut text = header.join(",") + "\n";
        for row in rows {
            let numbers: Vec<String> = row.iter().map(|x| format!("{x:.9e}")).collect();
            text += &(numbers.join(",") + "\n");
        }
        self.check_finite(name, text.as_bytes())?;
        Ok(text.into_bytes())
    }

    /// Returns the relative path of the file of a mode.
    pub fn name_of_mode(name: &str) -> String {
        format!("modes/{name}.{STATE_ENDING}")
    }

    /// Saves a mode under a name without extension; returns its relative path.
    pub fn write_mode(&self, name: &str, mode: &SavedState) -> Result<String, RunError> {
        let name = Self::name_of_mode(name);
        self.write_saved(&name, mode)?;
        Ok(name)
    }

    /// Writes a state under a relative path.
    pub(super) fn write_saved(&self, name: &str, state: &SavedState) -> Result<(), RunError> {
        self.write(name, &self.state_bytes(name, state)?)
    }

    /// Returns the content of the file of a state, for a relative path.
    pub(super) fn state_bytes(&self, name: &str, state: &SavedState) -> Result<Vec<u8>, RunError> {
        let path = || self.path.join(name);
        state.to_bytes().map_err(|source| match source {
            SavedStateError::Array { name, .. } => RunError::NotFinite {
                path: path(),
                what: format!("the array `{name}`"),
                number: "not finite in places".into(),
            },
            source => RunError::State {
                path: path(),
                source,
            },
        })
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
    ///
    /// # Errors
    /// [`RunError::Moved`] if the directory is not where it was, [`RunError::File`] if the file cannot be written.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), RunError> {
        let path = self.path.join(name);
        let error_at = |source| RunError::File {
            path: path.clone(),
            source,
        };
        self.check_place()?;
        let folders = Path::new(name).ancestors().skip(1);
        let folders: Vec<&Path> = folders.filter(|f| !f.as_os_str().is_empty()).collect();
        for folder in folders.into_iter().rev() {
            // One by one, so that a run directory that was removed is not created again.
            let folder = self.path.join(folder);
            if !folder.is_dir() {
                match fs::create_dir(&folder) {
                    Err(e) if e.kind() == ErrorKind::AlreadyExists && folder.is_dir() => {}
                    made => made.map_err(error_at)?,
                }
            }
        }
        // Only one process can have the lock; others need names of their own.
        let temporary = match self.lock {
            Some(_) => path.with_extension("part"),
            None => unique_name(&path),
        };
        write_and_rename(&temporary, &path, bytes).map_err(error_at)
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

/// Writes a file under a temporary name beside it and renames it, so that an existing file stays until the new one is
/// complete, and several processes can write it at a time.
///
/// # Errors
/// The error of the system.
pub fn write_file(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    // A link stays a link; a pipe or a device is written to.
    let target = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    if target.exists() && !target.is_file() {
        return fs::write(path, bytes);
    }
    write_and_rename(&unique_name(&target), &target, bytes)
}

/// Returns a temporary name for a file that no other process uses.
fn unique_name(path: &Path) -> PathBuf {
    static COUNT: AtomicUsize = AtomicUsize::new(0);
    let mut name = path.file_name().unwrap_or_default().to_owned();
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    name.push(format!(".{}-{count}.part", std::process::id()));
    path.with_file_name(name)
}

/// Writes a file under a temporary name, flushes it to the disk and renames it.
fn write_and_rename(temporary: &Path, path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let mut file = File::create(temporary)?;
    let written = file
        .write_all(bytes)
        .and_then(|()| file.sync_all())
        .and_then(|()| fs::rename(temporary, path));
    if let (Ok(()), Some(parent)) = (&written, path.parent()) {
        // The new name, too; where folders cannot be flushed, the system does it later.
        let _ = File::open(parent).and_then(|folder| folder.sync_all());
    }
    if written.is_err() {
        // It would take room on a full disk.
        let _ = fs::remove_file(temporary);
    }
    written
}

#[cfg(test)]
mod tests {
    use super::super::scratch;
    use super::*;

    #[test]
    fn nothing_is_written_to_a_directory_that_was_moved_or_replaced() {
        let path = scratch("moved");
        let directory = RunDirectory::create(&path, "case", "", false).unwrap();
        directory.write("vtk/walls.pvd", b"before").unwrap();
        let elsewhere = path.with_extension("elsewhere");
        let _ = fs::remove_dir_all(&elsewhere);
        fs::rename(&path, &elsewhere).unwrap();
        let refused = || directory.write("vtk/walls.pvd", b"after");
        assert!(matches!(refused(), Err(RunError::Moved(_))));
        assert!(!path.exists());
        fs::create_dir(&path).unwrap();
        assert!(matches!(refused(), Err(RunError::Moved(_))));
        assert_eq!(fs::read_dir(&path).unwrap().count(), 0);
        fs::remove_dir(&path).unwrap();
        fs::rename(&elsewhere, &path).unwrap();
        directory.write("vtk/walls.pvd", b"after").unwrap();
        assert_eq!(fs::read(path.join("vtk/walls.pvd")).unwrap(), b"after");
        fs::remove_dir_all(path).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn files_outside_are_replaced_whole_and_links_stay() {
        let path = scratch("outside");
        let [file, link] = ["picture.png", "link.png"].map(|name| path.join(name));
        write_file(&file, b"first").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        write_file(&link, b"second").unwrap();
        assert!(link.is_symlink());
        assert_eq!(fs::read(&file).unwrap(), b"second");
        assert_eq!(fs::read_dir(&path).unwrap().count(), 2);
        assert_ne!(unique_name(&file), unique_name(&file));
        fs::remove_dir_all(path).unwrap();
    }

    #[test]
    fn a_number_that_is_not_finite_is_not_written() {
        let path = scratch("no-number");
        let directory = RunDirectory::create(&path, "case", "", false).unwrap();
        let refused = directory.table(
            "profiles/state-0001.csv",
            &["z", "r"],
            [vec![0.0, 1.0], vec![0.5, f64::NAN]].into_iter(),
        );
        let message = refused.unwrap_err().to_string();
        assert!(message.contains("`r` of row 5.000000000e-1"), "{message}");
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
            directory.write_saved("states/state-0002.safetensors", &state),
            Err(RunError::NotFinite { .. })
        ));
        fs::remove_dir_all(path).unwrap();
    }
}
