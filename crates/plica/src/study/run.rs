//! Leads a tube through its stages and writes down every accepted state.

use super::checkpoint::Digest;
use super::manifest::Manifest;
use super::stability::unstable_harmonics;
use super::summary::{Ending, Summary};
use super::units::Scale;
use super::{
    Checkpoint, Layout, Observer, Plan, Row, RunDirectory, SavedState, Snapshot, Start, StudyError,
    TubeProblem, forecast, prolong,
};
use crate::assembly::{Inverted, SplineTube};
use crate::measure::{Departure, Face, Measures, Meridians};
use crate::solve::{
    Equilibrium, Failure, Found, Method, Path, PathError, Step, Watch, newton, relaxation,
};
use crate::tube::{Mesh, Symmetry, Tube};
use std::collections::BTreeMap;
use std::time::Instant;

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
    let begun = match from {
        None => begin(plan, &problem, &mut record, observer)?.map(|path| (path, None)),
        Some((checkpoint, rows)) => {
            record.restore(rows, observer);
            let stage = checkpoint.stage;
            let path = take_up(plan, &problem, checkpoint);
            let path = path.map_err(|why| StudyError::NoCheckpoint {
                path: record.directory.path().to_owned(),
                reasons: vec![why],
            })?;
            Ok((path, stage))
        }
    };
    let ending = match begun {
        Ok((path, stage)) => follow(plan, path, stage, &mut record, observer)?,
        Err(ending) => ending,
    };
    let Record {
        rows, snapshots, ..
    } = record;

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
) -> Result<Path<'a, TubeProblem>, String> {
    let leg = checkpoint
        .leg(plan)
        .ok_or("its stage is none of the case's")?;
    let Checkpoint { state, memory, .. } = checkpoint;
    Path::go_on(
        problem,
        leg,
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
    mut path: Path<'_, TubeProblem>,
    within: Option<usize>,
    record: &mut Record<'_>,
    observer: &mut dyn Observer,
) -> Result<Ending, StudyError> {
    let states: usize = plan.stages.iter().map(|stage| stage.steps).sum();
    let steps_before = |stage: usize| plan.stages[..stage].iter().map(|stage| stage.steps).sum();
    for (k, stage) in plan.stages.iter().enumerate().skip(within.unwrap_or(0)) {
        let mut behind = 0;
        if within == Some(k) {
            behind = steps_behind(stage.steps, path.reached());
        } else {
            path.set_out(stage.load.clone());
        }
        let before: usize = steps_before(k);
        for n in behind + 1..=stage.steps {
            let done = before + n - 1;
            let mut watch = Relay {
                observer: &mut *observer,
                what: format!("{}, step {n} of {}", stage.name, stage.steps),
                fraction: done as f64 / states as f64,
                solves: 0,
                inner_iterations: 0,
            };
            let from = path.reached();
            match path.advance(n as f64 / stage.steps as f64, &mut watch) {
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
                    return Ok(if error.stopped() {
                        Ending::Stopped
                    } else {
                        Ending::Lost {
                            stage: stage.name.clone(),
                            error,
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
fn steps_behind(steps: usize, reached: f64) -> usize {
    let behind = |n: &usize| *n as f64 / steps as f64 <= reached;
    (1..=steps).take_while(behind).count()
}

/// The path at its first state: at rest, or at the state that the plan starts from, on this mesh and
/// in equilibrium. Where there is none the run has ended.
fn begin<'a>(
    plan: &Plan,
    problem: &'a TubeProblem,
    record: &mut Record<'_>,
    observer: &mut dyn Observer,
) -> Result<Result<Path<'a, TubeProblem>, Ending>, StudyError> {
    let path = |load, u| Path::begin(problem, load, u, plan.solver.clone());
    let lost = |stage: &str, error| Ending::Lost {
        stage: stage.to_owned(),
        error,
    };
    let Some(start) = &plan.start else {
        let rest = plan.tube.rest();
        let mut step = Step {
            method: Method::Rest,
            iterations: 1,
            inner_iterations: 0,
            drag_work: 0.0,
        };
        let mut path = match path(rest.clone(), problem.tube.start()) {
            Ok(path) => path,
            Err(broken) => {
                let tried = vec![(Method::Rest, Failure::Broken(broken))];
                return Ok(Err(lost("rest", PathError { tried, step })));
            }
        };
        if !plan.tube.imperfections.is_empty() {
            // The state of an imperfect tube at rest is to be found, too.
            let mut watch = Relay::new(observer, "rest");
            path.set_out(rest);
            match path.advance(1.0, &mut watch) {
                Ok(found) => step = found,
                Err(error) if error.stopped() => return Ok(Err(Ending::Stopped)),
                Err(error) => return Ok(Err(lost("rest", error))),
            }
        }
        record.accept("rest", &mut path, &step, true, observer)?;
        record.leave_checkpoint(None, &path, observer)?;
        return Ok(Ok(path));
    };
    let mut watch = Relay::new(observer, START);
    let (u, step) = match settle(plan, problem, start, &mut watch) {
        Ok(settled) => settled,
        Err(error) if error.stopped() => return Ok(Err(Ending::Stopped)),
        Err(error) => return Ok(Err(lost(START, error))),
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
    watch: &mut Relay<'_>,
) -> Result<(Vec<f64>, Step), PathError<Inverted>> {
    let Layout { mesh, rings, .. } = &start.state.layout;
    let perfect = Tube {
        imperfections: vec![],
        ..plan.tube.clone()
    };
    let from = SplineTube::new(&perfect, mesh, *rings);
    let mut u = prolong(&from, &problem.tube, &start.state.u);
    problem.impose(&start.load, &mut u);
    let (load, settings) = (&start.load, &plan.solver);
    let step = |method, found: &Found, inner_iterations| Step {
        method,
        iterations: found.iterations,
        inner_iterations,
        drag_work: found.drag_work,
    };
    let newton_failed = match newton(problem, load, u.clone(), settings, watch) {
        Ok(found) => {
            let step = step(Method::Newton, &found, watch.inner_iterations);
            return Ok((found.u, step));
        }
        Err(failed) => failed,
    };
    match relaxation(problem, load, u, settings, watch) {
        Ok(found) => {
            let step = step(Method::Relaxation, &found, watch.inner_iterations);
            Ok((found.u, step))
        }
        Err(failed) => Err(PathError {
            tried: vec![
                (Method::Newton, newton_failed),
                (Method::Relaxation, failed),
            ],
            step: Step {
                method: Method::Relaxation,
                iterations: 0,
                inner_iterations: watch.inner_iterations,
                drag_work: 0.0,
            },
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

/// Refuses a study that the free memory of the machine does not hold, where the system tells
/// (Linux). [`run`] asks this too; ask first if something would be lost by then.
pub fn fits(plan: &Plan) -> Result<(), StudyError> {
    let (needed, Some(available)) = (forecast::memory_bytes(plan), available_memory()) else {
        return Ok(());
    };
    if needed > available {
        let gib = |bytes: u64| bytes as f64 / (1_u64 << 30) as f64;
        return Err(StudyError::Memory {
            needed_gib: gib(needed),
            available_gib: gib(available),
        });
    }
    Ok(())
}

/// Free memory in bytes, where the system tells (Linux).
fn available_memory() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = text
        .lines()
        .find(|line| line.starts_with("MemAvailable:"))?;
    line.split_whitespace()
        .nth(1)?
        .parse::<u64>()
        .ok()
        .map(|kib| kib * 1024)
}

/// What was accepted so far.
struct Record<'a> {
    plan: &'a Plan,
    problem: &'a TubeProblem,
    directory: &'a mut RunDirectory,
    scale: Scale,
    rows: Vec<Row>,
    digest: Digest,
    snapshots: Vec<Option<Snapshot>>,
    since: Instant,
}

impl<'a> Record<'a> {
    fn new(plan: &'a Plan, problem: &'a TubeProblem, directory: &'a mut RunDirectory) -> Self {
        let scale = Scale::of(plan.units.as_ref());
        let since = Instant::now();
        Self {
            plan,
            problem,
            directory,
            scale,
            rows: vec![],
            digest: Digest::default(),
            snapshots: vec![],
            since,
        }
    }

    /// Writes a state down: its row, and its walls and itself if they are wanted.
    fn accept(
        &mut self,
        stage: &str,
        path: &mut Path<'_, TubeProblem>,
        step: &Step,
        last: bool,
        observer: &mut dyn Observer,
    ) -> Result<(), StudyError> {
        let harmonics = self.plan.output.harmonics;
        let mut goes_on = || !observer.stop();
        let unstable_harmonics = unstable_harmonics(self.problem, path, harmonics, &mut goes_on);
        let (tube, state) = (&self.problem.tube, path.state());
        // The state was accepted, so its energy exists.
        let Ok(forces) = tube.forces(&state.load, &state.u) else {
            unreachable!("an accepted state is not inverted")
        };
        let measures = Measures::of(tube, &state.load, &state.u);
        let (length, energy) = (self.scale.length, self.scale.energy);
        let [inner, outer] = state.load.pressures;
        // All rows have the same columns.
        let of_rows = self.rows.first().map(|row| row.potential.is_some());
        let pressed = of_rows.unwrap_or(self.plan.is_pressed());
        let pressure = |p: f64| pressed.then_some(self.scale.stress * p);
        let row = Row {
            step: self.rows.len(),
            stage: stage.to_owned(),
            length_ratio: self.plan.tube.length_ratio(&state.load),
            diameter_ratio: self.plan.tube.diameter_ratio(&state.load),
            colon_displacement: length * state.load.ends[0].displacement,
            ileum_displacement: length * state.load.ends[1].displacement,
            colon_twist_deg: state.load.ends[0].twist.to_degrees(),
            ileum_twist_deg: state.load.ends[1].twist.to_degrees(),
            inner_pressure: pressure(inner.follower),
            outer_pressure: pressure(outer.follower),
            inner_dead_pressure: pressure(inner.dead),
            outer_dead_pressure: pressure(outer.dead),
            potential: pressed.then_some(energy * self.above_rounding(forces.potential)),
            energy: energy * self.above_rounding(forces.energy),
            energy_ungrown_volume: energy * self.above_rounding(forces.energy_ungrown),
            residual: state.imbalance,
            drag_work: energy * tube.sector.repeats() * step.drag_work,
            method: step.method.to_string(),
            equilibrium: if state.in_equilibrium() || step.method == Method::Rest {
                "yes"
            } else {
                "no"
            }
            .into(),
            iterations: step.iterations,
            cg_iterations: step.inner_iterations,
            seconds: self.since.elapsed().as_secs_f64(),
            outer_radius_min: length * measures.outer_radius_min,
            z_at_min: length * measures.z_at_min,
            max_wall_angle_deg: measures.max_wall_angle_deg,
            overhang: length * measures.overhang,
            side: measures.side.to_string(),
            flatness: measures.flatness,
            gap: length * measures.gap,
            lumen: length * measures.lumen,
            shape: measures.shape.to_string(),
            departure: length * measures.departure.amplitude,
            departure_harmonic: measures.departure.harmonic,
            departure_angle_deg: measures.departure.crest.to_degrees(),
            min_det_fe: forces.smallest_jacobian,
            unstable_harmonics,
        };
        self.directory.record(&row)?;
        let every = self.plan.output.profiles_every;
        if every > 0 && (last || row.step.is_multiple_of(every)) {
            self.write_profile(row.step, path, measures.departure)?;
        }
        let every = self.plan.output.states_every;
        if every > 0 && (last || row.step.is_multiple_of(every)) {
            self.directory.write_state(&self.saved(&row, path))?;
        } else if self.plan.output.pictures {
            self.directory.write_spare(&self.saved(&row, path))?;
        }
        if self.plan.output.pictures {
            self.snapshots.push(Some(Snapshot {
                load: state.load.clone(),
                u: state.u.clone(),
            }));
        }
        observer.accepted(&row);
        self.digest.add(&row);
        self.rows.push(row);
        self.since = Instant::now();
        Ok(())
    }

    /// An energy, or zero where it is only what rounding leaves of a tube without stress.
    fn above_rounding(&self, energy: f64) -> f64 {
        let tube = &self.plan.tube;
        let rounding = 1e-15 * tube.material.longitudinal_modulus() * tube.thickness * tube.length;
        if energy.abs() < rounding { 0.0 } else { energy }
    }

    /// What was accepted before the run was left.
    fn restore(&mut self, rows: Vec<Row>, observer: &mut dyn Observer) {
        if self.plan.output.pictures {
            let snapshot = |row: &Row| {
                let state = self.directory.state(row.step).ok()?;
                state.belongs_to(self.plan).ok()?;
                let SavedState { load, u, .. } = state;
                Some(Snapshot { load, u })
            };
            self.snapshots = rows.iter().map(snapshot).collect();
            let missing = self.snapshots.iter().filter(|one| one.is_none()).count();
            if missing > 0 {
                observer.noticed(&format!(
                    "{missing} of {} states so far are not saved, and cannot be drawn",
                    rows.len()
                ));
            }
        }
        self.digest = Digest::of(&rows);
        self.rows = rows;
    }

    /// Leaves what it takes to go on from the last accepted state, in a stage or before the first; says whether. Not where someone
    /// has asked to stop: what was to be found out about the state may have been cut short, so that it is to be found again.
    fn leave_checkpoint(
        &self,
        stage: Option<usize>,
        path: &Path<'_, TubeProblem>,
        observer: &mut dyn Observer,
    ) -> Result<bool, StudyError> {
        let Some(row) = self.rows.last().filter(|_| !observer.stop()) else {
            return Ok(false);
        };
        self.directory.write_checkpoint(Checkpoint {
            state: self.saved(row, path),
            stage,
            memory: path.memory(),
            history: self.digest.finish(),
        })?;
        Ok(true)
    }

    fn saved(&self, row: &Row, path: &Path<'_, TubeProblem>) -> SavedState {
        let muscles = self.plan.tube.muscles.iter();
        SavedState {
            stage: row.stage.clone(),
            row: row.step,
            along: path.reached(),
            muscles: muscles.map(|m| (m.name.clone(), m.direction)).collect(),
            load: path.state().load.clone(),
            layout: Layout::of(self.plan),
            u: path.state().u.clone(),
            arrays: BTreeMap::new(),
        }
    }

    /// The walls of a state: one meridian, or where they differ those at crest and trough.
    fn write_profile(
        &self,
        step: usize,
        path: &Path<'_, TubeProblem>,
        departure: Departure,
    ) -> Result<(), StudyError> {
        let (tube, state) = (&self.problem.tube, path.state());
        let z = tube.axial.spread(self.plan.output.wall_points);
        let meridians = Meridians::of(tube, &state.load, &state.u);
        let both = departure.crest_and_trough();
        let angles = if tube.sector.rings == 1 {
            &both[..1]
        } else {
            &both
        };
        let [outer, inner] =
            [Face::Outer, Face::Inner].map(|face| meridians.walls(face, angles, &z));
        let length = self.scale.length;
        let rows = (0..z.len()).map(|i| {
            let mut row = vec![length * z[i]];
            for (outer, inner) in outer.iter().zip(&inner) {
                let (a, b) = (outer.points[i], inner.points[i]);
                row.extend([a.0, a.1, b.0, b.1].map(|x| length * x));
            }
            row
        });
        let header = [
            "reference_z",
            "outer_z",
            "outer_r",
            "inner_z",
            "inner_r",
            "trough_outer_z",
            "trough_outer_r",
            "trough_inner_z",
            "trough_inner_r",
        ];
        let header = &header[..1 + 4 * angles.len()];
        self.directory
            .write_table(&format!("profiles/state-{step:04}.csv"), header, rows)
    }
}

/// Tells an observer of every solve.
struct Relay<'a> {
    observer: &'a mut dyn Observer,
    what: String,
    fraction: f64,
    solves: usize,
    inner_iterations: usize,
}

impl<'a> Relay<'a> {
    fn new(observer: &'a mut dyn Observer, what: &str) -> Self {
        Self {
            observer,
            what: what.to_owned(),
            fraction: 0.0,
            solves: 0,
            inner_iterations: 0,
        }
    }
}

impl Watch for Relay<'_> {
    fn iterated(&mut self, inner_iterations: usize) {
        self.inner_iterations += inner_iterations;
    }
    fn iterating(&mut self) -> bool {
        !self.observer.stop()
    }
    fn solved(&mut self, method: Method, imbalance: f64) -> bool {
        self.solves += 1;
        let what = format!(
            "{}: {method}, solve {}, residual {imbalance:.1e}",
            self.what, self.solves
        );
        self.observer.working(&what, self.fraction);
        !self.observer.stop()
    }
}
