//! What is solved, and what a solution is.

use super::Tangent;
use crate::matrix::Singular;

/// An energy to be made stationary. Pure in (u, load): nothing remembers the last call.
///
/// Supports give single unknowns. Where they pin a combination of unknowns too, forces and drag come
/// without their part along it, and so do the steps that a [`super::Solver`] finds: all that the
/// drivers see lies in the space of what may move.
pub trait Equilibrium {
    /// What drives it.
    type Load: Clone;
    /// Why its energy does not exist at some state.
    type EvaluationError: std::error::Error + Clone;
    /// Its tangent stiffness.
    type Tangent: Tangent;

    /// For every unknown, whether a support gives it.
    fn prescribed(&self) -> &[bool];
    /// Writes the given unknowns of a load into `u`.
    fn apply_prescribed(&self, load: &Self::Load, u: &mut [f64]);
    /// The load a fraction `t` of the way from one to another.
    fn between(&self, from: &Self::Load, to: &Self::Load, t: f64) -> Self::Load;
    /// Energy and residual.
    fn forces(
        &self,
        load: &Self::Load,
        u: &[f64],
    ) -> Result<ResidualEvaluation, Self::EvaluationError>;
    /// Tangent stiffness K at a state.
    fn tangent(&self, load: &Self::Load, u: &[f64]) -> Self::Tangent;
    /// y += factor · C v with the drag matrix C, every unknown free that is not pinned.
    fn damping(&self, factor: f64, v: &[f64], y: &mut [f64]);
}

/// A reference to a problem is a problem.
impl<P: Equilibrium> Equilibrium for &P {
    type Load = P::Load;
    type EvaluationError = P::EvaluationError;
    type Tangent = P::Tangent;

    fn prescribed(&self) -> &[bool] {
        (**self).prescribed()
    }
    fn apply_prescribed(&self, load: &Self::Load, u: &mut [f64]) {
        (**self).apply_prescribed(load, u);
    }
    fn between(&self, from: &Self::Load, to: &Self::Load, t: f64) -> Self::Load {
        (**self).between(from, to, t)
    }
    fn forces(
        &self,
        load: &Self::Load,
        u: &[f64],
    ) -> Result<ResidualEvaluation, Self::EvaluationError> {
        (**self).forces(load, u)
    }
    fn tangent(&self, load: &Self::Load, u: &[f64]) -> Self::Tangent {
        (**self).tangent(load, u)
    }
    fn damping(&self, factor: f64, v: &[f64], y: &mut [f64]) {
        (**self).damping(factor, v, y);
    }
}

/// Energy and residual at a state.
#[derive(Clone, Debug)]
pub struct ResidualEvaluation {
    /// The energy W.
    pub energy: f64,
    /// R = ∂W/∂u, for every unknown, without its part along what is pinned.
    pub residual: Vec<f64>,
    /// The size of the forces whose balance R is; never zero.
    pub residual_scale: f64,
    /// How much the energy may be off by rounding.
    pub rounding: f64,
}

impl ResidualEvaluation {
    /// |R| over the free unknowns, relative to the forces in play.
    pub fn relative_residual(&self, prescribed: &[bool]) -> f64 {
        self.free(prescribed)
            .map(|(_, r)| r * r)
            .sum::<f64>()
            .sqrt()
            / self.residual_scale
    }

    /// The free unknown that is farthest from balance.
    pub fn worst(&self, prescribed: &[bool]) -> usize {
        largest(self.free(prescribed)).0
    }

    /// The free unknowns and their entries of R.
    fn free<'a>(&'a self, prescribed: &'a [bool]) -> impl Iterator<Item = (usize, f64)> + 'a {
        let all = self.residual.iter().copied().enumerate();
        all.zip(prescribed)
            .filter_map(|(entry, prescribed)| (!prescribed).then_some(entry))
    }
}

/// Which of some entries is largest, and its size; 0 and nothing if there are none.
pub(super) fn largest(entries: impl Iterator<Item = (usize, f64)>) -> (usize, f64) {
    let sizes = entries.map(|(i, x)| (i, x.abs()));
    sizes.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or_default()
}

/// An accepted state.
#[derive(Clone, Debug)]
pub struct State<L> {
    /// The load it is under.
    pub load: L,
    /// Its unknowns.
    pub u: Vec<f64>,
    /// Its energy.
    pub energy: f64,
    /// Its residual without drag, relative to the forces in play.
    pub relative_residual: f64,
    /// Negative eigenvalues of its tangent that the solver knows of. A direct solver knows all: 0
    /// if the state is stable. One that iterates knows of one at least where its average does, and may learn of one
    /// when the path goes on from here.
    /// A singular tangent, at the edge of stability, counts as one.
    pub negative_pivots: usize,
}

/// A solution on its way to becoming a state.
#[derive(Clone, Debug)]
pub struct Solution {
    /// Unknowns.
    pub u: Vec<f64>,
    /// Energy and residual there.
    pub forces: ResidualEvaluation,
    /// Energy spent on drag.
    pub damping_work: f64,
    /// Linear solves.
    pub iterations: usize,
}

/// How a state was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// It is where the path begins.
    Rest,
    /// Newton from the path's tangent.
    Newton,
    /// Relaxation with a drag that shrinks.
    Relaxation,
    /// Pseudo-time with a drag that stays.
    PseudoTime,
}

impl std::fmt::Display for Method {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Rest => "rest",
            Self::Newton => "newton",
            Self::Relaxation => "relaxation",
            Self::PseudoTime => "pseudo-time",
        })
    }
}

/// Why no state was found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Failure<B: std::error::Error> {
    /// The tangent has negative eigenvalues where none are admitted.
    #[error("the tangent has {negative_pivots} negative eigenvalue(s)")]
    Indefinite {
        /// How many.
        negative_pivots: usize,
    },
    /// The energy does not exist where the solver went.
    #[error(transparent)]
    Evaluation(B),
    /// No step lowered the energy.
    #[error(
        "no step lowered the energy (residual {relative_residual:.1e} after {iterations} solves)"
    )]
    NoDescent {
        /// Linear solves so far.
        iterations: usize,
        /// Residual reached.
        relative_residual: f64,
        /// The free unknown that was farthest from balance.
        worst: usize,
    },
    /// The linear systems were not solved as exactly as was asked for.
    #[error(
        "linear systems are hard to solve here (residual {relative_residual:.1e} after {iterations} solves)"
    )]
    Unsolved {
        /// Linear solves so far.
        iterations: usize,
        /// Residual reached.
        relative_residual: f64,
        /// The free unknown that was farthest from balance.
        worst: usize,
    },
    /// The iterations ran out.
    #[error("not in equilibrium after {iterations} solves (residual {relative_residual:.1e})")]
    NotConverged {
        /// Linear solves so far.
        iterations: usize,
        /// Residual reached.
        relative_residual: f64,
        /// The free unknown that was farthest from balance.
        worst: usize,
    },
    /// Pseudo-time went on and the tube still moved.
    #[error("still moving by {moved:.1e} D per pseudo-time step after {steps} steps")]
    StillMoving {
        /// Pseudo-time steps after the ramp.
        steps: usize,
        /// Largest motion of a control point in the last of them, in D.
        moved: f64,
        /// The unknown that moved so far.
        worst: usize,
    },
    /// The tangent is singular.
    #[error(transparent)]
    Singular(#[from] Singular),
    /// Someone asked to stop.
    #[error("stopped on request")]
    Stopped,
}

impl<B: std::error::Error> Failure<B> {
    /// The unknown at which it is to be looked for, if there is one.
    pub fn worst(&self) -> Option<usize> {
        match self {
            Self::NoDescent { worst, .. }
            | Self::Unsolved { worst, .. }
            | Self::NotConverged { worst, .. }
            | Self::StillMoving { worst, .. } => Some(*worst),
            Self::Indefinite { .. } | Self::Evaluation(_) | Self::Singular(_) | Self::Stopped => {
                None
            }
        }
    }
}

/// Someone who watches a solver at work.
pub trait Monitor {
    /// A linear solve was done: in what method, and what is left of the residual. The solver
    /// stops if this returns false.
    fn solved(&mut self, method: Method, relative_residual: f64) -> bool;
    /// A linear solve took so many iterations of its own; 0 if it was direct.
    fn iterated(&mut self, _inner_iterations: usize) {}
    /// Asked after each iteration inside a linear solve; if false it is cut off there. Who says so
    /// stops the solver too, when told of the solve.
    fn iterating(&mut self) -> bool {
        true
    }
}

/// Nobody watches.
impl Monitor for () {
    fn solved(&mut self, _: Method, _: f64) -> bool {
        true
    }
}
