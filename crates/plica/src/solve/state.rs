//! Accepted states, solutions, and the effort of finding them.

use super::equilibrium::{EQUILIBRIUM, ResidualEvaluation};
use super::failure::Failure;
use crate::monitor::Monitor;
use std::fmt;

/// An accepted state.
#[derive(Clone, Debug)]
pub struct State<L> {
    /// Its load.
    pub load: L,
    /// Its unknowns.
    pub u: Vec<f64>,
    /// Its energy.
    pub energy: f64,
    /// Its relative residual without damping.
    pub relative_residual: f64,
    /// Number of negative eigenvalues of its tangent that the solver has found. A direct solver finds
    /// all of them, so 0 means stable. An iterative solver may find one only in a later solve with the
    /// same tangent. A singular tangent counts as one.
    pub negative_pivots: usize,
}

impl<L> State<L> {
    /// Returns whether the relative residual without damping is at most 1e-6.
    pub fn in_equilibrium(&self) -> bool {
        self.relative_residual <= EQUILIBRIUM
    }
}

/// The result of a solver.
#[derive(Clone, Debug)]
pub struct Solution {
    /// Unknowns.
    pub u: Vec<f64>,
    /// Energy and residual there.
    pub forces: ResidualEvaluation,
    /// Energy dissipated by damping.
    pub damping_work: f64,
}

/// Method by which a state was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// None: the path begins at this state.
    Rest,
    /// Newton's method.
    Newton,
    /// Relaxation with damping that decreases.
    Relaxation,
    /// Pseudo-time with constant damping.
    PseudoTime,
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Rest => "rest",
            Self::Newton => "newton",
            Self::Relaxation => "relaxation",
            Self::PseudoTime => "pseudo-time",
        })
    }
}

/// Work of the solvers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Effort {
    /// Linear solves of successful attempts. A path adds those that the failures of its Newton and
    /// relaxation attempts count, and one for the tangent of every accepted state.
    pub linear_solves: usize,
    /// Iterations inside all linear solves, failed attempts included; 0 where the solver is direct.
    pub inner_iterations: usize,
}

/// Reports linear solve number `solve` of a method, and fails if the computation is cancelled.
pub(super) fn report<E: std::error::Error>(
    monitor: &mut dyn Monitor,
    method: Method,
    solve: usize,
    relative_residual: f64,
) -> Result<(), Failure<E>> {
    let activity = format_args!("{method}, solve {solve}, residual {relative_residual:.1e}");
    monitor.working(&activity, 0.0);
    if monitor.is_cancelled() {
        return Err(Failure::Cancelled);
    }
    Ok(())
}
