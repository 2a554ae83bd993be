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
    /// No step lowered the energy.
    #[error(
        "no step lowered the energy (residual {relative_residual:.1e} after {linear_solves} solves)"
    )]
    NoDescent {
        /// Linear solves so far.
        linear_solves: usize,
        /// Relative residual reached.
        relative_residual: f64,
        /// Free unknown with the largest residual.
        worst_unknown: usize,
    },
    /// Successive linear solves missed the required accuracy.
    #[error(
        "the linear solver misses the required accuracy (residual {relative_residual:.1e} after {linear_solves} solves)"
    )]
    InaccurateSolves {
        /// Linear solves so far.
        linear_solves: usize,
        /// Relative residual reached.
        relative_residual: f64,
        /// Free unknown with the largest residual.
        worst_unknown: usize,
    },
    /// The largest admitted number of linear solves did not suffice.
    #[error("not in equilibrium after {linear_solves} solves (residual {relative_residual:.1e})")]
    NotConverged {
        /// Linear solves so far.
        linear_solves: usize,
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

impl<E: std::error::Error> Failure<E> {
    /// Returns the unknown at which the failure shows most, if there is one.
    pub fn worst_unknown(&self) -> Option<usize> {
        match self {
            Self::NoDescent { worst_unknown, .. }
            | Self::InaccurateSolves { worst_unknown, .. }
            | Self::NotConverged { worst_unknown, .. }
            | Self::StillMoving { worst_unknown, .. } => Some(*worst_unknown),
            Self::Indefinite { .. } | Self::Evaluation(_) | Self::Singular(_) | Self::Cancelled => {
                None
            }
        }
    }
}
