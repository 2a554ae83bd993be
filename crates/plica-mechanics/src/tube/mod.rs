//! The tube as the user defines it: shape, wall, muscles and ends; its mesh; its load.
//!
//! Everything is dimensionless: lengths in the outer diameter D, stresses in Young's modulus E,
//! energies in E·D³. z = 0 is the colon end, z = L the ileum end.

mod imperfection;
mod load;
mod mesh;
mod obstacle;
mod random;

pub use imperfection::{Axial, EndDirection, Imperfection, Mode, Part, Shape, Wave};
pub use load::{EndMotion, Load, Pressure};
pub use mesh::{Integration, Mesh, Symmetry};
pub use obstacle::{Distance, Obstacle, ObstacleShape, Placement, turned};
pub use random::Random;

use crate::activation::{Direction, Muscle};
use crate::material::Material;

/// A circular tube of outer diameter 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Tube {
    /// Length L, in D.
    pub length: f64,
    /// Wall thickness H, in D; below ½.
    pub thickness: f64,
    /// Law of the wall, with stresses in E.
    pub material: Material,
    /// Muscles of the wall. Zones of muscles of one direction do not overlap.
    pub muscles: Vec<Muscle>,
    /// Supports of the colon end (z = 0) and the ileum end (z = L).
    pub ends: [Support; 2],
    /// Imperfections; they add up.
    pub imperfections: Vec<Imperfection>,
    /// Rigid obstacles that the walls may touch.
    pub obstacles: Vec<Obstacle>,
}

/// One end of the tube.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// z = 0.
    Colon,
    /// z = L.
    Ileum,
}

/// Support of an end face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Support {
    /// All displacements of the end face are prescribed (zero, unless the end is moved).
    Fixed,
    /// The axial displacement is prescribed; the face slides in its plane.
    Sliding,
    /// No displacement is prescribed.
    Free,
}

impl Tube {
    /// Outer radius, in D.
    pub const OUTER_RADIUS: f64 = 0.5;

    /// Inner radius, in D.
    pub fn inner_radius(&self) -> f64 {
        Self::OUTER_RADIUS - self.thickness
    }

    /// Returns the load at rest: all muscles at ratio one, no displacement of the ends, no pressure, obstacles at their
    /// first placement.
    pub fn rest(&self) -> Load {
        Load {
            muscles: vec![1.0; self.muscles.len()],
            ends: [EndMotion::default(); 2],
            pressures: [Pressure::default(); 2],
            obstacles: self
                .obstacles
                .iter()
                .map(|obstacle| obstacle.rest)
                .collect(),
        }
    }

    /// Returns the grown stretches (θζ, θη) at z under a load, of muscles without imperfections
    /// (Okino et al. 2025, Eq. (3)).
    pub fn stretches(&self, z: f64, load: &Load) -> (f64, f64) {
        self.grown(z, load, |_, theta| theta)
    }

    /// Returns the grown stretches (θζ, θη) at z and the angle `phi`, in radians, under a load, with
    /// θ − 1 of each muscle multiplied by [`Tube::strength`]. Without imperfections of muscles it
    /// equals [`Tube::stretches`] to the bit.
    pub fn stretches_at(&self, z: f64, phi: f64, load: &Load) -> (f64, f64) {
        self.grown(z, load, |m, theta| match self.strength(m, z, phi) {
            1.0 => theta,
            strength => 1.0 + strength * (theta - 1.0),
        })
    }

    /// Returns true if a muscle has an imperfection, so that its strength may depend on the angle.
    pub fn muscles_vary_around(&self) -> bool {
        let mut parts = self
            .imperfections
            .iter()
            .map(|imperfection| imperfection.of);
        parts.any(|part| matches!(part, Part::Muscle(_)))
    }

    /// Returns the strength of muscle `m` at z and the angle `phi`, in radians: 1 + Σ a f(φ, z) over
    /// its imperfections, whose shapes span its zone.
    pub fn strength(&self, m: usize, z: f64, phi: f64) -> f64 {
        let imperfections = self.imperfections.iter();
        let of_it = imperfections.filter(|imperfection| imperfection.of == Part::Muscle(m));
        of_it.fold(1.0, |sum, imperfection| {
            let f = imperfection.shape.value(phi, z, self.muscles[m].zone);
            sum + imperfection.amplitude * f
        })
    }

    /// Returns the products of the stretches of the muscles along and around, each θ changed by `change`.
    fn grown(&self, z: f64, load: &Load, change: impl Fn(usize, f64) -> f64) -> (f64, f64) {
        let (mut along, mut around) = (1.0, 1.0);
        for (m, (muscle, &ratio)) in self.muscles.iter().zip(&load.muscles).enumerate() {
            let theta = change(m, muscle.stretch(z, ratio, self.length));
            match muscle.direction {
                Direction::Longitudinal => along *= theta,
                Direction::Circular => around *= theta,
            }
        }
        (along, around)
    }

    /// Returns the grown length over the length, Lmax/L.
    pub fn length_ratio(&self, load: &Load) -> f64 {
        1.0 + self
            .ratios(load, Direction::Longitudinal)
            .map(|ratio| ratio - 1.0)
            .sum::<f64>()
    }

    /// Returns the smallest grown diameter over the diameter, Dmin/D, of the circular muscles.
    pub fn diameter_ratio(&self, load: &Load) -> f64 {
        self.ratios(load, Direction::Circular)
            .reduce(f64::min)
            .unwrap_or(1.0)
    }

    /// Returns the target ratios of the muscles of one direction.
    fn ratios<'a>(
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::activation::Profile;
    use crate::material::NeoHookean;
    use std::f64::consts::TAU;

    fn tube(wave: Wave) -> Tube {
        Tube {
            length: 3.0,
            thickness: 0.06,
            material: Material::NeoHookean(NeoHookean::new(1.0, 0.495)),
            muscles: vec![Muscle {
                name: "m".into(),
                direction: Direction::Circular,
                zone: [0.5, 1.0],
                profile: Profile::RaisedCosine,
            }],
            ends: [Support::Fixed; 2],
            obstacles: vec![],
            imperfections: vec![Imperfection {
                of: Part::Muscle(0),
                amplitude: 0.1,
                shape: Shape::Wave(wave),
            }],
        }
    }

    #[test]
    fn ratios_and_stretches_are_those_of_all_muscles() {
        let mut tube = tube(Wave::new(0, 0.0, Axial::Uniform));
        tube.imperfections.clear();
        let level = |direction, zone| Muscle {
            name: String::new(),
            direction,
            zone,
            profile: Profile::Table(vec![(0.0, 1.0), (1.0, 1.0)]),
        };
        let (along, around) = (Direction::Longitudinal, Direction::Circular);
        tube.muscles = vec![
            level(along, [0.0, 1.0]),
            level(along, [1.5, 3.0]),
            level(around, [0.5, 2.0]),
            level(around, [2.0, 3.0]),
        ];
        let load = Load {
            muscles: vec![1.1, 0.8, 0.7, 1.4],
            ..tube.rest()
        };
        assert!((tube.length_ratio(&load) - 0.9).abs() < 1e-15);
        assert_eq!(tube.diameter_ratio(&load), 0.7);
        // Changes of the length by 0.3 and −0.6, over 1 and 1.5.
        for (z, along, around) in [
            (0.2, 1.3, 1.0),
            (0.7, 1.3, 0.7),
            (1.7, 0.6, 0.7),
            (2.5, 0.6, 1.4),
        ] {
            let found = tube.stretches(z, &load);
            assert!(
                (found.0 - along).abs() < 1e-14 && (found.1 - around).abs() < 1e-14,
                "{z}: {found:?}"
            );
        }
        let ratio = |load: &Load| (tube.length_ratio(load), tube.diameter_ratio(load));
        assert_eq!(ratio(&tube.rest()), (1.0, 1.0));
    }

    #[test]
    fn the_average_strength_of_an_imperfect_muscle_is_one() {
        for harmonic in 1..=3 {
            let tube = tube(Wave::new(harmonic, 0.2, Axial::HalfWaves(1)));
            let load = Load {
                muscles: vec![0.25],
                ..tube.rest()
            };
            for z in [0.4, 0.6, 0.75, 0.9] {
                let around = (0..24).map(|i| TAU * f64::from(i) / 24.0);
                let sum: f64 = around.map(|phi| tube.stretches_at(z, phi, &load).1).sum();
                let mean = tube.stretches(z, &load).1;
                assert!((sum / 24.0 - mean).abs() < 1e-15, "{z}: {}", sum / 24.0);
            }
            // In the middle of the zone, at the crest, θ − 1 = −0.75 is a tenth larger.
            let (along, around) = tube.stretches_at(0.75, 0.2, &load);
            assert!((around - (1.0 - 1.1 * 0.75)).abs() < 1e-14, "{around}");
            assert_eq!(along, 1.0);
        }
    }
}
