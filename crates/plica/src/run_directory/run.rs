//! A study that writes every state into a run directory.

use super::checkpoint::{Checkpoint, Digest};
use super::manifest::Manifest;
use super::{RunDirectory, RunError, Snapshot, Summary};
use crate::measure::{Face, Meridians};
use crate::monitor::Monitor;
use crate::saved_state::SavedState;
use crate::study::{Ending, Plan, Row, Scale, State, Study, StudyError};
use std::collections::BTreeMap;

/// A study and the run directory that its states are written to.
///
/// When [`Run::next_row`] returns, the row of the state is on disk, with the files that the case asks for and a checkpoint. A
/// state at which the run is cancelled or lost has no checkpoint; resuming computes it again.
pub struct Run<'a> {
    plan: &'a Plan,
    study: Study,
    directory: &'a mut RunDirectory,
    manifest: Manifest,
    scale: Scale,
    has_pressures: bool,
    rows: Vec<Row>,
    snapshots: Vec<Option<Snapshot>>,
    digest: Digest,
}

/// Runs a plan in a run directory to its end, or as far as the tube can be followed.
///
/// # Errors
/// As [`Run::begin`] and [`Run::next_row`].
pub fn run(
    plan: &Plan,
    directory: &mut RunDirectory,
    monitor: &mut dyn Monitor,
) -> Result<Summary, RunError> {
    let mut run = Run::begin(plan, directory)?;
    while run.next_row(monitor)?.is_some() {}
    run.finish()
}

impl<'a> Run<'a> {
    /// Begins a run.
    ///
    /// # Errors
    /// [`RunError::Study`] if the study cannot begin, [`RunError::Busy`] if another process works in the directory,
    /// [`RunError::File`] if a file cannot be written.
    pub fn begin(plan: &'a Plan, directory: &'a mut RunDirectory) -> Result<Self, RunError> {
        let study = Study::new(plan)?;
        directory.lock()?;
        // Before the first state, so that a run with a state has all that it started from.
        for mode in &plan.modes {
            directory.write_imperfection(mode)?;
        }
        if let Some(start) = &plan.start {
            directory.write_start(&start.state)?;
        }
        let manifest = Manifest::begin(plan, directory);
        directory.write_manifest(&manifest)?;
        Ok(Self::new(plan, study, directory, manifest))
    }

    /// Resumes a run after its last checkpoint, or after the one before if the last is damaged. States beyond the checkpoint
    /// are computed again. The result is the same to the bit as without the interruption. A run that has no checkpoint
    /// because it had hardly begun begins again.
    ///
    /// The plan may differ from the one that was begun in what [`crate::study::forbidden_changes`] allows.
    ///
    /// # Errors
    /// [`RunError::NoCheckpoint`] if there is no checkpoint that fits; else as [`Run::begin`].
    pub fn resume(
        plan: &'a Plan,
        directory: &'a mut RunDirectory,
        monitor: &mut dyn Monitor,
    ) -> Result<Self, RunError> {
        crate::study::check_memory(plan)?;
        directory.lock()?;
        if directory.has_hardly_begun() {
            monitor.notice("the run had hardly begun; it begins again");
            directory.truncate(&[])?;
            return Self::begin(plan, directory);
        }
        let (rows, _) = directory.readable_history()?;
        let (checkpoint, damaged) = directory.checkpoint(plan, &rows)?;
        for why in &damaged {
            monitor.notice(&format!(
                "not used: {why}; resuming from the checkpoint before"
            ));
        }
        if !damaged.is_empty() {
            directory.remove_newest_checkpoint()?;
        }
        let number = checkpoint.state.row;
        let recorded = rows.len();
        let mut rows = rows[..=number].to_vec();
        if rows.len() < recorded {
            // Its results cover states that are computed again.
            directory.clear_stability()?;
        }
        if plan.has_pressures() {
            rows = rows.into_iter().map(Row::with_pressures).collect();
        }
        let study = Study::resume(plan, checkpoint.into_continuation());
        let study = study.map_err(|error| match error {
            StudyError::Resume(reason) => RunError::NoCheckpoint {
                path: directory.path().to_owned(),
                reasons: vec![reason],
            },
            error => error.into(),
        })?;
        monitor.notice(&format!("resuming after state {number}"));
        let manifest = Manifest::resume(plan, directory);
        directory.write_manifest(&manifest)?;
        directory.truncate(&rows)?;
        let mut run = Self::new(plan, study, directory, manifest);
        run.restore(rows, monitor);
        Ok(run)
    }

    fn new(
        plan: &'a Plan,
        study: Study,
        directory: &'a mut RunDirectory,
        manifest: Manifest,
    ) -> Self {
        Self {
            plan,
            study,
            directory,
            manifest,
            scale: Scale::of(plan.units.as_ref()),
            has_pressures: plan.has_pressures(),
            rows: vec![],
            snapshots: vec![],
            digest: Digest::default(),
        }
    }

    /// Takes over the rows that were written before an interruption.
    fn restore(&mut self, rows: Vec<Row>, monitor: &mut dyn Monitor) {
        if self.plan.output.pictures {
            let snapshot = |row: &Row| {
                let state = self.directory.state(row.step).ok()?;
                self.plan.accepts(&state).ok()?;
                let SavedState { load, u, .. } = state;
                Some(Snapshot { load, u })
            };
            self.snapshots = rows.iter().map(snapshot).collect();
            let missing = self.snapshots.iter().filter(|one| one.is_none()).count();
            if missing > 0 {
                monitor.notice(&format!(
                    "{missing} of {} states so far are not saved and cannot be drawn",
                    rows.len()
                ));
            }
        }
        // All rows of a history have the same columns.
        self.has_pressures = rows
            .first()
            .map_or(self.has_pressures, |row| row.potential.is_some());
        self.digest = Digest::of(&rows);
        self.rows = rows;
    }

    /// Computes the next state and writes it. Returns its row; none when the run has ended.
    ///
    /// # Errors
    /// [`RunError::File`] if a file cannot be written, [`RunError::NotFinite`] if a result is NaN or infinite.
    pub fn next_row(&mut self, monitor: &mut dyn Monitor) -> Result<Option<&Row>, RunError> {
        let state = match self.study.next_state(monitor) {
            Some(Ok(state)) => state,
            Some(Err(StudyError::Lost(_))) | None => return Ok(None),
            Some(Err(error)) => return Err(error.into()),
        };
        let written = self.write(&state);
        if let Err(error @ RunError::NotFinite { .. }) = &written {
            self.manifest.fail(error, &self.rows);
            self.directory.write_manifest(&self.manifest)?;
        }
        written?;
        if monitor.is_cancelled() {
            // The stability test of the state may have been cut short, so it is computed again when the run is resumed.
            self.study.stop();
        } else if let Some(continuation) = self.study.continuation() {
            self.directory.write_checkpoint(Checkpoint {
                state: self.saved(&state),
                stage: continuation.stage,
                path: continuation.path,
                history: self.digest.finish(),
            })?;
        }
        Ok(self.rows.last())
    }

    /// Closes the manifest and returns the result.
    ///
    /// # Errors
    /// [`RunError::File`] if the manifest cannot be written.
    pub fn finish(mut self) -> Result<Summary, RunError> {
        let ending = self.study.ending().cloned().unwrap_or(Ending::Stopped);
        self.manifest.end(&ending, &self.rows);
        self.directory.write_manifest(&self.manifest)?;
        Ok(Summary::new(
            self.plan,
            self.rows,
            self.snapshots,
            ending,
            self.directory.path(),
        ))
    }

    /// Writes the row, the walls and the unknowns of a state.
    fn write(&mut self, state: &State) -> Result<(), RunError> {
        let row = Row::new(state, &self.scale, self.has_pressures, self.rows.last());
        self.directory.append_row(&row)?;
        let output = &self.plan.output;
        let is_due =
            |every: usize| every > 0 && (state.ends_stage || row.step.is_multiple_of(every));
        if is_due(output.profiles_every) {
            self.write_profile(state)?;
        }
        if is_due(output.states_every) {
            self.directory.write_state(&self.saved(state))?;
        } else if output.pictures {
            self.directory.write_temporary_state(&self.saved(state))?;
        }
        if output.pictures {
            self.snapshots.push(Some(Snapshot {
                load: state.load.clone(),
                u: state.unknowns.clone(),
            }));
        }
        self.digest.add(&row);
        self.rows.push(row);
        Ok(())
    }

    fn saved(&self, state: &State) -> SavedState {
        let muscles = self.plan.tube.muscles.iter();
        SavedState {
            stage: state.stage.clone(),
            row: state.number,
            along: state.stage_fraction,
            muscles: muscles.map(|m| (m.name.clone(), m.direction)).collect(),
            load: state.load.clone(),
            layout: self.plan.layout(),
            u: state.unknowns.clone(),
            arrays: BTreeMap::new(),
        }
    }

    /// Writes the walls of a state: one meridian or, if the tube is not axisymmetric, those at crest and trough.
    fn write_profile(&self, state: &State) -> Result<(), RunError> {
        let tube = self.study.tube();
        let z = tube.axial.positions(self.plan.output.wall_points);
        let meridians = Meridians::of(tube, &state.load, &state.unknowns);
        let both = state.measures.asymmetry.crest_and_trough();
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
        let name = format!("profiles/state-{:04}.csv", state.number);
        self.directory.write_table(&name, header, rows)
    }
}
