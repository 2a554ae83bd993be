//! Errors of the program and their exit codes.

use crate::{console, diagnostics};
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
    /// Error of a run.
    Run(RunError),
    /// Interrupted by the user; says what has been written.
    Interrupted(String),
}

impl Failure {
    /// Prints the error and returns the exit code.
    pub fn report(&self) -> ExitCode {
        let (message, code) = match self {
            Self::Unfinished => return ExitCode::from(1),
            Self::Case { path, text, error } => (diagnostics::render(path, text, error), 2),
            Self::Usage(what) => (format!("error: {what}"), 2),
            Self::Files(what) => (format!("error: {what}"), 3),
            Self::Fault(what) => (format!("error: {what}"), 1),
            Self::Run(error) => {
                let code = if error.is_about_files() { 3 } else { 1 };
                (format!("error: {error}{}", help(error)), code)
            }
            Self::Interrupted(what) => (what.clone(), 130),
        };
        console::message(&message);
        ExitCode::from(code)
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
        RunError::Busy { .. } => "; wait for it, end it, or choose another directory with --out",
        RunError::NoCheckpoint { .. } => "; run the case again with --overwrite",
        RunError::NotARun(_) => " (not even with --overwrite); choose another directory with --out",
        RunError::NoDirectory(_) => {
            "; give the directory of a run: runs/NAME, or the value of --out"
        }
        _ => "",
    }
}
