//! Errors of the program and their exit codes.

use crate::{console, diagnostics};
use plica::case::CaseError;
use plica::run_directory::RunError;
use std::io::{Error, ErrorKind};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Reason why a command failed.
#[derive(Debug)]
pub enum Failure {
    /// The work is incomplete or a check failed; the reason has been printed.
    Unfinished,
    /// The case is invalid.
    Case {
        /// Path as given by the user.
        path: PathBuf,
        /// Its content.
        text: String,
        /// Its problems.
        error: CaseError,
    },
    /// The run is complete, but some of its states do not describe a real tube.
    Unphysical(String),
    /// Invalid arguments.
    Usage(String),
    /// Files could not be read or written.
    Files(String),
    /// Internal error.
    Fault(String),
    /// Error of a run directory.
    Run(RunError),
    /// Error of a run that can be resumed.
    OfRun {
        /// The error.
        error: RunError,
        /// Its directory.
        run: PathBuf,
    },
    /// Interrupted by the user; says what has been written.
    Interrupted(String),
}

impl Failure {
    /// Prints the error and returns the exit code.
    pub fn report(&self) -> ExitCode {
        let (message, code) = match self {
            Self::Unfinished => return ExitCode::from(1),
            Self::Case { path, text, error } => (diagnostics::render(path, text, error), 2),
            Self::Unphysical(what) => (format!("error: {what}"), 4),
            Self::Usage(what) => (format!("error: {what}"), 2),
            Self::Files(what) => (format!("error: {what}"), 3),
            Self::Fault(what) => (format!("error: {what}"), 1),
            Self::Run(error) => (format!("error: {error}{}", help(error)), code(error)),
            Self::OfRun { error, run } => {
                let help = help_for_run(error, run).unwrap_or_else(|| help(error).into());
                (format!("error: {error}{help}"), code(error))
            }
            Self::Interrupted(what) => (what.clone(), 130),
        };
        console::message(&message);
        ExitCode::from(code)
    }

    /// Adds the directory of the run that can be resumed.
    pub fn of_run(self, run: &Path) -> Self {
        match self {
            Self::Run(error) => Self::OfRun {
                error,
                run: run.to_owned(),
            },
            other => other,
        }
    }
}

/// Returns the exit code of an error of a run.
fn code(error: &RunError) -> u8 {
    if error.is_about_files() { 3 } else { 1 }
}

/// Returns whether there was no room on the disk.
fn is_full(error: &Error) -> bool {
    let kinds = [
        ErrorKind::StorageFull,
        ErrorKind::QuotaExceeded,
        ErrorKind::FileTooLarge,
    ];
    kinds.contains(&error.kind())
}

/// Returns how a run can be resumed after an error.
fn help_for_run(error: &RunError, run: &Path) -> Option<String> {
    let resume = format!("`plica resume {}`", run.display());
    match error {
        RunError::File { source, .. } if is_full(source) => {
            Some(format!("; make room, then {resume}"))
        }
        RunError::File { .. } => Some(format!("; all states before are kept: {resume} continues")),
        RunError::Moved(_) => Some(", where `plica resume` continues".into()),
        RunError::Changed(_) => Some(format!(
            "; its history and last state are written again, and {resume} continues"
        )),
        _ => None,
    }
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        Self::Run(error)
    }
}

/// Returns what a user of the program can do about an error, as the end of its message.
fn help(error: &RunError) -> &'static str {
    match error {
        RunError::Occupied(_) => {
            "; resume it with --resume, choose another directory with --out, or replace it with --overwrite"
        }
        RunError::Busy { .. } => "; wait for it, end it, or choose another directory",
        RunError::NoCheckpoint { .. } => "; run the case again with --overwrite",
        RunError::File { source, .. } if is_full(source) => "; make room, then repeat the command",
        RunError::DanglingLink { .. } => "; create that directory, or choose another with --out",
        RunError::IsAFile(_) => "; choose another with --out",
        RunError::Unwritten(_) => "; start it again with `plica run CASE --resume`",
        RunError::Incomplete { .. } => {
            ". What is left is intact. To compute the rest again, run the case in another directory or with --overwrite"
        }
        RunError::NotARun(_) => " (not even with --overwrite); choose another directory with --out",
        RunError::NoDirectory(_) => {
            "; give the directory of a run: runs/NAME, or the value of --out"
        }
        _ => "",
    }
}
