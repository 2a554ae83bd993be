//! Leads a tube through its stages, from the beginning or where it was left.

use super::manifest::Manifest;
use super::observer::Relay;
use super::record::Record;
use super::summary::{Ending, Phase, Summary, whereabouts};
use super::units::Scale;
use super::{Checkpoint, Layout, Observer, Plan, Row, RunDirectory, Start, StudyError, fits};
use crate::assembly::{Inverted, SplineTube};
use crate::equilibrium::{TubeProblem, prolong};
use crate::monitor::{Monitor, Part};
use crate::solve::{
    Effort, Equilibrium, Failure, Method, Path, PathError, Step, newton, relaxation,
};
use crate::tube::{Mesh, Symmetry, Tube};

/// Runs a study from rest, or from the state that it starts from, to the end of its last stage, or as far as the tube can be followed.
/// What has been accepted is on disk at any time.
pub fn run(
    plan: &Plan,
    directory: &mut RunDirectory,
    observer: &mut dyn Observer,
) -> Result<Summary, StudyError> {
    fits(plan)?;
    directory.own()?;
    // Before the first state, so that whatever has one has what it began with.
    for mode in &plan.modes {
        directory.write_imperfection(mode)?;
    }
    if let Some(start) = &plan.start {
        directory.write_start(&start.state)?;
    }
    let manifest = Manifest::begin(plan, directory);
    directory.write_manifest(&manifest)?;
    lead(plan, directory, observer, manifest, None)
}

/// Takes up a run where it was left: by its last checkpoint, or the one before where that is broken. What was computed beyond it
/// is computed again. The end is that of a run which was never interrupted, to the bit.
///
/// The plan may differ from the one that was begun in what [`super::kept`] allows. A run that had hardly begun begins again.
///
/// # Errors
/// [`StudyError::NoCheckpoint`] if it has left none that fits; else as [`run`].
pub fn resume(
    plan: &Plan,
    directory: &mut RunDirectory,
    observer: &mut dyn Observer,
) -> Result<Summary, StudyError> {
    fits(plan)?;
    directory.own()?;
    if directory.has_hardly_begun() {
        observer.noticed("the run had hardly begun; it begins again");
        directory.go_on_after(&[])?;
        return run(plan, directory, observer);
    }
    let (rows, _) = directory.history_so_far()?;
    let (checkpoint, broken) = directory.checkpoint(plan, &rows)?;
    for why in &broken {
        observer.noticed(&format!(
            "not used: {why}; going on from the checkpoint before"
        ));
    }
    if !broken.is_empty() {
        directory.drop_newest_checkpoint()?;
    }
    let recorded = rows.len();
    let mut rows = rows[..=checkpoint.state.row].to_vec();
    if rows.len() < recorded {
        // It tells of states that are to be found again.
        directory.clear_stability()?;
    }
    if plan.is_pressed() {
        rows = rows.into_iter().map(Row::pressed).collect();
    }
    observer.noticed(&format!("going on from state {}", checkpoint.state.row));
    let manifest = Manifest::again(plan, directory);
    directory.write_manifest(&manifest)?;
    directory.go_on_after(&rows)?;
    lead(
        plan,
        directory,
        observer,
        manifest,
        Some((checkpoint, rows)),
    )
}

/// Leads a tube to the end, from the beginning or from a checkpoint that its rows end with.
fn lead(
    plan: &Plan,
    directory: &mut RunDirectory,
    observer: &mut dyn Observer,
    mut manifest: Manifest,
    from: Option<(Checkpoint, Vec<Row>)>,
) -> Result<Summary, StudyError> {
    let rings = plan.mesh.rings(plan.symmetry);
    let problem = TubeProblem::new(SplineTube::new(&plan.tube, &plan.mesh, rings));
    let mut record = Record::new(plan, &problem, directory);
    let ending = match from {
        None => match begin(plan, &problem, &mut record, observer) {
            Ok(Ok(path)) => follow(plan, path, None, &mut record, observer),
            Ok(Err(ending)) => Ok(ending),
            Err(error) => Err(error),
        },
        Some((checkpoint, rows)) => {
            record.restore(rows, observer);
            let stage = checkpoint.stage;
            let path = take_up(plan, &problem, checkpoint);
            let path = path.map_err(|why| StudyError::NoCheckpoint {
                path: record.directory.path().to_owned(),
                reasons: vec![why],
            })?;
            follow(plan, path, stage, &mut record, observer)
        }
    };
    let Record {
        rows, snapshots, ..
    } = record;
    if let Err(error @ StudyError::NoNumber { .. }) = &ending {
        manifest.fail(error, &rows);
        directory.write_manifest(&manifest)?;
    }
    let ending = ending?;
    manifest.end(&ending, &rows);
    directory.write_manifest(&manifest)?;
    Ok(Summary::new(
        plan,
        rows,
        snapshots,
        ending,
        directory.path(),
    ))
}

/// The path at a checkpoint that fits a plan.
fn take_up<'a>(
    plan: &Plan,
    problem: &'a TubeProblem,
    checkpoint: Checkpoint,
) -> Result<Path<&'a TubeProblem>, String> {
    let segment = checkpoint
        .segment(plan)
        .ok_or("its stage is none of the case's")?;
    let Checkpoint { state, memory, .. } = checkpoint;
    Path::resume(
        problem,
        segment,
        state.load,
        state.u,
        memory,
        plan.solver.clone(),
    )
    .map_err(|broken| format!("its state is none of a wall: {broken}"))
}

/// Stage after stage, step after step; the path may be on its way through one already.
fn follow(
    plan: &Plan,
    mut path: Path<&TubeProblem>,
    within: Option<usize>,
    record: &mut Record<'_>,
    observer: &mut dyn Observer,
) -> Result<Ending, StudyError> {
    let states: usize = plan.stages.iter().map(|stage| stage.steps).sum();
    let steps_before = |stage: usize| plan.stages[..stage].iter().map(|stage| stage.steps).sum();
    for (k, stage) in plan.stages.iter().enumerate().skip(within.unwrap_or(0)) {
        let mut previous = 0;
        if within == Some(k) {
            previous = completed_steps(stage.steps, path.reached());
        } else {
            path.begin_segment(stage.load.clone());
        }
        let before: usize = steps_before(k);
        for n in previous + 1..=stage.steps {
            let done = before + n - 1;
            let activity = format!("{}, step {n} of {}", stage.name, stage.steps);
            let mut relay = Relay::new(&mut *observer);
            let mut monitor = Part::new(&mut relay, activity, done as f64 / states as f64, 0.0);
            let from = path.reached();
            match path.advance(n as f64 / stage.steps as f64, &mut monitor) {
                Ok(step) => {
                    record.accept(&stage.name, &mut path, &step, n == stage.steps, observer)?;
                    if !record.leave_checkpoint(Some(k), &path, observer)? {
                        return Ok(Ending::Stopped);
                    }
                }
                Err(error) => {
                    // What was reached on the way is a good state too.
                    if path.reached() > from {
                        record.accept(&stage.name, &mut path, &error.step, true, observer)?;
                    }
                    return Ok(if error.is_cancelled() {
                        Ending::Stopped
                    } else {
                        let state = path.state();
                        Ending::Lost {
                            phase: Phase::Stage {
                                name: stage.name.clone(),
                                step: n,
                                steps: stage.steps,
                            },
                            whereabouts: whereabouts(
                                record.tube(),
                                &error,
                                Some((&state.load, &state.u)),
                            ),
                            error,
                            scale: Scale::of(plan.units.as_ref()).into(),
                        }
                    });
                }
            }
            if observer.stop() && done + 1 < states {
                return Ok(Ending::Stopped);
            }
        }
    }
    Ok(Ending::Complete)
}

/// How many of a stage's equal steps lie behind a place along it.
fn completed_steps(steps: usize, reached: f64) -> usize {
    let previous = |n: &usize| *n as f64 / steps as f64 <= reached;
    (1..=steps).take_while(previous).count()
}

/// The path at its first state: at rest, or at the state that the plan starts from, on this mesh and
/// in equilibrium. Where there is none the run has ended.
fn begin<'a>(
    plan: &Plan,
    problem: &'a TubeProblem,
    record: &mut Record<'_>,
    observer: &mut dyn Observer,
) -> Result<Result<Path<&'a TubeProblem>, Ending>, StudyError> {
    let path = |load, u| Path::begin(problem, load, u, plan.solver.clone());
    let lost = |phase, error| Ending::Lost {
        phase,
        whereabouts: whereabouts(&problem.tube, &error, None),
        error,
        scale: Scale::of(plan.units.as_ref()).into(),
    };
    let Some(start) = &plan.start else {
        let rest = plan.tube.rest();
        let mut step = Step {
            method: Method::Rest,
            effort: Effort {
                linear_solves: 1,
                inner_iterations: 0,
            },
            damping_work: 0.0,
        };
        let mut path = match path(rest.clone(), problem.tube.start()) {
            Ok(path) => path,
            Err(broken) => {
                let attempts = vec![(Method::Rest, Failure::Evaluation(broken))];
                return Ok(Err(lost(Phase::Rest, PathError { attempts, step })));
            }
        };
        if !plan.tube.imperfections.is_empty() {
            // The state of an imperfect tube at rest is to be found, too.
            let mut relay = Relay::new(&mut *observer);
            let mut monitor = Part::new(&mut relay, "rest", 0.0, 0.0);
            path.begin_segment(rest);
            match path.advance(1.0, &mut monitor) {
                Ok(found) => step = found,
                Err(error) if error.is_cancelled() => return Ok(Err(Ending::Stopped)),
                Err(error) => return Ok(Err(lost(Phase::Rest, error))),
            }
        }
        record.accept("rest", &mut path, &step, true, observer)?;
        record.leave_checkpoint(None, &path, observer)?;
        return Ok(Ok(path));
    };
    let mut relay = Relay::new(&mut *observer);
    let mut monitor = Part::new(&mut relay, START, 0.0, 0.0);
    let (u, step) = match settle(plan, problem, start, &mut monitor) {
        Ok(settled) => settled,
        Err(error) if error.is_cancelled() => return Ok(Err(Ending::Stopped)),
        Err(error) => return Ok(Err(lost(Phase::Start, error))),
    };
    let mut path = match path(start.load.clone(), u) {
        Ok(path) => path,
        Err(broken) => unreachable!("a state in equilibrium is not inverted: {broken}"),
    };
    record.accept(START, &mut path, &step, true, observer)?;
    record.leave_checkpoint(None, &path, observer)?;
    Ok(Ok(path))
}

/// What the stage of a state is called from which a run starts.
const START: &str = "start";

/// Carries the state over to this mesh and brings it to equilibrium.
fn settle(
    plan: &Plan,
    problem: &TubeProblem,
    start: &Start,
    monitor: &mut dyn Monitor,
) -> Result<(Vec<f64>, Step), PathError<Inverted>> {
    let Layout { mesh, rings, .. } = &start.state.layout;
    let perfect = Tube {
        imperfections: vec![],
        ..plan.tube.clone()
    };
    let from = SplineTube::new(&perfect, mesh, *rings);
    let mut u = prolong(&from, &problem.tube, &start.state.u);
    problem.apply_prescribed(&start.load, &mut u);
    let (load, settings) = (&start.load, &plan.solver);
    let mut effort = Effort::default();
    let step = |method, damping_work, effort| Step {
        method,
        effort,
        damping_work,
    };
    let newton_failed = match newton(problem, load, u.clone(), settings, &mut effort, monitor) {
        Ok(found) => return Ok((found.u, step(Method::Newton, found.damping_work, effort))),
        Err(failed) => failed,
    };
    effort.linear_solves = 0;
    match relaxation(problem, load, u, settings, &mut effort, monitor) {
        Ok(found) => Ok((
            found.u,
            step(Method::Relaxation, found.damping_work, effort),
        )),
        Err(failed) => Err(PathError {
            attempts: vec![
                (Method::Newton, newton_failed),
                (Method::Relaxation, failed),
            ],
            step: step(Method::Relaxation, 0.0, effort),
        }),
    }
}

/// Where the imperfections of a tube fold its wall over, so that it is no wall any more; none if they
/// do not.
pub fn folded(tube: &Tube, mesh: &Mesh, symmetry: Symmetry) -> Option<Inverted> {
    let perfect = Tube {
        imperfections: vec![],
        ..tube.clone()
    };
    let perfect = SplineTube::new(&perfect, mesh, mesh.rings(symmetry));
    perfect.can_have(&tube.imperfections).err()
}
