//! Why a study could not go on.

use super::SavedStateError;
use std::path::PathBuf;

/// What can go wrong outside the physics. (A path that cannot be followed is a result, told in
/// the [`super::Summary`].)
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// A file could not be written.
    #[error("{}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A saved state cannot be used.
    #[error("{}: {source}", path.display())]
    State {
        /// Its file.
        path: PathBuf,
        /// What is wrong with it.
        source: SavedStateError,
    },
    /// The directory holds a run already.
    #[error("{} holds a run already; go on with it by --resume, give another directory with --out, or --overwrite it", .0.display())]
    Occupied(PathBuf),
    /// Another process is at work in the directory.
    #[error(
        "another plica is at work in {} ({owner}); wait for it, end it, or give another directory with --out",
        path.display()
    )]
    Busy {
        /// The directory.
        path: PathBuf,
        /// What the other has told of itself.
        owner: String,
    },
    /// The run has left nothing to go on from.
    #[error(
        "{}: nothing to go on from ({}); run the case again with --overwrite",
        path.display(),
        reasons.join("; ")
    )]
    NoCheckpoint {
        /// The directory.
        path: PathBuf,
        /// What is wrong with its checkpoints.
        reasons: Vec<String>,
    },
    /// A number came out that is none. It is not written.
    #[error(
        "{}: {what} came out as {number}, so that nothing more is written; what was accepted before is kept. This is a fault \
         of plica: please report it with the case",
        path.display()
    )]
    NoNumber {
        /// The file that it was for.
        path: PathBuf,
        /// Column and row.
        what: String,
        /// What stood there.
        number: String,
    },
    /// The directory holds something that is not a run.
    #[error(
        "{} is not empty and holds no former run, so nothing in it is touched (not even with \
         --overwrite); give another directory with --out",
        .0.display()
    )]
    NotARun(PathBuf),
    /// It is no directory.
    #[error("{} is not a directory; give that of a run, runs/NAME or what --out said", .0.display())]
    NoDirectory(PathBuf),
    /// The directory holds no run.
    #[error("{} holds no run of plica (no manifest.json that says so)", .0.display())]
    NoRun(PathBuf),
    /// The case in a run's directory is not the one that was run.
    #[error(
        "{} was changed after the run, so that the states beside it are not its own; run the case \
         again",
        .0.display()
    )]
    CaseChanged(PathBuf),
    /// The case needs more memory than the machine has.
    #[error(
        "the case needs about {needed_gib:.1} GiB of memory and the machine has {available_gib:.1} \
         GiB free; use fewer control points or a symmetry that repeats more often"
    )]
    ContinuationState {
        /// Forecast, in GiB.
        needed_gib: f64,
        /// Free, in GiB.
        available_gib: f64,
    },
}

impl StudyError {
    /// Whether it is trouble with files rather than with the case.
    pub fn is_file_trouble(&self) -> bool {
        !matches!(self, Self::ContinuationState { .. } | Self::NoNumber { .. })
    }
}
