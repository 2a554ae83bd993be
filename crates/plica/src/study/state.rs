//! An accepted state of a study.

use super::work::WorkPoint;
use super::{Plan, Work};
use crate::activation::Muscle;
use crate::assembly::ObstacleContact;
use crate::contact::ContactReport;
use crate::equilibrium::{Stability, TubeProblem};
use crate::measure::{Dimensions, Measures, Reaction};
use crate::solve::{Method, Step};
use crate::tube::{Load, Obstacle, Patch, Placement};

/// An accepted state of a study. Lengths in D, energies in E·D³, stresses in E.
#[derive(Clone, Debug)]
pub struct State {
    /// Number of the state, from 0 (the tube at rest, or the state the study starts from).
    pub number: usize,
    /// Name of the stage; `rest` or `start` for state 0.
    pub stage: String,
    /// True if the state is the last of its stage, or the last before the study ended early.
    pub ends_stage: bool,
    /// Fraction of the stage that is completed, 0 to 1.
    pub stage_fraction: f64,
    /// Time, in the unit of time of the case; none in a study without times.
    pub time: Option<f64>,
    /// The load.
    pub load: Load,
    /// The muscles, in the order of the tube.
    pub muscles: Vec<MuscleState>,
    /// Names of the ends at z = 0 and z = L.
    pub end_names: [String; 2],
    /// Displacements of the control points of the cyclic sector, in D; [`crate::saved_state::Layout::shape`] has
    /// the order of the indices.
    pub unknowns: Vec<f64>,
    /// History of friction ([`crate::solve::Equilibrium::history`]); empty without friction.
    pub history: Vec<f64>,
    /// Strain energy W = ∫ w det Fp dV₀ of the whole tube, over the grown volume.
    pub energy: f64,
    /// Strain energy ∫ w dV₀ of the whole tube, over the ungrown volume, as some other programs report it.
    pub energy_ungrown_volume: f64,
    /// Strain energy plus the potential of the pressures, which is zero at rest.
    pub potential: f64,
    /// Relative residual without damping.
    pub relative_residual: f64,
    /// Method by which the state was found.
    pub method: Method,
    /// True if the relative residual without damping meets the tolerance.
    pub in_equilibrium: bool,
    /// Linear solves since the previous state, including those of rejected attempts.
    pub linear_solves: usize,
    /// Iterations inside these linear solves; 0 for a direct solver.
    pub inner_iterations: usize,
    /// Wall time since the previous state, in seconds.
    pub seconds: f64,
    /// Measures of the deformed walls.
    pub measures: Measures,
    /// Sizes of the lumen and of the outer wall.
    pub dimensions: Dimensions,
    /// Pressure on the inner wall, in a study that drives the volume of the lumen in any stage.
    pub lumen_pressure: Option<f64>,
    /// True if an end leaves its axis in any stage of the study.
    pub has_sideways_ends: bool,
    /// Reactions at z = 0 and z = L.
    pub reactions: [Reaction; 2],
    /// Contact of the walls with themselves; none in a study without contact.
    pub contact: Option<ContactReport>,
    /// The obstacles, in the order of the tube.
    pub obstacles: Vec<ObstacleState>,
    /// The patches, in the order of the tube.
    pub patches: Vec<PatchState>,
    /// Energy of the foundations of the whole tube, in E·D³; none in a study without foundations.
    pub foundation_energy: Option<f64>,
    /// Work since the previous state.
    pub work: Work,
    /// Smallest det Fe at any quadrature point.
    pub min_det_fe: f64,
    /// Stability of the state.
    pub stability: Stability,
    length_ratio: f64,
    diameter_ratio: f64,
    /// Damping work of one cyclic sector.
    pub(super) sector_damping_work: f64,
    /// Number of cyclic sectors of the tube.
    pub(super) sectors: f64,
}

/// A muscle in a state.
#[derive(Clone, Debug, PartialEq)]
pub struct MuscleState {
    /// Its name in the case.
    pub name: String,
    /// Its target: Dmin/D, Lmax/L, or its tension in E.
    pub target: f64,
    /// Its growth stretch where it is furthest from one; none for a muscle with active stress.
    pub stretch: Option<f64>,
    /// Shift of its zone, in D; none if no stage moves it.
    pub shift: Option<f64>,
}

/// An obstacle in a state.
#[derive(Clone, Debug, PartialEq)]
pub struct ObstacleState {
    /// Its name in the case.
    pub name: String,
    /// Its size and place.
    pub placement: Placement,
    /// Its contact with the walls.
    pub contact: ObstacleContact,
}

/// A patch in a state.
#[derive(Clone, Debug, PartialEq)]
pub struct PatchState {
    /// Its name in the case.
    pub name: String,
    /// Stress-free thickness over the thickness at rest in its middle.
    pub growth_through: f64,
}

/// A point of a stage at which a state is accepted.
pub(super) struct Milestone<'a> {
    pub number: usize,
    pub stage: &'a str,
    pub ends_stage: bool,
    pub stage_fraction: f64,
    pub time: Option<f64>,
}

impl State {
    /// Returns the grown length over the length, Lmax/L.
    pub fn length_ratio(&self) -> f64 {
        self.length_ratio
    }

    /// Returns the narrowest grown diameter over the diameter, Dmin/D.
    pub fn diameter_ratio(&self) -> f64 {
        self.diameter_ratio
    }

    /// Returns the work done against damping since the previous state, in E·D³.
    pub fn damping_work(&self) -> f64 {
        self.sectors * self.sector_damping_work
    }

    /// Evaluates an equilibrium of a branch, which belongs to no stage.
    pub fn of_branch(
        (plan, problem): (&Plan, &TubeProblem),
        number: usize,
        accepted: &crate::solve::State<Load>,
        stability: Stability,
    ) -> Self {
        let at = Milestone {
            number,
            stage: "branch",
            ends_stage: false,
            stage_fraction: 0.0,
            time: None,
        };
        let step = Step {
            method: Method::Newton,
            effort: Default::default(),
            damping_work: 0.0,
        };
        Self::evaluate((plan, problem), None, &at, accepted, &step, stability, 0.0).0
    }

    /// Evaluates an equilibrium that the solver has accepted. Returns what the work to the next state is computed from, too.
    pub(super) fn evaluate(
        (plan, problem): (&Plan, &TubeProblem),
        previous: Option<&WorkPoint>,
        at: &Milestone<'_>,
        accepted: &crate::solve::State<Load>,
        step: &Step,
        stability: Stability,
        seconds: f64,
    ) -> (Self, WorkPoint) {
        let tube = &problem.tube;
        // The solver has evaluated the energy of this state already.
        let Ok(forces) = problem.forces_on_tube(&accepted.load, &accepted.u) else {
            unreachable!("an accepted state is not inverted")
        };
        let above_rounding = |energy: f64| {
            let tube = &plan.tube;
            let rounding = 1e-15 * tube.longitudinal_modulus() * tube.thickness * tube.length;
            if energy.abs() < rounding { 0.0 } else { energy }
        };
        let (load, u) = (&accepted.load, &accepted.u);
        let mut point = WorkPoint::of(plan, problem, (load, u), &forces);
        let none = || Work::none(load);
        let contact = problem.contact_report(load, u);
        let work = previous.map_or_else(none, |previous| previous.work_to(&mut point, tube));
        let state = Self {
            number: at.number,
            stage: at.stage.to_owned(),
            ends_stage: at.ends_stage,
            muscles: muscles(plan, &accepted.load),
            end_names: plan.end_names.clone(),
            stage_fraction: at.stage_fraction,
            time: at.time,
            energy: above_rounding(forces.energy),
            energy_ungrown_volume: above_rounding(forces.energy_ungrown),
            potential: above_rounding(forces.potential),
            relative_residual: accepted.relative_residual,
            method: step.method,
            in_equilibrium: accepted.in_equilibrium() || step.method == Method::Rest,
            linear_solves: step.effort.linear_solves,
            inner_iterations: step.effort.inner_iterations,
            seconds,
            measures: measures(problem, load, u, contact.as_ref()),
            dimensions: dimensions(problem, load, u),
            lumen_pressure: plan.drives_lumen().then_some(load.pressures[0].follower),
            has_sideways_ends: plan.has_sideways_ends(),
            reactions: Reaction::of(tube, load, u, &forces.residual),
            contact,
            obstacles: obstacles(plan, load, point.contacts()),
            patches: patches(plan, load),
            foundation_energy: (!plan.tube.foundations.is_empty()).then_some(forces.foundation),
            work,
            min_det_fe: forces.smallest_jacobian,
            stability,
            length_ratio: plan.tube.length_ratio(&accepted.load),
            diameter_ratio: plan.tube.diameter_ratio(&accepted.load),
            sector_damping_work: step.damping_work,
            sectors: tube.sector.repeats(),
            load: accepted.load.clone(),
            unknowns: accepted.u.clone(),
            history: vec![],
        };
        (state, point)
    }
}

/// Measures a state. Between the points of a measured wall, its chords can cross where it touches itself; with contact
/// the exact curves decide, and the gap is that of the points in contact.
fn measures(
    problem: &TubeProblem,
    load: &Load,
    u: &[f64],
    contact: Option<&ContactReport>,
) -> Measures {
    let mut measures = Measures::of(&problem.tube, load, u);
    if let (true, Some(report), Some(exact)) = (measures.gap == 0.0, contact, &problem.contact)
        && exact.crossing(u).is_none()
    {
        let gaps = report.faces.iter().flatten().map(|face| face.gap);
        measures.gap = gaps.fold(exact.barrier().range, f64::min);
    }
    measures
}

/// Measures the sizes of a state. A driven volume is the driven value: the quadrature of the pressure differs a little from
/// the exact volume.
fn dimensions(problem: &TubeProblem, load: &Load, u: &[f64]) -> Dimensions {
    let mut dimensions = Dimensions::of(&problem.tube, u);
    if let (Some(ratio), Some(at_rest)) = (load.lumen_volume, problem.driven_lumen_at_rest()) {
        dimensions.lumen_volume = ratio * at_rest;
    }
    dimensions
}

/// Returns the obstacles of a plan under a load.
fn obstacles(plan: &Plan, load: &Load, contacts: &[ObstacleContact]) -> Vec<ObstacleState> {
    let obstacles = plan.tube.obstacles.iter().zip(&load.obstacles);
    let state = |((obstacle, placement), contact): ((&Obstacle, &Placement), &ObstacleContact)| {
        ObstacleState {
            name: obstacle.name.clone(),
            placement: *placement,
            contact: contact.clone(),
        }
    };
    obstacles.zip(contacts).map(state).collect()
}

/// Returns the patches of a plan under a load.
fn patches(plan: &Plan, load: &Load) -> Vec<PatchState> {
    let patches = plan.tube.patches.iter().zip(&load.patches);
    let state = |(patch, &growth_through): (&Patch, &f64)| PatchState {
        name: patch.name.clone(),
        growth_through,
    };
    patches.map(state).collect()
}

/// Returns the muscles of a plan under a load.
fn muscles(plan: &Plan, load: &Load) -> Vec<MuscleState> {
    let state = |(m, muscle): (usize, &Muscle)| MuscleState {
        name: muscle.name.clone(),
        target: load.muscles[m],
        stretch: muscle
            .grows()
            .then(|| muscle.extreme_stretch(load.muscles[m], plan.tube.length)),
        shift: plan.shifts_muscle(m).then_some(load.shifts[m]),
    };
    plan.tube.muscles.iter().enumerate().map(state).collect()
}
