//! Errors of the program and their exit codes.

use crate::console;
use plica::case::CaseError;
use plica::run_directory::RunError;
use std::path::PathBuf;
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
    /// Invalid arguments.
    Usage(String),
    /// Files could not be read or written.
    Files(String),
    /// Internal error.
    Fault(String),
    /// Error of a study.
    Study(RunError),
    /// Interrupted by the user; says what has been written.
    Interrupted(String),
}

impl Failure {
    /// Prints the error and returns the exit code.
    pub fn report(&self) -> ExitCode {
        let code = match self {
            Self::Unfinished => 1,
            Self::Case { path, text, error } => {
                console::tell(&crate::diagnostics::render(path, text, error));
                2
            }
            Self::Usage(what) => {
                console::tell(&format!("error: {what}"));
                2
            }
            Self::Files(what) => {
                console::tell(&format!("error: {what}"));
                3
            }
            Self::Fault(what) => {
                console::tell(&format!("error: {what}"));
                1
            }
            Self::Study(error) => {
                console::tell(&format!("error: {error}{}", help(error)));
                if error.is_about_files() { 3 } else { 1 }
            }
            Self::Interrupted(what) => {
                console::tell(what);
                130
            }
        };
        ExitCode::from(code)
    }
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        Self::Study(error)
    }
}

/// Returns what a user of the program can do about an error, as the end of its message.
fn help(error: &RunError) -> &'static str {
    match error {
        RunError::Occupied(_) => {
            "; resume it with --resume, choose another directory with --out, or replace it with --overwrite"
        }
        RunError::Busy { .. } => "; wait for it, end it, or choose another directory with --out",
        RunError::NoCheckpoint { .. } => "; run the case again with --overwrite",
        RunError::NotARun(_) => " (not even with --overwrite); choose another directory with --out",
        RunError::NoDirectory(_) => {
            "; give the directory of a run: runs/NAME, or the value of --out"
        }
        _ => "",
    }
}
