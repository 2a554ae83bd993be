//! From state to state along a load, and through a snap.

use super::newton::EQUILIBRIUM;
use super::{
    Equilibrium, Failure, Forces, Found, Method, PseudoTime, Scheme, Settings, State, Watch,
    newton, pseudo_time, relaxation,
};

/// How often a step is halved for Newton before relaxation takes over.
const NEWTON_HALVINGS: usize = 2;

/// A way through states. It owns the last accepted one.
#[derive(Debug)]
pub struct Path<'a, P: Equilibrium> {
    problem: &'a P,
    settings: Settings,
    state: State<P::Load>,
    /// u̇ of the pseudo-time.
    velocity: Vec<f64>,
}

/// How an accepted state was reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// How it was found.
    pub method: Method,
    /// Linear solves, counting those of tries that failed.
    pub iterations: usize,
    /// Energy spent on drag.
    pub drag_work: f64,
}

/// Where a path ended.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("Newton: {newton}; relaxation: {relaxation}")]
pub struct PathError<B: std::error::Error> {
    /// Why Newton did not arrive.
    pub newton: Failure<B>,
    /// Why relaxation (or pseudo-time) did not arrive either.
    pub relaxation: Failure<B>,
    /// Linear solves that were spent.
    pub iterations: usize,
}

impl<'a, P: Equilibrium> Path<'a, P> {
    /// Begins at a state that is already in equilibrium under `load`.
    pub fn begin(
        problem: &'a P,
        load: P::Load,
        u: Vec<f64>,
        settings: Settings,
    ) -> Result<Self, P::Broken> {
        let forces = problem.forces(&load, &u)?;
        let velocity = vec![0.0; u.len()];
        let state = accepted(problem, load, u, &forces);
        Ok(Self {
            problem,
            settings,
            state,
            velocity,
        })
    }

    /// The last accepted state.
    pub fn state(&self) -> &State<P::Load> {
        &self.state
    }

    /// Goes to a load. On failure the path stays at the last state that it found on the way.
    pub fn advance(
        &mut self,
        load: &P::Load,
        watch: &mut dyn Watch,
    ) -> Result<Step, PathError<P::Broken>> {
        match self.settings.scheme.clone() {
            Scheme::Static => self.advance_static(load, watch),
            Scheme::PseudoTime(scheme) => self.advance_dragged(load, &scheme, watch),
        }
    }

    /// Newton from the path's tangent. Where that fails the step is halved, since a branch that
    /// bends can still be followed in shorter steps; where it still fails the branch has ended,
    /// and relaxation follows the tube down to another.
    fn advance_static(
        &mut self,
        target: &P::Load,
        watch: &mut dyn Watch,
    ) -> Result<Step, PathError<P::Broken>> {
        let from = self.state.load.clone();
        let mut step = Step {
            method: Method::Newton,
            iterations: 0,
            drag_work: 0.0,
        };
        let (mut t, mut length, mut halvings) = (0.0, 1.0, 0);
        while t < 1.0 {
            let load = self.problem.between(&from, target, t + length);
            let newton = match self.try_newton(&load, &mut step, watch) {
                Ok(()) => {
                    t += length;
                    if halvings > 0 && t < 1.0 && (t / (2.0 * length)).fract() == 0.0 {
                        (length, halvings) = (2.0 * length, halvings - 1);
                    }
                    continue;
                }
                Err(failed) => failed,
            };
            let relaxation = if matches!(newton, Failure::Stopped) {
                newton.clone()
            } else if halvings < NEWTON_HALVINGS.min(self.settings.halvings) {
                (length, halvings) = (0.5 * length, halvings + 1);
                continue;
            } else {
                match self.try_relaxation(&load, &mut step, watch) {
                    Ok(()) => {
                        t += length;
                        continue;
                    }
                    Err(failed) => failed,
                }
            };
            let stopped = matches!(relaxation, Failure::Stopped);
            if stopped || halvings >= self.settings.halvings {
                return Err(PathError {
                    newton,
                    relaxation,
                    iterations: step.iterations,
                });
            }
            (length, halvings) = (0.5 * length, halvings + 1);
        }
        Ok(step)
    }

    fn try_newton(
        &mut self,
        load: &P::Load,
        step: &mut Step,
        watch: &mut dyn Watch,
    ) -> Result<(), Failure<P::Broken>> {
        if self.state.negative_pivots > 0 {
            // The tangent leads away from an unstable state, not along it.
            return Err(Failure::Indefinite {
                negative_pivots: self.state.negative_pivots,
            });
        }
        let start = self.predict(load);
        let found = newton(self.problem, load, start, &self.settings, watch)
            .inspect_err(|failed| step.iterations += spent(failed))?;
        self.accept(load, found, step);
        Ok(())
    }

    fn try_relaxation(
        &mut self,
        load: &P::Load,
        step: &mut Step,
        watch: &mut dyn Watch,
    ) -> Result<(), Failure<P::Broken>> {
        // The last state, if its ends need not move; else the prediction, which moves them gently.
        let mut start = self.state.u.clone();
        self.problem.impose(load, &mut start);
        if start != self.state.u {
            start = self.predict(load);
        }
        let found = relaxation(self.problem, load, start, &self.settings, watch)
            .inspect_err(|failed| step.iterations += spent(failed))?;
        self.accept(load, found, step);
        step.method = Method::Relaxation;
        Ok(())
    }

    fn accept(&mut self, load: &P::Load, found: Found, step: &mut Step) {
        step.iterations += found.iterations + 1;
        step.drag_work += found.drag_work;
        self.state = accepted(self.problem, load.clone(), found.u, &found.forces);
    }

    /// Pseudo-time with a fixed drag, then to equilibrium without if the scheme says so.
    fn advance_dragged(
        &mut self,
        load: &P::Load,
        scheme: &PseudoTime,
        watch: &mut dyn Watch,
    ) -> Result<Step, PathError<P::Broken>> {
        let mut step = Step {
            method: Method::PseudoTime,
            iterations: 0,
            drag_work: 0.0,
        };
        let mut velocity = self.velocity.clone();
        let (from, u) = (self.state.load.clone(), self.state.u.clone());
        let fail = |failed: Failure<P::Broken>, iterations| PathError {
            newton: failed.clone(),
            relaxation: failed,
            iterations,
        };
        let settings = &self.settings;
        let dragged = pseudo_time(
            self.problem,
            &from,
            load,
            u,
            &mut velocity,
            scheme,
            settings,
            watch,
        )
        .map_err(|failed| {
            let iterations = spent(&failed);
            fail(failed, iterations)
        })?;
        self.velocity = velocity;
        step.iterations += dragged.iterations;
        step.drag_work += dragged.drag_work;
        let found = if scheme.settle {
            self.velocity.fill(0.0);
            relaxation(self.problem, load, dragged.u, settings, watch)
                .map_err(|failed| fail(failed, step.iterations))?
        } else {
            Found {
                iterations: 0,
                drag_work: 0.0,
                ..dragged
            }
        };
        self.accept(load, found, &mut step);
        Ok(step)
    }

    /// Where the path's tangent leads: K Δu = −R(uₙ, load) − K d, d the motion of the supports.
    fn predict(&self, load: &P::Load) -> Vec<f64> {
        let (problem, given) = (self.problem, self.problem.given());
        let mut u = self.state.u.clone();
        problem.impose(load, &mut u);
        let motion: Vec<f64> = u.iter().zip(&self.state.u).map(|(a, b)| a - b).collect();
        let (Some(factor), Ok(forces)) = (&self.state.factor, problem.forces(load, &self.state.u))
        else {
            return u;
        };
        if factor.negative_pivots() > 0 {
            return u;
        }
        let mut step: Vec<f64> = forces.residual.iter().map(|r| -r).collect();
        if motion.iter().any(|&d| d != 0.0) {
            problem
                .tangent(&self.state.load, &self.state.u)
                .multiply_add(-1.0, &motion, &mut step);
        }
        for i in 0..step.len() {
            if given[i] {
                step[i] = motion[i];
            }
        }
        factor.solve(&mut step);
        self.state.u.iter().zip(&step).map(|(u, s)| u + s).collect()
    }
}

/// Linear solves that a failure cost, as far as it tells.
fn spent<B: std::error::Error>(failure: &Failure<B>) -> usize {
    match failure {
        Failure::NoDescent { iterations, .. } | Failure::NotConverged { iterations, .. } => {
            *iterations
        }
        Failure::Indefinite { .. } => 1,
        _ => 0,
    }
}

/// Makes a state of a solution: factors its tangent, which tells whether it is stable and leads to
/// the next.
fn accepted<P: Equilibrium>(
    problem: &P,
    load: P::Load,
    u: Vec<f64>,
    forces: &Forces,
) -> State<P::Load> {
    let mut K = problem.tangent(&load, &u);
    K.constrain(problem.given());
    let factor = K.factor().ok();
    State {
        load,
        energy: forces.energy,
        imbalance: forces.imbalance(problem.given()),
        negative_pivots: factor.as_ref().map_or(0, |f| f.negative_pivots()),
        factor,
        u,
    }
}

impl<L> State<L> {
    /// Whether the residual without drag is small against the forces in play.
    pub fn in_equilibrium(&self) -> bool {
        self.imbalance <= EQUILIBRIUM
    }
}
