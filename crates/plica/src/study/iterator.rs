//! The iterator of states.

use super::start::{equilibrate, transferred};
use super::state::Milestone;
use super::work::WorkPoint;
use super::{Lost, Phase, Plan, State, StudyError, check_memory};
use crate::assembly::SplineTube;
use crate::equilibrium::{TubeProblem, segment_start, test_stability};
use crate::monitor::{Monitor, Part};
use crate::solve::{ContinuationState, Effort, Failure, Method, Path, PathError, Segment, Step};
use crate::tube::Load;
use std::time::Instant;

/// A tube that is followed through the stages of a plan: an iterator of accepted states.
///
/// The first state is the tube at rest, with its imperfections and residual stress, or the state that the plan starts
/// from. Then every step of every stage ends in one state. The iterator ends after the last stage,
/// when it is cancelled, or with an error when the tube cannot be followed further.
pub struct Study {
    plan: Plan,
    problem: TubeProblem,
    /// The path at the last accepted state; none before the first.
    path: Option<Path<TubeProblem>>,
    /// The last accepted state for the work to the next; none before the first.
    work_point: Option<WorkPoint>,
    /// Stage that the path is in; none before the first.
    stage: Option<usize>,
    /// Completed steps of that stage.
    completed_steps: usize,
    /// Number of the next state.
    next_number: usize,
    ending: Option<Ending>,
    /// True once the caller has received the error of a lost tube.
    error_returned: bool,
    since: Instant,
}

/// End of a study.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// Every stage was completed.
    Complete,
    /// A monitor cancelled it.
    Stopped,
    /// The tube could not be followed further.
    Lost(Box<Lost>),
}

/// Data from which a study is resumed after one of its states, bit for bit.
#[derive(Clone, Debug, PartialEq)]
pub struct Continuation {
    /// Number of the state.
    pub number: usize,
    /// Stage that the path is in, from 0; none before the first.
    pub stage: Option<usize>,
    /// Load of the state.
    pub load: Load,
    /// Unknowns of the state.
    pub unknowns: Vec<f64>,
    /// State of the path beside its accepted state: position, halving level, previous point, velocity.
    pub path: ContinuationState,
}

impl Continuation {
    /// Returns the segment of the load that the path is in; none if the plan has no such stage.
    pub fn segment(&self, plan: &Plan) -> Option<Segment<Load>> {
        let Some(number) = self.stage else {
            let first = plan.first_load();
            return Some(Segment::between(first.clone(), first));
        };
        let stage = plan.stages.get(number)?;
        let reached = self.path.reached;
        let completed = stage.completed_steps(reached);
        // A state at the end of a step belongs to that step.
        let ends_step = completed as f64 / stage.steps as f64 == reached;
        let step = completed.saturating_sub(usize::from(ends_step));
        let Segment { range, loads } = stage.segment(&plan.load_before(number), step);
        let [from, to] = loads;
        let from = segment_start(from, &to, &self.path.history);
        let loads = [from, to];
        Some(Segment { range, loads })
    }
}

impl Study {
    /// Prepares a study; its first state is computed when it is asked for.
    ///
    /// # Errors
    /// [`StudyError::OutOfMemory`] if the machine has too little free memory, where the system reports it;
    /// [`StudyError::Crosses`] if the state to start from passes through itself and the plan has contact.
    pub fn new(plan: &Plan) -> Result<Self, StudyError> {
        check_memory(plan)?;
        let problem = plan.problem();
        if let (Some(contact), Some(start)) = (&problem.contact, &plan.start)
            && let Some(face) = contact.crossing(&transferred(plan, &problem, start))
        {
            return Err(StudyError::Crosses(face));
        }
        Ok(Self {
            plan: plan.clone(),
            problem,
            path: None,
            work_point: None,
            stage: None,
            completed_steps: 0,
            next_number: 0,
            ending: None,
            error_returned: false,
            since: Instant::now(),
        })
    }

    /// Resumes a study after one of its states; the next state is the one after it, the same to the
    /// bit as without the interruption.
    ///
    /// # Errors
    /// [`StudyError::Resume`] if the state does not belong to the plan; else as [`Study::new`].
    pub fn resume(plan: &Plan, from: Continuation) -> Result<Self, StudyError> {
        let mut study = Self::new(plan)?;
        let unknown_stage = || StudyError::Resume("the case has no such stage".into());
        let segment = from.segment(plan).ok_or_else(unknown_stage)?;
        let path = Path::resume(
            study.problem.clone(),
            segment,
            from.load,
            from.unknowns,
            from.path,
            plan.solver.clone(),
        );
        let path =
            path.map_err(|error| StudyError::Resume(format!("its state is not a wall: {error}")))?;
        if let Some(stage) = from.stage {
            study.completed_steps = plan.stages[stage].completed_steps(path.reached());
        }
        let state = (&path.state().load, path.state().u.as_slice());
        let forces = path.problem().forces_on_tube(state.0, state.1);
        let forces = forces.map_err(|error| StudyError::Resume(error.to_string()))?;
        study.work_point = Some(WorkPoint::of(plan, path.problem(), state, &forces));
        study.stage = from.stage;
        study.next_number = from.number + 1;
        study.path = Some(path);
        Ok(study)
    }

    /// Returns the plan.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Returns the problem of the solver.
    pub fn problem(&self) -> &TubeProblem {
        &self.problem
    }

    /// Returns the discretised tube.
    pub fn tube(&self) -> &SplineTube {
        &self.problem.tube
    }

    /// Returns how the study ended; none while it has not.
    pub fn ending(&self) -> Option<&Ending> {
        self.ending.as_ref()
    }

    /// Ends the study after the last state.
    pub fn stop(&mut self) {
        self.ending.get_or_insert(Ending::Stopped);
    }

    /// Returns the data from which the study is resumed after its last state; none before the first state and after the
    /// study has ended early.
    pub fn continuation(&self) -> Option<Continuation> {
        if !matches!(self.ending, None | Some(Ending::Complete)) {
            return None;
        }
        let path = self.path.as_ref()?;
        Some(Continuation {
            number: self.next_number - 1,
            stage: self.stage,
            load: path.state().load.clone(),
            unknowns: path.state().u.clone(),
            path: path.continuation_state(),
        })
    }

    /// Computes the next state and reports progress to a monitor, which may cancel.
    ///
    /// Returns none after the last state and after a cancellation.
    pub fn next_state(&mut self, monitor: &mut dyn Monitor) -> Option<Result<State, StudyError>> {
        let state = match self.ending {
            Some(_) => None,
            None if self.path.is_none() => self.first_state(monitor),
            None if monitor.is_cancelled() => {
                self.stop();
                None
            }
            None => self.advance(monitor),
        };
        if let Some(state) = state {
            return Some(Ok(state));
        }
        match &self.ending {
            Some(Ending::Lost(lost)) if !self.error_returned => {
                self.error_returned = true;
                Some(Err(StudyError::Lost(lost.clone())))
            }
            _ => None,
        }
    }

    /// Computes the tube at rest with its imperfections and residual stress, or the state that the plan starts from.
    fn first_state(&mut self, monitor: &mut dyn Monitor) -> Option<State> {
        let name = if self.plan.start.is_some() {
            "start"
        } else {
            "rest"
        };
        let found = {
            let monitor = &mut Part::new(monitor, name, 0.0, 0.0);
            match &self.plan.start {
                Some(start) => {
                    equilibrate(&self.plan, &self.problem, start, monitor).map(|(u, step)| {
                        match self.begin(start.load.clone(), u) {
                            Ok(path) => (path, step),
                            Err(error) => unreachable!("an equilibrium is not inverted: {error}"),
                        }
                    })
                }
                None => self.rest(monitor),
            }
        };
        match found {
            Ok((path, step)) => {
                self.path = Some(path);
                Some(self.accept(name, &step, true, monitor))
            }
            Err(error) => {
                let phase = match self.plan.start {
                    Some(_) => Phase::Start,
                    None => Phase::Rest,
                };
                self.end(phase, error, false);
                None
            }
        }
    }

    fn begin(
        &self,
        load: Load,
        u: Vec<f64>,
    ) -> Result<Path<TubeProblem>, crate::assembly::Inverted> {
        Path::begin(self.problem.clone(), load, u, self.plan.solver.clone())
    }

    /// Brings the tube to rest, which takes a solve if it has imperfections or residual stress.
    fn rest(
        &self,
        monitor: &mut dyn Monitor,
    ) -> Result<(Path<TubeProblem>, Step), PathError<crate::assembly::Inverted>> {
        let rest = self.plan.tube.rest();
        let step = Step {
            method: Method::Rest,
            effort: Effort {
                linear_solves: 1,
                inner_iterations: 0,
            },
            damping_work: 0.0,
        };
        let mut path = self
            .begin(rest.clone(), self.problem.tube.initial_guess())
            .map_err(|error| PathError {
                attempts: vec![(Method::Rest, Failure::Evaluation(error))],
                limit_point: None,
                step,
            })?;
        let stressed = self.plan.tube.is_stressed_at_rest();
        if self.plan.tube.imperfections.is_empty() && !stressed {
            return Ok((path, step));
        }
        path.begin_segment(rest);
        let step = path.advance(1.0, monitor)?;
        Ok((path, step))
    }

    /// Computes the next step of the stage, or the first of the next stage.
    fn advance(&mut self, monitor: &mut dyn Monitor) -> Option<State> {
        let path = self.path.as_mut()?;
        let ended = |stage: usize| self.completed_steps >= self.plan.stages[stage].steps;
        let (stage, is_new) = match self.stage {
            Some(stage) if !ended(stage) => (stage, false),
            before => {
                let next = before.map_or(0, |stage| stage + 1);
                if next == self.plan.stages.len() {
                    self.ending = Some(Ending::Complete);
                    return None;
                }
                (self.stage, self.completed_steps) = (Some(next), 0);
                (next, true)
            }
        };
        let Segment { range, loads } =
            self.plan.stages[stage].segment(&self.plan.load_before(stage), self.completed_steps);
        if is_new || range[0] == path.reached() {
            let [_, to] = loads;
            path.begin_segment_over(range, to);
        }
        let (name, steps) = {
            let stage = &self.plan.stages[stage];
            (stage.name.clone(), stage.steps)
        };
        let step = self.completed_steps + 1;
        let before: usize = self.plan.stages[..stage].iter().map(|s| s.steps).sum();
        let done = before + self.completed_steps;
        let (from, all) = (path.reached(), self.plan.steps());
        let advanced = {
            let activity = format!("{name}, step {step} of {steps}");
            let fraction = |steps: usize| steps as f64 / all as f64;
            let monitor = &mut Part::new(monitor, activity, fraction(done), 0.0);
            path.advance(step as f64 / steps as f64, monitor)
        };
        match advanced {
            Ok(found) => {
                self.completed_steps = step;
                Some(self.accept(&name, &found, step == steps, monitor))
            }
            Err(error) => {
                // A state that was reached on the way is a good state, too.
                let reached_more = path.reached() > from;
                let found = error.step;
                let phase = Phase::Stage {
                    name: name.clone(),
                    step,
                    steps,
                };
                let state = reached_more.then(|| self.accept(&name, &found, true, monitor));
                self.end(phase, error, true);
                state
            }
        }
    }

    /// Tests and measures the state that the path has reached.
    fn accept(
        &mut self,
        stage: &str,
        step: &Step,
        ends_stage: bool,
        monitor: &mut dyn Monitor,
    ) -> State {
        let Some(path) = &mut self.path else {
            unreachable!("a state is accepted on a path")
        };
        let modes = self.plan.output.stability_modes;
        let stability = {
            let fraction = self.next_number as f64 / (1 + self.plan.steps()) as f64;
            let monitor = &mut Part::new(monitor, "testing stability", fraction, 0.0);
            test_stability(&self.problem, path, modes, monitor)
        };
        let milestone = Milestone {
            number: self.next_number,
            stage,
            ends_stage,
            stage_fraction: path.reached(),
            time: match self.stage {
                Some(stage) => self.plan.time_at(stage, path.reached()),
                None => self.plan.first_time(),
            },
        };
        let seconds = self.since.elapsed().as_secs_f64();
        let (mut state, work_point) = State::evaluate(
            (&self.plan, path.problem()),
            self.work_point.as_ref(),
            &milestone,
            path.state(),
            step,
            stability,
            seconds,
        );
        state.history = path.history().to_vec();
        self.work_point = Some(work_point);
        self.next_number += 1;
        self.since = Instant::now();
        state
    }

    /// Ends the study because no next state was found.
    fn end(
        &mut self,
        phase: Phase,
        error: PathError<crate::assembly::Inverted>,
        has_good_state: bool,
    ) {
        self.ending = Some(if error.is_cancelled() {
            Ending::Stopped
        } else {
            let path = self.path.as_ref().filter(|_| has_good_state);
            let last = path.map(|path| (&path.state().load, path.state().u.as_slice()));
            let limit = path.and_then(|path| Some(path.load_at(error.limit_point?)));
            Ending::Lost(Box::new(Lost::new(
                &self.plan,
                self.tube(),
                phase,
                error,
                last,
                limit.as_ref(),
            )))
        });
    }
}

impl Iterator for Study {
    type Item = Result<State, StudyError>;

    fn next(&mut self) -> Option<Self::Item> {
        self.next_state(&mut ())
    }
}
