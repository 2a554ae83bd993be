//! Arc-length continuation: branches of equilibria with a parameter λ, stable or not, through folds and branch points.
//!
//! A [`Family`] gives a problem and a load for every λ. Its equilibria R(u, λ) = 0 form a [`Curve`]; a [`Branch`] follows it
//! in steps of its arc length s,
//!
//! ds² = ½ (duᵀ C du / n + dλ²),
//!
//! with the damping matrix C of unit coefficient. n is u′ᵀ C u′ with u′ = du/dλ at the first point, so that both terms weigh
//! the same there and s begins as λ does. A step predicts along the cubic through the last two points, and corrects in the
//! plane orthogonal to the tangent (u̇, λ̇) of the last one:
//!
//! [K R_λ; u̇ᵀC/n λ̇] [Δu; Δλ] = [−R; 0]
//!
//! by block elimination with the factored K, and refinement of the bordered system, which is regular at a fold where K is
//! not. Corrections must decrease (natural monotonicity; Deuflhard 2011); the energy, of which an unstable state is no
//! minimum, decides nothing.
//!
//! [`Curve::locate`] finds the point between two others at which a function is zero. [`Reduced`] is the force on the
//! critical mode (Lyapunov and Schmidt), from which folds and branch points are computed to the accuracy of the solver, the
//! coefficients of their normal forms, and points of the branches that cross there.

mod bordered;
mod branch;
mod corrector;
mod critical;
mod curve;
mod error;
mod family;
mod locate;
mod metric;
mod reduced;
mod special;
mod step_length;
#[cfg(test)]
mod tests;

pub use branch::{Branch, BranchEnd};
pub use critical::CriticalPair;
pub use curve::{ArcSettings, Curve, Point};
pub use error::ArcFailure;
pub use family::{Family, LoadFamily};
pub use locate::Accuracy;
pub use reduced::{Reduced, ReducedPoint};
pub use special::{BranchPoint, Fold, NormalForm};
