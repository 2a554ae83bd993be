//! Changes between two points of a branch.

use super::follow::Follow;
use super::sample::{BranchState, Sample};
use crate::solve::Equilibrium;
use crate::solve::arc::Point;
use crate::study::{Event, PARAMETER};

/// A function that changes its sign, or a number that changes, between two points.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Change {
    /// The sign of dλ/ds.
    Fold,
    /// The number of negative eigenvalues of a mode.
    Mode(usize),
    Contact,
    Energy,
    Column(String, f64),
}

/// The changes between two points, and whether they must be separated by a point between before they are located.
pub(super) struct Changes {
    pub all: Vec<Change>,
    pub need_separation: bool,
}

impl Follow {
    /// Returns the changes between two points that the plan locates.
    pub(super) fn changes(&self, a: &Sample, b: &Sample) -> Changes {
        let mut all = vec![];
        let mut need_separation = false;
        let watches = |event: &Event| self.following.events.contains(event);
        let turns = a.point.tangent.1 * b.point.tangent.1 < 0.0;
        if turns && watches(&Event::Fold) {
            all.push(Change::Fold);
        }
        let [before, behind] = [a, b].map(|sample| &sample.state.negative);
        for mode in 0..before.len().min(behind.len()) {
            let change = before[mode].abs_diff(behind[mode]);
            let of_fold = usize::from(mode == 0 && turns);
            if change == of_fold || !watches(&Event::Modes) {
                continue;
            }
            need_separation |= change > 1 || of_fold == 1;
            all.push(Change::Mode(mode));
        }
        for event in &self.following.events {
            match event {
                Event::Contact if a.touches != b.touches => all.push(Change::Contact),
                Event::Energy => {
                    let [p, q] = [a, b].map(|sample| self.slope_of_energy(&sample.point));
                    if p * q < 0.0 {
                        all.push(Change::Energy);
                    }
                }
                Event::Column(name, value) => {
                    let [p, q] = [a, b].map(|sample| above(&sample.state, name, *value));
                    if p * q < 0.0 {
                        all.push(Change::Column(name.clone(), *value));
                    }
                }
                _ => {}
            }
        }
        Changes {
            all,
            need_separation,
        }
    }

    /// Returns the derivative of the energy of the problem with the parameter along the branch, ∂W/∂λ since R = 0; NaN if it is
    /// not defined.
    pub(super) fn slope_of_energy(&self, point: &Point) -> f64 {
        let [a, b] = self.following.range;
        let step = 1e-5 * (b - a).abs();
        let energy = |parameter: f64| {
            let load = self.load(parameter);
            let mut u = point.u.clone();
            self.problem.apply_prescribed(&load, &mut u);
            let forces = self.problem.forces(&load, &u);
            forces.map_or(f64::NAN, |forces| forces.energy)
        };
        let at = point.parameter;
        (energy(at + step) - energy(at - step)) / (2.0 * step)
    }
}

/// Returns the number in a column, or the parameter, less a value; NaN if there is none.
pub(super) fn above(state: &BranchState, name: &str, value: f64) -> f64 {
    match name {
        PARAMETER => state.parameter - value,
        name => state.column(name).map_or(f64::NAN, |x| x - value),
    }
}
