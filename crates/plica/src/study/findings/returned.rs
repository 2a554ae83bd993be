//! Comparison of the last state with an earlier one under the same load: what remains of a cycle of loads.

use super::loads::NamedLoad;
use super::place::{Path, Place};
use crate::measure::Shape;
use crate::study::{Row, Scale};
use serde::Serialize;

/// The last state and the first one under the same load, with other loads in between.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Return {
    /// The earlier state.
    pub earlier: Place,
    /// The last state.
    pub last: Place,
    /// True if both states are the same.
    pub is_same: bool,
    /// Strain energies of the earlier and of the last state.
    pub energy: [f64; 2],
    /// Shapes of the earlier and of the last state.
    pub shape: [Shape; 2],
}

/// Difference of loads, relative to their size, up to which they are equal.
const SAME_LOAD: f64 = 1e-9;

/// Difference of strain energies, relative to the largest on the path, up to which states are the same.
const SAME_ENERGY: f64 = 1e-6;

/// Difference of lengths, in D, up to which states are the same.
const SAME_LENGTH: f64 = 1e-3;

/// Compares the last state of a path with the first one under the same load; none if the load is new.
pub(super) fn returned(path: &Path<'_>, scale: &Scale) -> Option<Return> {
    let last = path.rows.len().checked_sub(1)?;
    let all: Vec<_> = (0..=last).map(|i| path.loads(i)).collect();
    let same = |i: usize| all[i].iter().zip(&all[last]).all(same_load);
    let earlier = (0..last).find(|&i| same(i))?;
    // The load must have been another one in between.
    (earlier..last).find(|&i| !same(i))?;
    let rows = [&path.rows[earlier], &path.rows[last]];
    let largest = path
        .rows
        .iter()
        .fold(0.0_f64, |most, row| most.max(row.energy.abs()));
    Some(Return {
        earlier: path.place(earlier),
        last: path.place(last),
        is_same: is_same_state(rows, largest, scale),
        energy: rows.map(|row| row.energy),
        shape: rows.map(|row| row.shape),
    })
}

fn same_load((a, b): (&NamedLoad, &NamedLoad)) -> bool {
    (a.value - b.value).abs() <= SAME_LOAD * a.value.abs().max(b.value.abs()).max(SAME_LOAD)
}

fn is_same_state([a, b]: [&Row; 2], largest_energy: f64, scale: &Scale) -> bool {
    let lengths = |row: &Row| {
        [
            row.outer_radius_min,
            row.z_at_min,
            row.overhang,
            row.lumen,
            row.asymmetry,
        ]
    };
    let close = |(a, b): (f64, f64)| (a - b).abs() <= SAME_LENGTH * scale.length;
    // The narrowest place of a tube that is straight again is anywhere.
    let straight = a.shape == Shape::Straight && b.shape == Shape::Straight;
    let mut pairs = lengths(a).into_iter().zip(lengths(b)).enumerate();
    (a.energy - b.energy).abs() <= SAME_ENERGY * largest_energy
        && a.shape == b.shape
        && pairs.all(|(k, pair)| close(pair) || (k == 1 && straight))
}
