//! Inputs of the batch kernels, made from a tube and a state.

use super::SplineTube;
use super::axial;
use super::circumferential;
use super::dispatch::with_degree;
use super::modified_wall::{ElementGrowth, ModifiedWall};
use super::stress_free::StressFreeStretch;
use super::tables::{AxialBatch, CircumferentialPoint, Layer};
use crate::tensor::{LANES, Lanes};
use crate::tube::Load;
use std::borrow::Cow;

/// Number of rings from which a sector uses circumferential batches.
pub(super) const CIRCUMFERENTIAL_BATCH_RINGS: usize = 2;

impl SplineTube {
    /// Returns the kernel input for an axial batch, with the rows of `u` that it uses.
    pub(super) fn axial_input<'a>(
        &'a self,
        batch: &'a AxialBatch,
        (growth, stress_free): (&'a ElementGrowth, Option<&'a [StressFreeStretch]>),
        u: &'a [f64],
    ) -> axial::Input<'a> {
        let m = self.row_size();
        let rows = batch.elements + self.degree();
        axial::Input {
            batch,
            layers: &self.layers,
            around: &self.around,
            points: self.wall.functions(),
            rings: self.sector.rings,
            inverse_stretch: &growth.inverse_stretch,
            modified: ModifiedWall::of(stress_free, &growth.patches),
            u: &u[batch.first * m..(batch.first + rows) * m],
        }
    }

    /// Returns 1/θζ and 1/θη at the quadrature points along an axial batch.
    pub(super) fn inverse_stretch(&self, batch: &AxialBatch, load: &Load) -> Vec<(Lanes, Lanes)> {
        let at = |z: &Lanes| {
            let (mut along, mut around) = (Lanes::default(), Lanes::default());
            for l in 0..z.0.len() {
                // Angle zero represents all; where muscles vary around the tube, see `growth_along`.
                let (theta_z, theta_t) = self.tube.stretches_at(self.wall_layer, z.0[l], 0.0, load);
                along.0[l] = 1.0 / theta_z;
                around.0[l] = 1.0 / theta_t;
            }
            (along, around)
        };
        batch.z.iter().map(at).collect()
    }

    /// Returns the size of a row of control points with padded rings.
    pub(super) fn padded_row_size(&self) -> usize {
        self.wall.functions() * 3 * self.padded_rings.padded
    }

    /// Returns the kernel input for the elements around the tube in lane `lane` of axial batch
    /// `number`.
    pub(super) fn circumferential_input<'a>(
        &'a self,
        (number, lane): (usize, usize),
        growth: &'a ElementGrowth,
        u: &'a [f64],
    ) -> circumferential::Input<'a> {
        let batch = &self.batches[number];
        let row = self.padded_row_size();
        let stress_free = self.stress_free_shape.as_ref().map(|imperfect| {
            let points = &imperfect.points[number];
            let len = points.len() / batch.elements;
            &points[lane * len..][..len]
        });
        circumferential::Input {
            batch,
            lane,
            layers: &self.layers,
            around: &self.around,
            points: self.wall.functions(),
            rings: &self.padded_rings,
            inverse_stretch: &growth.inverse_stretch,
            modified: ModifiedWall::of(stress_free, &growth.patches),
            u: &u[(batch.first + lane) * row..][..(self.degree() + 1) * row],
        }
    }

    /// Returns 1/θζ and 1/θη at the points of an element along the tube. If a muscle may vary around
    /// the tube, it returns them for every point around and every vector of elements too.
    pub(super) fn inverse_stretch_around(
        &self,
        batch: &AxialBatch,
        lane: usize,
        around: &[CircumferentialPoint],
        load: &Load,
    ) -> Vec<(Lanes, Lanes)> {
        let inverse = |at: &dyn Fn(usize) -> (f64, f64)| {
            let stretches: [(f64, f64); LANES] = std::array::from_fn(at);
            (
                Lanes(stretches.map(|(along, _)| 1.0 / along)),
                Lanes(stretches.map(|(_, around)| 1.0 / around)),
            )
        };
        let mut stretch = vec![];
        for z in batch.z.iter().map(|z| z.0[lane]) {
            if !self.tube.growth_is_modified() {
                stretch.push(inverse(&|_| self.tube.stretches(self.wall_layer, z, load)));
                continue;
            }
            for point in around {
                for v in 0..self.padded_rings.vectors() {
                    stretch.push(inverse(&|lane| {
                        let phi = self.angle_at(v * LANES + lane, point);
                        self.tube.stretches_at(self.wall_layer, z, phi, load)
                    }));
                }
            }
        }
        stretch
    }

    /// Returns the stress-free shape at the points of an axial batch, for control points displaced
    /// from the perfect tube.
    pub(super) fn stress_free_along(
        &self,
        batch: &AxialBatch,
        displacement: &[f64],
    ) -> Vec<StressFreeStretch> {
        let no_growth = ElementGrowth::default();
        let perfect = self.axial_input(batch, (&no_growth, None), displacement);
        with_degree!(self, axial::stress_free_stretch, &perfect)
    }

    /// Returns the stress-free shape at the points of an axial batch; none if the tube is perfect.
    pub(super) fn stress_free_in_axial_batch(
        &self,
        number: usize,
    ) -> Option<Cow<'_, [StressFreeStretch]>> {
        let imperfect = self.stress_free_shape.as_ref()?;
        Some(if self.sector.rings < CIRCUMFERENTIAL_BATCH_RINGS {
            Cow::Borrowed(&imperfect.points[number])
        } else {
            Cow::Owned(self.stress_free_along(&self.batches[number], &imperfect.displacement))
        })
    }

    /// Returns the stress-free shape at the points of a circumferential batch, for control points
    /// displaced from the perfect tube.
    pub(super) fn stress_free_around(
        &self,
        batch: &AxialBatch,
        lane: usize,
        layers: &[Layer],
        around: &[CircumferentialPoint],
        displacement: &[f64],
    ) -> Vec<StressFreeStretch> {
        let row = self.padded_row_size();
        let perfect = circumferential::Input {
            batch,
            lane,
            layers,
            around,
            points: self.wall.functions(),
            rings: &self.padded_rings,
            inverse_stretch: &[],
            modified: None,
            u: &displacement[(batch.first + lane) * row..][..(self.degree() + 1) * row],
        };
        with_degree!(self, circumferential::stress_free_stretch, &perfect)
    }
}
