//! Patches of the wall that differ from the rest: a scar, a polyp, an anastomosis.
//!
//! A patch has a function p(z, φ), 1 in the middle of its region, 0 outside and smooth at the edges. With factors f it
//! multiplies, at a point of its layers,
//!
//! - the energy of the law by 1 + (f − 1) p;
//! - θ − 1 of a muscle by 1 + (f − 1) p;
//! - the stress-free thickness: Fp = diag(θζ, θξ, θη) with θξ = 1 + (t − 1) p, where t is driven by the load.
//!
//! Factors of patches that overlap multiply.

use crate::activation::{AngularSector, smooth_rise};

/// A part of the tube with smooth edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    /// Its ends along the tube, edges included, in D.
    pub zone: [f64; 2],
    /// Length over which its function rises at either end, in D, at most half the zone; 0 for none.
    pub edge: f64,
    /// Its sector of the circumference; none for all around.
    pub sector: Option<AngularSector>,
}

impl Region {
    /// Returns its function at z, in D, and the angle `phi`, in radians: from 0 to 1.
    pub fn value(&self, z: f64, phi: f64) -> f64 {
        let [from, to] = self.zone;
        let inside = (z - from).min(to - z);
        let along = match self.edge > 0.0 {
            true => smooth_rise(inside / self.edge),
            false => f64::from(u8::from(inside >= 0.0)),
        };
        if along == 0.0 {
            return 0.0;
        }
        self.sector
            .map_or(along, |sector| along * sector.value(phi))
    }
}

/// A patch of the wall.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch {
    /// Its name in the case file.
    pub name: String,
    /// Its place.
    pub region: Region,
    /// Layers of the wall that it acts in, by their numbers.
    pub layers: Vec<usize>,
    /// Factor on the energy of the law where its function is one.
    pub stiffness: f64,
    /// Factor on θ − 1 of each muscle of the tube where its function is one.
    pub muscles: Vec<f64>,
}

impl Patch {
    /// Returns 1 + (f − 1) p in a layer, at z and the angle `phi`.
    pub(super) fn factor(&self, f: f64, layer: usize, z: f64, phi: f64) -> f64 {
        if f == 1.0 || !self.layers.contains(&layer) {
            return 1.0;
        }
        1.0 + (f - 1.0) * self.region.value(z, phi)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_region_is_a_product_of_smooth_steps() {
        let sector = AngularSector {
            centre: 0.0,
            width: 1.0,
            edge: 0.25,
            repeats: 1,
        };
        let region = Region {
            zone: [1.0, 2.0],
            edge: 0.2,
            sector: Some(sector),
        };
        assert_eq!(region.value(1.5, 0.2), 1.0);
        assert!((region.value(1.1, 0.375) - 0.25).abs() < 1e-14);
        assert_eq!([region.value(0.9, 0.0), region.value(1.5, 0.6)], [0.0; 2]);
        let sharp = Region {
            edge: 0.0,
            sector: None,
            ..region
        };
        assert_eq!(
            [0.99, 1.0, 2.0, 2.01].map(|z| sharp.value(z, 3.0)),
            [0.0, 1.0, 1.0, 0.0]
        );
    }

    #[test]
    fn a_patch_acts_in_its_layers() {
        let patch = Patch {
            name: "scar".into(),
            region: Region {
                zone: [0.0, 1.0],
                edge: 0.5,
                sector: None,
            },
            layers: vec![1],
            stiffness: 5.0,
            muscles: vec![],
        };
        assert_eq!(patch.factor(5.0, 0, 0.5, 0.0), 1.0);
        assert_eq!(patch.factor(5.0, 1, 0.5, 0.0), 5.0);
        assert!((patch.factor(5.0, 1, 0.25, 0.0) - 3.0).abs() < 1e-14);
    }
}
