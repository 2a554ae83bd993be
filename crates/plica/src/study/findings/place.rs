//! Places on a path: states and intervals of states, with the stage and the loads that are driven there.

use super::loads::{NamedLoad, describe, describe_range, loads, needs_names};
use crate::study::{Row, Scale};
use serde::Serialize;

/// A state of a path.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Place {
    /// Number of the state.
    pub state: usize,
    /// Name of its stage.
    pub stage: String,
    /// The loads that change during its stage.
    pub loads: Vec<NamedLoad>,
}

/// Consecutive states.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Interval {
    /// The first state.
    pub first: Place,
    /// The last state.
    pub last: Place,
}

impl Interval {
    /// Returns the number of states.
    pub fn states(&self) -> usize {
        self.last.state - self.first.state + 1
    }
}

/// Consecutive states of one stage.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Part {
    /// Indices of its first and last row.
    pub rows: [usize; 2],
    /// Positions of the loads that change, in the list of all loads. They change from the row before the first one.
    driven: Vec<usize>,
}

/// A path, divided into its stages.
#[derive(Clone, Debug)]
pub(super) struct Path<'a> {
    pub rows: &'a [Row],
    scale: &'a Scale,
    muscles_by_name: bool,
    pub parts: Vec<Part>,
}

impl<'a> Path<'a> {
    pub fn new(rows: &'a [Row], scale: &'a Scale) -> Self {
        let mut parts: Vec<Part> = vec![];
        for (i, row) in rows.iter().enumerate() {
            match parts.last_mut() {
                Some(part) if rows[part.rows[0]].stage == row.stage => part.rows[1] = i,
                _ => parts.push(Part {
                    rows: [i, i],
                    driven: vec![],
                }),
            }
        }
        let muscles_by_name = needs_names(rows);
        for part in &mut parts {
            let [first, last] = part.rows;
            let all: Vec<_> = rows[first.saturating_sub(1)..=last]
                .iter()
                .map(|row| loads(row, scale, muscles_by_name))
                .collect();
            let changes = |&k: &usize| all.iter().any(|one| one[k].value != all[0][k].value);
            part.driven = (0..all[0].len()).filter(changes).collect();
        }
        Self {
            rows,
            scale,
            muscles_by_name,
            parts,
        }
    }

    /// Returns all driven quantities of a row.
    pub fn loads(&self, row: usize) -> Vec<NamedLoad> {
        loads(&self.rows[row], self.scale, self.muscles_by_name)
    }

    /// Returns the part that holds a row.
    fn part(&self, row: usize) -> &Part {
        let holds = |part: &&Part| (part.rows[0]..=part.rows[1]).contains(&row);
        let part = self.parts.iter().find(holds);
        part.unwrap_or_else(|| unreachable!("row {row} belongs to no stage"))
    }

    /// Returns the place of a row.
    pub fn place(&self, row: usize) -> Place {
        let all = self.loads(row);
        let driven = &self.part(row).driven;
        Place {
            state: self.rows[row].step,
            stage: self.rows[row].stage.clone(),
            loads: driven.iter().map(|&k| all[k].clone()).collect(),
        }
    }

    /// Returns the intervals of rows that meet a condition.
    pub fn intervals(&self, condition: impl Fn(&Row) -> bool) -> Vec<Interval> {
        let mut found: Vec<[usize; 2]> = vec![];
        for (i, _) in self
            .rows
            .iter()
            .enumerate()
            .filter(|(_, row)| condition(row))
        {
            match found.last_mut() {
                Some([_, last]) if *last + 1 == i => *last = i,
                _ => found.push([i, i]),
            }
        }
        let interval = |[first, last]: [usize; 2]| Interval {
            first: self.place(first),
            last: self.place(last),
        };
        found.into_iter().map(interval).collect()
    }

    /// Returns the smallest and largest values of the loads that leave, inside a part, the range from its beginning to its end.
    pub fn through(&self, part: &Part) -> Vec<NamedLoad> {
        let rows = part.rows[0].saturating_sub(1)..=part.rows[1];
        let all: Vec<_> = rows.map(|row| self.loads(row)).collect();
        let mut found = vec![];
        for &k in &part.driven {
            let values = || all.iter().map(|loads| &loads[k]);
            let by_value = |a: &&NamedLoad, b: &&NamedLoad| a.value.total_cmp(&b.value);
            let ends = [&all[0][k], &all[all.len() - 1][k]].map(|load| load.value);
            let least = values().min_by(by_value);
            let most = values().max_by(by_value);
            found.extend(least.filter(|load| ends.iter().all(|end| load.value < *end)));
            found.extend(most.filter(|load| ends.iter().all(|end| load.value > *end)));
        }
        found.into_iter().cloned().collect()
    }

    /// Returns the loads at the beginning and at the end of a part that changed in it.
    pub fn driven(&self, part: &Part) -> [Vec<NamedLoad>; 2] {
        [part.rows[0].saturating_sub(1), part.rows[1]].map(|row| {
            let all = self.loads(row);
            part.driven.iter().map(|&k| all[k].clone()).collect()
        })
    }
}

impl std::fmt::Display for Place {
    /// Writes for example `state 28 (relax, Lmax/L = 1.1300)`.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "state {} ({})", self.state, in_stage(self))
    }
}

impl std::fmt::Display for Interval {
    /// Writes for example `states 33 to 34 (relax, Lmax/L = 1.1800 to 1.1900)`.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (first, last) = (&self.first, &self.last);
        if first.state == last.state {
            return first.fmt(f);
        }
        write!(f, "states {} to {} (", first.state, last.state)?;
        if first.stage != last.stage {
            return write!(f, "{}, to {})", in_stage(first), in_stage(last));
        }
        f.write_str(&last.stage)?;
        if !last.loads.is_empty() {
            write!(f, ", {}", describe_range(&first.loads, &last.loads))?;
        }
        f.write_str(")")
    }
}

/// Describes the stage and the loads of a state.
fn in_stage(place: &Place) -> String {
    if place.loads.is_empty() {
        place.stage.clone()
    } else {
        format!("{}, {}", place.stage, describe(&place.loads))
    }
}

/// Largest number of intervals that a sentence lists.
const LISTED: usize = 3;

/// Lists intervals; the middle ones of many are left out and counted.
pub(super) fn list(intervals: &[Interval]) -> String {
    let text = |interval: &Interval| interval.to_string();
    if intervals.len() <= LISTED {
        return intervals.iter().map(text).collect::<Vec<_>>().join("; ");
    }
    let states: usize = intervals.iter().map(Interval::states).sum();
    let (first, last) = (&intervals[0], &intervals[intervals.len() - 1]);
    format!(
        "{states} states in {} intervals, the first {first}, the last {last}",
        intervals.len()
    )
}
