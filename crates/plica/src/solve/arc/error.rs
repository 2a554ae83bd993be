//! Reasons why no point of a branch was found.

use crate::matrix::Singular;

/// The reason why a point of a branch was not found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ArcFailure<E: std::error::Error> {
    /// There is no problem at a value of the parameter.
    #[error("there is no problem at the value {parameter} of the parameter")]
    Undefined {
        /// The value.
        parameter: f64,
    },
    /// The residual is not defined.
    #[error(transparent)]
    Evaluation(E),
    /// A barrier of the energy lies on the way.
    #[error("a barrier lies on the way")]
    Blocked,
    /// The tangent cannot be factored, nor solved with.
    #[error("the tangent stiffness cannot be solved with ({0})")]
    Singular(Singular),
    /// The solver of the tangent is iterative, and needs a positive definite one.
    #[error("the linear solver of this problem needs a stable state")]
    Indefinite,
    /// Corrections do not decrease.
    #[error("the corrections do not decrease (relative residual {relative_residual:.1e})")]
    NotConverged {
        /// Relative residual reached.
        relative_residual: f64,
    },
    /// A special point was not found from where it was expected.
    #[error("Newton's method for the special point left its neighbourhood")]
    NoPoint,
    /// The monitor cancelled the computation.
    #[error("cancelled on request")]
    Cancelled,
}
