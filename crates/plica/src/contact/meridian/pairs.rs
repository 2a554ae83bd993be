//! Pairs of points of a meridian that are in contact.

use super::bezier::{Bezier, Point, dot, length, minus};
use super::boxes::near_and_turned;
use super::curve::FaceCurve;
use super::nearest::local_minima;
use crate::assembly::{Barrier, BarrierJet};
use crate::contact::bernstein::MAX_POINTS;
use crate::spline::gauss_legendre;
use rayon::prelude::*;

/// Quadrature points of an element.
const POINTS: usize = 8;

/// A quadrature point x of a face and a point y of the same face at which the distance from x has a local minimum
/// below the range.
#[derive(Clone, Copy, Debug)]
pub struct Pair {
    /// Element of x, and the values of its functions there.
    pub x: (usize, [f64; MAX_POINTS]),
    /// Element of y, and values and slopes of its functions there.
    pub y: (usize, [[f64; MAX_POINTS]; 2]),
    /// Places of x and y in their elements, 0 to 1.
    pub places: [f64; 2],
    /// Area of the quadrature point at rest, of the sector of one ring.
    pub area: f64,
    /// g = |x − y|.
    pub gap: f64,
    /// n = (x − y)/g, normal to the face at y.
    pub normal: Point,
    /// Radii of x and y, in D.
    pub radii: [f64; 2],
    /// y′.
    pub slope: Point,
    /// n · y″.
    pub curvature: f64,
    /// The barrier at g.
    pub barrier: BarrierJet,
}

/// Quadrature of one element of a face: places and areas at rest.
#[derive(Clone, Debug)]
pub struct FaceQuadrature {
    points: Vec<(f64, f64)>,
    /// Area at rest of each element.
    areas: Vec<f64>,
}

impl FaceQuadrature {
    /// Makes the quadrature of elements with these areas at rest.
    pub fn new(areas: Vec<f64>) -> Self {
        Self {
            points: gauss_legendre(POINTS),
            areas,
        }
    }

    /// Returns the points of an element, from 0 to 1, with their weights.
    pub fn points(&self) -> &[(f64, f64)] {
        &self.points
    }

    /// Returns the area at rest of an element.
    pub fn area(&self, element: usize) -> f64 {
        self.areas[element]
    }
}

/// Returns all pairs of a state, in the order of their elements. The distance of a point from itself is not a pair, nor
/// is any other whose normals do not face each other; a straight or round face has none.
pub fn pairs(
    face: &FaceCurve,
    quadrature: &FaceQuadrature,
    barrier: &Barrier,
    u: &[f64],
) -> Vec<Pair> {
    let curves = face.curves(u);
    let mut near = near_and_turned(&curves, barrier.range);
    near.retain(|&(e, other)| !all_face_the_same_side(&curves[e], &curves[other]));
    let of_element = |near: &[(usize, usize)]| {
        let mut pairs = vec![];
        let e = near[0].0;
        for &(xi, weight) in &quadrature.points {
            let area = weight * quadrature.areas[e];
            for &(_, other) in near {
                let (x, y) = ((e, &curves[e], xi), (other, &curves[other]));
                pairs_of_point(face, x, y, barrier, area, &mut pairs);
            }
        }
        pairs
    };
    let elements: Vec<&[(usize, usize)]> = near.chunk_by(|a, b| a.0 == b.0).collect();
    let by_element: Vec<Vec<Pair>> = elements.into_par_iter().map(of_element).collect();
    by_element.concat()
}

/// Adds the pairs of a point x with points y of one element.
pub fn pairs_of_point(
    face: &FaceCurve,
    (e, a, xi): (usize, &Bezier, f64),
    (other, b): (usize, &Bezier),
    barrier: &Barrier,
    area: f64,
    pairs: &mut Vec<Pair>,
) {
    let at = a.at(xi);
    let x = at.position;
    if b.differences().all(|d| dot(at.slope, d) > 0.0) || is_beyond(b, x, barrier.range) {
        return;
    }
    local_minima(b, x, &mut |eta| {
        let y = b.at(eta);
        let from_y = minus(x, y.position);
        let gap = length(from_y);
        let faces = dot(at.slope, y.slope) < 0.0 && face.free_side * cross(y.slope, from_y) > 0.0;
        if !(faces && gap < barrier.range && gap > 0.0) {
            return;
        }
        let normal = from_y.map(|d| d / gap);
        pairs.push(Pair {
            x: (e, face.functions(e, xi)[0]),
            y: (other, face.functions(other, eta)),
            places: [xi, eta],
            area,
            gap,
            normal,
            radii: [x[1], y.position[1]],
            slope: y.slope,
            curvature: dot(normal, y.curvature),
            barrier: barrier.at(gap),
        });
    });
}

/// Returns whether the box around the control points of a curve is farther from x than a range.
fn is_beyond(curve: &Bezier, x: Point, range: f64) -> bool {
    (0..2).any(|i| {
        let points = || curve.points().iter().map(|p| p[i]);
        points().all(|p| p > x[i] + range) || points().all(|p| p < x[i] - range)
    })
}

/// Returns whether all normals of two curves are less than 90° apart, judged by their control points.
fn all_face_the_same_side(a: &Bezier, b: &Bezier) -> bool {
    a.differences()
        .all(|s| b.differences().all(|t| dot(s, t) > 0.0))
}

/// Returns a × b: positive if b is on the left of a.
fn cross(a: Point, b: Point) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}
