//! Points of a branch with their measures and their stability.

use super::follow::Follow;
use crate::equilibrium::{Instability, Stability, UnstableMode};
use crate::solve::arc::{Family, Point};
use crate::study::{Row, State};
use crate::tube::Load;

/// Circumferential displacement, in D, above which a state counts as twisted.
const TWISTED: f64 = 1e-9;

/// A state of a branch, as its table has it.
#[derive(Clone, Debug)]
pub struct BranchState {
    /// Arc length.
    pub s: f64,
    /// The parameter.
    pub parameter: f64,
    /// The label of a special point.
    pub label: Option<String>,
    /// Numbers of negative eigenvalues of the circumferential modes 0, 1, …; of a twisted state of mode 0 only.
    pub negative: Vec<usize>,
    /// Its measures, in the units of the case.
    pub row: Row,
}

impl BranchState {
    /// Returns whether no tested mode has a negative eigenvalue.
    pub fn is_stable(&self) -> bool {
        self.negative.iter().all(|count| *count == 0)
    }

    /// Returns the number in a column of the history.
    pub fn column(&self, name: &str) -> Option<f64> {
        let mut cells = self.row.cells().into_iter();
        cells.find(|cell| cell.name == name)?.number()
    }
}

/// A point with what is watched on it.
#[derive(Clone, Debug)]
pub(super) struct Sample {
    pub point: Point,
    pub state: BranchState,
    /// True if the wall touches itself.
    pub touches: bool,
}

impl Follow {
    /// Measures a point, and tests its stability.
    pub(super) fn sample(&self, point: Point) -> Sample {
        let load = self.load(point.parameter);
        let negative = self.counts(&load, &point.u, point.negative);
        let row = self.row(&load, &point, &negative);
        Sample {
            touches: self.touches(&point),
            state: BranchState {
                s: point.s,
                parameter: point.parameter,
                label: None,
                negative,
                row,
            },
            point,
        }
    }

    /// Returns whether the wall touches itself.
    pub(super) fn touches(&self, point: &Point) -> bool {
        let load = self.load(point.parameter);
        let report = self.problem.contact_report(&load, &point.u);
        report.is_some_and(|report| report.faces.iter().any(Option::is_some))
    }

    /// Returns the load with a value of the parameter.
    pub(super) fn load(&self, parameter: f64) -> Load {
        match self.family.at(parameter) {
            Some((_, load)) => load,
            None => unreachable!("a load is defined for every parameter"),
        }
    }

    /// Returns the number of negative eigenvalues of every tested mode at a state, given that of mode 0.
    fn counts(&self, load: &Load, u: &[f64], own: usize) -> Vec<usize> {
        let twisted = u.iter().skip(2).step_by(3).any(|u| u.abs() > TWISTED);
        let mut counts = vec![own];
        if !twisted {
            counts.extend(self.harmonics.negative_from(1, load, u));
        }
        counts
    }

    /// Returns the measures of a point, in the units of the case.
    pub(super) fn row(&self, load: &Load, point: &Point, negative: &[usize]) -> Row {
        let accepted = crate::solve::State {
            load: load.clone(),
            u: point.u.clone(),
            energy: point.energy,
            relative_residual: point.relative_residual,
            negative_pivots: point.negative,
        };
        let of = (&self.plan, &self.problem);
        let state = State::of_branch(of, 0, &accepted, stability(negative));
        Row::new(&state, &self.scale, self.plan.has_pressures(), None)
    }
}

/// Returns the verdict of numbers of negative eigenvalues.
fn stability(negative: &[usize]) -> Stability {
    let unstable = negative.iter().enumerate().filter(|(_, count)| **count > 0);
    let unstable: Vec<Instability> = unstable
        .map(|(mode, count)| Instability {
            mode: UnstableMode::Circumferential(mode),
            eigenvalues: *count,
        })
        .collect();
    match (unstable.is_empty(), negative.len()) {
        (false, _) => Stability::Unstable(unstable),
        // Higher modes of a twisted state are not tested.
        (true, 1) => Stability::Unknown,
        (true, _) => Stability::Stable,
    }
}
