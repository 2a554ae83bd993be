//! Plane Bézier curves: one element of a spline curve, or a part of it.

use crate::contact::bernstein::MAX_POINTS;

/// A point or a vector (z, r) in the meridian plane, in D.
pub type Point = [f64; 2];

/// A Bézier curve over ξ from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bezier {
    points: [Point; MAX_POINTS],
    count: usize,
}

/// A point of a curve with its derivatives over ξ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    /// The point.
    pub position: Point,
    /// First derivative.
    pub slope: Point,
    /// Second derivative.
    pub curvature: Point,
}

impl Bezier {
    /// Makes the curve of some control points, from two to six.
    pub fn new(points: impl IntoIterator<Item = Point>) -> Self {
        let mut curve = Self {
            points: [[0.0; 2]; MAX_POINTS],
            count: 0,
        };
        for point in points.into_iter().take(MAX_POINTS) {
            curve.points[curve.count] = point;
            curve.count += 1;
        }
        curve
    }

    /// Returns the control points.
    pub fn points(&self) -> &[Point] {
        &self.points[..self.count]
    }

    /// Returns the degree.
    pub fn degree(&self) -> usize {
        self.count - 1
    }

    /// Returns the differences of successive control points: the directions that the curve takes lie
    /// in their cone.
    pub fn differences(&self) -> impl Iterator<Item = Point> + '_ {
        self.points().windows(2).map(|p| minus(p[1], p[0]))
    }

    /// Returns the point at ξ with its derivatives.
    pub fn at(&self, xi: f64) -> CurvePoint {
        let p = self.degree() as f64;
        let mut points = self.points;
        let mut level = self.count;
        let step = |points: &mut [Point; MAX_POINTS], level: usize| {
            for i in 0..level - 1 {
                points[i] = between(points[i], points[i + 1], xi);
            }
        };
        // De Casteljau's algorithm down to a parabola, whose three points give all derivatives.
        while level > 3 {
            step(&mut points, level);
            level -= 1;
        }
        let mut curvature = [0.0; 2];
        if level == 3 {
            let factor = p * (p - 1.0);
            curvature = [0, 1].map(|i| factor * (points[2][i] - 2.0 * points[1][i] + points[0][i]));
            step(&mut points, level);
        }
        let slope = [0, 1].map(|i| p * (points[1][i] - points[0][i]));
        CurvePoint {
            position: between(points[0], points[1], xi),
            slope,
            curvature,
        }
    }

    /// Returns the halves of the curve.
    pub fn halves(&self) -> [Self; 2] {
        let (mut left, mut right) = (*self, *self);
        for level in (1..self.count).rev() {
            for i in 0..level {
                right.points[i] = between(right.points[i], right.points[i + 1], 0.5);
            }
            left.points[self.count - level] = right.points[0];
        }
        // The points that remain in `right` run from the middle to the end.
        [left, right]
    }
}

/// Returns a − b.
pub fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

/// Returns a · b.
pub fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Returns the length of a vector.
pub fn length(a: Point) -> f64 {
    dot(a, a).sqrt()
}

fn between(a: Point, b: Point, xi: f64) -> Point {
    [0, 1].map(|i| (1.0 - xi) * a[i] + xi * b[i])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::bernstein::{bernstein, bernstein_slopes};

    fn curves() -> impl Iterator<Item = Bezier> {
        let points = [
            [0.0, 0.1],
            [0.3, 0.9],
            [0.2, -0.4],
            [1.1, 0.3],
            [0.7, 0.8],
            [-0.2, 0.5],
        ];
        (2..=6).map(move |count| Bezier::new(points.into_iter().take(count)))
    }

    #[test]
    fn points_are_sums_of_control_points_times_bernstein_polynomials() {
        for curve in curves() {
            for xi in [0.0, 0.2, 0.77, 1.0] {
                let at = curve.at(xi);
                let values = bernstein(curve.degree(), xi);
                let slopes = bernstein_slopes(curve.degree(), xi);
                for i in 0..2 {
                    let sum = |n: &[f64]| -> f64 {
                        let terms = curve.points().iter().zip(n);
                        terms.map(|(point, n)| n * point[i]).sum()
                    };
                    assert!((at.position[i] - sum(&values)).abs() < 1e-14);
                    assert!((at.slope[i] - sum(&slopes)).abs() < 1e-13);
                }
            }
        }
    }

    #[test]
    fn the_second_derivative_is_that_of_the_slope() {
        for curve in curves() {
            let (xi, h) = (0.4, 1e-5);
            let [low, high] = [xi - h, xi + h].map(|xi| curve.at(xi).slope);
            for i in 0..2 {
                let slope = (high[i] - low[i]) / (2.0 * h);
                assert!((slope - curve.at(xi).curvature[i]).abs() < 1e-7);
            }
        }
    }

    #[test]
    fn halves_continue_each_other() {
        for curve in curves() {
            let [left, right] = curve.halves();
            for xi in [0.0, 0.3, 1.0] {
                for (half, at) in [(left, 0.5 * xi), (right, 0.5 + 0.5 * xi)] {
                    let (a, b) = (half.at(xi).position, curve.at(at).position);
                    assert!(length(minus(a, b)) < 1e-15, "{a:?} {b:?}");
                }
            }
        }
    }
}
