//! Contribution of the walls to the tangent averaged around the tube.

use super::super::SplineTube;
use super::{WallTangent, rotated};
use crate::rings::{Circulant, Rotation};
use crate::tensor::with_vectors;

impl SplineTube {
    /// Adds the contribution of the walls to the tangent, averaged over the rings (see
    /// [`offset_blocks`](super::super::circumferential::offset_blocks)).
    pub(in crate::assembly) fn add_average_walls(&self, at: &WallTangent, average: &mut Circulant) {
        with_vectors!(simd => self.add_average_walls_in(at, average));
    }

    #[inline(always)]
    fn add_average_walls_in(&self, at: &WallTangent, average: &mut Circulant) {
        let (n, k) = (self.degree() + 1, self.sector.rings);
        let rotations: Vec<Vec<Rotation>> = self
            .around
            .iter()
            .map(|point| {
                self.sector
                    .function_values_at(point.s)
                    .iter()
                    .map(Rotation::from)
                    .collect()
            })
            .collect();
        for wall in &at.walls {
            for along @ (batch, lane) in self.elements_along() {
                // By distance d between rings, rows of control points a and b, and components i and
                // j.
                let mut blocks_apart = vec![[[0.0; 3]; 3]; n * n * n];
                for qz in 0..n {
                    let rings = self.rings_along(wall, &at.u, along, qz);
                    for (number, (point, rotations)) in
                        self.around.iter().zip(&rotations).enumerate()
                    {
                        let weight = batch.weight[qz].0[lane] * point.weight / k as f64;
                        let mut blocks = [[[0.0; 3]; 3]; 6];
                        let mut is_loaded = false;
                        for element in 0..k {
                            let moved = self.surface_displacement(&rings, element, point);
                            let at = self.wall_point(wall, along, qz, [element, number], point);
                            let Some(own) = self.wall_blocks(wall, &moved, &at, weight) else {
                                continue;
                            };
                            is_loaded = true;
                            for (sum, own) in
                                blocks.as_flattened_mut().iter_mut().zip(own.as_flattened())
                            {
                                for (sum, own) in sum.iter_mut().zip(own) {
                                    *sum += own;
                                }
                            }
                        }
                        if !is_loaded {
                            continue;
                        }
                        for r in 0..n {
                            for s in r..n {
                                let rotated = rotated(&blocks, &rotations[r], &rotations[s]);
                                self.add_along_tube(along, qz, &rotated, |a, b, i, j, x| {
                                    blocks_apart[((s - r) * n + a) * n + b][i][j] += x;
                                });
                            }
                        }
                    }
                }
                for d in 0..n {
                    for b in 0..n {
                        for a in b..n {
                            let (own, mirrored) = (
                                &blocks_apart[(d * n + a) * n + b],
                                &blocks_apart[(d * n + b) * n + a],
                            );
                            for i in 0..3 {
                                for j in 0..3 {
                                    let value = match (d, (i == 2) != (j == 2)) {
                                        (0, false) => own[i][j],
                                        (0, true) => 0.0,
                                        (_, false) => own[i][j] + mirrored[j][i],
                                        (_, true) => own[i][j] - mirrored[j][i],
                                    };
                                    let index = (wall.point * 3 + i, wall.point * 3 + j);
                                    average.offsets[d].add_at(
                                        batch.first + lane + b,
                                        a - b,
                                        index.0,
                                        index.1,
                                        value,
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
