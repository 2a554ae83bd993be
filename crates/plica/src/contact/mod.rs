//! Contact of the wall of a tube with itself, with or without friction.
//!
//! The outer face meets the outer face, the inner face the inner. Contact adds an energy to that of the tube,
//!
//! Π_c = ½ Σ over faces ∫ Σ b(|x − y|) dA₀(x),
//!
//! where y runs over the points of the same face at which the distance from x has a local minimum below the range d̂ of
//! the barrier b, and whose normal faces that of x. The area is that at rest, so muscles do no work on contact. The
//! range is a quarter of the smallest axial element at rest: contact becomes sharper as the mesh is refined. Points are
//! found on the exact splines, and no length along the wall is excluded. Π_c has continuous second
//! derivatives while the concave radii of the wall exceed d̂.
//!
//! A barrier never lets faces pass through each other if no step does: [`SelfContact::longest_step`].
//!
//! Sources: barrier and steps, incremental potential contact (Li et al. 2020, 2021); local minima that face each other,
//! the geometric contact potential (doi 10.1145/3731142).

mod bernstein;
mod face;
mod meridian;
mod pressure;
mod report;
mod stretch;
mod surfaces;

pub use crate::assembly::Barrier;
pub use face::Face;
pub use meridian::{FaceFriction, MeridianContact, SelfFriction};
pub use pressure::{PressedPoint, PressureField};
pub use report::{ContactReport, FaceContact};
pub use stretch::{BIOT, CREASE, FaceSurface};
pub use surfaces::{SurfaceContact, SurfaceTangent};

use crate::assembly::SplineTube;
use crate::tube::Load;

/// Contact of a tube with itself.
#[derive(Clone, Debug)]
pub enum SelfContact {
    /// Of a tube of one ring, without twist.
    Meridian(MeridianContact),
    /// Of a tube of many rings.
    Surface(SurfaceContact),
}

/// Energy of contact at a state, and its share of the residual scale.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactForces {
    /// Π_c of one sector, in E·D³.
    pub energy: f64,
    /// Sum of the squares of all parts of the forces.
    pub squares: f64,
}

impl SelfContact {
    /// Prepares contact for a discretised tube.
    pub fn new(tube: &SplineTube) -> Self {
        match tube.sector.rings {
            1 => Self::Meridian(MeridianContact::new(tube)),
            _ => Self::Surface(SurfaceContact::new(tube)),
        }
    }

    /// Returns the barrier.
    pub fn barrier(&self) -> &Barrier {
        match self {
            Self::Meridian(contact) => contact.barrier(),
            Self::Surface(contact) => contact.barrier(),
        }
    }

    /// Returns whether no points of a state are in contact.
    pub fn is_open(&self, u: &[f64]) -> bool {
        match self {
            Self::Meridian(contact) => contact.at(u).is_empty(),
            Self::Surface(contact) => contact.at(u).is_empty(),
        }
    }

    /// Adds the forces of a state to a residual.
    pub fn add_forces(&self, u: &[f64], residual: &mut [f64]) -> ContactForces {
        match self {
            Self::Meridian(contact) => contact.add_forces(&contact.at(u), residual),
            Self::Surface(contact) => contact.add_forces(&contact.at(u), residual),
        }
    }

    /// Returns the longest fraction of a step, at most 1, along which no face passes through itself; 0 if one does so
    /// at its start.
    pub fn longest_step(&self, u: &[f64], step: &[f64]) -> f64 {
        match self {
            Self::Meridian(contact) => contact.longest_step(u, step),
            Self::Surface(contact) => contact.longest_step(u, step),
        }
    }

    /// Returns a face that passes through itself, if one does.
    pub fn crossing(&self, u: &[f64]) -> Option<Face> {
        match self {
            Self::Meridian(contact) => contact.crossing(u),
            Self::Surface(contact) => contact.crossing(u),
        }
    }

    /// Sums up the contact of a state, with stretch and turning of its surfaces.
    pub fn report(&self, tube: &SplineTube, load: &Load, u: &[f64]) -> ContactReport {
        match self {
            Self::Meridian(contact) => contact.report(tube, load, u),
            Self::Surface(contact) => contact.report(tube, load, u),
        }
    }
}
