//! Contact of a face of the whole tube with itself, on a surface of triangles.
//!
//! The distance of two points along the surface is √(a² + b²), with the current arc length a along their meridians and
//! b around the tube, each the shorter of two ways.

use super::Face;
use super::patches::Patches;
use super::triangle::{Point, Triangle, combine, cross, distance, dot, intersect, minus, nearest};
use crate::assembly::SplineTube;
use crate::tube::Tube;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Spacing of the points at rest, in thicknesses of the wall.
const SPACING: f64 = 0.5;

/// Limits of the points per element.
const PER_ELEMENT: [usize; 2] = [2, 8];

/// Smallest ratio of the distance of two points along the surface to their distance in space for which they count as
/// parts of a wall that approach each other. For points of a circle it is at most π/2.
const APPROACH: f64 = 2.0;

/// Cosine of the smallest angle, 60°, between the normals of parts that face each other.
const FACING: f64 = 0.5;

/// Rows and columns of the corners of a cell, in order around it.
const CORNERS: [[usize; 2]; 4] = [[0, 0], [1, 0], [1, 1], [0, 1]];

/// Corners of the two triangles of a cell.
const TRIANGLES: [[usize; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

/// A face of the whole tube as a grid of points, closed around the tube.
pub struct Surface {
    /// Points by row along the tube, then around it.
    points: Vec<Vec<Point>>,
    /// Columns after which the grid repeats.
    sector: usize,
}

/// Contact of a surface with itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Smallest distance of two parts of the surface; 0 if it crosses itself, infinite if no parts approach.
    pub gap: f64,
    /// True if parts cross that are a third of a turn or more apart at rest: across the lumen.
    pub closes: bool,
}

impl Contact {
    const NONE: Self = Self {
        gap: f64::INFINITY,
        closes: false,
    };

    fn and(self, other: Self) -> Self {
        Self {
            gap: self.gap.min(other.gap),
            closes: self.closes || other.closes,
        }
    }
}

impl Surface {
    /// Samples a face, from a reference angle on.
    pub fn of(tube: &SplineTube, u: &[f64], face: Face, first: f64) -> Self {
        let (around, elements) = (tube.sector.around, tube.axial.elements());
        let per_element = |length: f64| {
            let wanted = (length / (SPACING * tube.tube.thickness)).ceil() as usize;
            wanted.clamp(PER_ELEMENT[0], PER_ELEMENT[1])
        };
        let along = per_element(tube.tube.length / elements as f64);
        let per_ring = per_element(TAU * Tube::OUTER_RADIUS / around as f64);
        let columns = per_ring * around;
        let angle = |j: usize| first + TAU * j as f64 / columns as f64;
        let angles: Vec<f64> = (0..columns).map(angle).collect();
        let z = tube.axial.positions(elements * along + 1);
        Self {
            points: tube.positions(u, face.radius(&tube.tube), &z, &angles),
            sector: per_ring * tube.sector.rings,
        }
    }

    fn columns(&self) -> usize {
        self.points[0].len()
    }

    /// Returns the columns between two columns, the shorter way around.
    fn columns_between(&self, j: usize, l: usize) -> usize {
        let apart = j.abs_diff(l);
        apart.min(self.columns() - apart)
    }

    /// Returns the corners of the cell between rows i and i + 1 and columns j and j + 1.
    fn cell(&self, [i, j]: [usize; 2]) -> [Point; 4] {
        CORNERS.map(|[row, column]| self.points[i + row][(j + column) % self.columns()])
    }

    /// Returns the smallest distance of two parts of the surface that face each other and are at least `min_distance`
    /// apart along it and at most half as far apart in space. Only distances below `limit` are found.
    pub fn contact(&self, min_distance: f64, limit: f64) -> Contact {
        let (rows, columns) = (self.points.len() - 1, self.columns());
        let lengths = Lengths::of(&self.points);
        let normals: Vec<Vec<Point>> = (0..rows)
            .map(|i| (0..columns).map(|j| normal(&self.cell([i, j]))).collect())
            .collect();
        let patches = Patches::of(&self.points, &normals);
        let of_row = |i: usize| {
            let mut closes = false;
            let mut gap = limit;
            for j in 0..self.sector {
                let own = self.cell([i, j]);
                let facing = (normals[i][j], FACING);
                patches.near(&own, facing, &mut gap, |k, l, boxes_apart, gap| {
                    let across = self.columns_between(j, l);
                    let neighbours = i.abs_diff(k) <= 1 && across <= 1;
                    let seen = l < self.sector && (k, l) < (i, j);
                    if neighbours || seen {
                        return;
                    }
                    let other = self.cell([k, l]);
                    if boxes_apart == 0.0 && cross_each_other(&own, &other) {
                        *gap = 0.0;
                        closes |= 3 * across >= columns;
                    } else if dot(normals[i][j], normals[k][l]) <= FACING {
                        for (a, b) in [([i, j], [k, l]), ([k, l], [i, j])] {
                            self.approach(&lengths, a, b, min_distance, gap);
                        }
                    }
                });
            }
            Contact { gap, closes }
        };
        let found = (0..rows).into_par_iter().map(of_row);
        let found = found.reduce(|| Contact::NONE, Contact::and);
        let gap = if found.gap < limit {
            found.gap
        } else {
            f64::INFINITY
        };
        Contact { gap, ..found }
    }

    /// Lowers `gap` to the smallest distance of a corner of one cell from another cell, of those pairs of points that
    /// are far enough apart along the surface.
    fn approach(
        &self,
        lengths: &Lengths,
        from: [usize; 2],
        to: [usize; 2],
        min_distance: f64,
        gap: &mut f64,
    ) {
        let place =
            |[i, j]: [usize; 2], [row, column]: [usize; 2]| [(i + row) as f64, (j + column) as f64];
        let other = self.cell(to);
        for (p, corner) in self.cell(from).into_iter().zip(CORNERS) {
            for triangle in TRIANGLES {
                let weights = nearest(p, &triangle.map(|c| other[c]));
                let far = distance(p, combine(&triangle.map(|c| other[c]), weights));
                if far >= *gap {
                    continue;
                }
                let places = triangle.map(|c| place(to, CORNERS[c]));
                let q = [0, 1].map(|d| (0..3).map(|c| weights[c] * places[c][d]).sum());
                let along = lengths.between(place(from, corner), q);
                if along >= min_distance.max(APPROACH * far) {
                    *gap = far;
                }
            }
        }
    }
}

/// Returns the unit normal of a cell; zero if it has no area.
fn normal([a, b, c, d]: &[Point; 4]) -> Point {
    let n = cross(minus(*c, *a), minus(*d, *b));
    let size = dot(n, n).sqrt();
    if size > 0.0 {
        n.map(|x| x / size)
    } else {
        [0.0; 3]
    }
}

/// Returns whether a triangle of one cell intersects one of another.
fn cross_each_other(a: &[Point; 4], b: &[Point; 4]) -> bool {
    let triangles =
        |cell: &[Point; 4]| -> [Triangle; 2] { TRIANGLES.map(|corners| corners.map(|c| cell[c])) };
    let others = triangles(b);
    triangles(a)
        .iter()
        .any(|a| others.iter().any(|b| intersect(a, b)))
}

/// Current lengths along the lines of a grid.
struct Lengths {
    /// From the first row, by row and column; the first column once more at the end.
    along: Vec<Vec<f64>>,
    /// From the first column, by row and column, and once around.
    around: Vec<Vec<f64>>,
}

impl Lengths {
    fn of(points: &[Vec<Point>]) -> Self {
        let columns = points[0].len();
        let mut along = vec![vec![0.0; columns + 1]];
        for (i, rows) in points.windows(2).enumerate() {
            let sum = |j: usize| along[i][j] + distance(rows[0][j % columns], rows[1][j % columns]);
            let sums = (0..=columns).map(sum).collect();
            along.push(sums);
        }
        let around = |row: &Vec<Point>| {
            let mut sums = vec![0.0];
            for j in 0..columns {
                sums.push(sums[j] + distance(row[j], row[(j + 1) % columns]));
            }
            sums
        };
        Self {
            along,
            around: points.iter().map(around).collect(),
        }
    }

    /// Returns the distance along the surface of two points, given by row and column with their fractions.
    fn between(&self, [i, j]: [f64; 2], [k, l]: [f64; 2]) -> f64 {
        let along = |column: f64| {
            (interpolate(&self.along, i, column) - interpolate(&self.along, k, column)).abs()
        };
        let columns = (self.around[0].len() - 1) as f64;
        let around = |row: f64| {
            let at = |column: f64| interpolate(&self.around, row, column);
            let one_way = (at(j) - at(l)).abs();
            one_way.min(at(columns) - one_way)
        };
        along(j).min(along(l)).hypot(around(i).min(around(k)))
    }
}

/// Returns the bilinear interpolation of values of a grid at a row and a column with their fractions.
fn interpolate(values: &[Vec<f64>], row: f64, column: f64) -> f64 {
    let (i, j) = (
        (row as usize).min(values.len() - 2),
        (column as usize).min(values[0].len() - 2),
    );
    let (s, t) = (row - i as f64, column - j as f64);
    let in_row = |i: usize| values[i][j] + t * (values[i][j + 1] - values[i][j]);
    in_row(i) + s * (in_row(i + 1) - in_row(i))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a surface through `at(z, φ)` with 61 rows from z = 0 to 3 and 120 columns.
    fn surface(at: impl Fn(f64, f64) -> Point) -> Surface {
        let point = |i: usize, j: usize| at(0.05 * i as f64, TAU * j as f64 / 120.0);
        Surface {
            points: (0..61)
                .map(|i| (0..120).map(|j| point(i, j)).collect())
                .collect(),
            sector: 120,
        }
    }

    #[test]
    fn no_parts_of_a_round_or_bent_or_narrowed_tube_approach_each_other() {
        for (narrow, bend) in [(0.0, 0.0), (0.0, 0.3), (0.7, 0.0), (0.7, 0.3)] {
            let tube = surface(|z, phi| {
                let r = 0.5 * (1.0 - narrow * (-(z - 1.5_f64).powi(2) / 0.1).exp());
                [z, r * phi.cos() + bend * z * z, r * phi.sin()]
            });
            assert_eq!(tube.contact(0.06, 0.1), Contact::NONE, "{narrow} {bend}");
        }
    }

    #[test]
    fn the_gap_of_a_waist_is_its_width_until_it_closes() {
        for phase in [0.0, 0.02, 1.0] {
            let waist = |width: f64| {
                surface(|z, phi| {
                    let (sin, cos) = (phi + phase).sin_cos();
                    [z, 0.5 * cos, sin * (0.5 * width + 0.3 * cos * cos)]
                })
            };
            let open = waist(0.04).contact(0.06, 0.1);
            assert!((open.gap - 0.04).abs() < 5e-4, "{phase}: {open:?}");
            assert!(!open.closes);
            assert_eq!(waist(0.04).contact(0.06, 0.03), Contact::NONE);
            let closed = Contact {
                gap: 0.0,
                closes: true,
            };
            assert_eq!(waist(-0.04).contact(0.06, 0.1), closed);
        }
    }

    #[test]
    fn distances_along_a_cylinder_are_those_of_its_unrolled_plane() {
        let tube = surface(|z, phi| [z, 0.5 * phi.cos(), 0.5 * phi.sin()]);
        let lengths = Lengths::of(&tube.points);
        // Columns are chords of 3°.
        let chord = (TAU / 240.0).sin();
        for ([i, j], [k, l], columns) in [
            ([0.0, 0.0], [0.0, 10.0], 10.0),
            ([2.5, 1.25], [12.0, 119.5], 1.75),
            ([60.0, 120.0], [3.0, 60.0], 60.0),
            ([7.0, 7.0], [7.0, 7.5], 0.5),
        ] {
            let expected = (0.05_f64 * (i - k)).hypot(columns * chord);
            let found = lengths.between([i, j], [k, l]);
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
    }
}
