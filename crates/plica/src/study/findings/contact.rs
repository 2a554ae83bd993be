//! Findings about walls that may touch themselves.

use super::place::{Interval, Path, Place};
use crate::contact::{BIOT, CREASE};
use crate::study::{ContactRow, Row, WALLS, WallContactRow};
use serde::Serialize;

/// Contact on a path.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Contact {
    /// The first state in which each wall touches itself; walls that never do are left out.
    pub first: Vec<FirstTouch>,
    /// The largest share of the energy of contact in the strain energy.
    pub largest_energy_share: f64,
    /// The smallest surface stretch s = λ₁² λ₂.
    pub smallest_stretch: SmallestStretch,
    /// States in which s is below 0.417: a crease has less energy than a flat surface.
    pub crease: Vec<Interval>,
    /// States in which s is below 0.296: a flat surface is unstable.
    pub biot: Vec<Interval>,
    /// States in which a wall turns by more than 20° within an element, so that a crease may be finer than the mesh.
    pub unresolved: Vec<Interval>,
    /// The largest angle by which a wall turns within an element, in degrees.
    pub largest_turn_deg: f64,
    /// Energy that friction of the walls with themselves has dissipated along the path; none without friction.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub friction_work: Option<f64>,
}

/// The first state in which a wall touches itself.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FirstTouch {
    /// Name of the wall.
    pub wall: String,
    /// The state.
    pub at: Place,
    /// Axial positions at rest of the first and the last point in contact there.
    pub from_to: [f64; 2],
    /// First and last angle at rest of the contact there, in degrees; none in an axisymmetric run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub angles_deg: Option<[f64; 2]>,
    /// All states in which the wall touches itself.
    pub states: Vec<Interval>,
}

/// The smallest surface stretch of a path.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SmallestStretch {
    /// Name of the wall.
    pub wall: String,
    /// s = λ₁² λ₂.
    pub stretch: f64,
    /// The state.
    pub at: Place,
}

/// Returns the findings about contact; none of a path without contact.
pub(super) fn contact(path: &Path<'_>) -> Option<Contact> {
    let rows = path.rows;
    rows.first()?.contact.energy?;
    let name = |wall: usize| WALLS[wall].replace('-', " ");
    let first = |wall: usize| {
        let at = rows
            .iter()
            .position(|row| row.contact.walls[wall].touches())?;
        let (from_to, angles_deg) = rows[at].contact.walls[wall].place();
        Some(FirstTouch {
            wall: name(wall),
            at: path.place(at),
            from_to,
            angles_deg,
            states: path.intervals(|row| row.contact.walls[wall].touches()),
        })
    };
    let stretches = rows.iter().enumerate().flat_map(|(i, row)| {
        let walls = row.contact.walls.iter().enumerate();
        walls.filter_map(move |(wall, of)| Some((of.surface_stretch?, wall, i)))
    });
    let (stretch, wall, i) = stretches.min_by(|a, b| a.0.total_cmp(&b.0))?;
    let below = |limit: f64| {
        let is_below = move |row: &Row| row.contact.surface_stretch().is_some_and(|s| s < limit);
        path.intervals(is_below)
    };
    let largest = |of: fn(&ContactRow) -> f64| {
        let values = rows.iter().map(|row| of(&row.contact));
        values.fold(0.0, f64::max)
    };
    let turn = |wall: &WallContactRow| wall.element_turn_deg.unwrap_or(0.0);
    Some(Contact {
        // The outer wall folds first, as a rule.
        first: [1, 0].into_iter().filter_map(first).collect(),
        largest_energy_share: largest(|contact| contact.energy_share.unwrap_or(0.0)),
        smallest_stretch: SmallestStretch {
            wall: name(wall),
            stretch,
            at: path.place(i),
        },
        crease: below(CREASE),
        biot: below(BIOT),
        unresolved: path.intervals(|row| row.contact.is_unresolved()),
        largest_turn_deg: rows
            .iter()
            .flat_map(|row| row.contact.walls.iter().map(turn))
            .fold(0.0, f64::max),
        friction_work: rows.last().and_then(|row| {
            let [inner, outer] = [0, 1].map(|wall| row.contact.walls[wall].friction_work);
            Some(inner? + outer?)
        }),
    })
}
