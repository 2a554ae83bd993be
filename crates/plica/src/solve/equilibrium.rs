//! The problem that the solvers see: an energy to be made stationary.

use super::tangent::Tangent;

/// Relative residual up to which a state counts as being in equilibrium, even if rounding keeps the
/// solver from its own, smaller tolerance.
pub const EQUILIBRIUM: f64 = 1e-6;

/// An energy W(u, load) to be made stationary in u. Its methods are pure functions of (u, load).
///
/// The energy may change from step to step of a [`Path`](super::Path), as with friction, whose forces depend on the way, or
/// with a multiplier that holds a constraint.
/// A step then begins with [`begin_step`](Self::begin_step), and is solved repeatedly, with
/// [`update`](Self::update) before each repetition, until the energy is that of its own solution.
///
/// Supports prescribe single unknowns. They may also constrain linear combinations of unknowns, such
/// as rigid-body motions; residuals, damping forces and the steps of a [`super::Solver`] are then
/// orthogonal to these, so the methods of this module need not consider them.
pub trait Equilibrium {
    /// The parameters that drive the problem.
    type Load: Clone + PartialEq;
    /// The reason why the energy is not defined at some u.
    type EvaluationError: std::error::Error + Clone;
    /// Its tangent stiffness.
    type Tangent: Tangent;

    /// Returns for every unknown whether a support prescribes it.
    fn prescribed(&self) -> &[bool];
    /// Writes the values that `load` prescribes into `u`.
    fn apply_prescribed(&self, load: &Self::Load, u: &mut [f64]);
    /// Returns the load at the fraction `t` of the way between two loads.
    fn between(&self, from: &Self::Load, to: &Self::Load, t: f64) -> Self::Load;
    /// Evaluates energy and residual at `u`.
    fn forces(
        &self,
        load: &Self::Load,
        u: &[f64],
    ) -> Result<ResidualEvaluation, Self::EvaluationError>;
    /// Returns the tangent stiffness K at `u`.
    fn tangent(&self, load: &Self::Load, u: &[f64]) -> Self::Tangent;
    /// Adds `factor` · C v to `y`, with the damping matrix C of all unknowns, prescribed or not.
    fn damping(&self, factor: f64, v: &[f64], y: &mut [f64]);
    /// Returns the longest fraction of a step from `u`, at most 1, that may be taken: none beyond it is a state that the
    /// energy alone would forbid, such as one behind a barrier. 0 if `u` itself is no such state.
    fn longest_step(&self, _u: &[f64], _step: &[f64]) -> f64 {
        1.0
    }
    /// Begins a step from an accepted state with its [`history`](Self::history), which is empty at the first state.
    fn begin_step(&mut self, _load: &Self::Load, _u: &[f64], _history: &[f64]) {}
    /// Changes the energy of the step to the one that depends on a state `u` as the forces there do. Returns false if the
    /// energy does not depend on any state.
    fn update(&mut self, _load: &Self::Load, _u: &[f64]) -> bool {
        false
    }
    /// Returns the relative residual with the energy of a solution itself up to which a step is not repeated, for a
    /// tolerance of the solver: at least 1e-6, where not stated otherwise.
    fn repetition_tolerance(&self, _load: &Self::Load, tolerance: f64) -> f64 {
        tolerance.max(EQUILIBRIUM)
    }
    /// Returns the load of a solution `u`, with the parameters that the solution determines.
    fn completed(&self, load: Self::Load, _u: &[f64]) -> Self::Load {
        load
    }
    /// Begins a segment from an accepted state to another load, and a step from there; `history` is that of the state, and
    /// becomes that at the start of the segment. Returns the load of the state from which the segment begins.
    fn begin_segment(
        &mut self,
        from: Self::Load,
        _to: &Self::Load,
        _u: &[f64],
        _history: &mut Vec<f64>,
    ) -> Self::Load {
        from
    }
    /// Returns everything that the energies of later steps take from the path up to a state `u` that ends the step, beside
    /// (u, load).
    fn history(&self, _load: &Self::Load, _u: &[f64]) -> Vec<f64> {
        vec![]
    }
}

/// A reference to a problem is a problem whose energy does not change.
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
    fn longest_step(&self, u: &[f64], step: &[f64]) -> f64 {
        (**self).longest_step(u, step)
    }
}

/// Returns whether the whole straight way from `u` to `to` may be taken.
pub(super) fn is_reachable<P: Equilibrium>(problem: &P, u: &[f64], to: &[f64]) -> bool {
    let step: Vec<f64> = to.iter().zip(u).map(|(a, b)| a - b).collect();
    problem.longest_step(u, &step) == 1.0
}

/// Energy and residual at some u.
#[derive(Clone, Debug)]
pub struct ResidualEvaluation {
    /// The energy W.
    pub energy: f64,
    /// R = ∂W/∂u of every unknown, orthogonal to constrained combinations.
    pub residual: Vec<f64>,
    /// Norm of the forces that balance each other in R; never zero.
    pub residual_scale: f64,
    /// Bound of the rounding error of the energy.
    pub rounding: f64,
}

impl ResidualEvaluation {
    /// Returns |R| over the free unknowns, divided by the residual scale.
    pub fn relative_residual(&self, prescribed: &[bool]) -> f64 {
        self.free(prescribed)
            .map(|(_, r)| r * r)
            .sum::<f64>()
            .sqrt()
            / self.residual_scale
    }

    /// Returns the free unknown with the largest entry of R.
    pub fn worst_unknown(&self, prescribed: &[bool]) -> usize {
        largest(self.free(prescribed)).0
    }

    /// Returns the free unknowns with their entries of R.
    fn free<'a>(&'a self, prescribed: &'a [bool]) -> impl Iterator<Item = (usize, f64)> + 'a {
        let all = self.residual.iter().copied().enumerate();
        all.zip(prescribed)
            .filter_map(|(entry, prescribed)| (!prescribed).then_some(entry))
    }
}

/// Returns index and size of the entry that is largest in size; (0, 0) if there are none.
pub(super) fn largest(entries: impl Iterator<Item = (usize, f64)>) -> (usize, f64) {
    let sizes = entries.map(|(i, x)| (i, x.abs()));
    sizes.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or_default()
}
