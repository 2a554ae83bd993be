//! Statements about a whole path and its stages, computed from the rows of its states.

mod contact;
mod extremes;
mod loads;
mod obstacles;
mod place;
mod pressure;
mod returned;
mod table;
#[cfg(test)]
mod tests;

pub use contact::{Contact, FirstTouch, SmallestStretch};
pub use extremes::{Extreme, Jump};
pub use loads::NamedLoad;
pub use obstacles::{LargestForce, ObstacleContacts};
pub use place::{Interval, Place};
pub use pressure::PressureExtreme;
pub use returned::Return;

use super::{Row, Scale};
use crate::equilibrium::{Stability, UnstableMode};
use crate::measure::{Shape, Side};
use crate::solve::Method;
use crate::tube::Symmetry;
use place::Path;
use serde::Serialize;
use std::collections::BTreeSet;

/// Statements about the accepted states of a path, in the units of its rows.
#[derive(Clone, Debug, Serialize)]
pub struct Findings {
    /// The stages, in order. State 0, which belongs to none, is left out.
    pub stages: Vec<StageEnd>,
    /// Minima and maxima of W inside the stages.
    pub extremes: Vec<Extreme>,
    /// True if a muscle has an active stress: W then includes the potential of its tension.
    #[serde(skip)]
    pub has_tension: bool,
    /// Maxima and minima of the pressure inside the stages, in a run that drives the volume of the lumen.
    pub pressure_extremes: Vec<PressureExtreme>,
    /// Steps made by relaxation after Newton's method had failed; the tube may have jumped to another branch.
    pub jumps: Vec<Jump>,
    /// States of square shape.
    pub square: Vec<Interval>,
    /// States whose outer wall runs back along the axis.
    pub overhanging: Vec<Interval>,
    /// Invaginated states.
    pub invaginated: Vec<Interval>,
    /// The invaginated state with the largest overhang.
    pub deepest: Option<Overhang>,
    /// Invaginated states in the order of their first ones: by the side to which they overhang if there are some to either
    /// side, and else all of them.
    pub invaginations: Vec<Invagination>,
    /// States in which a wall touches itself; none without contact.
    pub touching: Vec<Interval>,
    /// First touch, creases and their resolution on walls that may touch; none in a run without contact.
    pub contact: Option<Contact>,
    /// Contact with each obstacle, in the order of the case.
    pub obstacles: Vec<ObstacleContacts>,
    /// States in which a wall crosses itself, which is not physical.
    pub crossing: Vec<Interval>,
    /// States in which the lumen is closed, which is not physical without contact.
    pub closed: Vec<Interval>,
    /// States that are not in equilibrium.
    pub out_of_equilibrium: Vec<Interval>,
    /// States whose stability was not determined.
    pub untested: Vec<Interval>,
    /// Unstable states, by mode.
    pub unstable: Vec<Unstable>,
    /// The first state that is unstable to a mode which the symmetry of the run suppresses. A tube with a small
    /// imperfection leaves the path there.
    pub leaves: Option<Departure>,
    /// The state with the largest asymmetry.
    pub asymmetry: Option<LargestAsymmetry>,
    /// Comparison of the last state with an earlier one under the same load.
    pub returned: Option<Return>,
    /// Numbers of states and of linear solves, and the time.
    pub work: Work,
    /// Unit of lengths.
    pub length_unit: String,
    /// Unit of energies.
    pub energy_unit: String,
    /// Unit of stresses.
    pub stress_unit: String,
    /// Unit of volumes.
    pub volume_unit: String,
    /// Unit of forces.
    pub force_unit: String,
}

/// A stage and its last state.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StageEnd {
    /// Name of the stage.
    pub name: String,
    /// Numbers of its first and last state.
    pub states: [usize; 2],
    /// The loads that it changes, before its first state.
    pub from: Vec<NamedLoad>,
    /// The same loads at its last state.
    pub to: Vec<NamedLoad>,
    /// The smallest and largest values in between of those loads that leave the range from the one to the other.
    pub through: Vec<NamedLoad>,
    /// Shape of its last state.
    pub shape: Shape,
    /// Side of the overhang of its last state.
    #[serde(skip)]
    pub side: Side,
    /// Name of the end on that side, or none.
    #[serde(rename = "side")]
    pub toward: String,
    /// Overhang of its last state.
    pub overhang: f64,
    /// Strain energy of its last state.
    pub energy: f64,
}

/// A state with an overhang.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Overhang {
    /// The state.
    pub at: Place,
    /// Axial distance by which the outer wall runs back.
    pub overhang: f64,
    /// Side to which it invaginates.
    #[serde(skip)]
    pub side: Side,
    /// Name of the end on that side, or none.
    #[serde(rename = "side")]
    pub toward: String,
}

/// Invaginated states, to one side where a path has some to either side.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Invagination {
    /// The states.
    pub states: Vec<Interval>,
    /// The one with the largest overhang.
    pub deepest: Overhang,
}

/// States that are unstable to a mode.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Unstable {
    /// The circumferential mode; none for the lowest mode of states that are not axisymmetric.
    pub mode: Option<usize>,
    /// Description of the mode.
    pub description: String,
    /// The states.
    pub states: Vec<Interval>,
}

/// The place where a tube that is not perfectly symmetric leaves a path.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Departure {
    /// The first unstable state.
    pub at: Place,
    /// Description of the mode.
    pub mode: String,
}

/// The state with the largest asymmetry, beside the asymmetry of the start.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LargestAsymmetry {
    /// The state.
    pub at: Place,
    /// Amplitude of the largest wave around the outer wall.
    pub amplitude: f64,
    /// Amplitude at the first state, which the prescribed imperfections cause.
    pub at_start: f64,
    /// Circumferential mode of the wave.
    pub mode: usize,
}

/// Numbers of states and solves.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Work {
    /// Accepted states.
    pub states: usize,
    /// Linear solves.
    pub linear_solves: usize,
    /// Wall time in seconds.
    pub seconds: f64,
    /// Largest relative residual of a state that the solver found.
    pub largest_residual: f64,
}

impl Findings {
    /// Computes the findings of a path.
    pub fn of(rows: &[Row], scale: &Scale, symmetry: Symmetry) -> Self {
        let path = Path::new(rows, scale);
        let stages = path.parts.iter().filter(|part| rows[part.rows[1]].step > 0);
        let stage = |part: &place::Part| {
            let [first, last] = part.rows.map(|i| &rows[i]);
            let [from, to] = path.driven(part);
            let through = path.through(part);
            StageEnd {
                name: last.stage.clone(),
                states: [first.step, last.step],
                from,
                to,
                through,
                shape: last.shape,
                side: last.side,
                toward: last.name_of(last.side).to_owned(),
                overhang: last.overhang,
                energy: last.energy,
            }
        };
        let solved = rows.iter().filter(|row| row.method != Method::Rest);
        Self {
            stages: stages.map(stage).collect(),
            extremes: extremes::extremes(&path),
            has_tension: rows
                .iter()
                .flat_map(|row| &row.muscles)
                .any(|m| m.stretch.is_none()),
            pressure_extremes: pressure::extremes(&path),
            jumps: extremes::jumps(&path),
            square: path.intervals(|row| row.shape == Shape::Square),
            overhanging: path.intervals(Row::overhangs),
            invaginated: path.intervals(|row| row.shape == Shape::Invaginated),
            deepest: deepest(&path, |_| true),
            invaginations: invaginations(&path),
            touching: path.intervals(|row| row.contact.touches()),
            contact: contact::contact(&path),
            obstacles: obstacles::obstacles(&path),
            crossing: path.intervals(Row::crosses_itself),
            closed: path.intervals(Row::has_closed),
            out_of_equilibrium: path.intervals(|row| !row.in_equilibrium),
            untested: path.intervals(|row| row.stability == Stability::Unknown),
            unstable: unstable(&path),
            leaves: leaves(&path, symmetry),
            asymmetry: asymmetry(&path),
            returned: returned::returned(&path, scale),
            work: Work {
                states: rows.len(),
                linear_solves: rows.iter().map(|row| row.iterations).sum(),
                seconds: rows.iter().map(|row| row.seconds).sum(),
                largest_residual: solved.map(|row| row.residual).fold(0.0, f64::max),
            },
            length_unit: scale.length_name.clone(),
            energy_unit: scale.energy_name.clone(),
            stress_unit: scale.stress_name.clone(),
            volume_unit: format!("{}³", scale.length_name),
            force_unit: scale.force_name.clone(),
        }
    }

    /// Returns the minima of the strain energy inside the stages.
    pub fn energy_minima(&self) -> impl Iterator<Item = &Extreme> {
        self.extremes.iter().filter(|extreme| extreme.is_minimum)
    }

    /// Returns the number of states that do not describe a real tube: a wall crosses itself or overlaps an obstacle, the lumen
    /// is closed, or the state is not in equilibrium. A state is counted once.
    pub fn unphysical_states(&self) -> usize {
        let reasons = [&self.crossing, &self.closed, &self.out_of_equilibrium];
        let overlapping = self.obstacles.iter().map(|obstacle| &obstacle.overlapping);
        let intervals = reasons.into_iter().chain(overlapping).flatten();
        let states = intervals.flat_map(|interval| interval.first.state..=interval.last.state);
        states.collect::<BTreeSet<usize>>().len()
    }
}

/// Returns the number of states in intervals.
pub fn states_in(intervals: &[Interval]) -> usize {
    intervals.iter().map(Interval::states).sum()
}

/// Returns the invaginated states, by their side if there are some to either side.
fn invaginations(path: &Path<'_>) -> Vec<Invagination> {
    let of = |sides: &[Side]| {
        let is_own = |row: &Row| row.shape == Shape::Invaginated && sides.contains(&row.side);
        Some(Invagination {
            states: path.intervals(is_own),
            deepest: deepest(path, is_own)?,
        })
    };
    let ends = [of(&[Side::Colon]), of(&[Side::Ileum])];
    let mut all: Vec<Invagination> = match ends {
        [Some(colon), Some(ileum)] => [Some(colon), Some(ileum), of(&[Side::None])]
            .into_iter()
            .flatten()
            .collect(),
        _ => of(&[Side::Colon, Side::Ileum, Side::None])
            .into_iter()
            .collect(),
    };
    all.sort_by_key(|one| one.states[0].first.state);
    all
}

/// Returns the invaginated state with the largest overhang, of those that fulfil a condition.
fn deepest(path: &Path<'_>, is_own: impl Fn(&Row) -> bool) -> Option<Overhang> {
    let invaginated = |i: &usize| {
        let row = &path.rows[*i];
        row.shape == Shape::Invaginated && is_own(row)
    };
    let overhang = |i: usize| path.rows[i].overhang;
    let states = (0..path.rows.len()).filter(invaginated);
    // The first of equal ones.
    let deepest = states
        .rev()
        .max_by(|&a, &b| overhang(a).total_cmp(&overhang(b)))?;
    Some(Overhang {
        at: path.place(deepest),
        overhang: overhang(deepest),
        side: path.rows[deepest].side,
        toward: path.rows[deepest]
            .name_of(path.rows[deepest].side)
            .to_owned(),
    })
}

fn unstable(path: &Path<'_>) -> Vec<Unstable> {
    let modes = path
        .rows
        .iter()
        .flat_map(|row| row.stability.unstable_modes());
    let modes: BTreeSet<UnstableMode> = modes.collect();
    let of = |mode: UnstableMode| Unstable {
        mode: match mode {
            UnstableMode::Circumferential(n) => Some(n),
            UnstableMode::Lowest => None,
        },
        description: mode.describe(),
        states: path.intervals(|row| row.stability.unstable_modes().any(|one| one == mode)),
    };
    modes.into_iter().map(of).collect()
}

fn leaves(path: &Path<'_>, symmetry: Symmetry) -> Option<Departure> {
    path.rows.iter().enumerate().find_map(|(i, row)| {
        let suppressed = |mode: &UnstableMode| !mode.is_admitted_by(symmetry);
        let mode = row.stability.unstable_modes().find(suppressed)?;
        Some(Departure {
            at: path.place(i),
            mode: mode.describe(),
        })
    })
}

fn asymmetry(path: &Path<'_>) -> Option<LargestAsymmetry> {
    let amplitude = |i: usize| path.rows[i].asymmetry;
    let states = (0..path.rows.len()).filter(|&i| path.rows[i].asymmetry_mode > 0);
    let largest = states
        .rev()
        .max_by(|&a, &b| amplitude(a).total_cmp(&amplitude(b)))?;
    Some(LargestAsymmetry {
        at: path.place(largest),
        amplitude: amplitude(largest),
        at_start: amplitude(0),
        mode: path.rows[largest].asymmetry_mode,
    })
}
