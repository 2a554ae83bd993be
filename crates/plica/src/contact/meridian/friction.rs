//! Friction of the wall of an axisymmetric tube with itself.
//!
//! A pair of a point x and the nearest point y of the same face, as the material point η, has the slip
//!
//! s = τ · (x − y(η)) − τ₀ · (x₀ − y₀(η)) + s₀,
//!
//! with τ the unit tangent of the face at y, the index 0 for the state from which the load step begins, and s₀ the elastic
//! slip there. A rigid motion of the pair changes no slip. The force along τ is μλ f₁(s) ([`Slip`]) as on obstacles, with
//! λ the normal force of the pair. For the λ, τ and η of some state the forces have the potential Σ μλ f₀(s).

use super::bezier::{Bezier, Point, dot, length, minus};
use super::curve::FaceCurve;
use super::pairs::{FaceQuadrature, Pair};
use super::{ContactForces, MeridianContact};
use crate::assembly::Slip;
use crate::contact::bernstein::MAX_POINTS;
use std::collections::BTreeMap;

/// Share of a pair in the energy of contact: the two points of a gap find each other.
const SHARE: f64 = 0.5;

/// Largest distance along the wall between the points y of a pair before and after a step, in elements; beyond, the pair
/// is another one.
const SAME: f64 = 2.0;

/// Friction in a load step: limits of the forces, tangents, and slips at its start, by face.
#[derive(Clone, Debug)]
pub struct SelfFriction {
    faces: Vec<Vec<FrictionPair>>,
    /// Largest elastic slip ε, in D.
    elastic: f64,
}

/// Friction of a pair.
#[derive(Clone, Copy, Debug)]
struct FrictionPair {
    /// Number of the quadrature point x on its face.
    number: usize,
    /// Elements of x and y, places there, and values of the functions.
    x: (usize, f64, [f64; MAX_POINTS]),
    y: (usize, f64, [f64; MAX_POINTS]),
    tangent: Point,
    /// τ₀ · (x₀ − y₀) − s₀.
    offset: f64,
    /// μλ times the area at rest, of the sector, in the state that gives it and at the start of the step.
    limit: f64,
    limit_at_start: f64,
}

/// Friction of a face with itself, on the whole tube.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FaceFriction {
    /// Sum of the sizes of the friction forces between the two sides, in E·D².
    pub force: f64,
    /// Energy that has been dissipated since the start of the step, in E·D³.
    pub dissipated: f64,
}

impl MeridianContact {
    /// Returns the friction in a step from a state `start` with its elastic slips, with the normal forces and pairs of a
    /// state `u`.
    pub fn friction(
        &self,
        (start, slips): (&[f64], &[f64]),
        u: &[f64],
        elastic: f64,
    ) -> SelfFriction {
        // By face and number of x: place of y and slip.
        let mut before: BTreeMap<[usize; 2], Vec<[f64; 2]>> = BTreeMap::new();
        for [face, number, place, slip] in slips.as_chunks::<4>().0 {
            let key = [*face as usize, *number as usize];
            before.entry(key).or_default().push([*place, *slip]);
        }
        let (now, then) = (self.at(u), self.at(start));
        let faces = self.faces.iter().enumerate();
        let of_face = |(f, (curve, quadrature)): (usize, &(FaceCurve, FaceQuadrature))| {
            let mut limits: BTreeMap<usize, Vec<[f64; 2]>> = BTreeMap::new();
            for pair in &then.0[f] {
                let of_pair = [place(pair), self.limit(pair)];
                limits
                    .entry(number(quadrature, pair))
                    .or_default()
                    .push(of_pair);
            }
            let curves = curve.curves(start);
            let of_pair = |pair: &Pair| {
                let number = number(quadrature, pair);
                let slip = nearest(before.get(&[f, number]), place(pair));
                let [x, y] = [(pair.x.0, pair.places[0]), (pair.y.0, pair.places[1])];
                let at_start = curves[y.0].at(y.1);
                let from = minus(curves[x.0].at(x.1).position, at_start.position);
                FrictionPair {
                    number,
                    x: (x.0, x.1, pair.x.1),
                    y: (y.0, y.1, pair.y.1[0]),
                    tangent: unit(pair.slope),
                    offset: dot(unit(at_start.slope), from) - slip,
                    limit: self.limit(pair),
                    limit_at_start: nearest(limits.get(&number), place(pair)),
                }
            };
            // Pairs that part have dissipated energy, too.
            let mut places: BTreeMap<usize, Vec<[f64; 2]>> = BTreeMap::new();
            for pair in &now.0[f] {
                let of_pair = [place(pair), 1.0];
                places
                    .entry(number(quadrature, pair))
                    .or_default()
                    .push(of_pair);
            }
            let parted = then.0[f].iter().filter(|pair| {
                let own = places.get(&number(quadrature, pair));
                nearest(own, place(pair)) == 0.0
            });
            let curves_now = curve.curves(u);
            let parted = parted.map(|pair| FrictionPair {
                tangent: unit(curves_now[pair.y.0].at(pair.places[1]).slope),
                limit: 0.0,
                ..of_pair(pair)
            });
            now.0[f].iter().map(of_pair).chain(parted).collect()
        };
        SelfFriction {
            faces: faces.map(of_face).collect(),
            elastic,
        }
    }

    /// Returns the elastic slips of a state at the end of a step: four numbers for each pair that has one.
    pub fn elastic_slips(&self, friction: &SelfFriction, u: &[f64]) -> Vec<f64> {
        let mut slips = vec![];
        for (f, (curve, _)) in self.faces.iter().enumerate() {
            let curves = curve.curves(u);
            for pair in &friction.faces[f] {
                let slip = pair
                    .slip(&curves)
                    .clamp(-friction.elastic, friction.elastic);
                if slip != 0.0 && pair.limit > 0.0 {
                    slips.extend([
                        f as f64,
                        pair.number as f64,
                        pair.y.0 as f64 + pair.y.1,
                        slip,
                    ]);
                }
            }
        }
        slips
    }

    /// Returns the friction of the outer and the inner face.
    pub fn friction_on_faces(&self, friction: &SelfFriction, u: &[f64]) -> [FaceFriction; 2] {
        let mut found = [FaceFriction::default(); 2];
        for (f, (curve, _)) in self.faces.iter().enumerate() {
            let curves = curve.curves(u);
            for pair in &friction.faces[f] {
                let slip = pair.slip(&curves).abs();
                let law = Slip::at(slip, friction.elastic);
                let limit = 0.5 * (pair.limit_at_start + pair.limit);
                let beyond = (slip - friction.elastic).max(0.0);
                found[f].force += self.repeats * pair.limit * law.secant * slip;
                found[f].dissipated += self.repeats * limit * beyond;
            }
        }
        found
    }

    /// Adds the friction forces of a state to a residual.
    pub fn add_friction(
        &self,
        friction: &SelfFriction,
        u: &[f64],
        residual: &mut [f64],
    ) -> ContactForces {
        let mut forces = ContactForces::default();
        for ((curve, _), pairs) in self.faces.iter().zip(&friction.faces) {
            let curves = curve.curves(u);
            for pair in pairs {
                let slip = pair.slip(&curves);
                let law = Slip::at(slip.abs(), friction.elastic);
                forces.energy += pair.limit * law.energy;
                for (unknown, variation) in pair.variations(curve) {
                    let part = pair.limit * law.secant * slip * variation;
                    residual[unknown] += part;
                    forces.squares += part * part;
                }
            }
        }
        forces
    }

    /// Calls `add` with row, column and value of the entries on or below the diagonal of the tangent of friction; entries
    /// of one place add up.
    pub fn add_friction_tangent(
        &self,
        friction: &SelfFriction,
        u: &[f64],
        mut add: impl FnMut(usize, usize, f64),
    ) {
        for ((curve, _), pairs) in self.faces.iter().zip(&friction.faces) {
            let curves = curve.curves(u);
            for pair in pairs {
                let slip = pair.slip(&curves);
                let law = Slip::at(slip.abs(), friction.elastic);
                let stiffness = pair.limit * (law.secant + slip * slip * law.second);
                let all = pair.variations(curve);
                for (row, a) in &all {
                    for (column, b) in &all {
                        if row >= column {
                            add(*row, *column, stiffness * a * b);
                        }
                    }
                }
            }
        }
    }

    /// Returns μλ of a pair times its area.
    fn limit(&self, pair: &Pair) -> f64 {
        -SHARE * self.friction * pair.area * pair.barrier.slope
    }
}

#[cfg(test)]
impl SelfFriction {
    /// Returns the largest μλ of a pair times its area.
    pub fn largest_limit(&self) -> f64 {
        let pairs = self.faces.iter().flatten();
        pairs.fold(0.0, |most, pair| most.max(pair.limit))
    }
}

impl FrictionPair {
    fn slip(&self, curves: &[Bezier]) -> f64 {
        let [x, y] = [self.x, self.y].map(|(e, xi, _)| curves[e].at(xi).position);
        dot(self.tangent, minus(x, y)) - self.offset
    }

    /// Returns the unknowns of both points with the derivatives of the slip; an unknown of both appears twice.
    fn variations(&self, face: &FaceCurve) -> Vec<(usize, f64)> {
        let [axial, radial, _] = face.amplitudes(0);
        let along = [self.tangent[0] * axial[0], self.tangent[1] * radial[1]];
        let mut all = Vec::with_capacity(4 * MAX_POINTS);
        for (sign, (element, _, values)) in [(1.0, self.x), (-1.0, self.y)] {
            for (first, value) in face.unknowns(element).zip(values) {
                all.extend([0, 1].map(|i| (first + i, sign * value * along[i])));
            }
        }
        all
    }
}

/// Returns the number of the quadrature point x of a pair on its face.
fn number(quadrature: &FaceQuadrature, pair: &Pair) -> usize {
    let points = quadrature.points();
    let own = points.iter().position(|(xi, _)| *xi == pair.places[0]);
    pair.x.0 * points.len() + own.unwrap_or(0)
}

/// Returns the place of y along the face, in elements.
fn place(pair: &Pair) -> f64 {
    pair.y.0 as f64 + pair.places[1]
}

/// Returns the value at the place nearest to another, 0 if none is near.
fn nearest(values: Option<&Vec<[f64; 2]>>, place: f64) -> f64 {
    let far = |value: &&[f64; 2]| (value[0] - place).abs();
    let values = values.into_iter().flatten();
    let found = values.min_by(|a, b| far(a).total_cmp(&far(b)));
    found
        .filter(|value| far(value) <= SAME)
        .map_or(0.0, |value| value[1])
}

fn unit(v: Point) -> Point {
    let size = length(v);
    v.map(|x| x / size)
}
