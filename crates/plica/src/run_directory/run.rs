//! A study that writes every state into a run directory.

use super::manifest::Manifest;
use super::resume::list;
use super::{
    Checkpoint, Record, RunDirectory, RunError, START, Snapshot, Summary, imperfection, materials,
    name_of_profile, name_of_temporary_state,
};
use crate::contact::{self, PressureField};
use crate::measure::{Face, Meridians};
use crate::monitor::{Monitor, Part};
use crate::saved_state::{Array, FRICTION, SavedState};
use crate::study::{Condition, Ending, Plan, Row, Scale, State, Study, StudyError, half_range};
use std::collections::BTreeSet;

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
    /// Record of the rows and files written so far, for the next checkpoint.
    record: Record,
    /// Files that were missing or damaged when the run was resumed.
    missing: Vec<String>,
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
        let mut inputs = vec![];
        for mode in &plan.modes {
            inputs.push((imperfection(mode.imperfection), &mode.state));
        }
        inputs.extend(
            plan.start
                .iter()
                .map(|start| (START.to_owned(), &start.state)),
        );
        let mut record = Record::default();
        for (name, state) in inputs {
            let bytes = directory.state_bytes(&name, state)?;
            directory.write(&name, &bytes)?;
            record.add_file(&name, &bytes);
        }
        for (i, library) in plan.materials.iter().enumerate() {
            let name = materials(i + 1);
            directory.write(&name, library.text.as_bytes())?;
            record.add_file(&name, library.text.as_bytes());
        }
        let manifest = Manifest::begin(plan, directory);
        directory.write_manifest(&manifest)?;
        let mut run = Self::new(plan, study, directory, manifest);
        run.record = record;
        Ok(run)
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
            monitor
                .notice("the run has no checkpoint and at most its first state; it begins again");
            directory.truncate(&[])?;
            return Self::begin(plan, directory);
        }
        let found = directory.checkpoint(plan)?;
        for why in &found.faults {
            monitor.notice(&format!(
                "not used: {why}; resuming from the checkpoint before"
            ));
        }
        if !found.faults.is_empty() {
            directory.remove_newest_checkpoint()?;
        }
        if !found.restored.is_empty() {
            monitor.notice(&format!(
                "history.csv was damaged or incomplete at state {}; restored from the checkpoint",
                list(&found.restored)
            ));
        }
        let checkpoint = found.checkpoint;
        let number = checkpoint.state.row;
        let mut record = checkpoint.record.clone();
        let mut missing = vec![];
        for (name, fault) in record.damaged(directory.path()) {
            monitor.notice(&format!(
                "warning: {} is {fault}; it is not computed again",
                directory.path().join(&name).display()
            ));
            missing.push(name);
        }
        let mut rows = found.rows;
        if found.has_later_rows && directory.clear_stability()? {
            monitor.notice(
                "the results of `plica stability` are removed: they cover states that are computed again",
            );
        }
        if plan.has_pressures() {
            rows = rows.into_iter().map(Row::with_pressures).collect();
            if plan.drives_lumen() {
                rows = rows.into_iter().map(Row::with_lumen_pressure).collect();
            }
            record.replace_rows(&rows);
        }
        if plan.has_sideways_ends() {
            rows = rows.into_iter().map(Row::with_sideways_ends).collect();
            record.replace_rows(&rows);
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
        (run.record, run.missing) = (record, missing);
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
            record: Record::default(),
            missing: vec![],
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
        self.rows = rows;
    }

    /// Computes the next state and writes it. Returns its row; none when the run has ended.
    ///
    /// # Errors
    /// [`RunError::File`] if a file cannot be written, [`RunError::NotFinite`] if a result is NaN or infinite.
    pub fn next_row(&mut self, monitor: &mut dyn Monitor) -> Result<Option<&Row>, RunError> {
        let state = match self.study.next_state(monitor) {
            Some(Ok(state)) => state,
            Some(Err(StudyError::Lost(_))) | None => {
                self.halve_contact_range(monitor);
                return Ok(None);
            }
            Some(Err(error)) => return Err(error.into()),
        };
        // A file may not be found because the directory has just been moved.
        let written = self.write(&state, monitor).map_err(|error| match error {
            RunError::File { .. } => self.directory.check_place().err().unwrap_or(error),
            error => error,
        });
        if let Err(error @ RunError::NotFinite { .. }) = &written {
            self.manifest.fail(error, &self.rows);
            self.directory.write_manifest(&self.manifest)?;
        }
        written?;
        Ok(self.rows.last())
    }

    /// Compares the last state of a complete run, if it touches something, with that of half the range of contact.
    fn halve_contact_range(&mut self, monitor: &mut dyn Monitor) {
        let touches = self.rows.last().is_some_and(|row| {
            row.contact.touches() || row.obstacles.iter().any(|obstacle| obstacle.area > 0.0)
        });
        let is_complete = self.study.ending() == Some(&Ending::Complete);
        if let Some(at) = self.study.continuation().filter(|_| touches && is_complete) {
            let monitor = &mut Part::new(monitor, "halving the range of contact", 1.0, 0.0);
            self.manifest.half_contact_range =
                half_range(self.plan, &at.load, &at.unknowns, monitor);
        }
    }

    /// Ends the run after the last state, which fulfils the condition at which it was to stop. The run is complete, and can be
    /// resumed.
    pub fn stop_at(&mut self, condition: &Condition) {
        self.manifest.until = Some(condition.to_string());
    }

    /// Closes the manifest and returns the result.
    ///
    /// # Errors
    /// [`RunError::File`] if the manifest cannot be written; [`RunError::Moved`], [`RunError::Changed`] or
    /// [`RunError::Incomplete`] if the directory or files in it were removed or changed while the run wrote them.
    pub fn finish(mut self) -> Result<Summary, RunError> {
        let ending = match self.manifest.until {
            Some(_) => Ending::Complete,
            None => self.study.ending().cloned().unwrap_or(Ending::Stopped),
        };
        let changed = self.restore_files()?;
        let missing = self.record.missing(self.directory.path());
        self.manifest.end(&ending, &self.rows);
        let names = missing.iter().map(|(name, _)| name);
        let names = names.chain(&self.missing).cloned();
        self.manifest.missing_files = BTreeSet::from_iter(names).into_iter().collect();
        self.directory.write_manifest(&self.manifest)?;
        if let Some(error) = changed {
            return Err(error);
        }
        let is_new = |(name, _): &(String, _)| !self.missing.contains(name);
        let files: Vec<_> = missing.into_iter().filter(is_new).collect();
        if !files.is_empty() {
            return Err(RunError::Incomplete {
                path: self.directory.path().to_owned(),
                files,
            });
        }
        Ok(Summary::new(
            self.plan,
            self.rows,
            self.snapshots,
            ending,
            self.directory.path(),
        )
        .with_half_range(self.manifest.half_contact_range))
    }

    /// Writes files again that another program has removed or changed; returns the error that stops the run.
    fn restore_files(&mut self) -> Result<Option<RunError>, RunError> {
        match self.directory.check_files() {
            Ok(()) => Ok(None),
            Err(error @ RunError::Changed(_)) => {
                self.directory.restore(&self.rows)?;
                Ok(Some(error))
            }
            Err(error) => Err(error),
        }
    }

    /// Writes the walls, the unknowns and the row of a state, and a checkpoint. Nothing of a state with a number that is not
    /// finite is written.
    fn write(&mut self, state: &State, monitor: &mut dyn Monitor) -> Result<(), RunError> {
        let mut row = Row::new(state, &self.scale, self.has_pressures, self.rows.last());
        if self
            .rows
            .first()
            .is_some_and(|row| row.lumen_pressure.is_some())
        {
            row = row.with_lumen_pressure();
        }
        let first = self.rows.first();
        if first.is_some_and(|row| row.ends[0].sideways.is_some()) {
            row = row.with_sideways_ends();
        }
        let table = self.directory.row_table(&row)?;
        let output = &self.plan.output;
        let is_due =
            |every: usize| every > 0 && (state.ends_stage || row.step.is_multiple_of(every));
        let mut files = vec![];
        if is_due(output.profiles_every) {
            let name = name_of_profile(state.number);
            files.push((self.profile(&name, state)?, name));
        }
        let mut temporary = None;
        if is_due(output.states_every) {
            let name = RunDirectory::name_of_state(state.number);
            files.push((self.directory.state_bytes(&name, &self.saved(state))?, name));
        } else if output.pictures {
            let name = name_of_temporary_state(state.number);
            temporary = Some((self.directory.state_bytes(&name, &self.saved(state))?, name));
        }
        let changed = self.restore_files()?;
        for (bytes, name) in &files {
            self.directory.write(name, bytes)?;
            self.record.add_file(name, bytes);
        }
        if let Some((bytes, name)) = temporary {
            self.directory.write(&name, &bytes)?;
        }
        self.directory.append_row(&table)?;
        if output.pictures {
            self.snapshots.push(Some(Snapshot {
                load: state.load.clone(),
                u: state.unknowns.clone(),
            }));
        }
        self.record.add_row(&row);
        self.rows.push(row);
        if monitor.is_cancelled() {
            // The stability test of the state may have been cut short, so it is computed again when the run is resumed.
            self.study.stop();
        } else if let Some(continuation) = self.study.continuation() {
            self.directory.write_checkpoint(Checkpoint {
                state: self.saved(state),
                stage: continuation.stage,
                path: continuation.path,
                record: self.record.clone(),
            })?;
        }
        match changed {
            None => Ok(()),
            Some(error) => {
                self.manifest.halt(&error, &self.rows);
                self.directory.write_manifest(&self.manifest)?;
                Err(error)
            }
        }
    }

    fn saved(&self, state: &State) -> SavedState {
        let muscles = self.plan.tube.muscles.iter();
        let obstacles = self.plan.tube.obstacles.iter();
        let patches = self.plan.tube.patches.iter();
        let history = (!state.history.is_empty()).then(|| {
            let array = Array {
                shape: vec![state.history.len()],
                values: state.history.clone(),
            };
            (FRICTION.to_owned(), array)
        });
        SavedState {
            stage: state.stage.clone(),
            row: state.number,
            along: state.stage_fraction,
            muscles: muscles.map(|m| (m.name.clone(), m.target())).collect(),
            obstacles: obstacles.map(|obstacle| obstacle.name.clone()).collect(),
            patches: patches.map(|patch| patch.name.clone()).collect(),
            load: state.load.clone(),
            layout: self.plan.layout(),
            u: state.unknowns.clone(),
            arrays: history.into_iter().collect(),
        }
    }

    /// Returns the table of the walls of a state: one meridian or, if the tube is not axisymmetric, those at crest and trough.
    fn profile(&self, name: &str, state: &State) -> Result<Vec<u8>, RunError> {
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
        let (length, stress) = (self.scale.length, self.scale.stress);
        let pressure = self.study.problem().contact_pressure(&state.unknowns);
        let faces = [contact::Face::Outer, contact::Face::Inner];
        let pressures = |z: f64| -> Vec<f64> {
            let places = angles
                .iter()
                .flat_map(|angle| faces.map(|face| (face, *angle)));
            let of = |field: &PressureField<'_>| {
                places
                    .map(|(face, angle)| stress * field.at(face, z, angle))
                    .collect()
            };
            pressure.as_ref().map(of).unwrap_or_default()
        };
        let rows = (0..z.len()).map(|i| {
            let mut row = vec![length * z[i]];
            for (outer, inner) in outer.iter().zip(&inner) {
                let (a, b) = (outer.points[i], inner.points[i]);
                row.extend([a.0, a.1, b.0, b.1].map(|x| length * x));
            }
            row.extend(pressures(z[i]));
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
        let mut header = header[..1 + 4 * angles.len()].to_vec();
        if self.plan.contact {
            let names = [
                "outer_contact_pressure",
                "inner_contact_pressure",
                "trough_outer_contact_pressure",
                "trough_inner_contact_pressure",
            ];
            header.extend(&names[..2 * angles.len()]);
        }
        self.directory.table(name, &header, rows)
    }
}
