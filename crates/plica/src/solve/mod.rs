//! Solvers that find equilibrium states of any energy, one by one or along a path of loads.
//!
//! A problem is an [`Equilibrium`]: an energy W(u, load) with residual R = ∂W/∂u, tangent K = ∂²W/∂u²
//! and damping matrix C; supports prescribe some of the unknowns. Its [`Tangent`] makes the linear
//! [`Solver`]: [`Direct`] factors assembled matrices; others may iterate, and report directions of
//! negative curvature. This module contains no physics.
//!
//! - [`Path`] follows states along a load: it predicts with the tangent du/dt of the path, corrects
//!   with Newton's method, halves the step, relaxes, and halves further.
//! - [`newton`] solves K Δu = −R with a line search in the energy, and refuses an indefinite tangent.
//! - [`relaxation`] solves (K + α C) Δu = −R, backward Euler in pseudo-time, with damping α that
//!   decreases with the residual. Every step lowers the energy, so it leaves unstable states, unless
//!   a symmetry keeps it on them.
//! - [`PseudoTime`] is relaxation with constant damping, by backward Euler or the Newmark recurrence of
//!   Okino et al. (2025).
//! - [`conjugate_gradients`] and [`lowest`] solve linear systems and eigenvalue problems with an
//!   [`Operator`] that is never assembled.
//!
//! [`arc`] follows branches of equilibria, stable or not, through folds and branch points.
//!
//! A [`Monitor`](crate::monitor::Monitor) may cancel each of them. The solvers of equilibrium states count their work in
//! [`Effort`].
//!
//! | letter | meaning | unit |
//! |---|---|---|
//! | u | unknowns | D |
//! | W | energy | E D³ |
//! | R | residual | E D² |
//! | K | tangent stiffness | E D |
//! | C | damping matrix of unit coefficient | D³ |
//! | α | damping | E/D² |

#![allow(non_snake_case)] // the formulas keep the letters of their sources

pub mod arc;
#[cfg(test)]
mod barrier_tests;
mod conjugate_gradients;
mod continuation;
mod damping_controller;
mod equilibrium;
mod failure;
mod forcing;
#[cfg(test)]
mod friction_tests;
mod iterate;
mod limit_point;
mod line_search;
mod lowest;
mod newton;
mod operator;
mod path;
mod pseudo_time;
#[cfg(test)]
mod reflected;
mod relaxation;
mod repeated;
mod settings;
mod state;
mod step_controller;
mod tangent;
#[cfg(test)]
mod tests;

pub use conjugate_gradients::conjugate_gradients;
pub use continuation::{ContinuationState, PreviousPoint};
pub(crate) use equilibrium::EQUILIBRIUM;
pub use equilibrium::{Equilibrium, ResidualEvaluation};
pub use failure::{Cause, Failure};
pub use lowest::{Lowest, Search, lowest};
pub use newton::newton;
pub use operator::Operator;
pub use path::{Path, PathError, Segment, Step};
pub use relaxation::relaxation;
pub use settings::{Integrator, PseudoTime, Scheme, Settings};
pub use state::{Effort, Method, Solution, State};
pub use tangent::{Direct, NegativeCurvature, Solved, Solver, Tangent};
