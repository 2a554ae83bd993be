//! Contribution of the walls to the tangent on low harmonics.

use super::super::SplineTube;
use super::super::blocks::Block;
use super::super::low_harmonics::LowHarmonics;
use crate::matrix::BlockBanded;
use crate::tensor::with_vectors;
use crate::tube::Load;

impl SplineTube {
    /// Adds the contribution of the walls to Eᵀ K E (see [`SplineTube::low_harmonic_tangent`]).
    pub(in crate::assembly) fn add_low_harmonic_walls(
        &self,
        low: &LowHarmonics,
        load: &Load,
        u: &[f64],
        matrix: &mut BlockBanded,
    ) {
        with_vectors!(simd => self.add_low_harmonic_walls_in(low, load, u, matrix));
    }

    #[inline(always)]
    fn add_low_harmonic_walls_in(
        &self,
        low: &LowHarmonics,
        load: &Load,
        u: &[f64],
        matrix: &mut BlockBanded,
    ) {
        let (n, columns, point) = (self.degree() + 1, 3 * low.modes(), &low.middle[0]);
        let [values, slopes] = &low.waves;
        let along = low.points_along;
        for wall in self.walls_with_tangent(load) {
            // 1, t, t² at the wall.
            let through = [1.0, if wall.point == 0 { -1.0 } else { 1.0 }, 1.0];
            for batch in &low.batches {
                for (lane, qz) in (0..batch.elements * along).map(|i| (i / along, i % along)) {
                    let rings = self.rings_along(&wall, u, (batch, lane), qz);
                    let weight = batch.weight[qz].0[lane] * point.weight;
                    // The parts that multiply (N′, N) and (N, N) along the tube.
                    let mut mixed = vec![0.0; columns * columns];
                    let mut own = vec![0.0; columns * columns];
                    let mut is_loaded = false;
                    for element in 0..self.sector.rings {
                        let moved = self.surface_displacement(&rings, element, point);
                        let at = self.wall_point(&wall, (batch, lane), qz, [element, 0], point);
                        let Some(blocks) = self.wall_blocks(&wall, &moved, &at, weight) else {
                            continue;
                        };
                        is_loaded = true;
                        let [_, zs, zv, _, sv, vv] = blocks;
                        // `own` is added to its transpose.
                        let half = vv.map(|row| row.map(|x| 0.5 * x));
                        let rows = 3 * element * columns..3 * (element + 1) * columns;
                        let (value, slope) = (&values[rows.clone()], &slopes[rows]);
                        add_form(value, &zs, slope, &mut mixed);
                        add_form(value, &zv, value, &mut mixed);
                        add_form(slope, &sv, value, &mut own);
                        add_form(value, &half, value, &mut own);
                    }
                    if !is_loaded {
                        continue;
                    }
                    for b in 0..n {
                        let (value_b, slope_b) = self.along((batch, lane), qz, b);
                        for a in b..n {
                            let (value_a, slope_a) = self.along((batch, lane), qz, a);
                            for x in 0..columns {
                                for y in 0..columns {
                                    let (at, across) = (x * columns + y, y * columns + x);
                                    let entry = slope_a * value_b * mixed[at]
                                        + value_a * slope_b * mixed[across]
                                        + value_a * value_b * (own[at] + own[across]);
                                    for (c, f) in through.iter().enumerate() {
                                        for (d, g) in through.iter().enumerate() {
                                            matrix.add_at(
                                                batch.first + lane + b,
                                                a - b,
                                                c * columns + x,
                                                d * columns + y,
                                                f * g * entry,
                                            );
                                        }
                                    }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Adds Gᵀ B H of two matrices of three rows.
#[inline(always)]
pub(super) fn add_form(G: &[f64], B: &Block<f64>, H: &[f64], out: &mut [f64]) {
    let columns = G.len() / 3;
    for x in 0..columns {
        let mut row = [0.0; 3];
        for j in 0..3 {
            for i in 0..3 {
                row[j] += G[i * columns + x] * B[i][j];
            }
        }
        for (y, out) in out[x * columns..][..columns].iter_mut().enumerate() {
            *out += row[0] * H[y] + row[1] * H[columns + y] + row[2] * H[2 * columns + y];
        }
    }
}
