//! Pseudo-time with a drag that stays: the paper's scheme, and its backward Euler sister.

use super::newton::newton;
use super::state::largest;
use super::{
    Equilibrium, Failure, Integrator, Method, Monitor, PseudoTime, ResidualEvaluation, Settings,
    Solution, Tangent, relaxation,
};
use crate::matrix::Singular;

/// Leads the problem from one load to another against a fixed drag and on until it hardly moves:
/// C u̇ + R(u) = 0 (Okino et al. 2025, Eqs. (15)–(18)).
///
/// Eliminating the acceleration from the Newmark recurrences with γ = ½, β = ¼ gives
/// u̇ₙ₊₁ = 2 (uₙ₊₁ − uₙ)/Δτ − u̇ₙ, so that each pseudo-time step solves R(u) + η C u̇(u) = 0 by
/// Newton with K + (2 η/Δτ) C; backward Euler has K + (η/Δτ) C. The pseudo-time step is Δτ = 1.
///
/// `velocity` is u̇ at the start and, on return, at the end.
pub fn pseudo_time<P: Equilibrium>(
    problem: &P,
    [from, target]: [&P::Load; 2],
    mut u: Vec<f64>,
    velocity: &mut Vec<f64>,
    scheme: &PseudoTime,
    settings: &Settings,
    monitor: &mut dyn Monitor,
) -> Result<Solution, Failure<P::EvaluationError>> {
    let monitor = &mut Renamed(monitor);
    let (mut iterations, mut damping_work, mut moved) = (0, 0.0, (0, 0.0));
    for n in 1..=scheme.ramp + scheme.max_steps {
        let t = (n as f64 / scheme.ramp as f64).min(1.0);
        let load = problem.between(from, target, t);
        let mut start = u.clone();
        problem.apply_prescribed(&load, &mut start);
        let damped = Dragged::new(problem, scheme, &u, velocity);
        let next = match newton(&damped, &load, start.clone(), settings, monitor) {
            Ok(next) => next,
            Err(Failure::Stopped) => return Err(Failure::Stopped),
            // The same step, approached with more drag that shrinks back to the scheme's.
            Err(_) => relaxation(&damped, &load, start, settings, monitor)?,
        };
        let now = damped.velocity_at(&next.u);
        let force = damped.drag_force(&next.u);
        let step: Vec<f64> = next.u.iter().zip(&u).map(|(a, b)| a - b).collect();
        iterations += next.iterations;
        damping_work += force.iter().zip(&step).map(|(f, s)| f * s).sum::<f64>();
        moved = largest(step.iter().copied().enumerate());
        (u, *velocity) = (next.u, now);
        if n >= scheme.ramp && moved.1 < scheme.tolerance {
            let forces = problem.forces(&load, &u).map_err(Failure::Evaluation)?;
            return Ok(Solution {
                u,
                forces,
                damping_work,
                iterations,
            });
        }
    }
    Err(Failure::StillMoving {
        steps: scheme.max_steps,
        moved: moved.1,
        worst: moved.0,
    })
}

/// One pseudo-time step as an equilibrium of its own: the energy
/// W(x) + η (½ rate |x − u|² − kept u̇ · (x − u)) in the metric of C, whose residual is
/// R(x) + η C u̇(x) with u̇(x) = rate (x − u) − kept u̇.
struct Dragged<'a, P: Equilibrium> {
    problem: &'a P,
    u: &'a [f64],
    velocity: &'a [f64],
    damping: f64,
    rate: f64,
    kept: f64,
}

impl<'a, P: Equilibrium> Dragged<'a, P> {
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

    fn velocity_at(&self, x: &[f64]) -> Vec<f64> {
        let at = |i: usize| self.rate * (x[i] - self.u[i]) - self.kept * self.velocity[i];
        (0..x.len()).map(at).collect()
    }

    /// η C u̇(x).
    fn drag_force(&self, x: &[f64]) -> Vec<f64> {
        self.times_drag(&self.velocity_at(x))
    }

    fn times_drag(&self, v: &[f64]) -> Vec<f64> {
        let mut force = vec![0.0; v.len()];
        self.problem.damping(self.damping, v, &mut force);
        force
    }
}

impl<'a, P: Equilibrium> Equilibrium for Dragged<'a, P> {
    type Load = P::Load;
    type EvaluationError = P::EvaluationError;
    type Tangent = DraggedTangent<'a, P>;

    fn prescribed(&self) -> &[bool] {
        self.problem.prescribed()
    }
    fn apply_prescribed(&self, load: &P::Load, u: &mut [f64]) {
        self.problem.apply_prescribed(load, u);
    }
    fn between(&self, from: &P::Load, to: &P::Load, t: f64) -> P::Load {
        self.problem.between(from, to, t)
    }
    fn forces(&self, load: &P::Load, x: &[f64]) -> Result<ResidualEvaluation, P::EvaluationError> {
        let mut forces = self.problem.forces(load, x)?;
        // ½ rate d·d − kept u̇·d = d · (½ rate d − kept u̇)
        let mean: Vec<f64> = (0..x.len())
            .map(|i| 0.5 * self.rate * (x[i] - self.u[i]) - self.kept * self.velocity[i])
            .collect();
        let force = self.times_drag(&mean);
        forces.energy += (0..x.len())
            .map(|i| force[i] * (x[i] - self.u[i]))
            .sum::<f64>();
        for (r, f) in forces.residual.iter_mut().zip(self.drag_force(x)) {
            *r += f;
        }
        Ok(forces)
    }
    fn tangent(&self, load: &P::Load, x: &[f64]) -> DraggedTangent<'a, P> {
        DraggedTangent {
            problem: self.problem,
            stiffness: self.problem.tangent(load, x),
            damping: self.rate * self.damping,
        }
    }
    fn damping(&self, factor: f64, v: &[f64], y: &mut [f64]) {
        self.problem.damping(factor, v, y);
    }
}

/// K of a problem and the drag of a pseudo-time step.
struct DraggedTangent<'a, P: Equilibrium> {
    problem: &'a P,
    stiffness: P::Tangent,
    damping: f64,
}

impl<P: Equilibrium> Tangent for DraggedTangent<'_, P> {
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

/// Tells the watcher of pseudo-time, whatever solves its steps.
struct Renamed<'a>(&'a mut dyn Monitor);

impl Monitor for Renamed<'_> {
    fn solved(&mut self, _: Method, relative_residual: f64) -> bool {
        self.0.solved(Method::PseudoTime, relative_residual)
    }
    fn iterated(&mut self, inner_iterations: usize) {
        self.0.iterated(inner_iterations);
    }
    fn iterating(&mut self) -> bool {
        self.0.iterating()
    }
}
