//! Findings about contact with obstacles.

use super::place::{Interval, Path, Place};
use crate::study::ObstacleRow;
use serde::Serialize;

/// Contact of a path with one obstacle.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ObstacleContacts {
    /// Name of the obstacle.
    pub name: String,
    /// States in which a wall touches it.
    pub touching: Vec<Interval>,
    /// The state with the largest contact force; none if nothing touches it.
    pub largest_force: Option<LargestForce>,
    /// States in which a wall overlaps it, which is not physical.
    pub overlapping: Vec<Interval>,
    /// Energy that friction on it has dissipated along the path; none without friction.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub friction_work: Option<f64>,
}

/// The largest contact force of a path.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LargestForce {
    /// Sum of the sizes of the contact forces.
    pub force: f64,
    /// The state.
    pub at: Place,
}

/// Returns the contact with each obstacle of a path.
pub(super) fn obstacles(path: &Path<'_>) -> Vec<ObstacleContacts> {
    let first = path.rows.first();
    let all = first.map_or(&[][..], |row| &row.obstacles);
    let of = |(i, obstacle): (usize, &ObstacleRow)| {
        let force = |row: usize| path.rows[row].obstacles[i].force;
        // The first of equal ones.
        let largest = (0..path.rows.len())
            .rev()
            .max_by(|&a, &b| force(a).total_cmp(&force(b)));
        ObstacleContacts {
            name: obstacle.name.clone(),
            touching: path.intervals(|row| row.obstacles[i].area > 0.0),
            largest_force: largest
                .filter(|&row| force(row) > 0.0)
                .map(|row| LargestForce {
                    force: force(row),
                    at: path.place(row),
                }),
            overlapping: path.intervals(|row| row.obstacles[i].gap <= 0.0),
            friction_work: path
                .rows
                .last()
                .and_then(|row| row.obstacles[i].friction_work),
        }
    };
    all.iter().enumerate().map(of).collect()
}
