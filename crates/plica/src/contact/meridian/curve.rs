//! The meridian of a face of an axisymmetric tube, as Bézier curves.

use super::bezier::{Bezier, Point};
use crate::assembly::SplineTube;
use crate::contact::Face;
use crate::contact::bernstein::{MAX_POINTS, bernstein, bernstein_slopes};
use crate::spline::control_wave;
use crate::tube::Tube;

/// The meridian of a face of an axisymmetric tube without twist: its place among the unknowns.
#[derive(Clone, Debug)]
pub struct FaceCurve {
    /// The face.
    pub face: Face,
    /// Its radius at rest, in D.
    pub radius: f64,
    /// +1 if the free side is on the left of the curve as it runs from z = 0 to L, else −1.
    pub free_side: f64,
    /// Bézier form of every element, by control point and function.
    elements: Vec<[[f64; MAX_POINTS]; MAX_POINTS]>,
    /// Axial positions of the control points at rest.
    at_rest: Vec<f64>,
    /// First unknown of the face in a row, and number of unknowns of a row.
    first: usize,
    row_size: usize,
    /// Control rings around the whole tube.
    rings: usize,
    /// Radius of a spline whose radial control values are one.
    radial: f64,
    degree: usize,
}

impl FaceCurve {
    /// Returns the meridian of a face of a tube of one ring.
    pub fn new(tube: &SplineTube, face: Face) -> Self {
        let degree = tube.degree();
        let element = |e: usize| {
            let mut factors = [[0.0; MAX_POINTS]; MAX_POINTS];
            for (to, from) in factors.iter_mut().zip(tube.axial.bezier_points(e)) {
                to[..=degree].copy_from_slice(&from);
            }
            factors
        };
        let (radius, free_side, point) = match face {
            Face::Outer => (Tube::OUTER_RADIUS, 1.0, tube.wall.functions() - 1),
            Face::Inner => (tube.tube.inner_radius(), -1.0, 0),
        };
        Self {
            face,
            radius,
            free_side,
            elements: (0..tube.axial.elements()).map(element).collect(),
            at_rest: tube.axial.greville(),
            first: 3 * point,
            row_size: tube.row_size(),
            rings: tube.sector.around,
            radial: 1.0 / tube.circle.control_radius,
            degree,
        }
    }

    /// Returns the curves of all elements of a state.
    pub fn curves(&self, u: &[f64]) -> Vec<Bezier> {
        self.map(|row| {
            let motion = self.motion(u, row);
            [self.at_rest[row] + motion[0], self.radius + motion[1]]
        })
    }

    /// Returns the motion of the control points of these curves along a step.
    pub fn motions(&self, step: &[f64]) -> Vec<Bezier> {
        self.map(|row| self.motion(step, row))
    }

    fn motion(&self, u: &[f64], row: usize) -> Point {
        let at = row * self.row_size + self.first;
        [u[at], self.radial * u[at + 1]]
    }

    fn map(&self, point: impl Fn(usize) -> Point) -> Vec<Bezier> {
        let points: Vec<Point> = (0..self.at_rest.len()).map(point).collect();
        let curve = |(e, factors): (usize, &[[f64; MAX_POINTS]; MAX_POINTS])| {
            let points = &points[e..=e + self.degree];
            Bezier::new(factors[..=self.degree].iter().map(|factors| {
                let terms = factors.iter().zip(points);
                terms.fold([0.0; 2], |sum, (f, point)| {
                    [sum[0] + f * point[0], sum[1] + f * point[1]]
                })
            }))
        };
        self.elements.iter().enumerate().map(curve).collect()
    }

    /// Returns values and slopes over ξ of the functions of an element.
    pub fn functions(&self, element: usize, xi: f64) -> [[f64; MAX_POINTS]; 2] {
        let factors = &self.elements[element];
        [
            bernstein(self.degree, xi),
            bernstein_slopes(self.degree, xi),
        ]
        .map(|polynomials| {
            let mut values = [0.0; MAX_POINTS];
            for (factors, b) in factors.iter().zip(polynomials) {
                for (value, factor) in values.iter_mut().zip(factors) {
                    *value += b * factor;
                }
            }
            values
        })
    }

    /// Returns the first unknown, the axial one, of every control point of an element.
    pub fn unknowns(&self, element: usize) -> impl Iterator<Item = usize> + '_ {
        (element..=element + self.degree).map(|row| row * self.row_size + self.first)
    }

    /// Returns for each component of the control points (axial, radial, circumferential) the amplitudes (z, r, θ) of
    /// the displacement (z cos nφ, r cos nφ, −θ sin nφ) of the face per unit of control values of that form. A wave
    /// of control values on splines gives a wave of slightly smaller amplitude.
    pub fn amplitudes(&self, mode: usize) -> [[f64; 3]; 3] {
        if mode == 0 {
            return [[1.0, 0.0, 0.0], [0.0, self.radial, 0.0], [0.0; 3]];
        }
        // In the plane the displacement is ½ [(r − θ) exp(i(n+1)φ) + (r + θ) exp(−i(n−1)φ)].
        let of_wave = |n: usize| 1.0 / control_wave(self.degree, self.rings, n);
        let [lower, own, upper] = [mode - 1, mode, mode + 1].map(of_wave);
        let (mean, difference) = (0.5 * (upper + lower), 0.5 * (lower - upper));
        [
            [own, 0.0, 0.0],
            [0.0, mean, difference],
            [0.0, difference, mean],
        ]
    }
}
