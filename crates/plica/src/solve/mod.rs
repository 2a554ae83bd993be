//! Finding equilibria: Newton, relaxation, pseudo-time, and the way through a snap.
//!
//! This room never hears of a tube. It sees an [`Equilibrium`]: an energy W(u, load) with its
//! residual R = ∂W/∂u, its tangent K = ∂²W/∂u², a drag matrix C, and unknowns that supports give.
//! How a linear system is solved it leaves to the [`Tangent`] and its [`Solver`]: [`Direct`] has
//! matrices that are factored; others may iterate, and then say where they meet an energy that is
//! curved downwards.
//!
//! - [`newton`]: K Δu = −R with the energy as judge. Refuses an indefinite tangent.
//! - [`relaxation`]: (K + α C) Δu = −R, backward Euler in pseudo-time with a drag α that shrinks
//!   as the residual does; every step lowers the energy, so it leaves every unstable state but
//!   one that its symmetry keeps it on.
//! - [`pseudo_time`]: the same with a drag that stays, and the paper's Newmark recurrence.
//! - [`conjugate_gradients`] and [`lowest`]: linear systems and lowest eigenpairs of an [`Operator`]
//!   that is never assembled.
//! - [`Path`]: from state to state along a load; predicts with the path's tangent, then takes the
//!   first of these that arrives, and halves the step when none does.
//!
//! | letter | meaning | unit |
//! |---|---|---|
//! | u | unknowns | D |
//! | R | residual | E D² |
//! | K | tangent stiffness | E D |
//! | C | drag matrix of unit coefficient | D³ |
//! | α | drag | E/D² |

#![allow(non_snake_case)] // the formulas keep the letters of their sources

mod conjugate_gradients;
mod forcing;
mod lowest;
mod newton;
mod operator;
mod path;
mod pseudo_time;
#[cfg(test)]
mod reflected;
mod relaxation;
mod settings;
mod state;
mod tangent;
#[cfg(test)]
mod tests;

pub use conjugate_gradients::conjugate_gradients;
pub use lowest::{Lowest, Search, lowest};
pub use newton::newton;
pub use operator::Operator;
pub use path::{ContinuationState, Path, PathError, PreviousPoint, Step};
pub use pseudo_time::pseudo_time;
pub use relaxation::relaxation;
pub use settings::{Integrator, PseudoTime, Scheme, Settings};
pub use state::{Equilibrium, Failure, Method, Monitor, ResidualEvaluation, Solution, State};
pub use tangent::{Direct, NegativeCurvature, Solved, Solver, Tangent};
