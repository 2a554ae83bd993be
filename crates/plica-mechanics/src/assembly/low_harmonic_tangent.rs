//! Tangent on the low harmonics, assembled at a state that is not axisymmetric.

use super::SplineTube;
use super::circumferential::{self, AVERAGED};
use super::dispatch::{with_degree, with_law_and_degree};
use super::low_harmonics::{LayerPoints, LowHarmonics, POINTS_THROUGH, THROUGH};
use super::modified_wall::ModifiedWall;
use super::spline_tube::PartKind;
use super::tables::AxialBatch;
use crate::material::Material;
use crate::matrix::{BlockBanded, multiply};
use crate::tube::Load;
use rayon::prelude::*;

impl SplineTube {
    /// Assembles Eᵀ K E at a state into a matrix with blocks of [`LowHarmonics::row_size`]; every
    /// unknown is free.
    pub fn low_harmonic_tangent(
        &self,
        low: &LowHarmonics,
        load: &Load,
        u: &[f64],
        matrix: &mut BlockBanded,
    ) {
        let imperfect = self.stress_free_shape.as_ref();
        let displacement =
            imperfect.map(|imperfect| self.padded_rings.pad(&imperfect.displacement));
        let displacement = displacement.as_deref();
        let (p, size) = (self.degree(), low.row_size());
        matrix.clear();
        self.add_low_harmonic_walls(low, load, u, matrix);
        let u = self.padded_rings.pad(u);
        // A few batches at a time, added in their order.
        for batches in low.batches.chunks(4) {
            let parts: Vec<Vec<[Vec<f64>; 4]>> = batches
                .par_iter()
                .map(|batch| {
                    (0..batch.elements)
                        .flat_map(|lane| {
                            self.coupled_sums(low, (batch, lane), load, &u, displacement)
                        })
                        .collect()
                })
                .collect();
            let (first, last) = (batches[0].first, batches[batches.len() - 1].first);
            let end = last + batches[batches.len() - 1].elements + p;
            let panels: Vec<_> = matrix.panels_mut().enumerate().collect();
            let (height, n) = ((p + 1) * size, p + 1);
            panels
                .into_par_iter()
                .filter(|(row, _)| (first..end).contains(row))
                .for_each(|(row, panel)| {
                    for (batch, parts) in batches.iter().zip(&parts) {
                        for (at, [slopes, mixed, across, values]) in parts.iter().enumerate() {
                            let (lane, q) = (at / low.points_along, at % low.points_along);
                            let Some(b) = row.checked_sub(batch.first + lane).filter(|b| *b < n)
                            else {
                                continue;
                            };
                            let value = |a: usize| batch.value[q * n + a].0[lane];
                            let slope = |a: usize| batch.slope[q * n + a].0[lane];
                            for a in b..n {
                                let [f, g, h, k] = [
                                    slope(a) * slope(b),
                                    slope(a) * value(b),
                                    value(a) * slope(b),
                                    value(a) * value(b),
                                ];
                                for column in 0..size {
                                    let to = &mut panel[column * height + (a - b) * size..][..size];
                                    let from = column * size..(column + 1) * size;
                                    let own =
                                        slopes[from.clone()].iter().zip(&values[from.clone()]);
                                    let both = mixed[from.clone()].iter().zip(&across[from]);
                                    for ((to, (s, v)), (m, t)) in to.iter_mut().zip(own).zip(both) {
                                        *to += f * s + k * v + g * m + h * t;
                                    }
                                }
                            }
                        }
                    }
                });
        }
    }

    /// Returns, for every point along an element, the sums through the wall and around the tube
    /// that multiply the slopes of row and column along the tube, the slope of the row and the
    /// value of the column, the value of the row and the slope of the column, and both values;
    /// column by column.
    fn coupled_sums(
        &self,
        low: &LowHarmonics,
        (batch, lane): (&AxialBatch, usize),
        load: &Load,
        u: &[f64],
        displacement: Option<&[f64]>,
    ) -> Vec<[Vec<f64>; 4]> {
        let size = low.row_size();
        let mut sums = vec![[0, 1, 2, 3].map(|_| vec![0.0; size * size]); low.points_along];
        let parts = self.all_parts().filter(|part| !part.is_volumetric());
        for (part, layer) in parts.zip(&low.layers) {
            if part.is_idle(load) {
                continue;
            }
            part.add_coupled_sums(low, layer, (batch, lane), load, u, displacement, &mut sums);
        }
        sums
    }

    /// Adds the sums over the points of this part of the wall.
    #[allow(clippy::too_many_arguments)] // all of them are needed
    fn add_coupled_sums(
        &self,
        low: &LowHarmonics,
        layer: &LayerPoints,
        (batch, lane): (&AxialBatch, usize),
        load: &Load,
        u: &[f64],
        displacement: Option<&[f64]>,
        out: &mut [[Vec<f64>; 4]],
    ) {
        let (k, padded) = (self.sector.rings, self.padded_rings.padded);
        let row = self.wall.functions() * 3 * padded;
        let growth = self.growth_around(batch, lane, &low.middle, load);
        if growth.is_idle {
            return;
        }
        let law = match self.kind {
            PartKind::Muscle(_) => &self.law,
            // The whole law, also where its volumetric part is integrated apart.
            _ => &self.tube.layers[self.wall_layer].material,
        };
        let shape = displacement
            .map(|u| self.stress_free_around(batch, lane, &layer.points, &low.middle, u));
        let input = circumferential::Input {
            batch,
            lane,
            layers: &layer.points,
            around: &low.middle,
            points: self.wall.functions(),
            rings: &self.padded_rings,
            inverse_stretch: &growth.inverse_stretch,
            modified: ModifiedWall::of(shape.as_deref(), &growth.patches),
            u: &u[(batch.first + lane) * row..][..(self.degree() + 1) * row],
        };
        let mut moduli = vec![0.0; low.points_along * POINTS_THROUGH * AVERAGED * padded];
        with_law_and_degree!(self, *law, circumferential::moduli, &input, &mut moduli);

        let (columns, size) = (3 * low.modes(), low.row_size());
        let mut moved = vec![0.0; 3 * k * 3 * columns];
        let mut sums = [
            vec![0.0; 3 * columns * columns],
            vec![0.0; 2 * columns * columns],
            vec![0.0; columns * columns],
        ];
        let mut moduli = moduli.chunks_exact(AVERAGED * padded);
        for total in out {
            let mut out = [0, 1, 2].map(|_| vec![0.0; size * size]);
            for ((value, slope), moduli) in layer.wall.iter().zip(moduli.by_ref()) {
                // Blocks (ζ,ζ) (ζ,s) (ζ,R); (s,s) (s,R); (R,R).
                let mut block = 0;
                for (alpha, sum) in sums.iter_mut().enumerate() {
                    let width = (3 - alpha) * columns;
                    for beta in alpha..3 {
                        let wave = &low.waves[usize::from(beta == 1)];
                        for e in 0..k {
                            let A: [f64; 9] =
                                std::array::from_fn(|x| moduli[(9 * block + x) * padded + e]);
                            let from = &wave[3 * e * columns..][..3 * columns];
                            for j in 0..3 {
                                let to = (3 * e + j) * width + (beta - alpha) * columns;
                                let to = &mut moved[to..to + columns];
                                for (x, to) in to.iter_mut().enumerate() {
                                    *to = A[3 * j] * from[x]
                                        + A[3 * j + 1] * from[columns + x]
                                        + A[3 * j + 2] * from[2 * columns + x];
                                }
                            }
                        }
                        block += 1;
                    }
                    let wave = &low.waves[usize::from(alpha == 1)];
                    multiply(
                        (wave, [columns, 3 * k], [1, columns]),
                        (&moved[..3 * k * width], [3 * k, width], [width, 1]),
                        (sum, [1, columns]),
                    );
                }
                add_through(&sums, columns, value, slope, &mut out);
            }
            let [slopes, mixed, values] = out;
            let transposed = |at: usize| mixed[at % size * size + at / size];
            let across = (0..size * size).map(transposed).collect();
            for (total, part) in total.iter_mut().zip([slopes, mixed, across, values]) {
                let sums = total.iter_mut().zip(&part);
                sums.for_each(|(total, part): (&mut f64, &f64)| *total += part);
            }
        }
    }
}

/// Adds the contribution of a point through the wall to the three sums of
/// [`SplineTube::coupled_sums`].
fn add_through(
    sums: &[Vec<f64>; 3],
    n: usize,
    value: &[f64; THROUGH],
    slope: &[f64; THROUGH],
    out: &mut [Vec<f64>; 3],
) {
    let size = THROUGH * n;
    let [along, around, through] = sums;
    for d in 0..THROUGH {
        for column in 0..n {
            let of = |sum, block| &Vec::as_slice(sum)[block * n * n + column * n..][..n];
            let (zz, zs, zr) = (of(along, 0), of(along, 1), of(along, 2));
            let (ss, sr, rr) = (of(around, 0), of(around, 1), of(through, 0));
            for c in 0..THROUGH {
                let at = (d * n + column) * size + c * n;
                let (m, dm, m2, dm2) = (value[c], slope[c], value[d], slope[d]);
                for row in 0..n {
                    let rs = around[n * n + row * n + column];
                    out[0][at + row] += m * m2 * zz[row];
                    out[1][at + row] += m * (m2 * zs[row] + dm2 * zr[row]);
                    out[2][at + row] +=
                        m * (m2 * ss[row] + dm2 * sr[row]) + dm * (m2 * rs + dm2 * rr[row]);
                }
            }
        }
    }
}
