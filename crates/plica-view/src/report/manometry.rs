//! The forces of contact of the walls with themselves along the tube, over the path.

use super::labels::unit;
use super::selection::Selection;
use crate::draw::{Chart, Curve};
use plica::contact::Face;
use plica::equilibrium::TubeProblem;
use plica::run_directory::{Snapshot, Summary};
use plica::study::{Plan, Row, Scale};
use std::fmt::Write;

/// Intervals along the length of the tube at rest in which forces are summed up.
const INTERVALS: f64 = 200.0;

/// Most states in the picture.
const MOST_STATES: usize = 24;

/// Height of the largest force in the picture, in distances of two states.
const HEIGHT: f64 = 3.0;

/// Contact in one interval along the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Interval {
    /// Number of the interval, from z = 0.
    number: i64,
    /// ∫ p da over the interval and its length, in E·D.
    force_per_length: f64,
    /// Largest pressure, in E.
    pressure: f64,
}

/// The contact of a wall in a state, by interval.
struct Trace<'a> {
    row: &'a Row,
    wall: Face,
    intervals: Vec<Interval>,
}

/// The record of a run: a table and a picture.
pub(super) struct Manometry<'a> {
    plan: &'a Plan,
    traces: Vec<Trace<'a>>,
}

impl<'a> Manometry<'a> {
    /// Computes the record from the states of a run; none if no wall touches itself in any of them.
    pub fn of(plan: &'a Plan, summary: &'a Summary) -> Option<Self> {
        if !plan.contact {
            return None;
        }
        let problem = plan.problem();
        let states = summary.rows().iter().zip(summary.snapshots());
        let mut traces = vec![];
        for (row, snapshot) in states {
            let Some(Snapshot { u, .. }) = snapshot else {
                continue;
            };
            for wall in [Face::Outer, Face::Inner] {
                let intervals = intervals(&problem, wall, u);
                if !intervals.is_empty() {
                    traces.push(Trace {
                        row,
                        wall,
                        intervals,
                    });
                }
            }
        }
        (!traces.is_empty()).then_some(Self { plan, traces })
    }

    /// Returns the table, in the units of the case; intervals without contact are left out.
    pub fn table(&self) -> String {
        let scale = Scale::of(self.plan.units.as_ref());
        let mut table = "state,wall,z,force_per_length,pressure\n".to_owned();
        for trace in &self.traces {
            let (step, wall) = (trace.row.step, trace.wall.to_string().replace(' ', "-"));
            for interval in &trace.intervals {
                let z = scale.length * middle(self.plan, interval);
                let force = scale.force / scale.length * interval.force_per_length;
                let pressure = scale.stress * interval.pressure;
                // Writing to a text cannot fail.
                let _ = writeln!(table, "{step},{wall},{z:.6e},{force:.6e},{pressure:.6e}");
            }
        }
        table
    }

    /// Draws the force per length of both walls along the axis, one line per state at the height of its load.
    pub fn chart(&self, selection: &Selection<'_>) -> Chart {
        let scale = Scale::of(self.plan.units.as_ref());
        // From the state before the first one that touches.
        let touches = |row: &&Row| self.traces.iter().any(|trace| trace.row.step == row.step);
        let first = selection.rows.iter().position(touches).unwrap_or(0);
        let rows = &selection.rows[first.saturating_sub(1)..];
        let every = rows.len().div_ceil(MOST_STATES).max(1);
        let last = rows.len() - 1;
        let chosen = (0..rows.len()).filter(|i| (last - i).is_multiple_of(every));
        let chosen: Vec<&Row> = chosen.map(|i| rows[i]).collect();
        let at = |row: &Row| selection.abscissa.of(row);
        let ends = rows.iter().map(|row| at(row));
        let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| {
            (low.min(y), high.max(y))
        });
        let distance = (high - low) / (chosen.len().max(2) - 1) as f64;
        let forces: Vec<Vec<f64>> = chosen.iter().map(|row| self.forces(row)).collect();
        let largest = forces.iter().flatten().fold(0.0, |a: f64, b| a.max(*b));
        let step = self.plan.tube.length / INTERVALS;
        let curve = |(row, forces): (&&Row, &Vec<f64>)| Curve {
            points: forces
                .iter()
                .enumerate()
                .map(|(i, force)| {
                    let z = scale.length * step * (i as f64 + 0.5);
                    let lift = HEIGHT * distance * force / largest.max(f64::MIN_POSITIVE);
                    (z, at(row) + lift)
                })
                .collect(),
            colour: usize::from(forces.iter().any(|force| *force > 0.0)),
            ..Curve::default()
        };
        let force = scale.force / scale.length * largest;
        Chart {
            title: format!(
                "force of contact along the tube, at most {} {}",
                crate::draw::format_number(force, 2),
                match self.plan.units {
                    None => "*E* *D*".to_owned(),
                    Some(_) => format!("{}/{}", unit(&scale.force_name), unit(&scale.length_name)),
                }
            ),
            x_label: format!("*z* ({})", unit(&scale.length_name)),
            y_label: selection.abscissa.label(&scale),
            curves: chosen.iter().zip(&forces).map(curve).collect(),
            proportion: 0.9,
            ..Chart::default()
        }
    }

    /// Returns the force per length of both walls in a state, for every interval of the length at rest.
    fn forces(&self, row: &Row) -> Vec<f64> {
        let mut forces = vec![0.0; INTERVALS as usize];
        let own = self
            .traces
            .iter()
            .filter(|trace| trace.row.step == row.step);
        for interval in own.flat_map(|trace| &trace.intervals) {
            let number = usize::try_from(interval.number).ok();
            if let Some(force) = number.and_then(|number| forces.get_mut(number)) {
                *force += interval.force_per_length;
            }
        }
        forces
    }
}

/// Returns the axial position of the middle of an interval, in D.
fn middle(plan: &Plan, interval: &Interval) -> f64 {
    plan.tube.length / INTERVALS * (interval.number as f64 + 0.5)
}

/// Returns the intervals in which a wall is under pressure, from the colon end to the other.
fn intervals(problem: &TubeProblem, wall: Face, u: &[f64]) -> Vec<Interval> {
    let Some(contact) = &problem.contact else {
        return vec![];
    };
    let length = problem.tube.tube.length / INTERVALS;
    let mut found: std::collections::BTreeMap<i64, Interval> = Default::default();
    for point in contact.pressed_points(u, wall) {
        let number = (point.z / length).floor() as i64;
        let interval = found.entry(number).or_insert(Interval {
            number,
            force_per_length: 0.0,
            pressure: 0.0,
        });
        interval.force_per_length += point.pressure * point.area / length;
        interval.pressure = interval.pressure.max(point.pressure);
    }
    found.into_values().collect()
}
