//! The tube as the user defines it: shape, wall, muscles and ends; its mesh; its load.
//!
//! Everything is dimensionless: lengths in the outer diameter D, stresses in Young's modulus E,
//! energies in E·D³. z = 0 is the colon end, z = L the ileum end.

mod foundation;
mod imperfection;
mod load;
mod mesh;
mod obstacle;
mod outline;
mod patch;
mod random;
mod wall_layer;

pub use foundation::{Foundation, SpringDirection};
pub use imperfection::{Axial, EndDirection, Imperfection, Mode, Part, Shape, Wave};
pub use load::{EndMotion, Load, Pressure};
pub use mesh::{Integration, Mesh, MeshLayer, Symmetry};
pub use obstacle::{Distance, Obstacle, ObstacleShape, Placement, turned};
pub use outline::Outline;
pub use patch::{Patch, Region};
pub use random::Random;
pub use wall_layer::{Opening, ResidualStretch, WallLayer};

use crate::activation::{Direction, Muscle, MuscleTarget};

/// Points at which the grown length is integrated where zones overlap, repeat or leave the tube.
const LENGTH_POINTS: usize = 4096;

/// A circular tube of outer diameter 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Tube {
    /// Length L, in D.
    pub length: f64,
    /// Wall thickness H, in D; below ½.
    pub thickness: f64,
    /// Layers of the wall from the inside out, at least one. Their shares of the thickness add up to one.
    pub layers: Vec<WallLayer>,
    /// Muscles of the wall.
    pub muscles: Vec<Muscle>,
    /// Supports of the colon end (z = 0) and the ileum end (z = L).
    pub ends: [Support; 2],
    /// Imperfections, and a diameter or thickness that varies along the tube; they add up.
    pub imperfections: Vec<Imperfection>,
    /// Rigid obstacles that the walls may touch.
    pub obstacles: Vec<Obstacle>,
    /// Patches of the wall.
    pub patches: Vec<Patch>,
    /// Foundations of the outer wall; they add up.
    pub foundations: Vec<Foundation>,
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

    /// Returns the diameter and thickness along the tube, if they vary.
    pub fn outline(&self) -> Option<&Outline> {
        self.imperfections.iter().find_map(|one| match &one.shape {
            Shape::Outline(outline) => Some(outline),
            _ => None,
        })
    }

    /// Returns the radii of the faces of the layers, from the inside out: one more than there are layers.
    pub fn faces(&self) -> Vec<f64> {
        let mut share = 0.0;
        let mut faces = vec![self.inner_radius()];
        for layer in &self.layers[..self.layers.len() - 1] {
            share += layer.share;
            faces.push(self.inner_radius() + share * self.thickness);
        }
        faces.push(Self::OUTER_RADIUS);
        faces
    }

    /// Returns the residual stretches along and around in a layer at a radius.
    pub fn residual_stretch(&self, layer: usize, radius: f64) -> [f64; 2] {
        let residual = &self.layers[layer].residual;
        if residual.is_none() {
            return [1.0; 2];
        }
        let faces = self.faces();
        let [inner, outer] = [faces[layer], faces[layer + 1]];
        residual.at((radius - inner) / (outer - inner), radius)
    }

    /// Returns true if a layer has residual stretches or an active tension, so that the tube is not free of stress at rest.
    pub fn is_stressed_at_rest(&self) -> bool {
        let stressed = |layer: &WallLayer| !layer.residual.is_none() || layer.material.has_tone();
        self.layers.iter().any(stressed)
    }

    /// Returns the largest stiffness under uniaxial strain of the layers, at small strains.
    pub fn longitudinal_modulus(&self) -> f64 {
        let moduli = self
            .layers
            .iter()
            .map(|layer| layer.material.longitudinal_modulus());
        moduli.fold(0.0, f64::max)
    }

    /// Returns the load at rest: all muscles at ratio one or without tension, no displacement of the ends, no pressure,
    /// obstacles at their first placement, no growth of patches.
    pub fn rest(&self) -> Load {
        Load {
            muscles: self
                .muscles
                .iter()
                .map(|muscle| muscle.target().at_rest())
                .collect(),
            shifts: vec![0.0; self.muscles.len()],
            ends: [EndMotion::default(); 2],
            pressures: [Pressure::default(); 2],
            lumen_volume: None,
            obstacles: self
                .obstacles
                .iter()
                .map(|obstacle| obstacle.rest)
                .collect(),
            patches: vec![1.0; self.patches.len()],
        }
    }

    /// Returns the grown stretches (θζ, θη) of a layer at z under a load, of muscles without imperfections, sectors and
    /// patches (Okino et al. 2025, Eq. (3)).
    pub fn stretches(&self, layer: usize, z: f64, load: &Load) -> (f64, f64) {
        self.grown(layer, z, load, |_, theta| theta)
    }

    /// Returns the grown stretches (θζ, θη) of a layer at z and the angle `phi`, in radians, under a load, with
    /// θ − 1 of each muscle multiplied by [`Tube::strength`]. If no muscle is modified it equals [`Tube::stretches`] to the
    /// bit.
    pub fn stretches_at(&self, layer: usize, z: f64, phi: f64, load: &Load) -> (f64, f64) {
        self.grown(layer, z, load, |(m, in_zone), theta| {
            match self.strength([layer, m], [in_zone, z], phi) {
                1.0 => theta,
                strength => 1.0 + strength * (theta - 1.0),
            }
        })
    }

    /// Returns the tension of a muscle with an active stress in a layer, at z and the angle `phi`, in radians, under a load.
    pub fn tension(&self, [layer, m]: [usize; 2], z: f64, phi: f64, load: &Load) -> f64 {
        if self.layers[layer].idle_muscles.contains(&m) {
            return 0.0;
        }
        let in_zone = self.muscles[m].unshifted(z, load.shifts[m]);
        match load.muscles[m] * self.muscles[m].activity(in_zone) {
            0.0 => 0.0,
            tension => tension * self.strength([layer, m], [in_zone, z], phi),
        }
    }

    /// Returns true if an imperfection, a sector or a patch modifies a muscle that changes the stress-free state, so that
    /// its strength may depend on the angle.
    pub fn growth_is_modified(&self) -> bool {
        let grows = |m: usize| self.muscles[m].grows();
        let imperfect = |i: &Imperfection| matches!(i.of, Part::Muscle(m) if grows(m));
        let patched = |patch: &Patch| {
            let mut factors = patch.muscles.iter().enumerate();
            factors.any(|(m, factor)| *factor != 1.0 && grows(m))
        };
        let in_sector = |muscle: &Muscle| muscle.sector.is_some() && muscle.grows();
        self.imperfections.iter().any(imperfect)
            || self.muscles.iter().any(in_sector)
            || self.patches.iter().any(patched)
    }

    /// Returns the strength of a muscle in a layer at z, of which the place before the shift of its zone comes first, and
    /// the angle `phi`, in radians: 1 + Σ a f(φ, z) over its imperfections, whose shapes span its zone, times the functions
    /// of its sector and of patches.
    pub fn strength(&self, [layer, m]: [usize; 2], [in_zone, z]: [f64; 2], phi: f64) -> f64 {
        let imperfections = self.imperfections.iter();
        let of_it = imperfections.filter(|imperfection| imperfection.of == Part::Muscle(m));
        let strength = of_it.fold(1.0, |sum, imperfection| {
            let f = imperfection.shape.value(phi, in_zone, self.muscles[m].zone);
            sum + imperfection.amplitude * f
        });
        let sector = self.muscles[m].sector;
        let strength = strength * sector.map_or(1.0, |sector| sector.value(phi));
        self.patches.iter().fold(strength, |strength, patch| {
            strength * patch.factor(patch.muscles[m], layer, z, phi)
        })
    }

    /// Returns true if a patch changes the stiffness or the thickness of a layer under a load.
    pub fn has_patches(&self, layer: usize, load: &Load) -> bool {
        let mut patches = self.patches.iter().zip(&load.patches);
        patches.any(|(patch, growth)| {
            patch.layers.contains(&layer) && (patch.stiffness != 1.0 || *growth != 1.0)
        })
    }

    /// Returns the factor of patches on the energy of a layer at z and the angle `phi`, in radians.
    pub fn stiffness_factor(&self, layer: usize, z: f64, phi: f64) -> f64 {
        let factor = |patch: &Patch| patch.factor(patch.stiffness, layer, z, phi);
        self.patches.iter().map(factor).product()
    }

    /// Returns the growth through the wall θξ of a layer at z and the angle `phi`, in radians, under a load.
    pub fn growth_through(&self, layer: usize, z: f64, phi: f64, load: &Load) -> f64 {
        let patches = self.patches.iter().zip(&load.patches);
        let factor = |(patch, growth): (&Patch, &f64)| patch.factor(*growth, layer, z, phi);
        patches.map(factor).product()
    }

    /// Returns true if a muscle, a patch or a foundation acts in a sector of the circumference.
    pub fn has_sectors(&self) -> bool {
        self.muscles.iter().any(|muscle| muscle.sector.is_some())
            || self.regions().any(|region| region.sector.is_some())
    }

    /// Returns true if foundations hold the tube against the rigid motions of circumferential harmonic n.
    pub fn is_held_by_foundations(&self, n: usize) -> bool {
        self.foundations
            .iter()
            .any(|foundation| foundation.holds(n))
    }

    /// Returns the regions of patches and foundations.
    fn regions(&self) -> impl Iterator<Item = &Region> {
        let patches = self.patches.iter().map(|patch| &patch.region);
        patches.chain(self.foundations.iter().map(|foundation| &foundation.region))
    }

    /// Returns the products of the stretches of the muscles of a layer along and around, each θ changed by `change`, which
    /// is given the number of the muscle and the place before the shift of its zone.
    fn grown(
        &self,
        layer: usize,
        z: f64,
        load: &Load,
        change: impl Fn((usize, f64), f64) -> f64,
    ) -> (f64, f64) {
        let idle = &self.layers[layer].idle_muscles;
        let (mut along, mut around) = (1.0, 1.0);
        for (m, muscle) in self.muscles.iter().enumerate() {
            if idle.contains(&m) || !muscle.grows() {
                continue;
            }
            let z = muscle.unshifted(z, load.shifts[m]);
            let theta = muscle.stretch(z, load.muscles[m], self.length);
            let theta = change((m, z), theta);
            match muscle.direction {
                Direction::Longitudinal => along *= theta,
                Direction::Circular => around *= theta,
            }
        }
        (along, around)
    }

    /// Returns the grown length over the length, Lmax/L. Muscles in different layers count as if they acted in the same.
    pub fn length_ratio(&self, load: &Load) -> f64 {
        if self.each_zone_is_whole(load) {
            let changes = self.ratios(load, MuscleTarget::LengthRatio);
            return 1.0 + changes.map(|ratio| ratio - 1.0).sum::<f64>();
        }
        let along = |z: f64| {
            let muscles = self.muscles.iter().enumerate();
            let along = muscles.filter(|(_, muscle)| muscle.target() == MuscleTarget::LengthRatio);
            let theta = |(m, muscle): (usize, &Muscle)| {
                let z = muscle.unshifted(z, load.shifts[m]);
                muscle.stretch(z, load.muscles[m], self.length)
            };
            along.map(theta).product::<f64>()
        };
        let middles = (0..LENGTH_POINTS).map(|i| (i as f64 + 0.5) / LENGTH_POINTS as f64);
        middles.map(|x| along(x * self.length)).sum::<f64>() / LENGTH_POINTS as f64
    }

    /// Returns true if every longitudinal muscle acts on one zone, which lies within the tube and apart from the others.
    fn each_zone_is_whole(&self, load: &Load) -> bool {
        let muscles = self.muscles.iter().zip(&load.shifts);
        let along = muscles.filter(|(muscle, _)| muscle.target() == MuscleTarget::LengthRatio);
        let mut zones = vec![];
        for (muscle, shift) in along {
            let zone = muscle.zone.map(|z| z + shift);
            let moved = muscle.repeat.is_some() || *shift != 0.0;
            if moved && (muscle.repeat.is_some() || zone[0] < 0.0 || zone[1] > self.length) {
                return false;
            }
            zones.push(zone);
        }
        zones.sort_by(|a, b| a[0].total_cmp(&b[0]));
        zones
            .windows(2)
            .all(|pair| pair[0][1] <= pair[1][0] * (1.0 + 1e-12))
    }

    /// Returns the smallest grown diameter over the diameter, Dmin/D, of the circular muscles.
    pub fn diameter_ratio(&self, load: &Load) -> f64 {
        self.ratios(load, MuscleTarget::DiameterRatio)
            .reduce(f64::min)
            .unwrap_or(1.0)
    }

    /// Returns the targets of one kind.
    fn ratios<'a>(
        &'a self,
        load: &'a Load,
        target: MuscleTarget,
    ) -> impl Iterator<Item = f64> + 'a {
        let pairs = self.muscles.iter().zip(&load.muscles);
        pairs
            .filter(move |(muscle, _)| muscle.target() == target)
            .map(|(_, &ratio)| ratio)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::activation::Profile;
    use crate::material::{Material, NeoHookean};
    use std::f64::consts::TAU;

    fn tube(wave: Wave) -> Tube {
        Tube {
            length: 3.0,
            thickness: 0.06,
            layers: vec![WallLayer::of(Material::NeoHookean(NeoHookean::new(
                1.0, 0.495,
            )))],
            muscles: vec![Muscle::new(
                "m".into(),
                Direction::Circular,
                [0.5, 1.0],
                Profile::RaisedCosine,
            )],
            ends: [Support::Fixed; 2],
            obstacles: vec![],
            patches: vec![],
            foundations: vec![],
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
        let level = |direction, zone| {
            Muscle::new(
                String::new(),
                direction,
                zone,
                Profile::Table(vec![(0.0, 1.0), (1.0, 1.0)]),
            )
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
            let found = tube.stretches(0, z, &load);
            assert!(
                (found.0 - along).abs() < 1e-14 && (found.1 - around).abs() < 1e-14,
                "{z}: {found:?}"
            );
        }
        let ratio = |load: &Load| (tube.length_ratio(load), tube.diameter_ratio(load));
        assert_eq!(ratio(&tube.rest()), (1.0, 1.0));
    }

    #[test]
    fn zones_that_overlap_multiply_and_count_within_the_tube() {
        let mut tube = tube(Wave::new(0, 0.0, Axial::Uniform));
        tube.imperfections.clear();
        let along = Direction::Longitudinal;
        let even = Profile::Table(vec![(0.0, 1.0), (1.0, 1.0)]);
        let level = |zone, repeat| Muscle {
            repeat,
            ..Muscle::new(String::new(), along, zone, even.clone())
        };
        tube.muscles = vec![level([0.0, 1.0], None), level([0.75, 1.5], Some(1.5))];
        let mut load = tube.rest();
        load.muscles = [(0, 1.3), (1, 0.8)]
            .map(|(m, stretch)| tube.muscles[m].ratio_of(stretch, 3.0))
            .to_vec();
        // 1.3 on [0, 1], and 0.8 on [0.75, 1.5] and [2.25, 3].
        let along = |z, load: &Load| tube.stretches(0, z, load).0;
        for (z, theta) in [
            (0.5, 1.3),
            (0.9, 1.3 * 0.8),
            (1.2, 0.8),
            (2.0, 1.0),
            (2.9, 0.8),
        ] {
            assert!((along(z, &load) - theta).abs() < 1e-14, "{z}");
        }
        let length = 3.0 + 0.3 - 1.5 * 0.2 - 0.25 * 0.3 * 0.2;
        assert!((tube.length_ratio(&load) - length / 3.0).abs() < 1e-3);
        // The first leaves the tube by a half, the second moves to where it was before.
        load.shifts = vec![-0.5, 1.5];
        for (z, theta) in [(0.4, 1.3), (0.6, 1.0), (0.9, 0.8)] {
            assert!((along(z, &load) - theta).abs() < 1e-14, "{z}");
        }
        let length = 3.0 + 0.15 - 1.5 * 0.2;
        assert!((tube.length_ratio(&load) - length / 3.0).abs() < 1e-3);
    }

    #[test]
    fn layers_have_their_own_faces_muscles_and_residual_stretches() {
        let mut tube = tube(Wave::new(0, 0.0, Axial::Uniform));
        tube.imperfections.clear();
        let mut layers = vec![tube.layers[0].clone(); 2];
        (layers[0].share, layers[1].share) = (0.25, 0.75);
        layers[0].idle_muscles = vec![0];
        layers[1].residual.around = [0.9, 1.1];
        tube.layers = layers;
        let faces = tube.faces();
        for (face, expected) in faces.iter().zip([0.44, 0.455, 0.5]) {
            assert!((face - expected).abs() < 1e-15);
        }
        let load = Load {
            muscles: vec![0.5],
            ..tube.rest()
        };
        let around = [0, 1].map(|layer| tube.stretches(layer, 0.75, &load).1);
        assert_eq!(around, [1.0, 0.5]);
        assert_eq!(tube.residual_stretch(0, 0.45), [1.0; 2]);
        for (radius, expected) in [(0.455, 0.9), (0.4775, 1.0), (0.5, 1.1)] {
            let [along, around] = tube.residual_stretch(1, radius);
            assert!(along == 1.0 && (around - expected).abs() < 1e-12);
        }
        tube.layers[1].residual = ResidualStretch {
            opening: Some(Opening {
                fraction: 0.6,
                shift: 0.3,
            }),
            ..ResidualStretch::default()
        };
        let [along, around] = tube.residual_stretch(1, 0.5);
        assert!(along == 1.0 && (around - 0.6 * 0.8 / 0.5).abs() < 1e-15);
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
                let sum: f64 = around
                    .map(|phi| tube.stretches_at(0, z, phi, &load).1)
                    .sum();
                let mean = tube.stretches(0, z, &load).1;
                assert!((sum / 24.0 - mean).abs() < 1e-15, "{z}: {}", sum / 24.0);
            }
            // In the middle of the zone, at the crest, θ − 1 = −0.75 is a tenth larger.
            let (along, around) = tube.stretches_at(0, 0.75, 0.2, &load);
            assert!((around - (1.0 - 1.1 * 0.75)).abs() < 1e-14, "{around}");
            assert_eq!(along, 1.0);
        }
    }
}
