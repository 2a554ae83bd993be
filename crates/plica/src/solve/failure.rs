//! Reasons why a solver found no state.

use crate::matrix::Singular;

/// The reason why a solver found no state.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Failure<E: std::error::Error> {
    /// The tangent is not positive definite, and the method requires that.
    #[error("the tangent has {negative_pivots} negative eigenvalue(s)")]
    Indefinite {
        /// Number of negative eigenvalues found.
        negative_pivots: usize,
    },
    /// The energy is not defined at the shortest step that was tried.
    #[error(transparent)]
    Evaluation(E),
    /// The start of the step lies behind a barrier of the energy: [`longest_step`](super::Equilibrium::longest_step).
    #[error("moving the prescribed values leads past a barrier")]
    Blocked,
    /// The residual is not within the tolerance.
    #[error("{cause} after {linear_solves} solves (residual {relative_residual:.1e})")]
    NotConverged {
        /// The reason for giving up.
        cause: Cause,
        /// Linear solves so far.
        linear_solves: usize,
        /// Relative residual reached.
        relative_residual: f64,
        /// Free unknown with the largest residual.
        worst_unknown: usize,
    },
    /// The forces that a step takes from a state, as those of friction, did not become those of the solution.
    #[error("friction does not become that of the solution (residual {relative_residual:.1e})")]
    Friction {
        /// Relative residual reached.
        relative_residual: f64,
        /// Free unknown with the largest residual.
        worst_unknown: usize,
    },
    /// The largest admitted number of pseudo-time steps did not bring the tube to rest.
    #[error("still moving by {displacement:.1e} D per pseudo-time step after {steps} steps")]
    StillMoving {
        /// Pseudo-time steps after the ramp.
        steps: usize,
        /// Largest displacement of a control point in the last of them, in D.
        displacement: f64,
        /// Unknown with the largest displacement.
        worst_unknown: usize,
    },
    /// The tangent is singular.
    #[error(transparent)]
    Singular(#[from] Singular),
    /// The monitor cancelled the computation.
    #[error("cancelled on request")]
    Cancelled,
}

/// The reason for giving up before the residual is within the tolerance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// No step lowered the energy.
    NoDescent,
    /// Successive linear solves missed the required accuracy.
    InaccurateSolves,
    /// The largest admitted number of linear solves was reached.
    SolveLimit,
}

impl std::fmt::Display for Cause {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::NoDescent => "no step lowered the energy",
            Self::InaccurateSolves => "the linear solver misses the required accuracy",
            Self::SolveLimit => "not in equilibrium",
        })
    }
}

impl<E: std::error::Error> Failure<E> {
    /// Returns the linear solves that the failure counts: 1 of an indefinite tangent.
    pub(crate) fn linear_solves(&self) -> usize {
        match self {
            Self::NotConverged { linear_solves, .. } => *linear_solves,
            Self::Indefinite { .. } => 1,
            _ => 0,
        }
    }

    /// Returns the unknown at which the failure shows most, if there is one.
    pub fn worst_unknown(&self) -> Option<usize> {
        match self {
            Self::NotConverged { worst_unknown, .. }
            | Self::Friction { worst_unknown, .. }
            | Self::StillMoving { worst_unknown, .. } => Some(*worst_unknown),
            _ => None,
        }
    }
}
