//! The run directory: a study's states on disk, and how a run is resumed.
//!
//! [`Run`] is a [`crate::study::Study`] that writes every state; [`RunDirectory`] reads and writes the files.

mod checkpoint;
mod clear;
mod coverage;
mod disk;
mod error;
mod history;
mod lock;
mod manifest;
mod names;
mod presence;
mod record;
mod resume;
mod run;
mod summary;
mod write;

pub use checkpoint::Checkpoint;
pub use coverage::StabilityCoverage;
pub use disk::DiskUse;
pub use error::RunError;
pub use record::{Fault, Record};
pub use resume::{CheckedHistory, Resumption};
pub use run::{Run, run};
pub use summary::{Snapshot, Summary};
pub use write::write_file;

use clear::{clear, files};
use lock::{LOCK, Lock};
use names::{imperfection, materials, name_of_profile, name_of_temporary_state, number_of_state};
use presence::Folder;
use serde::{Deserialize, Serialize};
use std::fs::{self, File};
use std::path::{Path, PathBuf};

/// The directory of one run:
///
/// | file | holds |
/// |---|---|
/// | `case.toml` | the case as it was run, to the byte |
/// | `manifest.json` | version, hash of the case, machine, threads, start and end, verdict |
/// | `history.csv` | one row per accepted state, see [`crate::study::Row`] |
/// | `profiles/state-NNNN.csv` | outer and inner wall of a state |
/// | `states/state-NNNN.safetensors` | a state in full, see [`crate::saved_state::SavedState`] |
/// | `checkpoint.safetensors`, `checkpoint-before.safetensors` | the last accepted state and the one before, with all that it takes to resume, see [`Checkpoint`] |
/// | `temporary/` | states that are not saved, until pictures are drawn |
/// | `lock` | locked by the process that works in the directory |
/// | `*.png` | pictures |
/// | `pictures/` | pictures drawn on request |
/// | `report.html` | the page of the run, on request |
/// | `vtk/` | VTK files, on request |
/// | `start.safetensors` | the state that the run started from, if not from rest |
/// | `imperfections/mode-NN.safetensors` | the mode that gives imperfection NN its shape |
/// | `materials/library-NN.toml` | the library of materials NN that the case names |
/// | `stability.csv`, `eigenvalues.csv`, `eigenpairs.csv`, `modes/` | results of `stability` |
#[derive(Debug)]
pub struct RunDirectory {
    path: PathBuf,
    /// The directory that was at the path when it was opened.
    folder: Folder,
    case: Vec<u8>,
    case_hash: String,
    /// `history.csv` of the run that this process writes, and its length in bytes.
    history: Option<File>,
    history_length: u64,
    /// Held by the process that writes the run.
    lock: Option<Lock>,
}

/// Verdict on a run, as in its manifest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// The run has not ended, or was killed.
    Running,
    /// Every stage was completed.
    Complete,
    /// The run was cancelled.
    Stopped,
    /// The tube could not be followed further.
    Lost,
}

impl std::fmt::Display for Verdict {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Running => "running",
            Self::Complete => "complete",
            Self::Stopped => "stopped",
            Self::Lost => "lost",
        })
    }
}

/// Key in the manifest of a run that is being replaced.
const REPLACED: &str = "replaced";

/// Key in the manifest for the coverage of `plica stability`.
const STABILITY: &str = "stability";

/// Name of the program in a manifest.
const PROGRAM: &str = "plica";

/// Name of the file that marks a directory as a run.
const MANIFEST: &str = "manifest.json";

/// Name of the table of states.
const HISTORY: &str = "history.csv";

/// Name of the case as it was run.
const CASE: &str = "case.toml";

/// Folders of walls, of saved states, and of states that are kept only until the pictures are drawn.
const PROFILES: &str = "profiles";
const STATES: &str = "states";
const TEMPORARY: &str = "temporary";

/// The newest checkpoint, and the one before it.
const CHECKPOINTS: [&str; 2] = ["checkpoint.safetensors", "checkpoint-before.safetensors"];

/// Name of the state that a run started from.
const START: &str = "start.safetensors";

/// Folder of the modes that give imperfections their shapes.
const IMPERFECTIONS: &str = "imperfections";

/// Folder of the libraries of materials that the case names.
const MATERIALS: &str = "materials";

/// Extension of the files of saved states.
const STATE_ENDING: &str = "safetensors";

/// Folders with one file per state, and the extension of these files.
const OF_STATES: [(&str, &str); 3] = [
    (PROFILES, "csv"),
    (STATES, STATE_ENDING),
    (TEMPORARY, STATE_ENDING),
];

impl RunDirectory {
    /// Creates the directory and writes the case and its title.
    ///
    /// # Errors
    /// [`RunError::NotARun`] if the directory holds anything that is not a run, [`RunError::Occupied`] if it holds a run and
    /// `overwrite` is false, [`RunError::Busy`] if another process works in it.
    pub fn create(
        path: &Path,
        case_text: &str,
        title: &str,
        overwrite: bool,
    ) -> Result<Self, RunError> {
        let error_at = |source| RunError::File {
            path: path.to_owned(),
            source,
        };
        match fs::read_dir(path) {
            Ok(_) => check_free(path, overwrite)?,
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => {
                if let Ok(target) = fs::read_link(path) {
                    let link = path.to_owned();
                    return Err(RunError::DanglingLink { link, target });
                }
                fs::create_dir_all(path).map_err(error_at)?;
            }
            Err(_) if path.is_file() => return Err(RunError::IsAFile(path.to_owned())),
            Err(e) => return Err(error_at(e)),
        }
        let lock = Some(Lock::take(path)?);
        // Another process may have run there since.
        check_free(path, overwrite)?;
        let mut directory = Self {
            path: path.to_owned(),
            folder: Folder::open(path),
            case: vec![],
            case_hash: String::new(),
            history: None,
            history_length: 0,
            lock,
        };
        // First, so that the directory stays a run whatever happens next: the previous one, as long as its case is there.
        let mut about = directory.about();
        about.insert(REPLACED.into(), true.into());
        directory.write_manifest(&about)?;
        clear(path)?;
        directory.write_manifest(&serde_json::json!({ "program": PROGRAM }))?;
        directory.write_case(case_text, title)?;
        Ok(directory)
    }

    /// Locks the directory for this process, until `self` is dropped.
    ///
    /// # Errors
    /// [`RunError::Busy`] if another process works in it; else as [`RunDirectory::open`].
    pub fn lock(&mut self) -> Result<(), RunError> {
        if self.lock.is_none() {
            let lock = Some(Lock::take(&self.path)?);
            // Another process may have changed it since it was opened.
            *self = Self {
                lock,
                ..Self::read_from(&self.path, true)?
            };
        }
        Ok(())
    }

    /// Opens the directory of a run, complete or not.
    ///
    /// # Errors
    /// [`RunError::File`] if it does not exist, [`RunError::Busy`] if another process creates the run just now,
    /// [`RunError::NoRun`] or [`RunError::Unwritten`] if it holds no run, and [`RunError::CaseChanged`] if its case is not
    /// the one that was run.
    pub fn open(path: &Path) -> Result<Self, RunError> {
        Self::read_from(path, false)
    }

    /// Opens the directory; `is_mine` if this process has locked it.
    fn read_from(path: &Path, is_mine: bool) -> Result<Self, RunError> {
        let read = |name: &str| {
            fs::read(path.join(name)).map_err(|source| RunError::File {
                path: path.join(name),
                source,
            })
        };
        if path.exists() && !path.is_dir() {
            return Err(RunError::NoDirectory(path.to_owned()));
        }
        fs::read_dir(path).map_err(|source| RunError::File {
            path: path.to_owned(),
            source,
        })?;
        let folder = Folder::open(path);
        if !is_run(path) || !path.join(CASE).exists() {
            // A run that begins now writes them in a moment.
            let none = match is_run(path) {
                true if is_unwritten(path) => RunError::Unwritten(path.to_owned()),
                true => RunError::File {
                    path: path.join(CASE),
                    source: std::io::ErrorKind::NotFound.into(),
                },
                false => RunError::NoRun(path.to_owned()),
            };
            let owner = if is_mine { None } else { Lock::owner(path) };
            return Err(owner.unwrap_or(none));
        }
        let manifest: serde_json::Value =
            serde_json::from_slice(&read(MANIFEST)?).unwrap_or_default();
        let case = read(CASE)?;
        let case_hash = blake3::hash(&case).to_string();
        if manifest["case_hash"]
            .as_str()
            .is_some_and(|hash| hash != case_hash)
        {
            return Err(RunError::CaseChanged(path.join(CASE)));
        }
        Ok(Self {
            path: path.to_owned(),
            folder,
            case,
            case_hash,
            history: None,
            history_length: 0,
            lock: None,
        })
    }

    /// Returns the verdict in the manifest.
    pub fn verdict(&self) -> Verdict {
        let verdict = &manifest(&self.path)["verdict"];
        Verdict::deserialize(verdict).unwrap_or(Verdict::Running)
    }

    /// Returns the content of `manifest.json`; null if there is none.
    pub fn manifest(&self) -> serde_json::Value {
        manifest(&self.path)
    }

    /// Returns the bytes of one of its files; none if it cannot be read.
    pub fn read(&self, name: &str) -> Option<Vec<u8>> {
        fs::read(self.path.join(name)).ok()
    }

    /// Returns the rows of one of its tables as texts, starting with the names of the columns; none if it cannot be read.
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

    /// Returns the version of the program that wrote it; empty if the manifest does not say.
    pub fn version(&self) -> String {
        let version = manifest(&self.path)["version"].as_str().map(String::from);
        version.unwrap_or_default()
    }

    /// Returns the number of accepted states in the manifest; none if it does not say.
    pub fn state_count(&self) -> Option<usize> {
        manifest(&self.path)["states"].as_u64().map(|n| n as usize)
    }

    /// Returns the path of the directory.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the hash (BLAKE3) of the text of the case.
    pub fn case_hash(&self) -> &str {
        &self.case_hash
    }

    /// Returns whether there is a run at a path, with a case at least.
    pub fn exists(path: &Path) -> bool {
        is_run(path) && !is_unwritten(path)
    }
}

/// Refuses a directory that holds anything that is not a run, or a run that is not to be replaced.
fn check_free(path: &Path, overwrite: bool) -> Result<(), RunError> {
    if !files(path).any(|file| !is_leftover(&file)) {
        return Ok(());
    }
    if !is_run(path) {
        return Err(RunError::NotARun(path.to_owned()));
    }
    match overwrite || is_unwritten(path) {
        true => Ok(()),
        false => Err(RunError::Occupied(path.to_owned())),
    }
}

/// Reads the manifest in a directory; null if there is none.
fn manifest(path: &Path) -> serde_json::Value {
    let bytes = fs::read(path.join(MANIFEST)).unwrap_or_default();
    serde_json::from_slice(&bytes).unwrap_or_default()
}

/// Returns whether a directory holds a run, by its manifest.
fn is_run(path: &Path) -> bool {
    manifest(path)["program"] == PROGRAM
}

/// Returns whether a directory holds a run that was killed before its case was written, perhaps while it replaced another run.
fn is_unwritten(path: &Path) -> bool {
    let manifest = manifest(path);
    let no_more = |about: &serde_json::Map<String, serde_json::Value>| {
        about
            .keys()
            .all(|key| ["program", "title"].contains(&key.as_str()))
    };
    let begins = manifest[REPLACED] == true || manifest.as_object().is_some_and(no_more);
    begins && is_run(path) && !path.join(CASE).exists()
}

/// Returns whether a file was left by a run that could not begin.
fn is_leftover(file: &Path) -> bool {
    let name = file.file_name().and_then(|name| name.to_str());
    ["manifest.part", "case.part", LOCK]
        .map(Some)
        .contains(&name)
}

/// Makes an empty directory for a test.
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
    fn a_directory_that_holds_no_run_is_not_changed() {
        let path = scratch("not-a-run");
        fs::write(path.join(MANIFEST), r#"{"name": "my web app"}"#).unwrap();
        fs::write(path.join("logo.png"), "logo").unwrap();
        let refused = RunDirectory::create(&path, "case", "", true);
        assert!(matches!(refused, Err(RunError::NotARun(_))));
        assert_eq!(fs::read(path.join("logo.png")).unwrap(), b"logo");
        fs::remove_dir_all(path).unwrap();
    }

    #[test]
    fn leftovers_of_a_run_that_could_not_begin_are_replaced() {
        let path = scratch("left-over");
        fs::write(path.join("manifest.part"), "{").unwrap();
        RunDirectory::create(&path, "case", "", false).unwrap();
        assert_eq!(fs::read(path.join("case.toml")).unwrap(), b"case");
        // Killed while it replaced a run.
        fs::remove_file(path.join("case.toml")).unwrap();
        fs::write(path.join(HISTORY), "of before").unwrap();
        RunDirectory::create(&path, "again", "", false).unwrap();
        assert!(!path.join(HISTORY).exists());
        // A run without its case is still a run.
        fs::remove_file(path.join("case.toml")).unwrap();
        fs::write(
            path.join(MANIFEST),
            r#"{"program": "plica", "verdict": "complete"}"#,
        )
        .unwrap();
        let refused = RunDirectory::create(&path, "again", "", false);
        assert!(matches!(refused, Err(RunError::Occupied(_))));
        RunDirectory::create(&path, "again", "", true).unwrap();
        fs::remove_dir_all(path).unwrap();
    }

    #[test]
    fn a_previous_run_is_replaced_on_request_and_other_files_stay() {
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
            "vtk/walls.pvd.12-0.part",
            "vtk/walls/state-0003.vtp.12-1.part",
            "report.html.12-0.part",
            "vtk/mine.vtu",
            "pictures/energy-state-0003.png",
            "pictures/energy-path.apng",
            "pictures/overhang-along-length_ratio-path.svg",
            "pictures/mine.png",
        ] {
            fs::write(path.join(name), name).unwrap();
        }
        let again = RunDirectory::create(&path, "second", "", false);
        assert!(matches!(again, Err(RunError::Occupied(_))));
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
        for folder in ["", "vtk", "vtk/walls", "pictures"] {
            assert!(
                files(&path.join(folder)).all(|file| file.extension() != Some("part".as_ref()))
            );
        }
        fs::remove_dir_all(path).unwrap();
    }
}
