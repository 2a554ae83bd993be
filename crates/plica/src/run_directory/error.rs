//! Errors of a run directory.

use super::Fault;
use crate::saved_state::SavedStateError;
use crate::study::StudyError;
use std::path::PathBuf;

/// An error of a run directory, or of a study that writes into one.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The study cannot begin or be resumed. (A tube that is lost on its path is an [`crate::study::Ending`], not an error.)
    #[error(transparent)]
    Study(#[from] StudyError),
    /// A file cannot be read or written.
    #[error("{}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// The error of the system.
        source: std::io::Error,
    },
    /// A saved state cannot be used.
    #[error("{}: {source}", path.display())]
    State {
        /// Its file.
        path: PathBuf,
        /// The fault.
        source: SavedStateError,
    },
    /// The directory holds a run already.
    #[error("{} already holds a run", .0.display())]
    Occupied(PathBuf),
    /// Another process works in the directory.
    #[error("another process works in {} ({owner})", path.display())]
    Busy {
        /// The directory.
        path: PathBuf,
        /// Name of the other process, as it has written it.
        owner: String,
    },
    /// The run has no checkpoint that fits.
    #[error("{}: the run cannot be resumed ({})", path.display(), reasons.join("; "))]
    NoCheckpoint {
        /// The directory.
        path: PathBuf,
        /// The faults of its checkpoints.
        reasons: Vec<String>,
    },
    /// A result is NaN or infinite. It is not written.
    #[error(
        "{}: {what} is {number}; nothing more is written, and all states before are kept. This is an error in plica: \
         please report it with the case",
        path.display()
    )]
    NotFinite {
        /// The file that it was to be written to.
        path: PathBuf,
        /// Column and row.
        what: String,
        /// The number.
        number: String,
    },
    /// The directory holds something that is not a run.
    #[error("{} is not empty and holds no run; nothing in it is changed", .0.display())]
    NotARun(PathBuf),
    /// The directory is not where it was when this process opened it.
    #[error(
        "{} was removed, moved or replaced while plica worked in it; nothing more is written. If it was moved, all that was \
         written is in its new place",
        .0.display()
    )]
    Moved(PathBuf),
    /// A file of a run in progress was removed or changed by another program.
    #[error(
        "{} was removed or changed by another program while plica worked in its directory; the run stops here",
        .0.display()
    )]
    Changed(PathBuf),
    /// Files of a run are missing or damaged.
    #[error("{}: missing or damaged: {}", path.display(), list(files))]
    Incomplete {
        /// The directory.
        path: PathBuf,
        /// Their relative paths, and what is wrong with them.
        files: Vec<(String, Fault)>,
    },
    /// The directory holds a run that has written no case yet.
    #[error("{}: the run ended before it wrote its case", .0.display())]
    Unwritten(PathBuf),
    /// The path leads nowhere: it is a symbolic link to a directory that does not exist.
    #[error("{} is a symbolic link to {}, which does not exist", link.display(), target.display())]
    DanglingLink {
        /// The link.
        link: PathBuf,
        /// Its target.
        target: PathBuf,
    },
    /// A run cannot be written to a path that is a file.
    #[error("{} is a file, and a run needs a directory", .0.display())]
    IsAFile(PathBuf),
    /// The path is not a directory.
    #[error("{} is not a directory", .0.display())]
    NoDirectory(PathBuf),
    /// The directory holds no run.
    #[error("{} holds no run: it has no manifest.json written by plica", .0.display())]
    NoRun(PathBuf),
    /// The case in a run directory is not the one that was run.
    #[error("{} was changed after the run, so the states do not belong to it; run the case again", .0.display())]
    CaseChanged(PathBuf),
}

impl RunError {
    /// Returns whether the cause is a file or a directory rather than the case.
    pub fn is_about_files(&self) -> bool {
        !matches!(self, Self::Study(_) | Self::NotFinite { .. })
    }
}

/// Lists a few faults of files.
fn list(files: &[(String, Fault)]) -> String {
    const SHOWN: usize = 6;
    let shown = files.iter().take(SHOWN);
    let mut words: Vec<String> = shown
        .map(|(name, fault)| format!("{name} ({fault})"))
        .collect();
    if files.len() > SHOWN {
        words.push(format!("and {} more", files.len() - SHOWN));
    }
    words.join(", ")
}
