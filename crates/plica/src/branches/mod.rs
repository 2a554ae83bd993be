//! Branches of equilibria of an axisymmetric tube, stable or not: folds, branch points, losses of stability, and the
//! branches that cross.
//!
//! [`Follow`] runs the stages of a plan up to the state where its branch begins, and follows the equilibria from there with
//! [`crate::solve::arc`]. Every point is tested for stability to the circumferential modes. Between two points that differ in
//! an [`Event`](crate::study::Event) the special point is located; at a branch point of mode 0 both sides of the other
//! branch are followed, too. [`Branches`] is the result, with its tables.
//!
//! | label | point |
//! |---|---|
//! | LP | fold (limit point): the parameter has an extreme value |
//! | BP0 | branch point of axisymmetric branches, mode 0 |
//! | BPn | change of the stability to the circumferential mode n, from which a branch of this mode leaves |
//! | EV | any other event |

mod detect;
mod error;
mod follow;
mod locate;
mod sample;
mod special;
mod start_state;
mod tables;
#[cfg(test)]
mod tests;

pub use error::BranchError;
pub use follow::{Follow, Progress};
pub use sample::BranchState;
pub use special::{PointKind, SpecialPoint};
pub use start_state::start_state;

/// A branch.
#[derive(Clone, Debug)]
pub struct Branch {
    /// Its number, from 1.
    pub number: usize,
    /// The label of the branch point that it leaves, with the sign of the amplitude of the mode; none of a first branch.
    pub from: Option<String>,
    /// Its states in order, with located points between the others.
    pub states: Vec<BranchState>,
    /// The reason why it ends.
    pub end: BranchEnd,
}

/// The end of a branch.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum BranchEnd {
    /// The parameter has left its range.
    Range,
    /// The largest number of points was reached.
    Points,
    /// It was cancelled.
    Cancelled,
    /// No further point was found.
    Lost(String),
}

impl std::fmt::Display for BranchEnd {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Range => f.write_str("reached the end of the range"),
            Self::Points => f.write_str("has as many points as allowed (continuation.points)"),
            Self::Cancelled => f.write_str("was stopped"),
            Self::Lost(reason) => write!(f, "was lost: {reason}"),
        }
    }
}

/// All branches that were followed.
#[derive(Clone, Debug)]
pub struct Branches {
    /// The parameter, as the case names it.
    pub parameter: String,
    /// The branches.
    pub branches: Vec<Branch>,
    /// Their special points.
    pub points: Vec<SpecialPoint>,
    /// True if the monitor cancelled.
    pub cancelled: bool,
}
