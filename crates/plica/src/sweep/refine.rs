//! Refinement: bisection between neighbouring points whose outcomes differ.

use super::axis::{number, written};
use super::{Axis, Outcome, Point, Status};
use std::collections::BTreeSet;

/// The part of an outcome whose changes are located.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// The shape of the last state.
    Shape,
    /// The side to which the last state overhangs.
    Side,
    /// True if a state of the path is invaginated.
    Invaginates,
    /// The mode to which a state of the path is unstable first, or `stable`.
    Unstable,
    /// The status: complete, lost or invalid.
    Status,
}

impl Measure {
    /// All measures, by name.
    pub const ALL: [(&str, Self); 5] = [
        ("shape", Self::Shape),
        ("side", Self::Side),
        ("invaginates", Self::Invaginates),
        ("unstable", Self::Unstable),
        ("status", Self::Status),
    ];

    /// Returns the value in an outcome; none if the tube was not computed.
    pub fn of(self, outcome: &Outcome) -> Option<String> {
        let text = match self {
            // A failure is one of the machine, not of the tube.
            Self::Status if outcome.status != Status::Failed => outcome.status.to_string(),
            _ if !outcome.status.has_states() => return None,
            Self::Shape => outcome.shape.clone(),
            Self::Side => outcome.side.clone(),
            Self::Invaginates => outcome.invaginated_state.is_some().to_string(),
            Self::Unstable => outcome.unstable_mode.clone(),
            Self::Status => return None,
        };
        Some(text)
    }
}

/// A request to bisect boundaries.
#[derive(Clone, Debug, PartialEq)]
pub struct Refinement {
    /// The part of the outcomes that differs between neighbours.
    pub of: Measure,
    /// The axes that are bisected, by their place among all axes, and the distance of values at which bisection ends.
    pub until: Vec<(usize, f64)>,
}

impl Refinement {
    /// Returns the points that bisect boundaries, as far as outcomes are known: on every line of the grid along an axis, between
    /// neighbours that differ. In an order that depends on the outcomes alone.
    pub(super) fn points(
        &self,
        axes: &[Axis],
        grid: &[Point],
        outcome: &dyn Fn(&Point) -> Option<Outcome>,
    ) -> Vec<Point> {
        let mut found = vec![];
        let mut known: BTreeSet<Point> = grid.iter().cloned().collect();
        for &(axis, until) in &self.until {
            let values = &axes[axis].values;
            for point in grid {
                let place = values.iter().position(|value| *value == point.values[axis]);
                let Some(next) = place.and_then(|place| values.get(place + 1)) else {
                    continue;
                };
                let mut neighbour = point.clone();
                neighbour.values[axis] = next.clone();
                self.bisect(axis, until, [point, &neighbour], outcome, &mut |new| {
                    if known.insert(new.clone()) {
                        found.push(new);
                    }
                });
            }
        }
        found
    }

    /// Adds the points between two that bisect a boundary.
    fn bisect(
        &self,
        axis: usize,
        until: f64,
        [a, b]: [&Point; 2],
        outcome: &dyn Fn(&Point) -> Option<Outcome>,
        add: &mut dyn FnMut(Point),
    ) {
        let measured = |point: &Point| outcome(point).and_then(|outcome| self.of.of(&outcome));
        let [Some(before), Some(after)] = [a, b].map(measured) else {
            return;
        };
        let [Some(low), Some(high)] = [a, b].map(|point| number(&point.values[axis])) else {
            return;
        };
        let middle = 0.5 * (low + high);
        let is_fine = (high - low).abs() <= until * (1.0 + 1e-9);
        if is_fine || before == after {
            return;
        }
        let mut between = a.clone();
        between.values[axis] = written(middle);
        // The middle of two neighbours in twelve digits.
        if [a, b].contains(&&between) {
            return;
        }
        add(between.clone());
        self.bisect(axis, until, [a, &between], outcome, add);
        self.bisect(axis, until, [&between, b], outcome, add);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bisects the circle x² + y² = 0.5 on a grid of nine points, as if outcomes came one after another.
    #[test]
    fn boundaries_are_bisected_to_the_tolerance_in_an_order_of_their_own() {
        let axis = |name: &str| Axis {
            name: name.into(),
            key: name.into(),
            values: vec!["0.0".into(), "0.5".into(), "1.0".into()],
            span: 0..0,
        };
        let axes = [axis("x"), axis("y")];
        let mut grid = vec![];
        for x in &axes[0].values {
            for y in &axes[1].values {
                grid.push(Point {
                    values: vec![x.clone(), y.clone()],
                });
            }
        }
        let refinement = Refinement {
            of: Measure::Shape,
            until: vec![(0, 0.02), (1, 0.02)],
        };
        let outcome = |point: &Point| {
            let [x, y] = [0, 1].map(|i| number(&point.values[i]).unwrap());
            let shape = if x * x + y * y < 0.5 { "U" } else { "square" };
            Some(Outcome {
                shape: shape.into(),
                ..Outcome::of_status(Status::Complete)
            })
        };
        let all = refinement.points(&axes, &grid, &outcome);
        // On every line of the grid, neighbours that differ are as close as asked for.
        let mut crossings = 0;
        for axis in [0, 1] {
            for across in &axes[1 - axis].values {
                let own = grid
                    .iter()
                    .chain(&all)
                    .filter(|point| point.values[1 - axis] == *across);
                let place = |point: &&Point| number(&point.values[axis]).unwrap();
                let mut line: Vec<&Point> = own.collect();
                line.sort_by(|a, b| place(a).total_cmp(&place(b)));
                for pair in line.windows(2) {
                    let shapes = [0, 1].map(|i| outcome(pair[i]).unwrap().shape);
                    if shapes[0] != shapes[1] {
                        crossings += 1;
                        assert!(place(&pair[1]) - place(&pair[0]) <= 0.02, "{pair:?}");
                    }
                }
            }
        }
        assert_eq!(crossings, 4);
        // Rounds of one point each come to the same points.
        let mut done: BTreeSet<Point> = BTreeSet::new();
        loop {
            let known = |point: &Point| {
                let is_known = grid.contains(point) || done.contains(point);
                is_known.then(|| outcome(point)).flatten()
            };
            let points = refinement.points(&axes, &grid, &known);
            match points.into_iter().rfind(|point| !done.contains(point)) {
                Some(next) => done.insert(next),
                None => break,
            };
        }
        assert_eq!(done, all.into_iter().collect());
    }
}
