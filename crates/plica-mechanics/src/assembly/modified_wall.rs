//! Differences of a wall from the plain one at its quadrature points: a stress-free shape, patches, and the tension of
//! muscles with active stress. The kernels skip all of it in a plain wall.

use super::SplineTube;
use super::spline_tube::PartKind;
use super::stress_free::{ImperfectionMap, StressFreeStretch};
use super::tables::{AxialBatch, CircumferentialPoint};
use crate::tensor::{LANES, Lanes};
use crate::tube::Load;
use fearless_simd::{Simd, f64x8};

/// Growth and stiffness at a point of eight elements, beside what the kernels take from
/// [`ElementGrowth::inverse_stretch`].
#[derive(Clone, Copy, Debug)]
pub struct PatchFactors {
    /// One over the growth along, through and around.
    inverse: [Lanes; 3],
    /// Factor on the energy of the law; the tension of a muscle with active stress.
    stiffness: Lanes,
}

/// A wall that is not plain, at the points of a batch.
#[derive(Clone, Copy)]
pub struct ModifiedWall<'a> {
    /// The stress-free shape; none if the tube is perfect.
    pub stress_free: Option<&'a [StressFreeStretch]>,
    /// Factors of patches; none if there are no patches.
    pub patches: Option<&'a [PatchFactors]>,
}

/// Growth of the elements of a batch.
#[derive(Clone, Debug, Default)]
pub struct ElementGrowth {
    /// 1/θζ and 1/θη of the muscles.
    pub inverse_stretch: Vec<(Lanes, Lanes)>,
    /// Factors of patches; empty if there are none.
    pub patches: Vec<PatchFactors>,
    /// True for a muscle with active stress that has no tension here.
    pub is_idle: bool,
}

impl PatchFactors {
    /// Returns the factors for eight elements, from growth (along, through, around) and stiffness of each.
    fn new(of: impl Fn(usize) -> ([f64; 3], f64)) -> Self {
        let lanes: [([f64; 3], f64); LANES] = std::array::from_fn(of);
        Self {
            inverse: [0, 1, 2].map(|i| Lanes(lanes.map(|(growth, _)| 1.0 / growth[i]))),
            stiffness: Lanes(lanes.map(|(_, stiffness)| stiffness)),
        }
    }
}

impl<'a> ModifiedWall<'a> {
    /// Returns the wall, or none if it is plain.
    pub fn of(
        stress_free: Option<&'a [StressFreeStretch]>,
        patches: &'a [PatchFactors],
    ) -> Option<Self> {
        let patches = (!patches.is_empty()).then_some(patches);
        (stress_free.is_some() || patches.is_some()).then_some(Self {
            stress_free,
            patches,
        })
    }

    /// Returns the map from F Fp⁻¹ to Fe at a point, given 1/θζ and 1/θη, the number of the point for the stress-free shape
    /// and that for the factors of patches.
    #[inline(always)]
    pub fn map<S: Simd>(
        &self,
        simd: S,
        [inverse_along, inverse_around]: [f64x8<S>; 2],
        [shape, patch]: [usize; 2],
    ) -> ImperfectionMap<f64x8<S>> {
        let map = match self.stress_free {
            Some(at) => at[shape].imperfection_map(simd, inverse_along, inverse_around),
            None => ImperfectionMap::identity(inverse_along),
        };
        match self.patches {
            Some(at) => {
                let PatchFactors { inverse, stiffness } = &at[patch];
                let [along, through, around] = inverse;
                let inverse = [along.load(simd), through.load(simd), around.load(simd)];
                map.with_patch(inverse, stiffness.load(simd))
            }
            None => map,
        }
    }
}

impl SplineTube {
    /// Returns the growth at the points of an axial batch: 1/θζ and 1/θη at the points along it. Where muscles vary around a
    /// tube of several rings, they are one, and the growth is that of the factors of patches, by (element around, point
    /// along, point around).
    pub(super) fn growth_along(&self, batch: &AxialBatch, load: &Load) -> ElementGrowth {
        let (tube, layer) = (&self.tube, self.wall_layer);
        let varies = self.sector.rings > 1 && tube.growth_is_modified();
        let inverse_stretch = match varies {
            true => vec![(Lanes([1.0; LANES]), Lanes([1.0; LANES])); batch.z.len()],
            false => self.inverse_stretch(batch, load),
        };
        let mut patches = vec![];
        if varies || self.has_factors(load) {
            for element in 0..self.sector.rings {
                for z in &batch.z {
                    for point in &self.around {
                        let phi = self.angle_at(element, point);
                        patches.push(PatchFactors::new(|l| {
                            let z = z.0[l];
                            let (along, around) = match varies {
                                true => tube.stretches_at(layer, z, phi, load),
                                false => (1.0, 1.0),
                            };
                            let through = tube.growth_through(layer, z, phi, load);
                            ([along, through, around], self.energy_factor(z, phi, load))
                        }));
                    }
                }
            }
        }
        ElementGrowth {
            inverse_stretch,
            is_idle: self.is_idle_at(&patches),
            patches,
        }
    }

    /// Returns true if factors of patches, or a tension, may act in this part of the wall.
    pub(super) fn has_factors(&self, load: &Load) -> bool {
        matches!(self.kind, PartKind::Muscle(_)) || self.tube.has_patches(self.wall_layer, load)
    }

    /// Returns the factor on the energy of the law of this part, at z and the angle `phi`, in radians.
    pub(super) fn energy_factor(&self, z: f64, phi: f64, load: &Load) -> f64 {
        match self.kind {
            PartKind::Muscle(m) => self.tube.tension([self.wall_layer, m], z, phi, load),
            PartKind::Law | PartKind::Volume => self.tube.stiffness_factor(self.wall_layer, z, phi),
        }
    }

    /// Returns true if this part is a muscle with active stress without tension at points.
    fn is_idle_at(&self, factors: &[PatchFactors]) -> bool {
        let is_zero = |at: &PatchFactors| at.stiffness.0 == [0.0; LANES];
        matches!(self.kind, PartKind::Muscle(_)) && factors.iter().all(is_zero)
    }

    /// Returns the growth at the points of the elements around the tube in a lane of an axial batch, see
    /// [`SplineTube::inverse_stretch_around`]; the factors of patches by (point along, point around, vector of elements).
    pub(super) fn growth_around(
        &self,
        batch: &AxialBatch,
        lane: usize,
        around: &[CircumferentialPoint],
        load: &Load,
    ) -> ElementGrowth {
        let (tube, layer) = (&self.tube, self.wall_layer);
        let mut patches = vec![];
        if self.has_factors(load) {
            for z in batch.z.iter().map(|z| z.0[lane]) {
                for point in around {
                    for v in 0..self.padded_rings.vectors() {
                        patches.push(PatchFactors::new(|lane| {
                            let phi = self.angle_at(v * LANES + lane, point);
                            let through = tube.growth_through(layer, z, phi, load);
                            ([1.0, through, 1.0], self.energy_factor(z, phi, load))
                        }));
                    }
                }
            }
        }
        ElementGrowth {
            inverse_stretch: self.inverse_stretch_around(batch, lane, around, load),
            is_idle: self.is_idle_at(&patches),
            patches,
        }
    }

    /// Returns the angle of a point of an element around the tube, in radians. Elements beyond the sector repeat it.
    pub(super) fn angle_at(&self, element: usize, point: &CircumferentialPoint) -> f64 {
        // The middle of element 0 is at angle zero.
        let element = (element % self.sector.rings) as f64;
        (element + point.s - 0.5) * self.sector.angle()
    }
}
