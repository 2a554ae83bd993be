//! Energy and residual of a tube.

use super::axial::{self, BatchForces, SmallestJacobian};
use super::batch_input::CIRCUMFERENTIAL_BATCH_RINGS;
use super::circumferential;
use super::dispatch::{with_degree, with_law_and_degree};
use super::tables::AxialBatch;
use super::{Place, SplineTube};
use crate::material::Material;
use crate::tube::Load;
use rayon::prelude::*;

/// Energy and residual at a state.
#[derive(Clone, Debug, Default)]
pub struct Forces {
    /// ∫ w det Fp dV₀ of the whole tube: the paper's W, in E·D³.
    pub energy: f64,
    /// ∫ w dV₀ of the whole tube, over the ungrown volume.
    pub energy_ungrown: f64,
    /// Π of the whole tube: W plus the potential of the pressures, zero at rest, and the energy of the foundations.
    pub potential: f64,
    /// Energy of the foundations, of the whole tube.
    pub foundation: f64,
    /// Energy of contact with obstacles, of the whole tube.
    pub contact: f64,
    /// Potential of friction in a load step, of the whole tube; not part of Π.
    pub friction: f64,
    /// R of the sector, in E·D²: the derivative of Π and of the energy of contact by u_cp, of the whole tube, over the number
    /// of repeats.
    pub residual: Vec<f64>,
    /// Residual scale: root of the sum of squares of the element contributions to R, before they
    /// cancel.
    pub residual_scale: f64,
    /// Smallest det Fe at any quadrature point; of the volumetric points, if the volumetric part of
    /// the law has its own.
    pub smallest_jacobian: f64,
}

/// An inverted element: det Fe is not positive, or NaN.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("the wall is inverted (det Fe = {jacobian:.3e}, element {element:?})")]
pub struct Inverted {
    /// Element along the tube, through the wall and around the sector.
    pub element: [usize; 3],
    /// Middle of the element along and around, at the depth of the point with the smallest det Fe.
    pub place: Place,
    /// det Fe there.
    pub jacobian: f64,
}

impl SplineTube {
    /// Assembles energy and residual of a state `u` under a load.
    ///
    /// # Errors
    /// [`Inverted`] if det Fe is not positive at a quadrature point.
    pub fn forces(&self, load: &Load, u: &[f64]) -> Result<Forces, Inverted> {
        let mut forces = self.elastic_forces(load, u)?;
        // Where a law has volumetric points, det Fe only has to be positive at those of its shear part.
        let counts =
            |part: &Self| part.is_volumetric() || self.parts.iter().all(|p| !p.is_volumetric());
        if !counts(self) {
            forces.smallest_jacobian = f64::INFINITY;
        }
        for part in self.parts.iter().filter(|part| !part.is_idle(load)) {
            let of_part = part.elastic_forces(load, u)?;
            forces.energy += of_part.energy;
            forces.energy_ungrown += of_part.energy_ungrown;
            forces.residual_scale = forces.residual_scale.hypot(of_part.residual_scale);
            if counts(part) {
                forces.smallest_jacobian = forces.smallest_jacobian.min(of_part.smallest_jacobian);
            }
            for (sum, part) in forces.residual.iter_mut().zip(&of_part.residual) {
                *sum += part;
            }
        }
        forces.potential = forces.energy;
        self.add_walls(load, u, &mut forces);
        Ok(forces)
    }

    /// Assembles energy and residual of this part of the wall, without pressures.
    fn elastic_forces(&self, load: &Load, u: &[f64]) -> Result<Forces, Inverted> {
        let batches: Vec<BatchForces> = if self.sector.rings < CIRCUMFERENTIAL_BATCH_RINGS {
            let forces = |(number, batch): (usize, &AxialBatch)| {
                let growth = self.growth_along(batch, load);
                if growth.is_idle {
                    return BatchForces::default();
                }
                let shape = self.stress_free_in_axial_batch(number);
                let input = self.axial_input(batch, (&growth, shape.as_deref()), u);
                with_law_and_degree!(self, self.law, axial::forces, &input)
            };
            self.batches.par_iter().enumerate().map(forces).collect()
        } else {
            let u = self.padded_rings.pad(u);
            let forces = |number| self.circumferential_forces(number, load, &u);
            (0..self.batches.len())
                .into_par_iter()
                .map(forces)
                .collect()
        };

        let repeats = self.sector.repeats();
        let mut forces = Forces {
            residual: vec![0.0; u.len()],
            smallest_jacobian: f64::INFINITY,
            ..Forces::default()
        };
        for (batch, part) in self.batches.iter().zip(&batches) {
            let SmallestJacobian {
                jacobian,
                element: [lane, layer, around],
                qr,
            } = part.smallest;
            if jacobian.is_nan() || jacobian <= 0.0 {
                let along = batch.first + batch.row(lane);
                let (from, to) = self.axial.element(along);
                return Err(Inverted {
                    element: [along, self.layers[layer].element, around],
                    place: self.place(
                        f64::midpoint(from, to),
                        self.layers[layer].radius[qr],
                        around,
                    ),
                    jacobian,
                });
            }
            forces.smallest_jacobian = forces.smallest_jacobian.min(jacobian);
            forces.energy += repeats * part.energy;
            forces.energy_ungrown += repeats * part.energy_ungrown;
            forces.residual_scale += part.squares;
            let rows = &mut forces.residual[batch.first * self.row_size()..];
            for (sum, part) in rows.iter_mut().zip(&part.residual) {
                *sum += part;
            }
        }
        forces.residual_scale = forces.residual_scale.sqrt();
        Ok(forces)
    }

    /// Returns the forces of the elements of an axial batch, computed by circumferential batches.
    fn circumferential_forces(&self, number: usize, load: &Load, u: &[f64]) -> BatchForces {
        let batch = &self.batches[number];
        let row = self.padded_row_size();
        let mut residual = vec![0.0; (batch.elements + self.degree()) * row];
        let mut sum = BatchForces::default();
        for lane in 0..batch.elements {
            let growth = self.growth_around(batch, lane, &self.around, load);
            if growth.is_idle {
                continue;
            }
            let input = self.circumferential_input((number, lane), &growth, u);
            let residual = &mut residual[lane * row..][..(self.degree() + 1) * row];
            let part =
                with_law_and_degree!(self, self.law, circumferential::forces, &input, residual);
            sum.energy += part.energy;
            sum.energy_ungrown += part.energy_ungrown;
            sum.squares += part.squares;
            let worse =
                part.smallest.jacobian.is_nan() || part.smallest.jacobian < sum.smallest.jacobian;
            if worse && !sum.smallest.jacobian.is_nan() {
                sum.smallest = part.smallest;
                sum.smallest.element[0] = lane;
            }
        }
        sum.residual = vec![0.0; (batch.elements + self.degree()) * self.row_size()];
        let alone = AxialBatch {
            first: 0,
            ..batch.clone()
        };
        self.add_rows(&alone, 1.0, &residual, &mut sum.residual);
        sum
    }

    /// Adds the padded rows of a batch, times `factor`, to those of the tube.
    pub(super) fn add_rows(&self, batch: &AxialBatch, factor: f64, part: &[f64], y: &mut [f64]) {
        let k = self.sector.rings;
        let rows = y[batch.first * self.row_size()..].chunks_exact_mut(k);
        for (y, part) in rows.zip(part.chunks_exact(self.padded_rings.padded)) {
            for (y, x) in y.iter_mut().zip(part) {
                *y += factor * x;
            }
        }
    }
}
