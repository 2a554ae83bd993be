//! Bézier patches in three dimensions: one element of a spline surface, or a part of it.

use super::vector::{Vector, between, minus, plus};
use crate::contact::bernstein::{MAX_POINTS, bernstein};

/// A Bézier patch over (v, w) from 0 to 1: v along the tube, w around it. Points are (z, x, y), in D.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch {
    /// Control points, along and around.
    pub points: [[Vector; MAX_POINTS]; MAX_POINTS],
    /// Degree in both directions.
    pub degree: usize,
}

/// A point of a patch with its derivatives over v and w.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchPoint {
    /// The point.
    pub position: Vector,
    /// First derivatives over v and w.
    pub slopes: [Vector; 2],
    /// Second derivatives over vv, vw and ww.
    pub curvatures: [Vector; 3],
}

impl Patch {
    /// Returns the control points, row by row.
    pub fn all_points(&self) -> impl Iterator<Item = Vector> + Clone + '_ {
        let n = self.degree + 1;
        self.points[..n]
            .iter()
            .flat_map(move |row| row[..n].iter().copied())
    }

    /// Returns the differences of successive control points in a direction (0 along, 1 around), times the degree. The
    /// derivative of the patch in that direction lies in their convex hull.
    pub fn differences(&self, direction: usize) -> impl Iterator<Item = Vector> + Clone + '_ {
        let n = self.degree + 1;
        let p = self.degree as f64;
        (0..self.degree).flat_map(move |i| {
            (0..n).map(move |j| {
                let [from, to] = match direction {
                    0 => [self.points[i][j], self.points[i + 1][j]],
                    _ => [self.points[j][i], self.points[j][i + 1]],
                };
                minus(to, from).map(|d| p * d)
            })
        })
    }

    /// Returns the largest second derivatives over vv, vw and ww, as bounds of their lengths.
    pub fn largest_curvatures(&self) -> [f64; 3] {
        let n = self.degree + 1;
        let p = self.degree as f64;
        let at = |i: usize, j: usize| self.points[i][j];
        let mut largest = [0.0_f64; 3];
        for i in 0..n {
            for j in 0..n {
                if i + 2 < n {
                    let d = minus(
                        minus(at(i + 2, j), at(i + 1, j)),
                        minus(at(i + 1, j), at(i, j)),
                    );
                    largest[0] = largest[0].max(super::vector::dot(d, d));
                }
                if i + 1 < n && j + 1 < n {
                    let d = minus(
                        minus(at(i + 1, j + 1), at(i + 1, j)),
                        minus(at(i, j + 1), at(i, j)),
                    );
                    largest[1] = largest[1].max(super::vector::dot(d, d));
                }
                if j + 2 < n {
                    let d = minus(
                        minus(at(i, j + 2), at(i, j + 1)),
                        minus(at(i, j + 1), at(i, j)),
                    );
                    largest[2] = largest[2].max(super::vector::dot(d, d));
                }
            }
        }
        let factors = [p * (p - 1.0), p * p, p * (p - 1.0)];
        [0, 1, 2].map(|k| factors[k] * largest[k].sqrt())
    }

    /// Returns the point at (v, w) with its derivatives.
    pub fn at(&self, place: [f64; 2]) -> PatchPoint {
        let n = self.degree + 1;
        let along = jet(self.degree, place[0]);
        let around = jet(self.degree, place[1]);
        let mut sums = [[0.0; 3]; 6];
        for (i, row) in self.points[..n].iter().enumerate() {
            // Value, first and second derivative around.
            let (mut value, mut first, mut second) = ([0.0; 3], [0.0; 3], [0.0; 3]);
            for (j, point) in row[..n].iter().enumerate() {
                value = plus(value, around[0][j], *point);
                first = plus(first, around[1][j], *point);
                second = plus(second, around[2][j], *point);
            }
            sums[0] = plus(sums[0], along[0][i], value);
            sums[1] = plus(sums[1], along[1][i], value);
            sums[2] = plus(sums[2], along[0][i], first);
            sums[3] = plus(sums[3], along[2][i], value);
            sums[4] = plus(sums[4], along[1][i], first);
            sums[5] = plus(sums[5], along[0][i], second);
        }
        let [position, dv, dw, dvv, dvw, dww] = sums;
        PatchPoint {
            position,
            slopes: [dv, dw],
            curvatures: [dvv, dvw, dww],
        }
    }

    /// Returns the point at (v, w).
    #[cfg(test)]
    pub fn position(&self, [v, w]: [f64; 2]) -> Vector {
        let n = self.degree + 1;
        let [along, around] = [v, w].map(|xi| bernstein(self.degree, xi));
        let mut sum = [0.0; 3];
        for (row, a) in self.points[..n].iter().zip(&along) {
            for (point, b) in row[..n].iter().zip(&around) {
                for c in 0..3 {
                    sum[c] += a * b * point[c];
                }
            }
        }
        sum
    }

    /// Returns the halves of the patch in a direction: 0 along, 1 around.
    pub fn halves(&self, direction: usize) -> [Self; 2] {
        let (mut left, mut right) = (*self, *self);
        let n = self.degree + 1;
        for other in 0..n {
            let place = |i: usize| match direction {
                0 => (i, other),
                _ => (other, i),
            };
            for level in (1..n).rev() {
                for i in 0..level {
                    let (a, b) = (place(i), place(i + 1));
                    right.points[a.0][a.1] =
                        between(right.points[a.0][a.1], right.points[b.0][b.1], 0.5);
                }
                let (to, first) = (place(n - level), place(0));
                left.points[to.0][to.1] = right.points[first.0][first.1];
            }
        }
        [left, right]
    }
}

/// Returns the Bernstein polynomials of degree p at ξ with their first and second derivatives.
#[inline]
fn jet(degree: usize, xi: f64) -> [[f64; MAX_POINTS]; 3] {
    let p = degree as f64;
    // Those of degree p − 2, from which one level up gives those of degree p − 1, and another of degree p.
    let mut values = bernstein(degree.saturating_sub(2), xi);
    let mut jet = [[0.0; MAX_POINTS]; 3];
    if degree >= 2 {
        for i in 0..=degree {
            let at = |back: usize| if i >= back { values[i - back] } else { 0.0 };
            jet[2][i] = p * (p - 1.0) * (at(2) - 2.0 * at(1) + at(0));
        }
        raise(&mut values, degree - 1, xi);
    }
    for i in 0..=degree {
        let left = if i > 0 { values[i - 1] } else { 0.0 };
        jet[1][i] = p * (left - values[i]);
    }
    raise(&mut values, degree, xi);
    jet[0] = values;
    jet
}

/// Turns the Bernstein polynomials of the degree below into those of a degree.
#[inline]
fn raise(values: &mut [f64; MAX_POINTS], degree: usize, xi: f64) {
    for i in (0..=degree).rev() {
        let left = if i > 0 { values[i - 1] } else { 0.0 };
        values[i] = xi * left + (1.0 - xi) * values[i];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::surfaces::random::Random;
    use crate::contact::surfaces::vector::length;

    fn patch(degree: usize, random: &mut Random) -> Patch {
        let mut points = [[[0.0; 3]; MAX_POINTS]; MAX_POINTS];
        for (i, row) in points.iter_mut().enumerate() {
            for (j, point) in row.iter_mut().enumerate() {
                let rough = [(); 3].map(|()| random.next() - 0.5);
                *point = [
                    i as f64 + 0.5 * rough[0],
                    j as f64 + 0.5 * rough[1],
                    rough[2],
                ];
            }
        }
        Patch { points, degree }
    }

    #[test]
    fn derivatives_are_those_of_differences_and_halves_are_parts() {
        let mut random = Random::new(3);
        for degree in 1..=5 {
            let patch = patch(degree, &mut random);
            let at = [0.3, 0.8];
            let point = patch.at(at);
            assert!(length(minus(point.position, patch.position(at))) < 1e-14);
            let h = 1e-5;
            let moved = |dv: f64, dw: f64| patch.at([at[0] + dv, at[1] + dw]);
            let difference = |a: Vector, b: Vector| minus(a, b).map(|d| d / (2.0 * h));
            let dv = difference(moved(h, 0.0).position, moved(-h, 0.0).position);
            let dw = difference(moved(0.0, h).position, moved(0.0, -h).position);
            assert!(length(minus(dv, point.slopes[0])) < 1e-8);
            assert!(length(minus(dw, point.slopes[1])) < 1e-8);
            let second = |i: usize, dv: f64, dw: f64| {
                difference(moved(dv, dw).slopes[i], moved(-dv, -dw).slopes[i])
            };
            let seconds = [second(0, h, 0.0), second(0, 0.0, h), second(1, 0.0, h)];
            for (own, of) in point.curvatures.iter().zip(seconds) {
                assert!(length(minus(*own, of)) < 1e-7, "{degree}");
            }
            let bounds = patch.largest_curvatures();
            for (curvature, bound) in point.curvatures.iter().zip(bounds) {
                assert!(length(*curvature) <= bound + 1e-12);
            }
            for direction in [0, 1] {
                let [left, right] = patch.halves(direction);
                for (part, shift) in [(left, 0.0), (right, 0.5)] {
                    let mut place = [0.4, 0.4];
                    let own = part.position(place);
                    place[direction] = 0.5 * place[direction] + shift;
                    assert!(length(minus(own, patch.position(place))) < 1e-14);
                }
            }
        }
    }
}
