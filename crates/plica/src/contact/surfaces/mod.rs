//! Contact of the wall of a tube of many rings with itself, without friction: see [`super`]. Points are found on the exact
//! spline surfaces.

mod average;
mod energy;
mod low_harmonics;
mod nearest;
mod net;
mod pairs;
mod patch;
mod pressure;
#[cfg(test)]
mod random;
mod step;
mod stretch;
#[cfg(test)]
mod tests;
mod tree;
mod vector;

pub use pressure::SurfacePressure;

use super::report::FaceContact;
use super::{ContactForces, ContactReport, Face};
use crate::assembly::{Barrier, LowHarmonics, SplineTube};
use crate::matrix::CoupledBanded;
use crate::rings::shortest_arc;
use crate::tube::Load;
use average::AverageContact;
use net::FaceNet;
use pairs::{FaceState, Pair, Quadrature};
use std::sync::{Arc, Mutex, PoisonError};
use tree::Tree;

/// Quadrature points of an element, along and around.
const POINTS: [usize; 2] = [8, 4];

/// The same for the stiffness on low harmonics.
const POINTS_OF_LOW: [usize; 2] = [2, 1];

/// Contact of a tube with itself, found on its surfaces.
#[derive(Clone, Debug)]
pub struct SurfaceContact {
    barrier: Barrier,
    faces: Vec<(FaceNet, Tree)>,
    quadrature: Quadrature,
    row_size: usize,
    /// Sectors of the whole tube.
    repeats: f64,
    /// The last state whose pairs were found, and these: forces and tangent of a state follow each other.
    last: Arc<Mutex<Option<Found>>>,
}

/// A state and its pairs.
type Found = (Vec<f64>, SurfacePairs);

/// The pairs of a state, by face.
#[derive(Clone, Debug)]
pub struct SurfacePairs(Arc<Vec<Vec<Pair>>>);

/// The tangent of contact at a state.
#[derive(Clone, Debug)]
pub struct SurfaceTangent {
    pairs: SurfacePairs,
    average: Vec<AverageContact>,
}

impl SurfaceContact {
    /// Prepares contact for a discretised tube.
    pub fn new(tube: &SplineTube) -> Self {
        let face = |face: Face| {
            let net = FaceNet::new(tube, face);
            let mean = tube.tube.length / net.elements() as f64;
            let tree = Tree::new(
                [net.elements(), net.around],
                [mean, net.radius * net.element_angle()],
            );
            (net, tree)
        };
        Self {
            barrier: *tube.barrier(),
            faces: vec![face(Face::Outer), face(Face::Inner)],
            quadrature: Quadrature::new(POINTS),
            row_size: 3 * tube.wall.functions(),
            repeats: tube.sector.repeats(),
            last: Arc::default(),
        }
    }

    /// Returns the barrier.
    pub fn barrier(&self) -> &Barrier {
        &self.barrier
    }

    /// Finds the pairs of a state.
    pub fn at(&self, u: &[f64]) -> SurfacePairs {
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((state, pairs)) = &*last
            && state == u
        {
            return pairs.clone();
        }
        let pairs = self.pairs(u, &self.quadrature);
        *last = Some((u.to_vec(), pairs.clone()));
        pairs
    }

    fn pairs(&self, u: &[f64], quadrature: &Quadrature) -> SurfacePairs {
        let of_face = |(net, tree): &(FaceNet, Tree)| {
            FaceState::new(net, tree, u).pairs(quadrature, &self.barrier)
        };
        SurfacePairs(Arc::new(self.faces.iter().map(of_face).collect()))
    }

    /// Adds the forces of a state to a residual.
    pub fn add_forces(&self, at: &SurfacePairs, residual: &mut [f64]) -> ContactForces {
        let mut forces = ContactForces::default();
        for ((net, _), pairs) in self.faces.iter().zip(&*at.0) {
            if !pairs.is_empty() {
                forces.energy += energy::energy(pairs);
                forces.squares += energy::add_forces(net, pairs, residual);
            }
        }
        forces
    }

    /// Prepares the tangent at a state; none where nothing touches.
    pub fn tangent(&self, u: &[f64]) -> Option<SurfaceTangent> {
        let pairs = self.at(u);
        if pairs.is_empty() {
            return None;
        }
        let average = |((net, _), pairs): (&(FaceNet, Tree), &Vec<Pair>)| {
            AverageContact::new(net, pairs, self.row_size)
        };
        Some(SurfaceTangent {
            average: self.faces.iter().zip(&*pairs.0).map(average).collect(),
            pairs,
        })
    }

    /// Adds `factor` times the tangent times v to y.
    pub fn add_product(&self, tangent: &SurfaceTangent, factor: f64, v: &[f64], y: &mut [f64]) {
        for ((net, _), pairs) in self.faces.iter().zip(&*tangent.pairs.0) {
            energy::add_product(net, pairs, factor, v, y);
        }
    }

    /// Adds the stiffness against approach, at points of a coarser quadrature, to the tangent on low harmonics.
    pub fn add_low_harmonics(&self, u: &[f64], low: &LowHarmonics, matrix: &mut CoupledBanded) {
        let pairs = self.pairs(u, &Quadrature::new(POINTS_OF_LOW));
        for ((net, _), pairs) in self.faces.iter().zip(&*pairs.0) {
            low_harmonics::add_approach(net, pairs, low, matrix);
        }
    }

    /// Returns the longest fraction of a step, at most 1, along which no face passes through itself; 0 if one does so
    /// at its start.
    pub fn longest_step(&self, u: &[f64], step: &[f64]) -> f64 {
        let of_face = |(net, tree): &(FaceNet, Tree)| {
            step::longest_step(net, tree, &net.positions(u), &net.motions(step))
        };
        self.faces.iter().map(of_face).fold(1.0, f64::min)
    }

    /// Returns a face that passes through itself, if one does.
    pub fn crossing(&self, u: &[f64]) -> Option<Face> {
        let nothing = vec![0.0; u.len()];
        let crosses = |(net, tree): &&(FaceNet, Tree)| {
            step::longest_step(net, tree, &net.positions(u), &net.motions(&nothing)) < 1.0
        };
        Some(self.faces.iter().find(crosses)?.0.face)
    }
}

impl SurfaceContact {
    /// Sums up the contact of a state, with its surfaces.
    pub fn report(&self, tube: &SplineTube, load: &Load, u: &[f64]) -> ContactReport {
        let mut report = ContactReport {
            energy: 0.0,
            faces: [None; 2],
            angles: None,
            surfaces: self.surfaces(tube, load, u),
            friction: None,
        };
        let mut arcs = [[0.0; 2]; 2];
        for ((net, _), pairs) in self.faces.iter().zip(&*self.at(u).0) {
            let index = usize::from(net.face == Face::Inner);
            let face = &mut report.faces[index];
            let element = net.element_angle();
            let angles = pairs.iter().map(|pair| {
                // Element 0 is centred on angle zero.
                let around = net.elements_of(pair.patches[0])[1];
                (around as f64 + pair.places[0][1] - 0.5) * element
            });
            let arc = shortest_arc(angles, net.rings as f64 * element, element);
            arcs[index] = arc.unwrap_or_default();
            // A point may belong to several pairs; its area counts once.
            let mut last = None;
            for pair in pairs {
                let x = (pair.patches[0], pair.places[0]);
                let (from, to) = tube.axial.element(net.elements_of(x.0)[0]);
                let z = from + x.1[0] * (to - from);
                let own = self.repeats * pair.area;
                let area = if last == Some(x) { 0.0 } else { own };
                last = Some(x);
                let force = self.repeats * vector::length(pair.force);
                FaceContact::add(face, z, area, force, pair.gap);
                report.energy += self.repeats * pair.energy;
            }
        }
        report.angles = Some(arcs);
        report
    }
}

impl SurfacePairs {
    /// Returns whether no points are in contact.
    pub fn is_empty(&self) -> bool {
        self.0.iter().all(Vec::is_empty)
    }
}

impl SurfaceTangent {
    /// Adds the circumferential average of the tangent in a harmonic of the sector to a matrix of one ring.
    pub fn add_harmonic(&self, harmonic: usize, matrix: &mut CoupledBanded) {
        for average in &self.average {
            average.add_harmonic(harmonic, matrix);
        }
    }
}
