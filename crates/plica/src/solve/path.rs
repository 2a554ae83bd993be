//! From state to state along a load, and through a snap.

use super::newton::EQUILIBRIUM;
use super::{
    Equilibrium, Failure, Forces, Found, Method, PseudoTime, Scheme, Settings, State, Watch,
    newton, pseudo_time, relaxation,
};

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

    /// Goes to a load in one step. On failure the path stays where it is.
    pub fn advance(
        &mut self,
        load: &P::Load,
        watch: &mut dyn Watch,
    ) -> Result<Step, PathError<P::Broken>> {
        let (found, method, wasted) = match self.settings.scheme.clone() {
            Scheme::Static => self.advance_static(load, watch)?,
            Scheme::PseudoTime(scheme) => self.advance_dragged(load, &scheme, watch)?,
        };
        let step = Step {
            method,
            iterations: found.iterations + wasted + 1,
            drag_work: found.drag_work,
        };
        self.state = accepted(self.problem, load.clone(), found.u, &found.forces);
        Ok(step)
    }

    /// Newton from the path's tangent, else relaxation from the last state.
    fn advance_static(
        &mut self,
        load: &P::Load,
        watch: &mut dyn Watch,
    ) -> Result<(Found, Method, usize), PathError<P::Broken>> {
        let start = self.predict(load);
        let tried = newton(self.problem, load, start.clone(), &self.settings, watch);
        let failed = match tried {
            Ok(found) => return Ok((found, Method::Newton, 0)),
            Err(failed) => failed,
        };
        let wasted = spent(&failed);
        if matches!(failed, Failure::Stopped) {
            return Err(PathError {
                newton: failed.clone(),
                relaxation: failed,
                iterations: wasted,
            });
        }
        // The last state, if its ends need not move; else the prediction, which moves them gently.
        let mut from = self.state.u.clone();
        self.problem.impose(load, &mut from);
        if from != self.state.u {
            from = start;
        }
        match relaxation(self.problem, load, from, &self.settings, watch) {
            Ok(found) => Ok((found, Method::Relaxation, wasted)),
            Err(relaxation) => {
                let iterations = wasted + spent(&relaxation);
                Err(PathError {
                    newton: failed,
                    relaxation,
                    iterations,
                })
            }
        }
    }

    /// Pseudo-time with a fixed drag, then to equilibrium without if the scheme says so.
    fn advance_dragged(
        &mut self,
        load: &P::Load,
        scheme: &PseudoTime,
        watch: &mut dyn Watch,
    ) -> Result<(Found, Method, usize), PathError<P::Broken>> {
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
        if !scheme.settle {
            return Ok((dragged, Method::PseudoTime, 0));
        }
        let mut settled = relaxation(self.problem, load, dragged.u, settings, watch)
            .map_err(|failed| fail(failed, dragged.iterations))?;
        settled.drag_work += dragged.drag_work;
        settled.iterations += dragged.iterations;
        self.velocity.fill(0.0);
        Ok((settled, Method::PseudoTime, 0))
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
