//! Writes every accepted state down: its row, its walls, itself, and what it takes to go on from it.

use super::checkpoint::Digest;
use super::observer::Relay;
use super::units::Scale;
use super::{
    Checkpoint, Layout, Observer, Plan, Row, RunDirectory, SavedState, Snapshot, StudyError,
};
use crate::assembly::SplineTube;
use crate::equilibrium::{TubeProblem, unstable_modes};
use crate::measure::{Asymmetry, Face, Measures, Meridians};
use crate::monitor::Part;
use crate::solve::{Method, Path, Step};
use std::collections::BTreeMap;
use std::time::Instant;

/// What was accepted so far.
pub(super) struct Record<'a> {
    plan: &'a Plan,
    problem: &'a TubeProblem,
    pub directory: &'a mut RunDirectory,
    scale: Scale,
    pub rows: Vec<Row>,
    digest: Digest,
    pub snapshots: Vec<Option<Snapshot>>,
    since: Instant,
}

impl<'a> Record<'a> {
    pub fn new(plan: &'a Plan, problem: &'a TubeProblem, directory: &'a mut RunDirectory) -> Self {
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
    pub fn accept(
        &mut self,
        stage: &str,
        path: &mut Path<&TubeProblem>,
        step: &Step,
        last: bool,
        observer: &mut dyn Observer,
    ) -> Result<(), StudyError> {
        let harmonics = self.plan.output.stability_modes;
        let mut relay = Relay::new(observer);
        let mut monitor = Part::new(&mut relay, "testing stability", 0.0, 0.0);
        let unstable_modes = unstable_modes(self.problem, path, harmonics, &mut monitor);
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
            inner_dead_load: pressure(inner.dead),
            outer_dead_load: pressure(outer.dead),
            potential: pressed.then_some(energy * self.above_rounding(forces.potential)),
            energy: energy * self.above_rounding(forces.energy),
            energy_ungrown_volume: energy * self.above_rounding(forces.energy_ungrown),
            residual: state.relative_residual,
            damping_work: energy * tube.sector.repeats() * step.damping_work,
            method: step.method.to_string(),
            equilibrium: if state.in_equilibrium() || step.method == Method::Rest {
                "yes"
            } else {
                "no"
            }
            .into(),
            iterations: step.effort.linear_solves,
            cg_iterations: step.effort.inner_iterations,
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
            asymmetry: length * measures.asymmetry.amplitude,
            asymmetry_mode: measures.asymmetry.harmonic,
            asymmetry_angle_deg: measures.asymmetry.crest.to_degrees(),
            min_det_fe: forces.smallest_jacobian,
            unstable_modes,
        };
        self.directory.record(&row)?;
        let every = self.plan.output.profiles_every;
        if every > 0 && (last || row.step.is_multiple_of(every)) {
            self.write_profile(row.step, path, measures.asymmetry)?;
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

    /// The tube that is followed.
    pub fn tube(&self) -> &SplineTube {
        &self.problem.tube
    }

    /// An energy, or zero where it is only what rounding leaves of a tube without stress.
    fn above_rounding(&self, energy: f64) -> f64 {
        let tube = &self.plan.tube;
        let rounding = 1e-15 * tube.material.longitudinal_modulus() * tube.thickness * tube.length;
        if energy.abs() < rounding { 0.0 } else { energy }
    }

    /// What was accepted before the run was left.
    pub fn restore(&mut self, rows: Vec<Row>, observer: &mut dyn Observer) {
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
    pub fn leave_checkpoint(
        &self,
        stage: Option<usize>,
        path: &Path<&TubeProblem>,
        observer: &mut dyn Observer,
    ) -> Result<bool, StudyError> {
        let Some(row) = self.rows.last().filter(|_| !observer.stop()) else {
            return Ok(false);
        };
        self.directory.write_checkpoint(Checkpoint {
            state: self.saved(row, path),
            stage,
            memory: path.continuation_state(),
            history: self.digest.finish(),
        })?;
        Ok(true)
    }

    fn saved(&self, row: &Row, path: &Path<&TubeProblem>) -> SavedState {
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
        path: &Path<&TubeProblem>,
        asymmetry: Asymmetry,
    ) -> Result<(), StudyError> {
        let (tube, state) = (&self.problem.tube, path.state());
        let z = tube.axial.spread(self.plan.output.wall_points);
        let meridians = Meridians::of(tube, &state.load, &state.u);
        let both = asymmetry.crest_and_trough();
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
