//! Errors of a check.

use super::one_dimension::NoEquilibrium;
use plica::assembly::Inverted;
use plica::matrix::NoEigenpairs;
use plica::solve::PathError;
use plica::solve::arc::ArcFailure;

/// An error that ends a check.
#[derive(Debug, thiserror::Error)]
pub enum VerificationError {
    /// The monitor cancelled the verification.
    #[error("cancelled")]
    Cancelled,
    /// A path could not be continued.
    #[error("{0}")]
    Path(#[from] PathError<Inverted>),
    /// A linear or nonlinear solver failed.
    #[error("{0}")]
    Solve(String),
    /// An element of a state is inverted.
    #[error("{0}")]
    Inverted(#[from] Inverted),
    /// A lowest eigenvalue was not found.
    #[error("{0}")]
    Eigenpairs(#[from] NoEigenpairs),
    /// The reference solution has no equilibrium.
    #[error("{0}")]
    Reference(#[from] NoEquilibrium),
}

impl<E: std::error::Error> From<ArcFailure<E>> for VerificationError {
    fn from(failure: ArcFailure<E>) -> Self {
        Self::Solve(failure.to_string())
    }
}
