//! What a run leaves on disk.

mod former;
mod going_on;
mod writing;

use super::lock::{LOCK, Lock};
use super::{Row, StudyError};
use former::{clear, files, modes, remove, stability_files};
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::path::{Path, PathBuf};

/// The directory of one run:
///
/// | file | holds |
/// |---|---|
/// | `case.toml` | the case as it was run, to the byte |
/// | `manifest.json` | version, hash of the case, machine, threads, start and end, verdict |
/// | `history.csv` | one row per accepted state, see [`Row`] |
/// | `profiles/state-NNNN.csv` | outer and inner wall of a state |
/// | `states/state-NNNN.safetensors` | a state in full, see [`super::SavedState`] |
/// | `checkpoint.safetensors`, `checkpoint-before.safetensors` | the last accepted state and the one before, with what it takes to go on, see [`super::Checkpoint`] |
/// | `spare/` | states that are not saved, until pictures are drawn |
/// | `lock` | held by the process that runs it |
/// | `*.png` | pictures |
/// | `pictures/` | states and paths drawn on request |
/// | `report.html` | the run as a page, on request |
/// | `vtk/` | states as files of VTK, in a folder and a collection for each kind |
/// | `start.safetensors` | the state that the run began from, if not from rest |
/// | `imperfections/mode-NN.safetensors` | a mode that imperfection NN has the shape of |
/// | `stability.csv`, `eigenvalues.csv`, `eigenpairs.csv`, `modes/` | what a test of stability found |
#[derive(Debug)]
pub struct RunDirectory {
    path: PathBuf,
    case_hash: String,
    history: Option<File>,
    /// Held by whoever writes a run.
    lock: Option<Lock>,
}

/// What a manifest says of a run that is being replaced.
const REPLACED: &str = "replaced";

/// What a manifest names as its program.
pub const PROGRAM: &str = "plica";

/// Name of the file by which a directory is known to be a run.
const MANIFEST: &str = "manifest.json";

/// Name of the table of states.
const HISTORY: &str = "history.csv";

/// Name of the case as it was run.
const CASE: &str = "case.toml";

/// Folders of walls, of saved states, and of states that are kept only until pictures are drawn.
const PROFILES: &str = "profiles";
const STATES: &str = "states";
const SPARE: &str = "spare";

/// The newest checkpoint, and the one before it.
const CHECKPOINTS: [&str; 2] = ["checkpoint.safetensors", "checkpoint-before.safetensors"];

/// The state that a run began from.
const START: &str = "start.safetensors";

/// Folder of the modes that imperfections have the shape of.
const IMPERFECTIONS: &str = "imperfections";

/// Ending of the files of saved states.
const STATE_ENDING: &str = "safetensors";

/// The folders that hold a file of every state, or of some, and the ending of those.
const OF_STATES: [(&str, &str); 3] = [
    (PROFILES, "csv"),
    (STATES, STATE_ENDING),
    (SPARE, STATE_ENDING),
];

impl RunDirectory {
    /// Makes the directory and writes the case into it, and its title beside. A directory that holds anything is left
    /// alone, unless it is that of a former run and `overwrite` is given.
    pub fn create(
        path: &Path,
        case_text: &str,
        title: &str,
        overwrite: bool,
    ) -> Result<Self, StudyError> {
        let trouble = |source| StudyError::File {
            path: path.to_owned(),
            source,
        };
        match fs::read_dir(path) {
            Ok(_) => {
                if files(path).any(|file| !is_left_over(&file)) {
                    if !is_a_run(path) {
                        return Err(StudyError::NotARun(path.to_owned()));
                    }
                    if !overwrite && !is_unborn(path) {
                        return Err(StudyError::Occupied(path.to_owned()));
                    }
                }
            }
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => {
                fs::create_dir_all(path).map_err(trouble)?;
            }
            Err(e) => return Err(trouble(e)),
        }
        let lock = Some(Lock::take(path)?);
        let mut directory = Self {
            path: path.to_owned(),
            case_hash: String::new(),
            history: None,
            lock,
        };
        // First of all, so that whatever becomes of the rest it is known as a run: as the former one while that has its case.
        let mut about = directory.about();
        about.insert(REPLACED.into(), true.into());
        directory.write_manifest(&about)?;
        clear(path)?;
        directory.write_manifest(&serde_json::json!({ "program": PROGRAM }))?;
        directory.write_case(case_text, title)?;
        Ok(directory)
    }

    /// Takes it for this process, until it is dropped.
    ///
    /// # Errors
    /// [`StudyError::Busy`] if another process has it; else as [`RunDirectory::open`].
    pub fn own(&mut self) -> Result<(), StudyError> {
        if self.lock.is_none() {
            let lock = Some(Lock::take(&self.path)?);
            // Whoever had it may have changed it since.
            *self = Self {
                lock,
                ..Self::open(&self.path)?
            };
        }
        Ok(())
    }

    /// Opens the directory of a former run, finished or not.
    ///
    /// # Errors
    /// [`StudyError::File`] if it is not there, [`StudyError::NoRun`] if it holds none, and
    /// [`StudyError::CaseChanged`] if its case is not the one that was run.
    pub fn open(path: &Path) -> Result<Self, StudyError> {
        let read = |name: &str| {
            fs::read(path.join(name)).map_err(|source| StudyError::File {
                path: path.join(name),
                source,
            })
        };
        if path.exists() && !path.is_dir() {
            return Err(StudyError::NoDirectory(path.to_owned()));
        }
        fs::read_dir(path).map_err(|source| StudyError::File {
            path: path.to_owned(),
            source,
        })?;
        if !is_a_run(path) {
            return Err(StudyError::NoRun(path.to_owned()));
        }
        let manifest: serde_json::Value =
            serde_json::from_slice(&read(MANIFEST)?).unwrap_or_default();
        let case_hash = blake3::hash(&read(CASE)?).to_string();
        if manifest["case_hash"]
            .as_str()
            .is_some_and(|hash| hash != case_hash)
        {
            return Err(StudyError::CaseChanged(path.join(CASE)));
        }
        Ok(Self {
            path: path.to_owned(),
            case_hash,
            history: None,
            lock: None,
        })
    }

    /// How the run ended, as its manifest says: `complete`, `stopped`, `lost`, or `running` if it
    /// has not, or was killed.
    pub fn verdict(&self) -> String {
        let verdict = manifest(&self.path)["verdict"].as_str().map(String::from);
        verdict.unwrap_or_else(|| "running".into())
    }

    /// What `manifest.json` says; null where there is none.
    pub fn manifest(&self) -> serde_json::Value {
        manifest(&self.path)
    }

    /// The bytes of one of its files; none if it is not there.
    pub fn read(&self, name: &str) -> Option<Vec<u8>> {
        fs::read(self.path.join(name)).ok()
    }

    /// The rows of one of its tables as texts, the names of the columns first; none if it is not there, or broken.
    pub fn records(&self, name: &str) -> Option<Vec<Vec<String>>> {
        let mut table = csv::ReaderBuilder::new();
        let mut table = table
            .has_headers(false)
            .from_path(self.path.join(name))
            .ok()?;
        let rows = table
            .records()
            .map(|row| Some(row.ok()?.iter().map(String::from).collect()));
        rows.collect()
    }

    /// The version of the program that wrote it; empty if its manifest does not say.
    pub fn written_by(&self) -> String {
        let version = manifest(&self.path)["version"].as_str().map(String::from);
        version.unwrap_or_default()
    }

    /// How many accepted states its manifest tells of; none if it does not say.
    pub fn states_told(&self) -> Option<usize> {
        manifest(&self.path)["states"].as_u64().map(|n| n as usize)
    }

    /// The rows of `history.csv`.
    ///
    /// # Errors
    /// [`StudyError::File`] if it is not there, or not one of this version's.
    pub fn history(&self) -> Result<Vec<Row>, StudyError> {
        match self.history_so_far()? {
            (rows, None) => Ok(rows),
            (_, Some(broken)) => Err(StudyError::File {
                path: self.path.join(HISTORY),
                source: std::io::Error::other(broken),
            }),
        }
    }

    /// The rows of `history.csv` up to the first that is broken, as power that fails or a full disk may leave one; and what is
    /// wrong with that, if there is one.
    ///
    /// # Errors
    /// [`StudyError::File`] if it is not there, or not one of this version's: if already its first row is none.
    pub fn history_so_far(&self) -> Result<(Vec<Row>, Option<String>), StudyError> {
        let path = self.path.join(HISTORY);
        let trouble = |error: csv::Error| StudyError::File {
            path: path.clone(),
            source: std::io::Error::other(error),
        };
        if path.exists() && !path.is_file() {
            let what = std::io::Error::other("not a plain file");
            return Err(trouble(what.into()));
        }
        let mut table = csv::Reader::from_path(&path).map_err(trouble)?;
        let mut rows: Vec<Row> = vec![];
        for row in table.deserialize() {
            match row {
                Ok(row) => rows.push(row),
                Err(error) if rows.is_empty() => return Err(trouble(error)),
                Err(error) => return Ok((rows, Some(error.to_string()))),
            }
        }
        Ok((rows, None))
    }

    /// The files of the saved states, in the order of their numbers.
    ///
    /// # Errors
    /// [`StudyError::File`] if they cannot be listed; none are no error.
    pub fn states(&self) -> Result<Vec<PathBuf>, StudyError> {
        Ok(self.numbered(STATES, STATE_ENDING)?.into_values().collect())
    }

    /// The files `state-N` with an ending in a folder, by their numbers.
    ///
    /// # Errors
    /// [`StudyError::File`] if they cannot be listed; none are no error.
    pub fn numbered(
        &self,
        folder: &str,
        ending: &str,
    ) -> Result<BTreeMap<usize, PathBuf>, StudyError> {
        let folder = self.path.join(folder);
        let entries = match fs::read_dir(&folder) {
            Ok(entries) => entries,
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Ok(BTreeMap::new()),
            Err(source) => {
                return Err(StudyError::File {
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

    /// The relative path of the file of a saved state, by the number of its row.
    pub fn name_of_state(row: usize) -> String {
        format!("{STATES}/state-{row:04}.{STATE_ENDING}")
    }

    /// The files that keep what the run began with: its first state, if that is not rest, and modes.
    pub fn kept(&self) -> Vec<PathBuf> {
        let start = Some(self.start()).filter(|start| start.exists());
        let modes = modes(&self.path.join(IMPERFECTIONS));
        start.into_iter().chain(modes).collect()
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The hash (BLAKE3) of the case text.
    pub fn case_hash(&self) -> &str {
        &self.case_hash
    }

    /// Whether there is a run at a path: a case, at least, that is to be run.
    pub fn is_there(path: &Path) -> bool {
        is_a_run(path) && !is_unborn(path)
    }

    /// Where the mode is kept that an imperfection has the shape of; they are counted from 1.
    pub fn imperfection(&self, number: usize) -> PathBuf {
        self.path.join(imperfection(number))
    }

    /// Where the state is kept that the run began from, if not from rest.
    pub fn start(&self) -> PathBuf {
        self.path.join(START)
    }

    /// Takes out what a test of stability wrote before.
    pub fn clear_stability(&self) -> Result<(), StudyError> {
        remove(stability_files(&self.path))
    }
}

/// What the manifest in a directory says; nothing if there is none.
fn manifest(path: &Path) -> serde_json::Value {
    let bytes = fs::read(path.join(MANIFEST)).unwrap_or_default();
    serde_json::from_slice(&bytes).unwrap_or_default()
}

/// Whether a directory is that of a former run: its manifest says so.
fn is_a_run(path: &Path) -> bool {
    manifest(path)["program"] == PROGRAM
}

/// Whether a directory is that of a run that was killed before its case was there: while it replaced another, maybe. Its manifest
/// says no more than whose it is.
fn is_unborn(path: &Path) -> bool {
    let manifest = manifest(path);
    let no_more = |about: &serde_json::Map<String, serde_json::Value>| {
        about
            .keys()
            .all(|key| ["program", "title"].contains(&key.as_str()))
    };
    let begins = manifest[REPLACED] == true || manifest.as_object().is_some_and(no_more);
    begins && is_a_run(path) && !path.join(CASE).exists()
}

/// Whether a file is what is left of a run that could not even begin.
fn is_left_over(file: &Path) -> bool {
    let name = file.file_name().and_then(|name| name.to_str());
    ["manifest.part", "case.part", LOCK]
        .map(Some)
        .contains(&name)
}

/// The relative path of a state that is kept for pictures.
fn name_of_spare(row: usize) -> String {
    format!("{SPARE}/state-{row:04}.{STATE_ENDING}")
}

/// The relative path of the mode that an imperfection has the shape of.
fn imperfection(number: usize) -> String {
    format!("{IMPERFECTIONS}/mode-{number:02}.{STATE_ENDING}")
}

/// The number N of a file that is called `state-N` with an ending.
fn number_of_state(file: &Path, ending: &str) -> Option<usize> {
    let name = file.file_name()?.to_str()?;
    let number = name.strip_prefix("state-")?.strip_suffix(ending)?;
    let number = number.strip_suffix('.')?;
    let digits = !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit());
    digits.then(|| number.parse().ok())?
}

/// A directory of its own for a test, empty.
#[cfg(test)]
fn scratch(name: &str) -> PathBuf {
    let path = std::env::temp_dir().join(format!("plica-{name}-{}", std::process::id()));
    let _ = fs::remove_dir_all(&path);
    fs::create_dir_all(&path).unwrap();
    path
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_a_run_is_never_touched() {
        let path = scratch("not-a-run");
        fs::write(path.join(MANIFEST), r#"{"name": "my web app"}"#).unwrap();
        fs::write(path.join("logo.png"), "logo").unwrap();
        let refused = RunDirectory::create(&path, "case", "", true);
        assert!(matches!(refused, Err(StudyError::NotARun(_))));
        assert_eq!(fs::read(path.join("logo.png")).unwrap(), b"logo");
        fs::remove_dir_all(path).unwrap();
    }

    #[test]
    fn what_is_left_of_a_run_that_could_not_begin_is_no_hindrance() {
        let path = scratch("left-over");
        fs::write(path.join("manifest.part"), "{").unwrap();
        RunDirectory::create(&path, "case", "", false).unwrap();
        assert_eq!(fs::read(path.join("case.toml")).unwrap(), b"case");
        // Cut off while it replaced a run, it begins.
        fs::remove_file(path.join("case.toml")).unwrap();
        fs::write(path.join(HISTORY), "of before").unwrap();
        RunDirectory::create(&path, "again", "", false).unwrap();
        assert!(!path.join(HISTORY).exists());
        // One that has lost its case is a run still.
        fs::remove_file(path.join("case.toml")).unwrap();
        fs::write(
            path.join(MANIFEST),
            r#"{"program": "plica", "verdict": "complete"}"#,
        )
        .unwrap();
        let refused = RunDirectory::create(&path, "again", "", false);
        assert!(matches!(refused, Err(StudyError::Occupied(_))));
        RunDirectory::create(&path, "again", "", true).unwrap();
        fs::remove_dir_all(path).unwrap();
    }

    #[test]
    fn a_former_run_is_replaced_when_asked_and_other_files_stay() {
        let path = scratch("former-run");
        RunDirectory::create(&path, "first", "", false).unwrap();
        for folder in ["profiles", "states", "vtk/walls", "pictures"] {
            fs::create_dir_all(path.join(folder)).unwrap();
        }
        for name in [
            "profiles/state-0003.csv",
            "profiles/mine.csv",
            "states/state-0003.safetensors",
            "states/state-0004.part",
            "states/mine.safetensors",
            "logo.png",
            "energy.png",
            "vtk/walls/state-0003.vtp",
            "vtk/walls.pvd",
            "vtk/mine.vtu",
            "pictures/energy-state-0003.png",
            "pictures/energy-path.apng",
            "pictures/overhang-along-length_ratio-path.svg",
            "pictures/mine.png",
        ] {
            fs::write(path.join(name), name).unwrap();
        }
        let again = RunDirectory::create(&path, "second", "", false);
        assert!(matches!(again, Err(StudyError::Occupied(_))));
        RunDirectory::create(&path, "second", "", true).unwrap();
        assert_eq!(fs::read(path.join("case.toml")).unwrap(), b"second");
        let stays = |name: &str| path.join(name).exists();
        assert!(stays("logo.png") && stays("profiles/mine.csv"));
        assert!(stays("states/mine.safetensors") && !stays("states/state-0004.part"));
        assert!(!stays("energy.png") && !stays("profiles/state-0003.csv"));
        assert!(!stays("states/state-0003.safetensors"));
        assert!(stays("pictures/mine.png") && !stays("pictures/energy-path.apng"));
        assert!(!stays("pictures/energy-state-0003.png"));
        assert!(!stays("pictures/overhang-along-length_ratio-path.svg"));
        assert!(stays("vtk/mine.vtu") && !stays("vtk/walls.pvd"));
        assert!(!stays("vtk/walls/state-0003.vtp"));
        fs::remove_dir_all(path).unwrap();
    }
}
