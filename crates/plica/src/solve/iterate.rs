//! One step towards equilibrium, as Newton's method and relaxation share it: a linear solve with
//! K + α C and a line search.

use super::equilibrium::{EQUILIBRIUM, Equilibrium, ResidualEvaluation};
use super::failure::{Cause, Failure};
use super::line_search::{LONGEST, LineSearch, largest};
use super::operator::dot;
use super::state::{Effort, Solution};
use super::tangent::Solver;
use crate::monitor::Monitor;

/// Largest displacement of the first step along a direction of negative curvature, in D, unless the
/// solver has already come further.
const NEGATIVE_CURVATURE_STEP: f64 = 1e-3;

/// The iterate of a solver: unknowns with the prescribed values, with energy and residual.
pub(super) struct Iterate<'a, P: Equilibrium> {
    problem: &'a P,
    load: &'a P::Load,
    pub u: Vec<f64>,
    pub forces: ResidualEvaluation,
    pub relative_residual: f64,
}

/// Solution of (K + α C) Δu = −R, as far as there is one.
pub(super) enum LinearStep {
    /// The energy decreases along the step. `accurate` is false if the solver missed the required
    /// accuracy although the iterate is not in equilibrium.
    Descent { step: Vec<f64>, accurate: bool },
    /// An iterative solver met a direction of negative curvature. The energy decreases along it and
    /// along the step found before.
    NegativeCurvature {
        step: Vec<f64>,
        direction: Vec<f64>,
        curvature: f64,
    },
    /// The factorisation has negative pivots.
    Indefinite { negative_pivots: usize },
}

impl<'a, P: Equilibrium> Iterate<'a, P> {
    /// Evaluates energy and residual at `u`.
    pub fn new(problem: &'a P, load: &'a P::Load, u: Vec<f64>) -> Result<Self, P::EvaluationError> {
        let forces = problem.forces(load, &u)?;
        Ok(Self {
            problem,
            load,
            u,
            relative_residual: forces.relative_residual(problem.prescribed()),
            forces,
        })
    }

    /// Returns whether the relative residual is within a tolerance; NaN is not.
    pub fn converged(&self, tolerance: f64) -> bool {
        self.relative_residual <= tolerance
    }

    /// Returns whether rounding alone may keep the residual from decreasing further.
    pub fn in_equilibrium(&self) -> bool {
        self.relative_residual <= EQUILIBRIUM
    }

    /// Returns the tangent stiffness.
    pub fn tangent(&self) -> P::Tangent {
        self.problem.tangent(self.load, &self.u)
    }

    /// Solves (K + α C) Δu = −R (Okino et al. 2025, Eq. (14), if α = 0).
    pub fn solve(
        &self,
        solver: impl Solver,
        accuracy: f64,
        effort: &mut Effort,
        monitor: &dyn Monitor,
    ) -> LinearStep {
        if solver.negative_pivots() > 0 {
            return LinearStep::Indefinite {
                negative_pivots: solver.negative_pivots(),
            };
        }
        let free = self.forces.residual.iter().zip(self.problem.prescribed());
        let mut step: Vec<f64> = free
            .map(|(r, &prescribed)| if prescribed { 0.0 } else { -r })
            .collect();
        match solver.solve(&mut step, accuracy, monitor) {
            Ok(solved) => {
                effort.inner_iterations += solved.iterations;
                LinearStep::Descent {
                    step,
                    accurate: solved.converged || self.in_equilibrium(),
                }
            }
            Err(met) => {
                effort.inner_iterations += met.iterations;
                LinearStep::NegativeCurvature {
                    step,
                    direction: met.direction,
                    curvature: met.curvature,
                }
            }
        }
    }

    /// Goes along a step as far as a rule accepts, and returns the fraction of it with the new
    /// iterate.
    ///
    /// # Errors
    ///
    /// If no length is accepted; with the error of the shortest length that was tried, if its energy
    /// is not defined.
    pub fn search(
        &self,
        step: &[f64],
        rule: LineSearch,
    ) -> Result<(f64, Self), Option<P::EvaluationError>> {
        let slope = dot(&self.forces.residual, step);
        let (from, prescribed) = (&self.forces, self.problem.prescribed());
        let (mut length, mut undefined) = (self.first_length(step, rule), None);
        for _ in 0..rule.trials() {
            length *= match self.moved(length, step) {
                Ok(next) if rule.accepts(from, &next.forces, prescribed, length, slope) => {
                    return Ok((length, next));
                }
                Ok(next) => {
                    undefined = None;
                    rule.shortening(next.forces.energy - from.energy, length, slope)
                }
                Err(error) => {
                    undefined = Some(error);
                    0.5
                }
            };
        }
        Err(undefined)
    }

    /// Returns the first length to try: all of the step, unless a rule or the problem forbids that.
    fn first_length(&self, step: &[f64], rule: LineSearch) -> f64 {
        let length = rule.first_length(step);
        let tried: Vec<f64> = step.iter().map(|s| length * s).collect();
        length * self.problem.longest_step(&self.u, &tried)
    }

    /// Doubles a step from here, which led to `next`, as long as that lowers the energy beyond
    /// rounding and the displacement is at most a tenth of the diameter.
    pub fn expand(&self, mut step: Vec<f64>, mut next: Self) -> Self {
        while 2.0 * largest(&step) <= LONGEST {
            step.iter_mut().for_each(|s| *s *= 2.0);
            if self.problem.longest_step(&self.u, &step) < 1.0 {
                break;
            }
            match self.moved(1.0, &step) {
                Ok(further)
                    if further.forces.energy < next.forces.energy - next.forces.rounding =>
                {
                    next = further;
                }
                _ => break,
            }
        }
        next
    }

    /// Goes along the step of an iterative solver and on along the direction of negative curvature
    /// that it met: at first as far again, or a thousandth of the diameter, then further as long as
    /// the energy decreases. Returns None if it does not decrease at all.
    pub fn follow_negative_curvature(
        &self,
        step: &[f64],
        direction: &[f64],
    ) -> Option<(f64, Self)> {
        let tau = largest(step).max(NEGATIVE_CURVATURE_STEP) / largest(direction);
        let step: Vec<f64> = step
            .iter()
            .zip(direction)
            .map(|(s, d)| s + tau * d)
            .collect();
        let (length, next) = self.search(&step, LineSearch::Decrease).ok()?;
        if length < 1.0 {
            return Some((length, next));
        }
        Some((length, self.expand(step, next)))
    }

    /// Returns α C v.
    pub fn damping_force(&self, alpha: f64, v: &[f64]) -> Vec<f64> {
        let mut force = vec![0.0; v.len()];
        self.problem.damping(alpha, v, &mut force);
        force
    }

    fn moved(&self, length: f64, step: &[f64]) -> Result<Self, P::EvaluationError> {
        let u = self.u.iter().zip(step).map(|(u, s)| u + length * s);
        Self::new(self.problem, self.load, u.collect())
    }

    /// Returns the iterate as a solution.
    pub fn into_solution(self, damping_work: f64) -> Solution {
        Solution {
            u: self.u,
            forces: self.forces,
            damping_work,
        }
    }

    /// Returns the failure to converge from here.
    pub fn failure(&self, cause: Cause, linear_solves: usize) -> Failure<P::EvaluationError> {
        Failure::NotConverged {
            cause,
            linear_solves,
            relative_residual: self.relative_residual,
            worst_unknown: self.forces.worst_unknown(self.problem.prescribed()),
        }
    }
}
