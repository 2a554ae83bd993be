//! Assembled damping matrix C/η = ∫ N N dV₀ (Okino et al. 2025, Eq. (16) with η = 1) over the
//! reference volume; also the consistent mass matrix of unit density.

use super::SplineTube;
use crate::matrix::BlockBanded;

impl SplineTube {
    /// Assembles the damping matrix of the sector.
    pub fn damping(&self) -> BlockBanded {
        let (around, sector) = (&self.around, &self.sector);
        let (rows, points) = (self.axial.functions(), self.wall.functions());
        let (degree, k) = (self.degree(), sector.rings);
        let functions = degree + 1;
        let size = points * 3 * k;
        let mut matrix = BlockBanded::zeros(rows, size, degree);

        // The integral over a cross-section: a dense block, the same for every row.
        let mut section = vec![0.0; size * size];
        for layer in self.elements_through() {
            for q in 0..layer.radius.len() {
                for point in around {
                    let area = layer.weight_at_rest[q]
                        * layer.radius[q]
                        * point.weight
                        * point.across
                        * point.radius;
                    for c in 0..functions {
                        for d in 0..functions {
                            let m = area
                                * layer.value[q * functions + c]
                                * layer.value[q * functions + d];
                            for (r, f) in point.ring_values.iter().enumerate() {
                                for (s, g) in point.ring_values.iter().enumerate() {
                                    // Conjugate product of the two ring values.
                                    let ((fr, fi), (gr, gi)) = (f.rotated[0], g.rotated[0]);
                                    let (re, im) = (fr * gr + fi * gi, fr * gi - fi * gr);
                                    let axial = f.axial[0] * g.axial[0];
                                    let block = [[axial, 0.0, 0.0], [0.0, re, -im], [0.0, im, re]];
                                    for element in 0..k {
                                        let (i, j) =
                                            (sector.ring(element, r), sector.ring(element, s));
                                        for (x, row) in block.iter().enumerate() {
                                            for (y, b) in row.iter().enumerate() {
                                                let row = ((layer.first + c) * 3 + x) * k + i;
                                                let column = ((layer.first + d) * 3 + y) * k + j;
                                                section[column * size + row] += m * b;
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

        // Times the integral along the tube.
        let mut axial = vec![vec![0.0; functions]; rows];
        for batch in &self.batches {
            for l in 0..batch.elements {
                for q in 0..batch.weight.len() {
                    let n = |a: usize| batch.value[q * functions + a].0[l];
                    for a in 0..functions {
                        for b in 0..=a {
                            axial[batch.first + l + b][a - b] += batch.weight[q].0[l] * n(a) * n(b);
                        }
                    }
                }
            }
        }
        let indices: Vec<Vec<usize>> = (0..functions)
            .map(|d| {
                (0..size * size)
                    .map(|e| matrix.place(d, e % size, e / size))
                    .collect()
            })
            .collect();
        for (panel, axial) in matrix.panels_mut().zip(&axial) {
            for (indices, &n) in indices.iter().zip(axial) {
                for (&index, s) in indices.iter().zip(&section) {
                    panel[index] = n * s;
                }
            }
        }
        matrix
    }
}
