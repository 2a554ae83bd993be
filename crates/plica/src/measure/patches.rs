//! A tree of bounding boxes over the cells of a grid of points that is closed around the tube.

use super::triangle::Point;
use std::ops::Range;

/// Patches of a grid, each with the box around its points. The first covers the whole grid.
pub struct Patches {
    patches: Vec<Patch>,
}

struct Patch {
    bounds: Bounds,
    /// The box around the normals of its cells.
    normals: Bounds,
    /// The first row and column of its cells.
    at: [usize; 2],
    /// The two halves; none for a single cell.
    halves: Option<[usize; 2]>,
}

/// A box, by its lowest and highest coordinates.
#[derive(Clone, Copy)]
struct Bounds {
    low: Point,
    high: Point,
}

impl Bounds {
    fn of(points: &[Point]) -> Self {
        let empty = Self {
            low: [f64::INFINITY; 3],
            high: [f64::NEG_INFINITY; 3],
        };
        points
            .iter()
            .fold(empty, |sum, &p| sum.and(Self { low: p, high: p }))
    }

    fn and(self, other: Self) -> Self {
        Self {
            low: [0, 1, 2].map(|i| self.low[i].min(other.low[i])),
            high: [0, 1, 2].map(|i| self.high[i].max(other.high[i])),
        }
    }

    /// Returns a lower bound of the products of a vector and those in the box.
    fn least_product(&self, v: Point) -> f64 {
        let least = |i: usize| (v[i] * self.low[i]).min(v[i] * self.high[i]);
        least(0) + least(1) + least(2)
    }

    /// Returns the distance of two boxes; 0 if they overlap.
    fn distance(&self, other: &Self) -> f64 {
        let apart = |i: usize| {
            (other.low[i] - self.high[i])
                .max(self.low[i] - other.high[i])
                .max(0.0)
        };
        (apart(0).powi(2) + apart(1).powi(2) + apart(2).powi(2)).sqrt()
    }
}

impl Patches {
    /// Divides a grid down to its cells, which have normals. The last column is next to the first.
    pub fn of(points: &[Vec<Point>], normals: &[Vec<Point>]) -> Self {
        let mut tree = Self { patches: vec![] };
        tree.add(points, normals, 0..points.len() - 1, 0..points[0].len());
        tree
    }

    /// Adds the patch of some rows and columns of cells and its parts, and returns its index.
    fn add(
        &mut self,
        points: &[Vec<Point>],
        normals: &[Vec<Point>],
        rows: Range<usize>,
        columns: Range<usize>,
    ) -> usize {
        let own = self.patches.len();
        let at = [rows.start, columns.start];
        let next = (at[1] + 1) % points[0].len();
        let [a, b] = [&points[at[0]], &points[at[0] + 1]];
        self.patches.push(Patch {
            bounds: Bounds::of(&[a[at[1]], a[next], b[at[1]], b[next]]),
            normals: Bounds::of(&[normals[at[0]][at[1]]]),
            at,
            halves: None,
        });
        if rows.len() * columns.len() > 1 {
            let middle = |range: &Range<usize>| usize::midpoint(range.start, range.end);
            let [first, second] = if rows.len() > columns.len() {
                let middle = middle(&rows);
                [
                    (rows.start..middle, columns.clone()),
                    (middle..rows.end, columns),
                ]
            } else {
                let middle = middle(&columns);
                [
                    (rows.clone(), columns.start..middle),
                    (rows, middle..columns.end),
                ]
            };
            let first = self.add(points, normals, first.0, first.1);
            let second = self.add(points, normals, second.0, second.1);
            let (a, b) = (&self.patches[first], &self.patches[second]);
            let (bounds, normals) = (a.bounds.and(b.bounds), a.normals.and(b.normals));
            self.patches[own] = Patch {
                bounds,
                normals,
                at,
                halves: Some([first, second]),
            };
        }
        own
    }

    /// Calls `visit` with the row and column of every cell whose box is at most `reach` from the box around `points`,
    /// with the distance of the boxes, and with the reach, which it may shorten. Cells whose boxes do not overlap are left
    /// out if the product of their normal and `normal` is above `facing`.
    pub fn near(
        &self,
        points: &[Point],
        (normal, facing): (Point, f64),
        reach: &mut f64,
        mut visit: impl FnMut(usize, usize, f64, &mut f64),
    ) {
        let bounds = Bounds::of(points);
        let mut open = vec![0];
        while let Some(index) = open.pop() {
            let patch = &self.patches[index];
            let apart = patch.bounds.distance(&bounds);
            if apart > *reach || apart > 0.0 && patch.normals.least_product(normal) > facing {
                continue;
            }
            match patch.halves {
                Some(halves) => open.extend(halves),
                None => visit(patch.at[0], patch.at[1], apart, reach),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cells_near_some_points_are_those_of_a_search_of_all() {
        // A grid of 6 rows and 9 columns around a bent tube.
        let point = |i: usize, j: usize| {
            let (z, phi) = (i as f64, j as f64 * std::f64::consts::TAU / 9.0);
            [z, phi.cos() + 0.1 * z * z, phi.sin()]
        };
        let points: Vec<Vec<Point>> = (0..6)
            .map(|i| (0..9).map(|j| point(i, j)).collect())
            .collect();
        let normal = |j: usize| {
            let phi = (j as f64 + 0.5) * std::f64::consts::TAU / 9.0;
            [0.0, phi.cos(), phi.sin()]
        };
        let normals = vec![(0..9).map(normal).collect(); 5];
        let tree = Patches::of(&points, &normals);
        let sought = [[2.2, 0.5, 0.9], [2.3, 0.4, 1.0]];
        let limits = [0.0, 0.4, 1.0, 10.0].map(|reach| [(reach, 2.0), (reach, 0.5)]);
        for (mut reach, facing) in limits.into_iter().flatten() {
            let mut found = vec![];
            tree.near(&sought, (normal(1), facing), &mut reach, |i, j, _, _| {
                found.push((i, j))
            });
            found.sort_unstable();
            let bounds = Bounds::of(&sought);
            let mut expected = vec![];
            for i in 0..5 {
                for j in 0..9 {
                    let next = (j + 1) % 9;
                    let cell = [
                        point(i, j),
                        point(i, next),
                        point(i + 1, j),
                        point(i + 1, next),
                    ];
                    let apart = Bounds::of(&cell).distance(&bounds);
                    let angle = (j as f64 - 1.0) * std::f64::consts::TAU / 9.0;
                    if apart <= reach && (apart == 0.0 || angle.cos() <= facing) {
                        expected.push((i, j));
                    }
                }
            }
            assert_eq!(found, expected, "{reach}");
        }
    }
}
