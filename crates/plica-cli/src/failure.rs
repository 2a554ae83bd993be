//! Errors of the program and their exit codes.

use crate::console;
use plica::case::CaseError;
use plica::study::StudyError;
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
    Study(StudyError),
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
                console::tell(&format!("error: {error}"));
                if error.is_file_trouble() { 3 } else { 1 }
            }
            Self::Interrupted(what) => {
                console::tell(what);
                130
            }
        };
        ExitCode::from(code)
    }
}
