//! Minima and maxima of the strain energy along each stage, and jumps.

use super::place::{Path, Place};
use crate::solve::Method;
use serde::Serialize;

/// A minimum or a maximum of the strain energy inside a stage.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Extreme {
    /// The state.
    pub at: Place,
    /// Strain energy.
    pub energy: f64,
    /// True for a minimum, false for a maximum.
    pub is_minimum: bool,
    /// True if relaxation leads to this minimum or away from this maximum, so that the energy jumps there.
    pub is_at_jump: bool,
}

/// A step whose state was found by relaxation after Newton's method had failed, as at a snap-through.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Jump {
    /// The state that it leads to.
    pub to: Place,
    /// Strain energy before and after.
    pub energy: [f64; 2],
}

/// Change of energy, relative to the largest on the path, below which two states have the same energy. Smaller waves of the
/// energy come from the mesh.
const RESOLVED: f64 = 1e-6;

/// Returns the extremes of the energy inside the stages. The first and the last state of a stage are none: the loads that
/// change there are others.
pub(super) fn extremes(path: &Path<'_>) -> Vec<Extreme> {
    let energies: Vec<f64> = path.rows.iter().map(|row| row.energy).collect();
    let largest = energies.iter().fold(0.0_f64, |most, w| most.max(w.abs()));
    let mut found = vec![];
    for part in &path.parts {
        let [first, last] = [part.rows[0].saturating_sub(1), part.rows[1]];
        // The last state from which the energy changed, and the sign of the change.
        let (mut turn, mut sign) = (first, 0.0);
        for i in first + 1..=last {
            let change = energies[i] - energies[turn];
            if change.abs() <= RESOLVED * largest {
                continue;
            }
            if change.signum() == -sign {
                let is_minimum = sign < 0.0;
                let reached = if is_minimum { turn } else { i };
                found.push(Extreme {
                    at: path.place(turn),
                    energy: energies[turn],
                    is_minimum,
                    is_at_jump: path.rows[reached].method == Method::Relaxation,
                });
            }
            (turn, sign) = (i, change.signum());
        }
    }
    found
}

/// Returns the steps that relaxation made.
pub(super) fn jumps(path: &Path<'_>) -> Vec<Jump> {
    let relaxed = |i: &usize| path.rows[*i].method == Method::Relaxation;
    let jump = |i: usize| Jump {
        to: path.place(i),
        energy: [i - 1, i].map(|i| path.rows[i].energy),
    };
    (1..path.rows.len()).filter(relaxed).map(jump).collect()
}
