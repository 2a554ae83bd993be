//! Errors of a study.

use super::Lost;
use crate::contact::Face;

/// An error that ends a study.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// The tube could not be followed further.
    #[error(transparent)]
    Lost(Box<Lost>),
    /// The study needs more memory than the machine has.
    #[error(
        "the case needs about {needed_gib:.1} GiB of memory and the machine has {available_gib:.1} \
         GiB free; use fewer control points or a symmetry that repeats more often"
    )]
    OutOfMemory {
        /// Forecast, in GiB.
        needed_gib: f64,
        /// Free, in GiB.
        available_gib: f64,
    },
    /// The state to start from passes through itself, and the study has contact.
    #[error(
        "the state to start from passes through itself at the {0}, and a wall with contact cannot: start from an earlier state, or set contact = false"
    )]
    Crosses(Face),
    /// The state to resume from does not belong to the plan.
    #[error("the study cannot be resumed: {0}")]
    Resume(String),
}
