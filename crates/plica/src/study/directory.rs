//! What a run leaves on disk.

use super::{Row, StudyError};
use serde::Serialize;
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};

/// The directory of one run:
///
/// | file | holds |
/// |---|---|
/// | `case.toml` | the case as it was run, to the byte |
/// | `manifest.json` | version, hash of the case, machine, threads, start and end, verdict |
/// | `history.csv` | one row per accepted state, see [`Row`] |
/// | `profiles/state-NNNN.csv` | outer and inner wall of a state |
/// | `*.png` | pictures |
#[derive(Debug)]
pub struct RunDirectory {
    path: PathBuf,
    case_hash: String,
    history: Option<csv::Writer<File>>,
}

/// Name of the file by which a directory is known to be a run.
const MANIFEST: &str = "manifest.json";

impl RunDirectory {
    /// Makes the directory and writes the case into it. A directory that holds anything is left
    /// alone, unless it is that of a former run and `overwrite` is given.
    pub fn create(path: &Path, case_text: &str, overwrite: bool) -> Result<Self, StudyError> {
        let trouble = |source| StudyError::File {
            path: path.to_owned(),
            source,
        };
        match fs::read_dir(path) {
            Ok(mut entries) => {
                if entries.next().is_some() {
                    if !path.join(MANIFEST).is_file() {
                        return Err(StudyError::NotARun(path.to_owned()));
                    }
                    if !overwrite {
                        return Err(StudyError::Occupied(path.to_owned()));
                    }
                    clear(path)?;
                }
            }
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => {
                fs::create_dir_all(path).map_err(trouble)?;
            }
            Err(e) => return Err(trouble(e)),
        }
        let directory = Self {
            path: path.to_owned(),
            case_hash: blake3::hash(case_text.as_bytes()).to_string(),
            history: None,
        };
        directory.write("case.toml", case_text.as_bytes())?;
        directory.write(MANIFEST, b"{}\n")?;
        Ok(directory)
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The hash (BLAKE3) of the case text.
    pub fn case_hash(&self) -> &str {
        &self.case_hash
    }

    /// Adds a row to `history.csv`; it is on its way to the disk when this returns.
    pub fn record(&mut self, row: &Row) -> Result<(), StudyError> {
        let path = self.path.join("history.csv");
        let trouble = |source| StudyError::File {
            path: path.clone(),
            source,
        };
        let history = match &mut self.history {
            Some(history) => history,
            none => none.insert(csv::Writer::from_writer(
                File::create(&path).map_err(trouble)?,
            )),
        };
        history
            .serialize(row)
            .map_err(|e| trouble(std::io::Error::other(e)))?;
        history.flush().map_err(trouble)
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
            let numbers: Vec<String> = row.iter().map(|x| format!("{x:.9}")).collect();
            text += &(numbers.join(",") + "\n");
        }
        self.write(name, text.as_bytes())
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
        file.write_all(bytes)
            .and_then(|()| file.sync_all())
            .map_err(trouble)?;
        fs::rename(&aside, &path).map_err(trouble)
    }
}

/// Takes what a former run wrote out of its directory; files it did not write stay.
fn clear(path: &Path) -> Result<(), StudyError> {
    let trouble = |path: &Path, source| StudyError::File {
        path: path.to_owned(),
        source,
    };
    let mut old: Vec<PathBuf> = ["case.toml", "history.csv", MANIFEST]
        .iter()
        .map(|name| path.join(name))
        .collect();
    for (folder, extension) in [(path.to_owned(), "png"), (path.join("profiles"), "csv")] {
        let Ok(entries) = fs::read_dir(&folder) else {
            continue;
        };
        let files = entries.flatten().map(|entry| entry.path());
        old.extend(files.filter(|file| file.extension().is_some_and(|e| e == extension)));
    }
    for file in old {
        match fs::remove_file(&file) {
            Err(e) if e.kind() != std::io::ErrorKind::NotFound => return Err(trouble(&file, e)),
            _ => {}
        }
    }
    Ok(())
}
