//! What a person means by a tube: its shape, wall, muscles and ends, the mesh laid over it, and
//! the load it is under. Checked values, no files, no numerics.
//!
//! Everything is dimensionless: lengths in the outer diameter D, stresses in Young's modulus E,
//! energies in E·D³. z = 0 is the colon end, z = L the ileum end.

mod load;
mod mesh;

pub use load::{EndMotion, Load};
pub use mesh::{Mesh, Symmetry};

use crate::activation::{Direction, Muscle};
use crate::material::Material;

/// A circular tube of outer diameter 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Tube {
    /// Length L, in D.
    pub length: f64,
    /// Wall thickness H, in D; below ½.
    pub thickness: f64,
    /// The law of the wall, its stresses in E.
    pub material: Material,
    /// The muscles of the wall. Zones of muscles of one direction do not overlap.
    pub muscles: Vec<Muscle>,
    /// How the colon end (z = 0) and the ileum end (z = L) are held.
    pub ends: [Support; 2],
}

/// One end of the tube.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// z = 0.
    Colon,
    /// z = L.
    Ileum,
}

/// How an end face is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Support {
    /// Every displacement of the end face is given (zero, unless the end is moved).
    Fixed,
    /// The axial displacement is given; the face slides freely on its plane.
    Sliding,
    /// Nothing is given.
    Free,
}

impl Tube {
    /// Outer radius, in D.
    pub const OUTER_RADIUS: f64 = 0.5;

    /// Inner radius, in D.
    pub fn inner_radius(&self) -> f64 {
        Self::OUTER_RADIUS - self.thickness
    }

    /// The load at rest: every muscle at ratio one, the ends where they are.
    pub fn rest(&self) -> Load {
        Load {
            muscles: vec![1.0; self.muscles.len()],
            ends: [EndMotion::default(); 2],
        }
    }

    /// The grown stretches (θζ, θη) at z under a load (Okino et al. 2025, Eq. (3)).
    pub fn stretches(&self, z: f64, load: &Load) -> (f64, f64) {
        let (mut along, mut around) = (1.0, 1.0);
        for (muscle, &ratio) in self.muscles.iter().zip(&load.muscles) {
            let theta = muscle.stretch(z, ratio, self.length);
            match muscle.direction {
                Direction::Longitudinal => along *= theta,
                Direction::Circular => around *= theta,
            }
        }
        (along, around)
    }

    /// The grown length over the length, Lmax/L.
    pub fn length_ratio(&self, load: &Load) -> f64 {
        1.0 + self
            .driven(load, Direction::Longitudinal)
            .map(|ratio| ratio - 1.0)
            .sum::<f64>()
    }

    /// The narrowest grown diameter over the diameter, Dmin/D (the widest, if every circular
    /// muscle relaxes).
    pub fn diameter_ratio(&self, load: &Load) -> f64 {
        self.driven(load, Direction::Circular)
            .reduce(f64::min)
            .unwrap_or(1.0)
    }

    fn driven<'a>(
        &'a self,
        load: &'a Load,
        direction: Direction,
    ) -> impl Iterator<Item = f64> + 'a {
        let pairs = self.muscles.iter().zip(&load.muscles);
        pairs
            .filter(move |(muscle, _)| muscle.direction == direction)
            .map(|(_, &ratio)| ratio)
    }
}
