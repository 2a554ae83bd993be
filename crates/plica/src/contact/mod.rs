//! Contact of the wall of an axisymmetric tube with itself, with or without friction.
//!
//! The outer face meets the outer face, the inner face the inner. Contact adds an energy to that of the tube,
//!
//! Π_c = ½ Σ over faces ∫ Σ b(|x − y|) dA₀(x),
//!
//! where y runs over the points of the same face at which the distance from x has a local minimum below the range d̂ of
//! the barrier b, and whose normal faces that of x. The area is that at rest, so muscles do no work on contact. The
//! range is a quarter of the smallest axial element at rest: contact becomes sharper as the mesh is refined. Points are
//! found on the exact curves of the splines, and no length along the wall is excluded. Π_c has continuous second
//! derivatives while the concave radii of the wall exceed d̂.
//!
//! A barrier never lets faces pass through each other if no step does: [`SelfContact::longest_step`].
//!
//! Sources: barrier and steps, incremental potential contact (Li et al. 2020, 2021); local minima that face each other,
//! the geometric contact potential (doi 10.1145/3731142).

mod bezier;
mod boxes;
mod curve;
mod energy;
mod friction;
#[cfg(test)]
mod friction_tests;
mod nearest;
mod pairs;
mod pressure;
mod report;
mod space;
mod step;
mod surface;
#[cfg(test)]
mod tests;

pub use crate::assembly::Barrier;
pub use curve::Face;
pub use friction::{FaceFriction, SelfFriction};
pub use pressure::{PressedPoint, PressureField, place_of};
pub use report::{ContactReport, FaceContact};
pub use space::{SurfaceContact, SurfaceContactState, SurfaceTangent};
pub use surface::{BIOT, CREASE, FaceSurface};

use crate::assembly::SplineTube;
use curve::FaceCurve;
use pairs::{FaceQuadrature, Pair, pairs};
use std::f64::consts::TAU;

/// Contact of a tube of one ring, without twist, with itself.
#[derive(Clone, Debug)]
pub struct SelfContact {
    barrier: Barrier,
    /// Coefficient of friction.
    friction: f64,
    faces: Vec<(FaceCurve, FaceQuadrature)>,
    /// Sectors of the whole tube.
    repeats: f64,
}

/// The pairs of a state, by face.
#[derive(Clone, Debug)]
pub struct ContactState(Vec<Vec<Pair>>);

/// Energy of contact at a state, and its share of the residual scale.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactForces {
    /// Π_c of one sector, in E·D³.
    pub energy: f64,
    /// Sum of the squares of all parts of the forces.
    pub squares: f64,
}

impl SelfContact {
    /// Prepares contact for a discretised tube of one ring.
    ///
    /// # Panics
    ///
    /// If the tube has several rings.
    pub fn new(tube: &SplineTube) -> Self {
        assert!(tube.sector.rings == 1, "a tube of one ring");
        let lengths: Vec<f64> = (0..tube.axial.elements())
            .map(|e| {
                let (from, to) = tube.axial.element(e);
                to - from
            })
            .collect();
        let repeats = tube.sector.repeats();
        let face = |face: Face| {
            let curve = FaceCurve::new(tube, face);
            let areas = lengths.iter().map(|l| TAU * curve.radius * l / repeats);
            let quadrature = FaceQuadrature::new(areas.collect());
            (curve, quadrature)
        };
        Self {
            barrier: *tube.barrier(),
            friction: 0.0,
            faces: vec![face(Face::Outer), face(Face::Inner)],
            repeats,
        }
    }

    /// Returns the barrier.
    pub fn barrier(&self) -> &Barrier {
        &self.barrier
    }

    /// Returns the same contact with another range, in D.
    pub fn with_range(mut self, range: f64) -> Self {
        self.barrier.range = range;
        self
    }

    /// Returns the same contact with a coefficient of friction.
    pub fn with_friction(mut self, friction: f64) -> Self {
        self.friction = friction;
        self
    }

    /// Returns whether the wall has friction on itself.
    pub fn has_friction(&self) -> bool {
        self.friction > 0.0
    }

    /// Finds the pairs of a state.
    pub fn at(&self, u: &[f64]) -> ContactState {
        let of_face = |(curve, quadrature): &(FaceCurve, FaceQuadrature)| {
            pairs(curve, quadrature, &self.barrier, u)
        };
        ContactState(self.faces.iter().map(of_face).collect())
    }

    /// Adds the forces of a state to a residual.
    pub fn add_forces(&self, at: &ContactState, residual: &mut [f64]) -> ContactForces {
        let mut forces = ContactForces::default();
        for ((curve, _), pairs) in self.faces.iter().zip(&at.0) {
            forces.energy += energy::energy(pairs);
            forces.squares += energy::add_forces(curve, pairs, residual);
        }
        forces
    }

    /// Calls `add` with row, column and value of the entries on or below the diagonal of the tangent in a circumferential
    /// mode, in the form and scale of the tube's own; entries of one place add up.
    pub fn add_tangent(
        &self,
        at: &ContactState,
        mode: usize,
        mut add: impl FnMut(usize, usize, f64),
    ) {
        for ((curve, _), pairs) in self.faces.iter().zip(&at.0) {
            energy::add_tangent(curve, pairs, mode, &mut add);
        }
    }

    /// Returns the longest fraction of a step, at most 1, along which no face passes through itself; 0 if one does so
    /// at its start.
    pub fn longest_step(&self, u: &[f64], step: &[f64]) -> f64 {
        let of_face = |(curve, _): &(FaceCurve, FaceQuadrature)| {
            step::longest_step(&curve.curves(u), &curve.motions(step))
        };
        self.faces.iter().map(of_face).fold(1.0, f64::min)
    }

    /// Returns a face that passes through itself, if one does.
    pub fn crossing(&self, u: &[f64]) -> Option<Face> {
        let crosses =
            |(curve, _): &&(FaceCurve, FaceQuadrature)| step::crosses_itself(&curve.curves(u));
        Some(self.faces.iter().find(crosses)?.0.face)
    }
}

impl ContactState {
    /// Returns whether no points are in contact.
    pub fn is_empty(&self) -> bool {
        self.0.iter().all(Vec::is_empty)
    }
}
