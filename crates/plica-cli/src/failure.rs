//! How the program ends when it does not end well.

use crate::console;
use plica::case::CaseError;
use plica::study::StudyError;
use std::path::PathBuf;
use std::process::ExitCode;

/// Why a command could not do what it was asked to.
#[derive(Debug)]
pub enum Failure {
    /// The run ended before its last stage did; it has said why.
    Unfinished,
    /// The case has problems.
    Case {
        /// The file as it was named.
        path: PathBuf,
        /// Its content.
        text: String,
        /// What is wrong with it.
        error: CaseError,
    },
    /// Something was asked for that cannot be.
    Usage(String),
    /// Files could not be read or written.
    Files(String),
    /// Something that must not happen did.
    Fault(String),
    /// The library could not go on.
    Study(StudyError),
    /// Someone pressed Ctrl-C; what is left of the work.
    Interrupted(String),
}

impl Failure {
    /// Says what happened, and gives the exit code.
    pub fn report(&self) -> ExitCode {
        let code = match self {
            Self::Unfinished => 1,
            Self::Case { path, text, error } => {
                console::tell(&crate::message::render(path, text, error));
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
