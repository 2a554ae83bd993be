//! A tube whose stress-free shape is imperfect.

use super::batch_input::CIRCUMFERENTIAL_BATCH_RINGS;
use super::imperfection::geometry;
use super::spline_tube::StressFreeShape;
use super::{Inverted, SplineTube};
use crate::tube::Imperfection;
use rayon::prelude::*;
use std::sync::Arc;

impl SplineTube {
    /// Returns the tube with a stress-free shape whose control points are displaced from the
    /// perfect tube.
    pub(super) fn with_stress_free_shape(mut self, displacement: Vec<f64>) -> Self {
        let batches = self.batches.par_iter();
        let points = if self.sector.rings < CIRCUMFERENTIAL_BATCH_RINGS {
            batches
                .map(|batch| self.stress_free_along(batch, &displacement))
                .collect()
        } else {
            let u = self.padded_rings.pad(&displacement);
            batches
                .map(|batch| {
                    let lanes = 0..batch.elements;
                    let shape =
                        |lane| self.stress_free_around(batch, lane, &self.layers, &self.around, &u);
                    lanes.flat_map(shape).collect()
                })
                .collect()
        };
        self.stress_free_shape = Some(Arc::new(StressFreeShape {
            displacement,
            points,
        }));
        self
    }

    /// Returns u₀ of the stress-free shape X + u₀(X): control values numbered like the unknowns.
    /// None if the tube has no imperfection of its geometry.
    ///
    /// Waves are zero at fixed ends. Other ends, and modes, are fixed at u₀, so that u = u₀ is free
    /// of stress and the equilibrium at rest is the stress-free shape.
    pub fn geometric_imperfection(&self) -> Option<&[f64]> {
        let imperfect = self.stress_free_shape.as_ref();
        imperfect.map(|imperfect| &imperfect.displacement[..])
    }

    /// Checks that the stress-free shape of a tube with these imperfections is a valid shape.
    ///
    /// # Errors
    /// [`Inverted`] if the shape is folded: det ∂(X + u₀)/∂X is not positive.
    pub fn check_imperfections(&self, imperfections: &[Imperfection]) -> Result<(), Inverted> {
        let bases = [&self.axial, &self.wall];
        let Some(u) = geometry(&self.tube, imperfections, &self.sector, bases) else {
            return Ok(());
        };
        let perfect = Self {
            stress_free_shape: None,
            ..self.clone()
        };
        perfect.forces(&self.tube.rest(), &u).map(drop)
    }

    /// Returns an initial guess for the equilibrium at rest: zero, or the displacements of the
    /// imperfections, interpolated along the tube. The ends are prescribed as at rest.
    pub fn initial_guess(&self) -> Vec<f64> {
        let mut u = match self.geometric_imperfection() {
            Some(u) => u.to_vec(),
            None => vec![0.0; self.unknowns()],
        };
        // Displacement of the ends relative to it.
        let mut held = u.clone();
        self.apply_prescribed(&self.tube.rest(), &mut held);
        let (m, z) = (self.row_size(), self.axial.greville());
        let from_shape = |row: usize| -> Vec<f64> {
            let row = row * m..(row + 1) * m;
            held[row.clone()]
                .iter()
                .zip(&u[row])
                .map(|(h, u)| h - u)
                .collect()
        };
        let (first, last) = (from_shape(0), from_shape(z.len() - 1));
        for (row, z) in z.iter().enumerate() {
            let x = z / self.tube.length;
            for i in 0..m {
                u[row * m + i] += (1.0 - x) * first[i] + x * last[i];
            }
        }
        self.apply_prescribed(&self.tube.rest(), &mut u);
        u
    }
}
