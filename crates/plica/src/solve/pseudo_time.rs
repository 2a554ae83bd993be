//! Pseudo-time with constant damping: the scheme of the paper, and backward Euler.

use super::equilibrium::{Equilibrium, ResidualEvaluation, is_reachable, largest};
use super::failure::Failure;
use super::newton::newton;
use super::relaxation::relaxation;
use super::settings::{Integrator, PseudoTime, Settings};
use super::state::{Effort, Solution};
use super::step_controller::StepController;
use super::tangent::Tangent;
use crate::matrix::Singular;
use crate::monitor::{Monitor, Part};

/// Ramps the load from one value to another against constant damping, and continues until the tube
/// hardly moves: C u̇ + R(u) = 0 (Okino et al. 2025, Eqs. (15)–(18)).
///
/// Eliminating the acceleration from the Newmark recurrences with γ = ½, β = ¼ gives
/// u̇ₙ₊₁ = 2 (uₙ₊₁ − uₙ)/Δτ − u̇ₙ, so that each pseudo-time step solves R(u) + η C u̇(u) = 0 by
/// Newton with K + (2 η/Δτ) C; backward Euler has K + (η/Δτ) C. The pseudo-time step is Δτ = 1.
///
/// Begins with u and u̇, and returns the solution and its u̇.
pub(super) fn pseudo_time<P: Equilibrium>(
    problem: &P,
    [from, target]: [&P::Load; 2],
    (mut u, mut velocity): (Vec<f64>, Vec<f64>),
    scheme: &PseudoTime,
    settings: &Settings,
    effort: &mut Effort,
    monitor: &mut dyn Monitor,
) -> Result<(Solution, Vec<f64>), Failure<P::EvaluationError>> {
    let (mut damping_work, mut moved, mut before) = (0.0, (0, 0.0), 0.0);
    for n in 1..=scheme.ramp + scheme.max_steps {
        let monitor = &mut Part::new(monitor, format!("pseudo-time step {n}"), 0.0, 1.0);
        let t = (n as f64 / scheme.ramp as f64).min(1.0);
        let load = problem.between(from, target, t);
        let damped = Damped::new(problem, scheme, &u, &velocity);
        let ramp = Ramp {
            loads: [from, target],
            part: [before, t],
        };
        let next = ramp.climb(&damped, settings, effort, monitor)?;
        before = t;
        let next_velocity = damped.velocity_at(&next.u);
        let force = damped.damping_force(&next_velocity);
        let step: Vec<f64> = next.u.iter().zip(&u).map(|(a, b)| a - b).collect();
        damping_work += force.iter().zip(&step).map(|(f, s)| f * s).sum::<f64>();
        moved = largest(step.iter().copied().enumerate());
        (u, velocity) = (next.u, next_velocity);
        if n >= scheme.ramp && moved.1 < scheme.tolerance {
            let forces = problem.forces(&load, &u).map_err(Failure::Evaluation)?;
            let solution = Solution {
                u,
                forces,
                damping_work,
            };
            return Ok((solution, velocity));
        }
    }
    Err(Failure::StillMoving {
        steps: scheme.max_steps,
        displacement: moved.1,
        worst_unknown: moved.0,
    })
}

/// The load of one pseudo-time step: part of the way between two loads.
struct Ramp<'a, L> {
    loads: [&'a L; 2],
    part: [f64; 2],
}

impl<L> Ramp<'_, L> {
    /// Solves a pseudo-time step from its u. Where moving the prescribed values alone leads past a barrier, they are
    /// moved in parts, with a solution of the same step at the end of each.
    fn climb<P: Equilibrium<Load = L>>(
        &self,
        damped: &Damped<'_, P>,
        settings: &Settings,
        effort: &mut Effort,
        monitor: &mut dyn Monitor,
    ) -> Result<Solution, Failure<P::EvaluationError>> {
        let [from, target] = self.loads;
        let mut parts = StepController::new(self.part, 0, settings.max_step_halvings);
        let (mut u, mut solution) = (damped.u.to_vec(), None);
        while let Some(t) = parts.next() {
            let load = damped.between(from, target, t);
            let mut start = u.clone();
            damped.apply_prescribed(&load, &mut start);
            if !is_reachable(damped, &u, &start) {
                if parts.halve() {
                    continue;
                }
                return Err(Failure::Blocked);
            }
            let found = match newton(damped, &load, start.clone(), settings, effort, monitor) {
                Err(Failure::Cancelled) => return Err(Failure::Cancelled),
                // The same step, approached with more damping that decreases to that of the scheme.
                Err(_) => relaxation(damped, &load, start, settings, effort, monitor)?,
                Ok(found) => found,
            };
            u.clone_from(&found.u);
            solution = Some(found);
            parts.accept();
        }
        solution.ok_or(Failure::Blocked)
    }
}

/// One pseudo-time step as an equilibrium problem: the energy
/// W(x) + η (½ rate |x − u|² − kept u̇ · (x − u)) in the metric of C, with the residual
/// R(x) + η C u̇(x) and u̇(x) = rate (x − u) − kept u̇.
struct Damped<'a, P: Equilibrium> {
    problem: &'a P,
    u: &'a [f64],
    velocity: &'a [f64],
    damping: f64,
    rate: f64,
    kept: f64,
}

impl<'a, P: Equilibrium> Damped<'a, P> {
    fn new(problem: &'a P, scheme: &PseudoTime, u: &'a [f64], velocity: &'a [f64]) -> Self {
        let (rate, kept) = match scheme.integrator {
            Integrator::Newmark => (2.0, 1.0),
            Integrator::BackwardEuler => (1.0, 0.0),
        };
        Self {
            problem,
            u,
            velocity,
            damping: scheme.damping,
            rate,
            kept,
        }
    }

    /// Returns u̇(x).
    fn velocity_at(&self, x: &[f64]) -> Vec<f64> {
        let at = |i: usize| self.rate * (x[i] - self.u[i]) - self.kept * self.velocity[i];
        (0..x.len()).map(at).collect()
    }

    /// Returns η C v.
    fn damping_force(&self, v: &[f64]) -> Vec<f64> {
        let mut force = vec![0.0; v.len()];
        self.problem.damping(self.damping, v, &mut force);
        force
    }
}

impl<'a, P: Equilibrium> Equilibrium for Damped<'a, P> {
    type Load = P::Load;
    type EvaluationError = P::EvaluationError;
    type Tangent = DampedTangent<'a, P>;

    fn prescribed(&self) -> &[bool] {
        self.problem.prescribed()
    }
    fn apply_prescribed(&self, load: &P::Load, u: &mut [f64]) {
        self.problem.apply_prescribed(load, u);
    }
    fn longest_step(&self, u: &[f64], step: &[f64]) -> f64 {
        self.problem.longest_step(u, step)
    }
    fn between(&self, from: &P::Load, to: &P::Load, t: f64) -> P::Load {
        self.problem.between(from, to, t)
    }
    fn forces(&self, load: &P::Load, x: &[f64]) -> Result<ResidualEvaluation, P::EvaluationError> {
        let mut forces = self.problem.forces(load, x)?;
        // ½ rate d·d − kept u̇·d = d · (½ rate d − kept u̇) with d = x − u
        let mean: Vec<f64> = (0..x.len())
            .map(|i| 0.5 * self.rate * (x[i] - self.u[i]) - self.kept * self.velocity[i])
            .collect();
        let force = self.damping_force(&mean);
        forces.energy += (0..x.len())
            .map(|i| force[i] * (x[i] - self.u[i]))
            .sum::<f64>();
        let force = self.damping_force(&self.velocity_at(x));
        for (r, f) in forces.residual.iter_mut().zip(force) {
            *r += f;
        }
        Ok(forces)
    }
    fn tangent(&self, load: &P::Load, x: &[f64]) -> DampedTangent<'a, P> {
        DampedTangent {
            problem: self.problem,
            stiffness: self.problem.tangent(load, x),
            damping: self.rate * self.damping,
        }
    }
    fn damping(&self, factor: f64, v: &[f64], y: &mut [f64]) {
        self.problem.damping(factor, v, y);
    }
}

/// The tangent of a pseudo-time step: K of the problem plus damping.
struct DampedTangent<'a, P: Equilibrium> {
    problem: &'a P,
    stiffness: P::Tangent,
    damping: f64,
}

impl<P: Equilibrium> Tangent for DampedTangent<'_, P> {
    type Solver = <P::Tangent as Tangent>::Solver;

    fn multiply_add(&self, factor: f64, v: &[f64], y: &mut [f64]) {
        self.stiffness.multiply_add(factor, v, y);
        self.problem.damping(factor * self.damping, v, y);
    }
    fn shifted(&self, alpha: f64) -> Result<Self::Solver, Singular> {
        self.stiffness.shifted(self.damping + alpha)
    }
    fn into_shifted(self, alpha: f64) -> Result<Self::Solver, Singular> {
        self.stiffness.into_shifted(self.damping + alpha)
    }
}
