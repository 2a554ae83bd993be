//! From state to state along a load, and through a snap.

use super::newton::EQUILIBRIUM;
use super::{
    Equilibrium, Failure, Method, Monitor, PseudoTime, ResidualEvaluation, Scheme, Settings,
    Solution, Solver, State, Tangent, newton, pseudo_time, relaxation,
};

/// How often a step is halved for Newton before relaxation takes over.
const NEWTON_HALVINGS: usize = 5;

/// Step of the difference that gives ∂R/∂t, as a fraction of a leg.
const DIFFERENCE: f64 = 1e-5;

/// Accuracy of du/dt, which a state is predicted with.
const PREDICTION: f64 = 1e-4;

/// A way through states, leg by leg; a leg is a straight way through loads, t from 0 to 1. It owns
/// the last accepted state.
pub struct Path<P: Equilibrium> {
    problem: P,
    settings: Settings,
    state: State<P::Load>,
    /// Solves with the tangent stiffness of the state, unless that is singular. It may be as large as
    /// everything else, so it is let go before another state is looked for, and made again if asked for.
    solver: Option<SolverOf<P>>,
    /// du/dt at the state, or that there is none, once it has been asked for.
    tangent: Option<Option<Vec<f64>>>,
    /// The leg, and how far along it the state is.
    from: P::Load,
    to: P::Load,
    t: f64,
    /// The state before on this leg, unless a snap lies between.
    previous: Option<PreviousPoint>,
    /// How often the last step had to be halved; the next begins there, or one halving longer.
    halving_level: usize,
    /// u̇ of the pseudo-time.
    velocity: Vec<f64>,
}

type SolverOf<P> = <<P as Equilibrium>::Tangent as Tangent>::Solver;

/// A state of the path and its tangent du/dt.
#[derive(Clone, Debug, PartialEq)]
pub struct PreviousPoint {
    /// How far along the leg.
    pub t: f64,
    /// The unknowns.
    pub u: Vec<f64>,
    /// Their change along the leg.
    pub tangent: Vec<f64>,
}

/// What a path keeps of its way beside its state: with both it goes on as if it had never been left.
#[derive(Clone, Debug, PartialEq)]
pub struct ContinuationState {
    /// How far along its leg it is, 0 to 1.
    pub reached: f64,
    /// How often the last step had to be halved.
    pub halving_level: usize,
    /// The state before on this leg, unless a snap lies between.
    pub previous: Option<PreviousPoint>,
    /// u̇ of the pseudo-time.
    pub velocity: Vec<f64>,
}

/// How an accepted state was reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// How it was found.
    pub method: Method,
    /// Linear solves, counting those of tries that failed.
    pub iterations: usize,
    /// Iterations inside the linear solves; 0 where the solver is direct.
    pub inner_iterations: usize,
    /// Energy spent on drag.
    pub damping_work: f64,
}

/// Where a path ended, and why: what was tried from there, in order.
#[derive(Clone, Debug, PartialEq)]
pub struct PathError<B: std::error::Error> {
    /// Methods and how they failed.
    pub tried: Vec<(Method, Failure<B>)>,
    /// What was done on the way, up to the last state that was found.
    pub step: Step,
}

impl<B: std::error::Error> PathError<B> {
    /// Whether someone asked to stop.
    pub fn stopped(&self) -> bool {
        self.tried
            .iter()
            .any(|(_, failure)| matches!(failure, Failure::Stopped))
    }
}

impl<B: std::error::Error> std::fmt::Display for PathError<B> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (i, (method, failure)) in self.tried.iter().enumerate() {
            let semicolon = if i > 0 { "; " } else { "" };
            write!(f, "{semicolon}{method}: {failure}")?;
        }
        Ok(())
    }
}

impl<B: std::error::Error> std::error::Error for PathError<B> {}

impl<P: Equilibrium> Path<P> {
    /// Begins at a state that is already in equilibrium under `load`.
    pub fn begin(
        problem: P,
        load: P::Load,
        u: Vec<f64>,
        settings: Settings,
    ) -> Result<Self, P::EvaluationError> {
        let forces = problem.forces(&load, &u)?;
        let velocity = vec![0.0; u.len()];
        let (state, solver) = accepted(&problem, load.clone(), u, &forces);
        let (from, to) = (load.clone(), load);
        Ok(Self {
            problem,
            settings,
            state,
            solver,
            tangent: None,
            from,
            to,
            t: 0.0,
            previous: None,
            halving_level: 0,
            velocity,
        })
    }

    /// Goes on from an accepted state of a leg between two loads.
    pub fn resume(
        problem: P,
        [from, to]: [P::Load; 2],
        load: P::Load,
        u: Vec<f64>,
        memory: ContinuationState,
        settings: Settings,
    ) -> Result<Self, P::EvaluationError> {
        Ok(Self {
            from,
            to,
            t: memory.reached,
            previous: memory.previous,
            halving_level: memory.halving_level,
            velocity: memory.velocity,
            ..Self::begin(problem, load, u, settings)?
        })
    }

    /// What it takes to go on later from the last accepted state.
    pub fn continuation_state(&self) -> ContinuationState {
        ContinuationState {
            reached: self.t,
            halving_level: self.halving_level,
            previous: self.previous.clone(),
            velocity: self.velocity.clone(),
        }
    }

    /// The last accepted state.
    pub fn state(&self) -> &State<P::Load> {
        &self.state
    }

    /// What solves with the tangent stiffness of the last accepted state, without drag; none where that
    /// is singular.
    pub fn solver(&mut self) -> Option<&SolverOf<P>> {
        if self.solver.is_none() {
            let State { load, u, .. } = &self.state;
            self.solver = self.problem.tangent(load, u).into_shifted(0.0).ok();
        }
        self.solver.as_ref()
    }

    /// Sets out on a leg from where the path is to a load.
    pub fn begin_segment(&mut self, to: P::Load) {
        (self.from, self.to, self.t) = (self.state.load.clone(), to, 0.0);
        (self.tangent, self.previous, self.halving_level) = (None, None, 0);
    }

    /// How far along its leg the path is, 0 to 1.
    pub fn reached(&self) -> f64 {
        self.t
    }

    /// Goes on to `t` of the leg. On failure the path stays at the last state that it found on
    /// the way.
    pub fn advance(
        &mut self,
        t: f64,
        monitor: &mut dyn Monitor,
    ) -> Result<Step, PathError<P::EvaluationError>> {
        let monitor = &mut Counted {
            monitor,
            inner_iterations: 0,
        };
        let mut advanced = match self.settings.scheme.clone() {
            Scheme::Static => self.advance_static(t, monitor),
            Scheme::PseudoTime(scheme) => self.advance_damped(t, &scheme, monitor),
        };
        let step = match &mut advanced {
            Ok(step) => step,
            Err(error) => &mut error.step,
        };
        step.inner_iterations = monitor.inner_iterations;
        advanced
    }

    /// Newton from the path's tangent. Where that fails the step is halved, since a branch that
    /// bends can still be followed in shorter steps; where it still fails relaxation takes over,
    /// and follows the tube down to whatever stable state comes next.
    fn advance_static(
        &mut self,
        target: f64,
        monitor: &mut dyn Monitor,
    ) -> Result<Step, PathError<P::EvaluationError>> {
        let mut step = Step {
            method: Method::Newton,
            iterations: 0,
            inner_iterations: 0,
            damping_work: 0.0,
        };
        let (begin, whole) = (self.t, target - self.t);
        // The step is cut into 2^halvings pieces, `done` of them behind.
        let (mut halvings, mut done) = (self.halving_level, 0_u64);
        while done < 1 << halvings {
            let reach = if done + 1 == 1 << halvings {
                target
            } else {
                begin + whole * (done + 1) as f64 / (1_u64 << halvings) as f64
            };
            let mut tried = vec![];
            let mut arrived = match self.try_newton(reach, &mut step, monitor) {
                Ok(()) => Some(done + 1),
                Err(failed) => {
                    tried.push((Method::Newton, failed));
                    None
                }
            };
            // Shorter steps help a tangent that leads too far, not one that leads away or is hard
            // to solve with.
            let unsolved = |(_, failed): &(_, _)| matches!(failed, Failure::Unsolved { .. });
            let halve_first = self.state.negative_pivots == 0
                && !tried.iter().any(unsolved)
                && halvings < NEWTON_HALVINGS.min(self.settings.max_step_halvings);
            let stopped = |tried: &[(_, _)]| {
                tried
                    .iter()
                    .any(|(_, failed)| matches!(failed, Failure::Stopped))
            };
            if arrived.is_none() && !halve_first && !stopped(&tried) {
                match self.try_relaxation(reach, &mut step, monitor) {
                    Ok(()) => arrived = Some(done + 1),
                    Err(failed) => tried.push((Method::Relaxation, failed)),
                }
            }
            match arrived {
                Some(now) => {
                    done = now;
                    if halvings > 0 && done % 2 == 0 {
                        (halvings, done) = (halvings - 1, done / 2);
                    }
                    self.halving_level = halvings;
                }
                None if stopped(&tried) || halvings >= self.settings.max_step_halvings => {
                    return Err(PathError { tried, step });
                }
                None => (halvings, done) = (halvings + 1, 2 * done),
            }
        }
        Ok(step)
    }

    fn try_newton(
        &mut self,
        t: f64,
        step: &mut Step,
        monitor: &mut dyn Monitor,
    ) -> Result<(), Failure<P::EvaluationError>> {
        // To ask for it may tell that the state is unstable.
        let stable = self.state.negative_pivots == 0;
        let tangent = if stable { self.tangent(monitor) } else { None };
        if self.state.negative_pivots > 0 {
            // The tangent leads away from an unstable state, not along it.
            return Err(Failure::Indefinite {
                negative_pivots: self.state.negative_pivots,
            });
        }
        let load = self.load_at(t);
        let start = self.predict(t, &load, tangent.as_deref());
        self.solver = None;
        let found = newton(&self.problem, &load, start, &self.settings, monitor)
            .inspect_err(|failed| step.iterations += spent(failed))?;
        let previous = tangent.map(|tangent| PreviousPoint {
            t: self.t,
            u: self.state.u.clone(),
            tangent,
        });
        self.accept(t, load, found, step);
        self.previous = previous;
        Ok(())
    }

    fn try_relaxation(
        &mut self,
        t: f64,
        step: &mut Step,
        monitor: &mut dyn Monitor,
    ) -> Result<(), Failure<P::EvaluationError>> {
        let load = self.load_at(t);
        // The last state, if its ends need not move; else along the tangent, which moves them
        // gently.
        let mut start = self.state.u.clone();
        self.problem.apply_prescribed(&load, &mut start);
        if start != self.state.u {
            self.previous = None;
            let tangent = self.tangent(monitor);
            start = self.predict(t, &load, tangent.as_deref());
        }
        self.solver = None;
        let found = relaxation(&self.problem, &load, start, &self.settings, monitor)
            .inspect_err(|failed| step.iterations += spent(failed))?;
        self.accept(t, load, found, step);
        self.previous = None;
        step.method = Method::Relaxation;
        Ok(())
    }

    fn load_at(&self, t: f64) -> P::Load {
        self.problem.between(&self.from, &self.to, t)
    }

    fn accept(&mut self, t: f64, load: P::Load, found: Solution, step: &mut Step) {
        step.iterations += found.iterations + 1;
        step.damping_work += found.damping_work;
        (self.state, self.solver) = accepted(&self.problem, load, found.u, &found.forces);
        (self.tangent, self.t) = (None, t);
    }

    /// Pseudo-time with a fixed drag, then to equilibrium without if the scheme says so.
    fn advance_damped(
        &mut self,
        t: f64,
        scheme: &PseudoTime,
        monitor: &mut dyn Monitor,
    ) -> Result<Step, PathError<P::EvaluationError>> {
        let mut step = Step {
            method: Method::PseudoTime,
            iterations: 0,
            inner_iterations: 0,
            damping_work: 0.0,
        };
        self.solver = None;
        let (load, settings) = (self.load_at(t), &self.settings);
        let fail = |method, failed, step| PathError {
            tried: vec![(method, failed)],
            step,
        };
        let mut velocity = self.velocity.clone();
        let damped = pseudo_time(
            &self.problem,
            [&self.state.load, &load],
            self.state.u.clone(),
            &mut velocity,
            scheme,
            settings,
            monitor,
        )
        .map_err(|failed| fail(Method::PseudoTime, failed, step))?;
        step.iterations += damped.iterations;
        step.damping_work += damped.damping_work;
        let found = if scheme.equilibrate {
            velocity.fill(0.0);
            relaxation(&self.problem, &load, damped.u, settings, monitor)
                .map_err(|failed| fail(Method::Relaxation, failed, step))?
        } else {
            Solution {
                iterations: 0,
                damping_work: 0.0,
                ..damped
            }
        };
        self.velocity = velocity;
        self.accept(t, load, found, &mut step);
        Ok(step)
    }

    /// The path's tangent du/dt at the state. None where the tangent stiffness is singular or the
    /// residual does not exist, where the solver does not come far enough, and where it meets negative
    /// curvature: the state is then known to be unstable.
    fn tangent(&mut self, monitor: &mut dyn Monitor) -> Option<Vec<f64>> {
        if self.tangent.is_none() {
            self.tangent = Some(self.solve_for_tangent(monitor));
        }
        self.tangent.clone().flatten()
    }

    /// K du/dt = −∂R/∂t, the supports moving as they do.
    fn solve_for_tangent(&mut self, monitor: &mut dyn Monitor) -> Option<Vec<f64>> {
        self.solver()?;
        let (problem, prescribed, u) = (&self.problem, self.problem.prescribed(), &self.state.u);
        // Central difference in t; the residual is smooth in the load.
        let at = |t: f64| {
            let load = self.load_at(t);
            let mut held = u.clone();
            problem.apply_prescribed(&load, &mut held);
            problem
                .forces(&load, u)
                .ok()
                .map(|forces| (forces.residual, held))
        };
        let (after, held_after) = at(self.t + DIFFERENCE)?;
        let (before, held_before) = at(self.t - DIFFERENCE)?;
        let slope = |a: &[f64], b: &[f64]| -> Vec<f64> {
            a.iter()
                .zip(b)
                .map(|(a, b)| (a - b) / (2.0 * DIFFERENCE))
                .collect()
        };
        let motion = slope(&held_after, &held_before);
        let mut tangent = slope(&before, &after);
        if motion.iter().any(|&d| d != 0.0) {
            let K = problem.tangent(&self.state.load, u);
            K.multiply_add(-1.0, &motion, &mut tangent);
        }
        for i in 0..tangent.len() {
            if prescribed[i] {
                tangent[i] = motion[i];
            }
        }
        let solver = self.solver.as_ref()?;
        match solver.solve(&mut tangent, PREDICTION, monitor) {
            Ok(solved) => {
                monitor.iterated(solved.iterations);
                // What was cut off is no du/dt.
                solved.reached.then_some(tangent)
            }
            Err(down) => {
                monitor.iterated(down.iterations);
                self.state.negative_pivots = self.state.negative_pivots.max(1);
                None
            }
        }
    }

    /// Where the path leads: along its tangent, or along the cubic through the state before and
    /// this one with the tangents of both, whichever comes closer to equilibrium.
    fn predict(&self, t: f64, load: &P::Load, tangent: Option<&[f64]>) -> Vec<f64> {
        let (problem, u, ahead) = (&self.problem, &self.state.u, t - self.t);
        let Some(tangent) = tangent else {
            let mut u = u.clone();
            problem.apply_prescribed(load, &mut u);
            return u;
        };
        let mut line: Vec<f64> = u.iter().zip(tangent).map(|(u, v)| u + ahead * v).collect();
        problem.apply_prescribed(load, &mut line);
        let Some(previous) = &self.previous else {
            return line;
        };
        // Hermite's cubic on [0, 1] = [behind, state], read at s beyond 1.
        let back = self.t - previous.t;
        let s = 1.0 + ahead / back;
        let [a, b, c, d] = [
            (2.0 * s - 3.0) * s * s + 1.0,
            ((s - 2.0) * s + 1.0) * s * back,
            (3.0 - 2.0 * s) * s * s,
            (s - 1.0) * s * s * back,
        ];
        let mut cubic: Vec<f64> = (0..u.len())
            .map(|i| a * previous.u[i] + b * previous.tangent[i] + c * u[i] + d * tangent[i])
            .collect();
        problem.apply_prescribed(load, &mut cubic);
        let relative_residual = |u: &[f64]| {
            let forces = problem.forces(load, u);
            forces.map_or(f64::INFINITY, |forces| {
                forces.relative_residual(problem.prescribed())
            })
        };
        if relative_residual(&cubic) < relative_residual(&line) {
            cubic
        } else {
            line
        }
    }
}

/// Linear solves that a failure cost, as far as it tells.
fn spent<B: std::error::Error>(failure: &Failure<B>) -> usize {
    match failure {
        Failure::NoDescent { iterations, .. }
        | Failure::NotConverged { iterations, .. }
        | Failure::Unsolved { iterations, .. } => *iterations,
        Failure::Indefinite { .. } => 1,
        _ => 0,
    }
}

/// Counts the iterations inside the linear solves, those of failed tries too.
struct Counted<'a> {
    monitor: &'a mut dyn Monitor,
    inner_iterations: usize,
}

impl Monitor for Counted<'_> {
    fn solved(&mut self, method: Method, relative_residual: f64) -> bool {
        self.monitor.solved(method, relative_residual)
    }
    fn iterated(&mut self, inner_iterations: usize) {
        self.inner_iterations += inner_iterations;
        self.monitor.iterated(inner_iterations);
    }
    fn iterating(&mut self) -> bool {
        self.monitor.iterating()
    }
}

/// Makes a state of a solution, and readies its tangent, which may tell whether it is stable and
/// leads to the next.
fn accepted<P: Equilibrium>(
    problem: &P,
    load: P::Load,
    u: Vec<f64>,
    forces: &ResidualEvaluation,
) -> (State<P::Load>, Option<SolverOf<P>>) {
    let solver = problem.tangent(&load, &u).into_shifted(0.0).ok();
    let negative = |solver: &SolverOf<P>| {
        let away = usize::from(solver.is_unstable());
        solver.negative_pivots().max(away)
    };
    let state = State {
        load,
        energy: forces.energy,
        relative_residual: forces.relative_residual(problem.prescribed()),
        negative_pivots: solver.as_ref().map_or(1, negative),
        u,
    };
    (state, solver)
}

impl<L> State<L> {
    /// Whether the residual without drag is small against the forces in play.
    pub fn in_equilibrium(&self) -> bool {
        self.relative_residual <= EQUILIBRIUM
    }
}
