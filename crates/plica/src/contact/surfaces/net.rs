//! The control points of a face of the whole tube: their place among the unknowns of the cyclic sector, and the Bézier
//! patches of the elements between them.

use super::patch::Patch;
use super::vector::{Vector, plus};
use crate::assembly::SplineTube;
use crate::contact::Face;
use crate::contact::bernstein::{MAX_POINTS, bernstein, bernstein_slopes};
use crate::spline::Basis;
use crate::tube::Tube;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Bézier form of the functions of an element: by Bézier point and function.
type Factors = [[f64; MAX_POINTS]; MAX_POINTS];

/// Values and slopes, over the place in their element, of the functions of an element along or around.
pub type Functions = [[f64; MAX_POINTS]; 2];

/// The control points of a face of the whole tube.
///
/// A net is a list of vectors, one per control point, numbered by row along the tube and then by ring around the whole
/// tube. Patches are numbered in the same way. The sector repeats around the tube.
#[derive(Clone, Debug)]
pub struct FaceNet {
    /// The face.
    pub face: Face,
    /// Its radius at rest, in D.
    pub radius: f64,
    /// The sign with which the product of the derivatives along and around points away from the material.
    pub free_side: f64,
    /// Degree of the splines.
    pub degree: usize,
    /// Rows of control points.
    pub rows: usize,
    /// Rings around the whole tube.
    pub around: usize,
    /// Rings of the sector.
    pub rings: usize,
    /// Control point through the wall, and number of them.
    pub point: usize,
    points: usize,
    along_tube: Vec<Factors>,
    around_tube: Factors,
    /// Lengths at rest of the elements along the tube, in D.
    pub lengths: Vec<f64>,
    /// Axial positions of the rows at rest, and the radius of the control points.
    at_rest: Vec<f64>,
    control_radius: f64,
    /// Sine and cosine of the angle of each ring.
    turns: Vec<(f64, f64)>,
}

impl FaceNet {
    /// Returns the control points of a face of a tube.
    pub fn new(tube: &SplineTube, face: Face) -> Self {
        let (degree, sector) = (tube.degree(), &tube.sector);
        let (radius, free_side, point) = match face {
            Face::Outer => (Tube::OUTER_RADIUS, -1.0, tube.wall.functions() - 1),
            Face::Inner => (tube.tube.inner_radius(), 1.0, 0),
        };
        let lengths = (0..tube.axial.elements()).map(|e| {
            let (from, to) = tube.axial.element(e);
            to - from
        });
        Self {
            face,
            radius,
            free_side,
            degree,
            rows: tube.axial.functions(),
            around: sector.around,
            rings: sector.rings,
            point,
            points: tube.wall.functions(),
            along_tube: (0..tube.axial.elements())
                .map(|e| factors(&tube.axial, e))
                .collect(),
            around_tube: factors(&Basis::uniform_element(degree), 0),
            lengths: lengths.collect(),
            at_rest: tube.axial.greville(),
            control_radius: radius * tube.circle.control_radius,
            turns: (0..sector.around)
                .map(|j| sector.ring_angle(j).sin_cos())
                .collect(),
        }
    }

    /// Returns the first of the three unknowns, a number of rings apart, of a control point.
    fn unknown(&self, row: usize, ring: usize) -> usize {
        (row * self.points + self.point) * 3 * self.rings + ring % self.rings
    }

    /// Returns sine and cosine of the angle of a ring.
    pub fn turn(&self, ring: usize) -> (f64, f64) {
        self.turns[ring]
    }

    /// Returns the number of elements along the tube.
    pub fn elements(&self) -> usize {
        self.lengths.len()
    }

    /// Returns the angle of an element around the tube.
    pub fn element_angle(&self) -> f64 {
        TAU / self.around as f64
    }

    /// Returns the control points of a state.
    pub fn positions(&self, u: &[f64]) -> Vec<Vector> {
        let mut net = self.motions(u);
        for (row, points) in net.chunks_exact_mut(self.around).enumerate() {
            for (point, &(sin, cos)) in points.iter_mut().zip(&self.turns) {
                let at_rest = [
                    self.at_rest[row],
                    self.control_radius * cos,
                    self.control_radius * sin,
                ];
                *point = plus(*point, 1.0, at_rest);
            }
        }
        net
    }

    /// Returns the displacements of the control points.
    pub fn motions(&self, v: &[f64]) -> Vec<Vector> {
        let mut net = Vec::with_capacity(self.rows * self.around);
        for row in 0..self.rows {
            for (ring, &(sin, cos)) in self.turns.iter().enumerate() {
                let at = self.unknown(row, ring);
                let [z, r, t] = [0, 1, 2].map(|i| v[at + i * self.rings]);
                net.push([z, r * cos - t * sin, r * sin + t * cos]);
            }
        }
        net
    }

    /// Adds `factor` times the forces on the control points of the whole tube to those on the unknowns of the sector.
    pub fn add_forces(&self, factor: f64, forces: &[Vector], y: &mut [f64]) {
        for (row, forces) in forces.chunks_exact(self.around).enumerate() {
            for ((ring, force), &(sin, cos)) in forces.iter().enumerate().zip(&self.turns) {
                let at = self.unknown(row, ring);
                let [z, x, t] = *force;
                y[at] += factor * z;
                y[at + self.rings] += factor * (x * cos + t * sin);
                y[at + 2 * self.rings] += factor * (t * cos - x * sin);
            }
        }
    }

    /// Returns the patches of all elements of a net.
    pub fn patches(&self, net: &[Vector]) -> Vec<Patch> {
        let n = self.degree + 1;
        let of_row = |e: usize| {
            // Bézier points along, control points around.
            let along: Vec<Vec<Vector>> = self.along_tube[e][..n]
                .iter()
                .map(|factors| {
                    (0..self.around)
                        .map(|ring| {
                            let terms = factors[..n].iter().enumerate();
                            terms.fold([0.0; 3], |sum, (a, f)| {
                                plus(sum, *f, net[(e + a) * self.around + ring])
                            })
                        })
                        .collect()
                })
                .collect();
            let patch = |element: usize| {
                let mut points = [[[0.0; 3]; MAX_POINTS]; MAX_POINTS];
                for (points, line) in points.iter_mut().zip(&along) {
                    for (point, factors) in points.iter_mut().zip(&self.around_tube[..n]) {
                        for (b, f) in factors[..n].iter().enumerate() {
                            *point = plus(*point, *f, line[self.ring(element, b)]);
                        }
                    }
                }
                Patch {
                    points,
                    degree: self.degree,
                }
            };
            (0..self.around).map(patch).collect::<Vec<_>>()
        };
        let rows: Vec<_> = (0..self.elements()).into_par_iter().map(of_row).collect();
        rows.concat()
    }

    /// Returns the ring of function `b` of an element around.
    #[inline(always)]
    pub fn ring(&self, element: usize, b: usize) -> usize {
        let ring = element + b;
        if ring < self.around {
            ring
        } else {
            ring % self.around
        }
    }

    /// Returns the elements along and around of a patch.
    pub fn elements_of(&self, patch: usize) -> [usize; 2] {
        [patch / self.around, patch % self.around]
    }

    /// Returns the functions of a patch at a place: along, and around.
    pub fn functions(&self, patch: usize, [v, w]: [f64; 2]) -> [Functions; 2] {
        let along = &self.along_tube[patch / self.around];
        [
            combined(self.degree, along, v),
            combined(self.degree, &self.around_tube, w),
        ]
    }
}

fn factors(basis: &Basis, element: usize) -> Factors {
    let mut factors = [[0.0; MAX_POINTS]; MAX_POINTS];
    for (to, from) in factors.iter_mut().zip(basis.bezier_points(element)) {
        to[..from.len()].copy_from_slice(&from);
    }
    factors
}

fn combined(degree: usize, factors: &Factors, xi: f64) -> Functions {
    [bernstein(degree, xi), bernstein_slopes(degree, xi)].map(|polynomials| {
        let mut values = [0.0; MAX_POINTS];
        for (factors, b) in factors.iter().zip(polynomials) {
            for (value, factor) in values.iter_mut().zip(factors) {
                *value += b * factor;
            }
        }
        values
    })
}
