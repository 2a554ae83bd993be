//! Contact of an axisymmetric tube without twist, on the exact curves of its meridians. The stiffness in circumferential
//! modes n ≥ 1 is exact, too.

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
mod step;
mod stretch;
#[cfg(test)]
mod tests;

pub use friction::{FaceFriction, SelfFriction};
pub use pressure::MeridianPressure;

use super::report::FaceContact;
use super::{ContactForces, ContactReport, Face};
use crate::assembly::{Barrier, SplineTube};
use crate::tube::Load;
use curve::FaceCurve;
use pairs::{FaceQuadrature, Pair, pairs};
use std::f64::consts::TAU;

/// Contact of a tube of one ring, without twist, with itself.
#[derive(Clone, Debug)]
pub struct MeridianContact {
    barrier: Barrier,
    /// Coefficient of friction.
    friction: f64,
    faces: Vec<(FaceCurve, FaceQuadrature)>,
    /// Sectors of the whole tube.
    repeats: f64,
}

/// The pairs of a state, by face.
#[derive(Clone, Debug)]
pub struct MeridianPairs(Vec<Vec<Pair>>);

impl MeridianContact {
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
    pub fn at(&self, u: &[f64]) -> MeridianPairs {
        let of_face = |(curve, quadrature): &(FaceCurve, FaceQuadrature)| {
            pairs(curve, quadrature, &self.barrier, u)
        };
        MeridianPairs(self.faces.iter().map(of_face).collect())
    }

    /// Adds the forces of a state to a residual.
    pub fn add_forces(&self, at: &MeridianPairs, residual: &mut [f64]) -> ContactForces {
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
        at: &MeridianPairs,
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

    /// Sums up the contact of a state, with its surfaces.
    pub fn report(&self, tube: &SplineTube, load: &Load, u: &[f64]) -> ContactReport {
        let mut report = ContactReport {
            energy: 0.0,
            faces: [None; 2],
            angles: None,
            surfaces: self.surfaces(tube, load, u),
            friction: None,
        };
        for ((curve, _), pairs) in self.faces.iter().zip(&self.at(u).0) {
            let face = &mut report.faces[usize::from(curve.face == Face::Inner)];
            // A point may belong to several pairs; its area counts once.
            let mut last = None;
            for pair in pairs {
                let place = (pair.x.0, pair.places[0]);
                let (from, to) = tube.axial.element(place.0);
                let z = from + place.1 * (to - from);
                let share = self.repeats * pair.area;
                let area = if last == Some(place) { 0.0 } else { share };
                last = Some(place);
                FaceContact::add(face, z, area, -0.5 * share * pair.barrier.slope, pair.gap);
                report.energy += 0.5 * share * pair.barrier.value;
            }
        }
        report
    }
}

impl MeridianPairs {
    /// Returns whether no points are in contact.
    pub fn is_empty(&self) -> bool {
        self.0.iter().all(Vec::is_empty)
    }
}
