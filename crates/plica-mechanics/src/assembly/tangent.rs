//! Assembled tangent stiffness of a tube.

use super::SplineTube;
use super::axial::{self, BatchTangent};
use super::dispatch::{with_degree, with_law_and_degree};
use super::tables::CircumferentialPoint;
use crate::material::Material;
use crate::matrix::BlockBanded;
use crate::rings::Rotation;
use crate::tube::Load;
use rayon::prelude::*;

/// Bytes of batch tangents that are stored before they are summed.
const TANGENT_MEMORY: usize = 256 << 20;

impl SplineTube {
    /// Assembles the tangent stiffness ∂R/∂u_cp of the sector at a state; every unknown is free.
    /// The state must not be inverted (see [`SplineTube::forces`]).
    pub fn tangent(&self, load: &Load, u: &[f64]) -> BlockBanded {
        let rotations =
            |at: &CircumferentialPoint| vec![at.ring_values.iter().map(Rotation::from).collect()];
        self.tangent_on(load, u, &rotations)
    }

    /// Assembles the block of the whole tube's tangent for circumferential harmonic n ≥ 1, at an
    /// axisymmetric state without twist: there the tangent is block-circulant, and real on
    /// displacements (z cos nφ, r cos nφ, −θ sin nφ). Scaled by 2/N_C; every unknown is free.
    pub fn tangent_in_harmonic(&self, load: &Load, u: &[f64], n: usize) -> BlockBanded {
        assert!(self.sector.rings == 1 && n >= 1);
        let rotations = |at: &CircumferentialPoint| {
            self.sector
                .harmonic_at(n, at.s)
                .map(|half| vec![half])
                .to_vec()
        };
        self.tangent_on(load, u, &rotations)
    }

    /// Assembles the tangent with the ring rotations that `rotations` returns for a point around
    /// the element.
    fn tangent_on(
        &self,
        load: &Load,
        u: &[f64],
        rotations: &dyn Fn(&CircumferentialPoint) -> Vec<Vec<Rotation>>,
    ) -> BlockBanded {
        let (p, m) = (self.degree(), self.row_size());
        let mut matrix = BlockBanded::zeros(self.axial.functions(), m, p);
        let own: Vec<_> = self.around.iter().map(rotations).collect();
        self.add_elastic_tangent(load, u, &own, &mut matrix);
        for part in self.parts.iter().filter(|part| !part.is_idle(load)) {
            part.add_elastic_tangent(load, u, &own, &mut matrix);
        }
        self.add_wall_tangent(load, u, &own, &mut matrix);
        matrix
    }

    fn add_elastic_tangent(
        &self,
        load: &Load,
        u: &[f64],
        rotations: &[Vec<Vec<Rotation>>],
        matrix: &mut BlockBanded,
    ) {
        let (p, m) = (self.degree(), self.row_size());
        // A few batches at a time when rows are large.
        let batch_bytes = 8 * (p + 1) * m * m * (8 + p);
        let together = (TANGENT_MEMORY / batch_bytes).clamp(2, self.batches.len().max(2));
        let mut before: Option<(usize, BatchTangent)> = None;
        for (chunk, batches) in self.batches.chunks(together).enumerate() {
            let mut parts: Vec<(usize, BatchTangent)> = batches
                .par_iter()
                .enumerate()
                .map(|(number, batch)| {
                    let growth = self.growth_along(batch, load);
                    if growth.is_idle {
                        return (batch.first, BatchTangent::default());
                    }
                    let shape = self.stress_free_in_axial_batch(chunk * together + number);
                    let input = self.axial_input(batch, (&growth, shape.as_deref()), u);
                    (
                        batch.first,
                        with_law_and_degree!(self, self.law, axial::tangent, &input, rotations),
                    )
                })
                .collect();
            // Each row adds the entries of its own batch, then those of the batch before.
            let first = parts[0].0;
            let last = parts[parts.len() - 1].0 + batches[batches.len() - 1].elements;
            let end = if last == self.axial.elements() {
                last + p
            } else {
                last
            };
            let indices = self.panel_indices(matrix);
            let parts_before = before.as_slice();
            matrix.panels_mut().enumerate().collect::<Vec<_>>()[first..end]
                .par_iter_mut()
                .for_each(|(row, panel)| {
                    for (from, part) in parts.iter().chain(parts_before) {
                        if (*from..from + part.rows).contains(row) {
                            for (i, &index) in indices.iter().enumerate() {
                                panel[index] += part.entries[i * part.rows + *row - from];
                            }
                        }
                    }
                });
            before = parts.pop();
        }
    }

    /// Returns the indices in a panel of the entries of a batch tangent, in their order.
    fn panel_indices(&self, matrix: &BlockBanded) -> Vec<usize> {
        let m = self.row_size();
        let mut indices = Vec::with_capacity((self.degree() + 1) * m * m);
        for d in 0..=self.degree() {
            for column in 0..m {
                indices.extend((0..m).map(|row| matrix.place(d, row, column)));
            }
        }
        indices
    }
}
