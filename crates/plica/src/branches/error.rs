//! Errors of the following of branches.

use crate::study::StudyError;

/// An error before the first point of a branch.
#[derive(Debug, thiserror::Error)]
pub enum BranchError {
    /// The plan has no branch.
    #[error(
        "the case has no table [continuation], which names the parameter of the branch and its range"
    )]
    NoBranch,
    /// The stages cannot be run to the state where the branch begins.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// The branch begins outside its range.
    #[error(
        "the branch begins at {of} = {parameter:.9}, outside its range from {from} to {to}; widen `between`, or name another \
         stage in `after`"
    )]
    Outside {
        /// The parameter.
        of: String,
        /// Its value where the branch begins.
        parameter: f64,
        /// One end of the range.
        from: f64,
        /// The other end.
        to: f64,
    },
    /// There is no equilibrium where the branch begins.
    #[error("there is no equilibrium where the branch begins: {0}")]
    Begin(String),
    /// The monitor cancelled the run of the stages.
    #[error("cancelled before the branch began")]
    Cancelled,
}
