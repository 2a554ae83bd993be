//! Matrix-free tangent stiffness of a tube of many rings.

use super::SplineTube;
use super::axial::BatchTangent;
use super::circumferential::{self, AVERAGED, PackedTangentData};
use super::dispatch::{with_degree, with_law_and_degree};
use super::modified_wall::ElementGrowth;
use super::tables::AxialBatch;
use super::walls::WallTangent;
use crate::material::Material;
use crate::matrix::BlockBanded;
use crate::rings::Circulant;
use crate::tube::Load;
use rayon::prelude::*;

/// Tangent stiffness at a state in the form that products need, and its average around the tube.
#[derive(Clone, Debug, Default)]
pub struct MatrixFreeTangent {
    /// Growth, by element along the tube.
    growth: Vec<ElementGrowth>,
    /// By batch.
    tangent_data: Vec<PackedTangentData>,
    pub(super) walls: Option<WallTangent>,
    /// Tangents of the other parts of the wall; `average` includes their averages.
    parts: Vec<MatrixFreeTangent>,
    /// The tangent averaged over the rings; every unknown is free.
    pub average: Circulant,
}

impl SplineTube {
    /// Linearises at a state: makes `tangent` the stiffness ∂R/∂u_cp of the sector, reusing its memory.
    /// The state must not be inverted (see [`SplineTube::forces`]). Stores the tangent data of the law
    /// at every quadrature point, in single precision.
    pub fn linearise(&self, load: &Load, u: &[f64], tangent: &mut MatrixFreeTangent) {
        tangent.walls = self.wall_tangent(load, u);
        self.linearise_elastic(load, u, tangent);
        tangent
            .parts
            .resize_with(self.parts.len(), Default::default);
        for (part, of_part) in self.parts.iter().zip(&mut tangent.parts) {
            if part.is_idle(load) {
                *of_part = MatrixFreeTangent::default();
                continue;
            }
            part.linearise_elastic(load, u, of_part);
            tangent.average.add(&of_part.average);
        }
        if let Some(walls) = &tangent.walls {
            self.add_average_walls(walls, &mut tangent.average);
        }
    }

    fn linearise_elastic(&self, load: &Load, u: &[f64], at: &mut MatrixFreeTangent) {
        let u = self.padded_rings.pad(u);
        let lanes = |batch: &AxialBatch| {
            let of = |lane| self.growth_around(batch, lane, &self.around, load);
            (0..batch.elements).map(of).collect::<Vec<_>>()
        };
        at.growth = self.batches.iter().flat_map(lanes).collect();
        at.tangent_data.resize(self.batches.len(), vec![]);
        let growth = &at.growth;
        let functions = self.degree() + 1;
        let element = functions.pow(3) * self.layers.len() * AVERAGED;
        let offsets: Vec<Vec<BatchTangent>> = (&self.batches, &mut at.tangent_data)
            .into_par_iter()
            .enumerate()
            .map(|(number, (batch, tangent_data))| {
                let (layers, vectors) = (self.layers.len(), self.padded_rings.vectors());
                let len = with_law_and_degree!(
                    self,
                    self.law,
                    circumferential::tangent_data_len,
                    layers,
                    vectors
                );
                tangent_data.resize(len * batch.elements, [0.0; 16]);
                let mut averaged = vec![0.0; element * batch.elements];
                for lane in 0..batch.elements {
                    let growth = &growth[batch.first + lane];
                    if growth.is_idle {
                        continue;
                    }
                    let input = self.circumferential_input((number, lane), growth, &u);
                    let tangent_data = &mut tangent_data[lane * len..][..len];
                    let averaged = &mut averaged[lane * element..][..element];
                    with_law_and_degree!(
                        self,
                        self.law,
                        circumferential::linearise,
                        &input,
                        tangent_data,
                        averaged
                    );
                }
                self.offset_blocks(batch, &averaged)
            })
            .collect();
        self.sum_offset_blocks(&offsets, &mut at.average);
    }

    /// Computes y += factor · K v.
    pub fn add_tangent_product(
        &self,
        at: &MatrixFreeTangent,
        factor: f64,
        v: &[f64],
        y: &mut [f64],
    ) {
        if let Some(walls) = &at.walls {
            self.add_wall_product(walls, factor, v, y);
        }
        let v = self.padded_rings.pad(v);
        self.add_elastic_product(at, factor, &v, y);
        for (part, at) in self.parts.iter().zip(&at.parts) {
            part.add_elastic_product(at, factor, &v, y);
        }
    }

    /// Adds the product of this part of the wall; v has padded rows.
    fn add_elastic_product(&self, at: &MatrixFreeTangent, factor: f64, v: &[f64], y: &mut [f64]) {
        let row = self.padded_row_size();
        let parts: Vec<Vec<f64>> = self
            .batches
            .par_iter()
            .zip(&at.tangent_data)
            .enumerate()
            .map(|(number, (batch, tangent_data))| {
                let mut out = vec![0.0; (batch.elements + self.degree()) * row];
                let len = tangent_data.len() / batch.elements;
                for lane in 0..batch.elements {
                    let growth = &at.growth[batch.first + lane];
                    if growth.is_idle {
                        continue;
                    }
                    let input = self.circumferential_input((number, lane), growth, v);
                    let tangent_data = &tangent_data[lane * len..][..len];
                    let out = &mut out[lane * row..][..(self.degree() + 1) * row];
                    with_law_and_degree!(
                        self,
                        self.law,
                        circumferential::tangent_product,
                        &input,
                        tangent_data,
                        out
                    );
                }
                out
            })
            .collect();
        for (batch, part) in self.batches.iter().zip(&parts) {
            self.add_rows(batch, factor, part, y);
        }
    }

    /// Returns the contribution of an axial batch to the blocks between rings, from its moduli
    /// summed around the tube.
    fn offset_blocks(&self, batch: &AxialBatch, summed: &[f64]) -> Vec<BatchTangent> {
        let (points, layers) = (self.wall.functions(), &self.layers);
        let (sector, around) = (&self.sector, &self.around);
        with_degree!(
            self,
            circumferential::offset_blocks,
            batch,
            layers,
            points,
            sector,
            around,
            summed
        )
    }

    /// Sums the contributions of the batches to the blocks between rings.
    fn sum_offset_blocks(&self, parts: &[Vec<BatchTangent>], average: &mut Circulant) {
        let (p, m) = (self.degree(), self.wall.functions() * 3);
        let zeros = || BlockBanded::zeros(self.axial.functions(), m, p);
        average.offsets.resize_with(p + 1, zeros);
        average.angle = self.sector.angle();
        average
            .offsets
            .par_iter_mut()
            .enumerate()
            .for_each(|(d, matrix)| {
                matrix.clear();
                for (batch, part) in self.batches.iter().zip(parts) {
                    part[d].add_to(matrix, batch.first, m, p);
                }
            });
    }
}
