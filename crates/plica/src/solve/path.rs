//! The path from state to state along a load, and through a snap.

use super::continuation::{ContinuationState, PreviousPoint};
use super::equilibrium::{Equilibrium, ResidualEvaluation, is_reachable};
use super::failure::{Cause, Failure};
use super::limit_point::limit_point;
use super::newton::newton;
use super::pseudo_time::pseudo_time;
use super::relaxation::relaxation;
use super::repeated::repeated;
use super::settings::{PseudoTime, Scheme, Settings};
use super::state::{Effort, Method, Solution, State};
use super::step_controller::StepController;
use super::tangent::{Solver, Tangent};
use crate::monitor::Monitor;

/// Step of the central difference that gives ∂R/∂t, as a fraction of a segment.
const DIFFERENCE: f64 = 1e-5;

/// Repetitions of a step in pseudo-time whose energy depends on its solution, if that is not brought to equilibrium.
const REPETITIONS: usize = 2;

/// Accuracy of the linear solve for du/dt.
const PREDICTION: f64 = 1e-4;

/// A path of equilibrium states. It consists of segments; on each the load goes straight from one
/// value to another, with t from 0 to 1 or in another range. The path owns its last accepted state.
pub struct Path<P: Equilibrium> {
    problem: P,
    settings: Settings,
    state: State<P::Load>,
    /// Solver of the state's tangent stiffness, unless that is singular. It may need as much memory as
    /// everything else, so it is dropped before the next state is computed, and made again on request.
    solver: Option<SolverOf<P>>,
    /// du/dt at the state, once it has been computed; None inside if there is none.
    tangent: Option<Option<Vec<f64>>>,
    segment: Segment<P::Load>,
    continuation: ContinuationState,
}

/// A segment of a path.
#[derive(Clone, Debug, PartialEq)]
pub struct Segment<L> {
    /// Positions t of its ends.
    pub range: [f64; 2],
    /// Loads at its ends.
    pub loads: [L; 2],
}

impl<L> Segment<L> {
    /// A segment between two loads with t from 0 to 1.
    pub fn between(from: L, to: L) -> Self {
        Self {
            range: [0.0, 1.0],
            loads: [from, to],
        }
    }

    /// Returns the fraction of the segment at a position t.
    pub fn fraction(&self, t: f64) -> f64 {
        let [from, to] = self.range;
        (t - from) / (to - from)
    }
}

type SolverOf<P> = <<P as Equilibrium>::Tangent as Tangent>::Solver;

/// The way in which an accepted state was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// The method that found it.
    pub method: Method,
    /// Work of the solvers.
    pub effort: Effort,
    /// Energy dissipated by damping.
    pub damping_work: f64,
}

/// Methods that were tried in order, with their failures.
type Attempts<E> = Vec<(Method, Failure<E>)>;

/// The end of a path: all attempts to continue from its last state failed.
#[derive(Clone, Debug, PartialEq)]
pub struct PathError<E: std::error::Error> {
    /// The attempts in their order, with their failures.
    pub attempts: Attempts<E>,
    /// Position on the segment at which the path turns back, if its states show that: the load has an extreme value
    /// there. It lies between the last accepted state and the position of the attempts, or a little beyond.
    pub limit_point: Option<f64>,
    /// Method and work up to the last accepted state, and the work of the attempts.
    pub step: Step,
}

impl<E: std::error::Error> PathError<E> {
    /// Returns whether the monitor cancelled the computation.
    pub fn is_cancelled(&self) -> bool {
        is_cancelled(&self.attempts)
    }
}

fn is_cancelled<E: std::error::Error>(attempts: &Attempts<E>) -> bool {
    matches!(attempts.last(), Some((_, Failure::Cancelled)))
}

impl<E: std::error::Error> std::fmt::Display for PathError<E> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (i, (method, failure)) in self.attempts.iter().enumerate() {
            let semicolon = if i > 0 { "; " } else { "" };
            write!(f, "{semicolon}{method}: {failure}")?;
        }
        Ok(())
    }
}

impl<E: std::error::Error> std::error::Error for PathError<E> {}

impl<P: Equilibrium> Path<P> {
    /// Begins at a state that is already in equilibrium under `load`.
    ///
    /// # Errors
    ///
    /// If the energy is not defined there.
    pub fn begin(
        mut problem: P,
        load: P::Load,
        u: Vec<f64>,
        settings: Settings,
    ) -> Result<Self, P::EvaluationError> {
        let load = problem.completed(load, &u);
        problem.begin_step(&load, &u, &[]);
        Self::begin_with(problem, load, u, vec![], settings)
    }

    /// Begins at a state with its history, from which the step of the problem begins.
    fn begin_with(
        problem: P,
        load: P::Load,
        u: Vec<f64>,
        history: Vec<f64>,
        settings: Settings,
    ) -> Result<Self, P::EvaluationError> {
        let forces = problem.forces(&load, &u)?;
        let continuation = ContinuationState::at_start(vec![0.0; u.len()], history);
        let (state, solver) = accepted(&problem, load.clone(), u, &forces);
        Ok(Self {
            problem,
            settings,
            state,
            solver,
            tangent: None,
            segment: Segment::between(load.clone(), load),
            continuation,
        })
    }

    /// Continues from an accepted state of a segment.
    ///
    /// # Errors
    ///
    /// If the energy is not defined there.
    pub fn resume(
        mut problem: P,
        segment: Segment<P::Load>,
        load: P::Load,
        u: Vec<f64>,
        continuation: ContinuationState,
        settings: Settings,
    ) -> Result<Self, P::EvaluationError> {
        problem.begin_step(&load, &u, &continuation.history);
        Ok(Self {
            segment,
            continuation,
            ..Self::begin_with(problem, load, u, vec![], settings)?
        })
    }

    /// Returns what [`Path::resume`] needs beside the last accepted state.
    pub fn continuation_state(&self) -> ContinuationState {
        self.continuation.clone()
    }

    /// Returns the problem, with the step that begins at the last accepted state.
    pub fn problem(&self) -> &P {
        &self.problem
    }

    /// Returns the history of the last accepted state.
    pub fn history(&self) -> &[f64] {
        &self.continuation.history
    }

    /// Returns the last accepted state.
    pub fn state(&self) -> &State<P::Load> {
        &self.state
    }

    /// Returns the solver of the tangent stiffness at the last accepted state, without damping; None
    /// if that is singular.
    pub fn solver(&mut self) -> Option<&SolverOf<P>> {
        if self.solver.is_none() {
            let State { load, u, .. } = &self.state;
            self.solver = self.problem.tangent(load, u).into_shifted(0.0).ok();
        }
        self.solver.as_ref()
    }

    /// Begins a segment from the load of the last accepted state to another, with t from 0 to 1.
    pub fn begin_segment(&mut self, to: P::Load) {
        self.begin_segment_over([0.0, 1.0], to);
    }

    /// Begins a segment from the load of the last accepted state to another, with t in a range.
    pub fn begin_segment_over(&mut self, range: [f64; 2], to: P::Load) {
        let ContinuationState {
            velocity,
            mut history,
            ..
        } = std::mem::replace(
            &mut self.continuation,
            ContinuationState::at_start(vec![], vec![]),
        );
        let State { load, u, .. } = &self.state;
        let from = (self.problem).begin_segment(load.clone(), &to, u, &mut history);
        self.switch(from.clone());
        let loads = [from, to];
        (self.segment, self.tangent) = (Segment { range, loads }, None);
        self.continuation = ContinuationState {
            reached: range[0],
            ..ContinuationState::at_start(velocity, history)
        };
    }

    /// Takes another load for the last accepted state, under which it is in equilibrium, too; its stability may differ.
    fn switch(&mut self, load: P::Load) {
        if load == self.state.load {
            return;
        }
        let u = std::mem::take(&mut self.state.u);
        let solver = self.problem.tangent(&load, &u).into_shifted(0.0).ok();
        self.state.negative_pivots = negative_eigenvalues(solver.as_ref());
        (self.state.load, self.state.u, self.solver) = (load, u, solver);
    }

    /// Returns the position of the last accepted state on its segment.
    pub fn reached(&self) -> f64 {
        self.continuation.reached
    }

    /// Advances to position `t` of the segment, through intermediate states if need be.
    ///
    /// # Errors
    ///
    /// If all attempts fail. The path then stays at the last state that was accepted on the way.
    pub fn advance(
        &mut self,
        t: f64,
        monitor: &mut dyn Monitor,
    ) -> Result<Step, PathError<P::EvaluationError>> {
        let mut step = Step {
            method: Method::Newton,
            effort: Effort::default(),
            damping_work: 0.0,
        };
        let advanced = match self.settings.scheme.clone() {
            Scheme::Static => self.advance_static(t, &mut step, monitor),
            Scheme::PseudoTime(scheme) => self
                .advance_damped(t, &scheme, &mut step, monitor)
                .map_err(|attempt| (vec![attempt], None)),
        };
        match advanced {
            Ok(()) => Ok(step),
            Err((attempts, limit_point)) => Err(PathError {
                attempts,
                limit_point,
                step,
            }),
        }
    }

    /// Advances part by part, and halves the parts where all methods fail.
    ///
    /// If Newton's method fails at a stable state, a shorter step may still follow a branch that bends; otherwise
    /// relaxation descends to the next stable state. If there is none beyond a limit point of the path, relaxation is not
    /// tried there again: the descent is the same from a state that is nearer.
    fn advance_static(
        &mut self,
        target: f64,
        step: &mut Step,
        monitor: &mut dyn Monitor,
    ) -> Result<(), (Attempts<P::EvaluationError>, Option<f64>)> {
        let max_level = self.settings.max_step_halvings;
        let level = self.continuation.halving_level;
        let mut parts = StepController::new([self.reached(), target], level, max_level);
        let mut descends_without_end = false;
        while let Some(t) = parts.next() {
            let Err(failed) = self.try_newton(t, step, monitor) else {
                parts.accept();
                self.continuation.halving_level = parts.level();
                continue;
            };
            let limit_point = self.limit_point(t);
            let relaxes = match failed {
                Failure::Cancelled => false,
                // A shorter step does not help where the linear solver misses its accuracy.
                Failure::NotConverged {
                    cause: Cause::InaccurateSolves,
                    ..
                } => true,
                _ => !parts.halves_before_relaxation() || self.state.negative_pivots > 0,
            };
            let mut attempts = vec![(Method::Newton, failed)];
            if relaxes && !(descends_without_end && limit_point.is_some()) {
                let Err(failed) = self.try_relaxation(t, step, monitor) else {
                    parts.accept();
                    self.continuation.halving_level = parts.level();
                    continue;
                };
                attempts.push((Method::Relaxation, failed));
                descends_without_end = limit_point.is_some();
            }
            if is_cancelled(&attempts) || !parts.halve() {
                return Err((attempts, limit_point));
            }
        }
        Ok(())
    }

    /// Returns the limit point that explains why no state was found at `t`; none without two states of the segment.
    fn limit_point(&self, t: f64) -> Option<f64> {
        let tangent = self.tangent.as_ref()?.as_ref()?;
        let previous = self.continuation.previous.as_ref()?;
        limit_point(previous, self.reached(), &self.state.u, tangent, t)
    }

    fn try_newton(
        &mut self,
        t: f64,
        step: &mut Step,
        monitor: &mut dyn Monitor,
    ) -> Result<(), Failure<P::EvaluationError>> {
        let mut tangent = None;
        if self.state.negative_pivots == 0 {
            tangent = self.tangent(&mut step.effort, monitor);
        }
        // Solving for the tangent may have shown that the state is unstable. The path then leaves it.
        if self.state.negative_pivots > 0 {
            return Err(Failure::Indefinite {
                negative_pivots: self.state.negative_pivots,
            });
        }
        let load = self.load_at(t);
        let start = self.predict(t, &load, tangent.as_deref());
        let start = start.ok_or(Failure::Blocked)?;
        self.solver = None;
        let (settings, effort) = (&self.settings, &mut step.effort);
        let found = newton(&self.problem, &load, start, settings, effort, monitor);
        let problem = &mut self.problem;
        let found = found.and_then(|found| {
            repeated(problem, &load, found, settings, |problem, u, settings| {
                newton(problem, &load, u, settings, effort, monitor)
            })
        });
        let found = found.map_err(|failed| self.abandon(failed, &mut step.effort))?;
        let previous = tangent.map(|tangent| PreviousPoint {
            t: self.continuation.reached,
            u: self.state.u.clone(),
            tangent,
        });
        self.accept(t, load, found, step);
        self.continuation.previous = previous;
        Ok(())
    }

    fn try_relaxation(
        &mut self,
        t: f64,
        step: &mut Step,
        monitor: &mut dyn Monitor,
    ) -> Result<(), Failure<P::EvaluationError>> {
        let load = self.load_at(t);
        // From the last state if prescribed unknowns stay; else along the tangent, which moves them
        // with the rest.
        let mut start = self.state.u.clone();
        self.problem.apply_prescribed(&load, &mut start);
        if start != self.state.u {
            self.continuation.previous = None;
            let tangent = self.tangent(&mut step.effort, monitor);
            start = self
                .predict(t, &load, tangent.as_deref())
                .ok_or(Failure::Blocked)?;
        }
        self.solver = None;
        let (settings, effort) = (&self.settings, &mut step.effort);
        let found = relaxation(&self.problem, &load, start, settings, effort, monitor);
        let problem = &mut self.problem;
        let found = found.and_then(|found| {
            repeated(problem, &load, found, settings, |problem, u, settings| {
                relaxation(problem, &load, u, settings, effort, monitor)
            })
        });
        let found = found.map_err(|failed| self.abandon(failed, &mut step.effort))?;
        self.accept(t, load, found, step);
        self.continuation.previous = None;
        step.method = Method::Relaxation;
        Ok(())
    }

    /// Advances in pseudo-time with constant damping, then to equilibrium without damping if the
    /// scheme requires that.
    fn advance_damped(
        &mut self,
        t: f64,
        scheme: &PseudoTime,
        step: &mut Step,
        monitor: &mut dyn Monitor,
    ) -> Result<(), (Method, Failure<P::EvaluationError>)> {
        step.method = Method::PseudoTime;
        self.solver = None;
        let load = self.load_at(t);
        let (problem, settings, effort) = (&mut self.problem, &self.settings, &mut step.effort);
        let loads = [&self.state.load, &load];
        let start = (self.state.u.clone(), self.continuation.velocity.clone());
        let (mut found, mut velocity) =
            pseudo_time(&*problem, loads, start, scheme, settings, effort, monitor)
                .map_err(|failed| (Method::PseudoTime, failed))?;
        step.damping_work += found.damping_work;
        found.damping_work = 0.0;
        if scheme.equilibrate {
            velocity.fill(0.0);
            found = relaxation(&*problem, &load, found.u, settings, effort, monitor)
                .map_err(|failed| (Method::Relaxation, failed))?;
            found = repeated(problem, &load, found, settings, |problem, u, settings| {
                relaxation(problem, &load, u, settings, effort, monitor)
            })
            .map_err(|failed| (Method::Relaxation, failed))?;
        } else {
            // A state that is not in equilibrium: its friction is that of the state before the last repetition.
            for _ in 0..REPETITIONS {
                if !problem.update(&load, &found.u) {
                    break;
                }
                let (start, loads) = ((found.u, velocity), [&load, &load]);
                let again = pseudo_time(&*problem, loads, start, scheme, settings, effort, monitor);
                (found, velocity) = again.map_err(|failed| (Method::PseudoTime, failed))?;
                step.damping_work += found.damping_work;
                found.damping_work = 0.0;
            }
        }
        self.continuation.velocity = velocity;
        self.accept(t, load, found, step);
        Ok(())
    }

    /// Returns the load at position `t` of the segment.
    pub fn load_at(&self, t: f64) -> P::Load {
        let [from, to] = &self.segment.loads;
        self.problem.between(from, to, self.segment.fraction(t))
    }

    /// Counts the solves of a failed attempt, and begins the step again.
    fn abandon(
        &mut self,
        failed: Failure<P::EvaluationError>,
        effort: &mut Effort,
    ) -> Failure<P::EvaluationError> {
        effort.linear_solves += failed.linear_solves();
        let State { load, u, .. } = &self.state;
        self.problem.begin_step(load, u, &self.continuation.history);
        failed
    }

    fn accept(&mut self, t: f64, load: P::Load, found: Solution, step: &mut Step) {
        step.effort.linear_solves += 1;
        step.damping_work += found.damping_work;
        self.continuation.history = self.problem.history(&load, &found.u);
        let load = self.problem.completed(load, &found.u);
        self.problem
            .begin_step(&load, &found.u, &self.continuation.history);
        (self.state, self.solver) = accepted(&self.problem, load, found.u, &found.forces);
        (self.tangent, self.continuation.reached) = (None, t);
    }

    /// Returns du/dt at the state. None if the tangent stiffness is singular, the residual is not
    /// defined, or the solver misses its accuracy. None, too, if the solver meets negative curvature;
    /// only then is the state recorded as unstable here.
    fn tangent(&mut self, effort: &mut Effort, monitor: &dyn Monitor) -> Option<Vec<f64>> {
        if self.tangent.is_none() {
            self.tangent = Some(self.solve_for_tangent(effort, monitor));
        }
        self.tangent.clone().flatten()
    }

    /// Solves K du/dt = −∂R/∂t, where prescribed unknowns move as the load says.
    fn solve_for_tangent(
        &mut self,
        effort: &mut Effort,
        monitor: &dyn Monitor,
    ) -> Option<Vec<f64>> {
        self.solver()?;
        let (problem, u) = (&self.problem, &self.state.u);
        // Central difference in t; the residual is smooth in the load.
        let at = |t: f64| {
            let load = self.load_at(t);
            let mut moved = u.clone();
            problem.apply_prescribed(&load, &mut moved);
            let forces = problem.forces(&load, u).ok()?;
            Some((forces.residual, moved))
        };
        let (after, moved_after) = at(self.continuation.reached + DIFFERENCE)?;
        let (before, moved_before) = at(self.continuation.reached - DIFFERENCE)?;
        let slope = |a: &[f64], b: &[f64]| -> Vec<f64> {
            let pairs = a.iter().zip(b);
            pairs.map(|(a, b)| (a - b) / (2.0 * DIFFERENCE)).collect()
        };
        let motion = slope(&moved_after, &moved_before);
        let mut tangent = slope(&before, &after);
        if motion.iter().any(|&d| d != 0.0) {
            let K = problem.tangent(&self.state.load, u);
            K.multiply_add(-1.0, &motion, &mut tangent);
        }
        for (i, _) in problem.prescribed().iter().enumerate().filter(|(_, p)| **p) {
            tangent[i] = motion[i];
        }
        match self
            .solver
            .as_ref()?
            .solve(&mut tangent, PREDICTION, monitor)
        {
            Ok(solved) => {
                effort.inner_iterations += solved.iterations;
                solved.converged.then_some(tangent)
            }
            Err(met) => {
                effort.inner_iterations += met.iterations;
                self.state.negative_pivots = self.state.negative_pivots.max(1);
                None
            }
        }
    }

    /// Predicts u at `t`: along the tangent, or along the cubic through the previous point and the
    /// state, whichever has the smaller residual. A prediction behind a barrier is replaced by the state with the
    /// prescribed values of `t`. Returns none if that lies behind a barrier, too.
    fn predict(&self, t: f64, load: &P::Load, tangent: Option<&[f64]>) -> Option<Vec<f64>> {
        let (problem, u) = (&self.problem, &self.state.u);
        let predicted = self.extrapolate(t, load, tangent);
        if is_reachable(problem, u, &predicted) {
            return Some(predicted);
        }
        let mut start = u.clone();
        problem.apply_prescribed(load, &mut start);
        is_reachable(problem, u, &start).then_some(start)
    }

    /// Extrapolates u to `t` along the tangent, or along the cubic, whichever has the smaller residual.
    fn extrapolate(&self, t: f64, load: &P::Load, tangent: Option<&[f64]>) -> Vec<f64> {
        let (problem, u, ahead) = (&self.problem, &self.state.u, t - self.continuation.reached);
        let prescribed = |mut u: Vec<f64>| {
            problem.apply_prescribed(load, &mut u);
            u
        };
        let Some(tangent) = tangent else {
            return prescribed(u.clone());
        };
        let line = prescribed(u.iter().zip(tangent).map(|(u, v)| u + ahead * v).collect());
        let Some(previous) = &self.continuation.previous else {
            return line;
        };
        let cubic = prescribed(previous.extrapolate(self.continuation.reached, u, tangent, t));
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

/// Returns the state of a solution and the solver of its tangent.
fn accepted<P: Equilibrium>(
    problem: &P,
    load: P::Load,
    u: Vec<f64>,
    forces: &ResidualEvaluation,
) -> (State<P::Load>, Option<SolverOf<P>>) {
    let solver = problem.tangent(&load, &u).into_shifted(0.0).ok();
    let state = State {
        load,
        energy: forces.energy,
        relative_residual: forces.relative_residual(problem.prescribed()),
        negative_pivots: negative_eigenvalues(solver.as_ref()),
        u,
    };
    (state, solver)
}

/// Returns the number of negative eigenvalues that a solver shows; 1 for a singular tangent, which has none.
fn negative_eigenvalues<S: Solver>(solver: Option<&S>) -> usize {
    let negative = |solver: &S| {
        let unstable = usize::from(solver.is_unstable());
        solver.negative_pivots().max(unstable)
    };
    solver.map_or(1, negative)
}
