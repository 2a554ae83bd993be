//! Symmetric block-banded matrices and their factorisation.
//!
//! The matrix of a tube couples the control points at one axial position (a block of m unknowns) with
//! those at the p positions on either side. It is stored as n panels; panel j holds the blocks (j, j),
//! (j+1, j), …, (j+p, j) on top of each other, column-major. The factorisation A = L D Lᵀ (unit lower
//! L, diagonal D, no pivoting) proceeds panel by panel with the dense kernels of [`super::dense`]. The
//! signs of D are those of the eigenvalues of A (Sylvester), so an indefinite tangent can be factored,
//! and its negative pivots are counted.
//!
//! Cost for n blocks: n m³ (1/3 + p + p (p+1)) flops and n (p+1) m² numbers; for the axisymmetric tube
//! of the paper (n = 305, m = 24, p = 3) 6.5e7 and 5.6 MB.

use super::dense;
use crate::tensor::with_vectors;

/// A symmetric matrix of n × n blocks of m × m and half-bandwidth p blocks; the lower half is stored.
#[derive(Clone, Debug)]
pub struct BlockBanded {
    blocks: usize,
    size: usize,
    band: usize,
    panels: Vec<f64>,
}

/// The factorisation L D Lᵀ of a [`BlockBanded`] matrix.
#[derive(Clone, Debug)]
pub struct Factor {
    matrix: BlockBanded,
    negative_pivots: usize,
}

/// A pivot was zero or NaN.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("the matrix is singular at unknown {unknown}")]
pub struct Singular {
    /// The unknown at whose pivot the factorisation stopped.
    pub unknown: usize,
}

impl BlockBanded {
    /// Makes the zero matrix of `blocks` × `blocks` blocks of `size` × `size`.
    pub fn zeros(blocks: usize, size: usize, band: usize) -> Self {
        Self {
            blocks,
            size,
            band,
            panels: vec![0.0; blocks * (band + 1) * size * size],
        }
    }

    /// Returns the number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.blocks * self.size
    }

    /// Returns the number of blocks along the diagonal.
    pub fn blocks(&self) -> usize {
        self.blocks
    }

    /// Returns the number of unknowns of a block.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Returns the half-bandwidth in blocks.
    pub fn band(&self) -> usize {
        self.band
    }

    /// Returns the entry in row `row` and column `column` of the block `d` below the diagonal of panel
    /// `panel`. Diagonal blocks are read below their diagonal.
    pub fn in_block(&self, panel: usize, d: usize, row: usize, column: usize) -> f64 {
        let (row, column) = match d {
            0 => (row.max(column), row.min(column)),
            _ => (row, column),
        };
        self.panels[panel * self.panel_len() + self.place(d, row, column)]
    }

    /// Returns the rows of a panel, which are its leading dimension.
    fn height(&self) -> usize {
        (self.band + 1) * self.size
    }

    /// Returns the number of entries of a panel.
    fn panel_len(&self) -> usize {
        self.height() * self.size
    }

    /// Returns the panels in order, mutably.
    pub fn panels_mut(&mut self) -> std::slice::ChunksExactMut<'_, f64> {
        let len = self.panel_len();
        self.panels.chunks_exact_mut(len)
    }

    /// Returns the index in its panel of the entry in row `row` and column `column` of the block `d`
    /// below the diagonal.
    pub fn place(&self, d: usize, row: usize, column: usize) -> usize {
        column * self.height() + d * self.size + row
    }

    /// Returns column `column` of the block `d` below the diagonal of panel `panel`.
    pub(super) fn column_of_block(&self, panel: usize, d: usize, column: usize) -> &[f64] {
        &self.panels[panel * self.panel_len() + self.place(d, 0, column)..][..self.size]
    }

    /// Adds to the entry in row `row` and column `column` of the block `d` below the diagonal of panel
    /// `panel`.
    pub fn add_at(&mut self, panel: usize, d: usize, row: usize, column: usize, value: f64) {
        let at = panel * self.panel_len() + self.place(d, row, column);
        self.panels[at] += value;
    }

    /// Returns the entry in row i and column j of the whole matrix.
    pub fn entry(&self, i: usize, j: usize) -> f64 {
        let (i, j) = (i.max(j), i.min(j));
        let (d, panel) = (i / self.size - j / self.size, j / self.size);
        if d > self.band {
            return 0.0;
        }
        self.panels[panel * self.panel_len() + self.place(d, i % self.size, j % self.size)]
    }

    /// Sets every entry to zero.
    pub fn clear(&mut self) {
        self.panels.fill(0.0);
    }

    /// Copies a matrix of the same shape.
    pub fn copy_from(&mut self, other: &Self) {
        self.panels.copy_from_slice(&other.panels);
    }

    /// Overwrites the matrix with a sum of matrices of the same shape, in which each entry has a factor
    /// that depends on its row and column inside its block.
    pub fn combine<F: Fn(usize, usize) -> f64>(&mut self, parts: &[(&Self, F)]) {
        let (size, height, len) = (self.size, self.height(), self.panel_len());
        let factors: Vec<Vec<f64>> = parts
            .iter()
            .map(|(_, factor)| {
                (0..size * height)
                    .map(|at| factor(at % height % size, at / height))
                    .collect()
            })
            .collect();
        for (j, panel) in self.panels.chunks_exact_mut(len).enumerate() {
            panel.fill(0.0);
            for ((part, _), factors) in parts.iter().zip(&factors) {
                let from = &part.panels[j * len..][..len];
                for ((sum, x), factor) in panel.iter_mut().zip(from).zip(factors) {
                    *sum += factor * x;
                }
            }
        }
    }

    /// Adds `factor` times another matrix of the same shape.
    pub fn add_scaled(&mut self, factor: f64, other: &Self) {
        assert_eq!(self.panels.len(), other.panels.len());
        for (a, b) in self.panels.iter_mut().zip(&other.panels) {
            *a += factor * b;
        }
    }

    /// Adds `factor` · A x to `y`.
    pub fn multiply_add(&self, factor: f64, x: &[f64], y: &mut [f64]) {
        let m = self.size;
        for (j, panel) in self.panels.chunks_exact(self.panel_len()).enumerate() {
            let below = (self.blocks - j).min(self.band + 1) * m;
            for c in 0..m {
                let column = &panel[c * self.height()..][..below];
                let xc = factor * x[j * m + c];
                let mut sum = 0.0;
                for (r, &a) in column.iter().enumerate() {
                    let i = j * m + r;
                    // The diagonal block is read below its diagonal only.
                    if r < c {
                        continue;
                    }
                    y[i] += a * xc;
                    if r > c {
                        sum += a * x[i];
                    }
                }
                y[j * m + c] += factor * sum;
            }
        }
    }

    /// Replaces the rows and columns of prescribed unknowns by those of the identity.
    pub fn constrain(&mut self, prescribed: &[bool]) {
        let (m, height, len, band) = (self.size, self.height(), self.panel_len(), self.band);
        for (j, panel) in self.panels.chunks_exact_mut(len).enumerate() {
            let below = (self.blocks - j).min(band + 1) * m;
            for c in 0..m {
                for r in 0..below {
                    if prescribed[j * m + c] || prescribed[j * m + r] {
                        panel[c * height + r] = if r == c { 1.0 } else { 0.0 };
                    }
                }
            }
        }
    }

    /// Factors A = L D Lᵀ.
    ///
    /// # Errors
    ///
    /// If a pivot is zero or NaN.
    pub fn factor(mut self) -> Result<Factor, Singular> {
        let (m, p, height, len) = (self.size, self.band, self.height(), self.panel_len());
        let mut kernels = dense::Kernels::new(m, p * m);
        let mut negative_pivots = 0;
        for j in 0..self.blocks {
            let below = (self.blocks - 1 - j).min(p);
            let (head, tail) = self.panels.split_at_mut((j + 1) * len);
            let panel = &mut head[j * len..];
            negative_pivots +=
                kernels
                    .factor_panel(panel, height, m, below * m)
                    .map_err(|unknown| Singular {
                        unknown: j * m + unknown,
                    })?;
            // Subtract X_{c..} L_cᵀ from the blocks (j+c.., j+c) of the trailing window.
            for (c, target) in tail.chunks_exact_mut(len).take(below).enumerate() {
                kernels.update(target, height, m, c * m, (below - c) * m, panel);
            }
        }
        Ok(Factor {
            matrix: self,
            negative_pivots,
        })
    }
}

impl Factor {
    /// Returns the memory of the factor for another matrix; its entries are meaningless.
    pub fn into_memory(self) -> BlockBanded {
        self.matrix
    }

    /// Returns the number of negative eigenvalues of the factored matrix.
    pub fn negative_pivots(&self) -> usize {
        self.negative_pivots
    }

    /// Replaces every pivot by its size. The result is positive definite, and unchanged if the factored
    /// matrix was.
    pub fn make_positive(&mut self) {
        let a = &mut self.matrix;
        let (m, height, len) = (a.size, a.height(), a.panel_len());
        for panel in a.panels.chunks_exact_mut(len) {
            for c in 0..m {
                let pivot = &mut panel[c * height + c];
                *pivot = pivot.abs();
            }
        }
    }

    /// Solves A x = b in place for two right-hand sides at once, so that the factor is read once.
    pub fn solve_pair(&self, b: [&mut [f64]; 2]) {
        with_vectors!(simd => self.solve_pair_in(b));
    }

    #[inline(always)]
    fn solve_pair_in(&self, [b0, b1]: [&mut [f64]; 2]) {
        let a = &self.matrix;
        let (m, height, len) = (a.size, a.height(), a.panel_len());
        for (j, panel) in a.panels.chunks_exact(len).enumerate() {
            let below = (a.blocks - j).min(a.band + 1) * m;
            let (b0, b1) = (&mut b0[j * m..][..below], &mut b1[j * m..][..below]);
            for c in 0..m {
                let (x0, x1) = (b0[c], b1[c]);
                let column = &panel[c * height..][c + 1..below];
                for ((y0, y1), l) in b0[c + 1..].iter_mut().zip(&mut b1[c + 1..]).zip(column) {
                    *y0 -= l * x0;
                    *y1 -= l * x1;
                }
            }
        }
        for (j, panel) in a.panels.chunks_exact(len).enumerate().rev() {
            let below = (a.blocks - j).min(a.band + 1) * m;
            let (b0, b1) = (&mut b0[j * m..][..below], &mut b1[j * m..][..below]);
            for c in (0..m).rev() {
                let column = &panel[c * height..][c + 1..below];
                let [sum0, sum1] = dot_pair(column, &b0[c + 1..], &b1[c + 1..]);
                let pivot = panel[c * height + c];
                b0[c] = b0[c] / pivot - sum0;
                b1[c] = b1[c] / pivot - sum1;
            }
        }
    }

    /// Solves A x = b in place.
    pub fn solve(&self, b: &mut [f64]) {
        let a = &self.matrix;
        let (m, height, len) = (a.size, a.height(), a.panel_len());
        for (j, panel) in a.panels.chunks_exact(len).enumerate() {
            let below = (a.blocks - j).min(a.band + 1) * m;
            for c in 0..m {
                let x = b[j * m + c];
                let column = &panel[c * height..][c + 1..below];
                for (y, l) in b[j * m + c + 1..].iter_mut().zip(column) {
                    *y -= l * x;
                }
            }
        }
        for (j, panel) in a.panels.chunks_exact(len).enumerate().rev() {
            let below = (a.blocks - j).min(a.band + 1) * m;
            for c in (0..m).rev() {
                let column = &panel[c * height..][c + 1..below];
                let sum: f64 = column
                    .iter()
                    .zip(&b[j * m + c + 1..])
                    .map(|(l, x)| l * x)
                    .sum();
                b[j * m + c] = b[j * m + c] / panel[c * height + c] - sum;
            }
        }
    }
}

/// Returns l · x and l · y, in eight partial sums each that are added in order.
#[inline(always)]
fn dot_pair(l: &[f64], x: &[f64], y: &[f64]) -> [f64; 2] {
    const LANES: usize = 8;
    let mut sums = [[0.0; LANES]; 2];
    let (l8, x8, y8) = (
        l.chunks_exact(LANES),
        x.chunks_exact(LANES),
        y.chunks_exact(LANES),
    );
    let tail = l8
        .remainder()
        .iter()
        .zip(x8.remainder())
        .zip(y8.remainder());
    let mut rest = [0.0; 2];
    for ((l, x), y) in tail {
        rest[0] += l * x;
        rest[1] += l * y;
    }
    for ((l, x), y) in l8.zip(x8).zip(y8) {
        for i in 0..LANES {
            sums[0][i] += l[i] * x[i];
            sums[1][i] += l[i] * y[i];
        }
    }
    [0, 1].map(|k| sums[k].iter().sum::<f64>() + rest[k])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Makes a matrix with pseudo-random entries and adds `shift` to its diagonal.
    fn matrix(blocks: usize, size: usize, band: usize, shift: f64) -> BlockBanded {
        let mut a = BlockBanded::zeros(blocks, size, band);
        let mut state = 1_u64;
        let mut next = || {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (state >> 33) as f64 / (1_u64 << 31) as f64 - 0.5
        };
        let places: Vec<usize> = (0..size)
            .flat_map(|c| (0..size).map(move |r| (r, c)))
            .map(|(r, c)| c * size + r)
            .collect();
        for j in 0..blocks {
            for d in 0..=band {
                for &at in &places {
                    let (c, r) = (at / size, at % size);
                    let place = j * a.panel_len() + a.place(d, r, c);
                    let value = next() + if d == 0 && r == c { shift } else { 0.0 };
                    if j + d < blocks && (d > 0 || r >= c) {
                        a.panels[place] = value;
                    }
                }
            }
        }
        a
    }

    #[test]
    fn solving_inverts_multiplication() {
        for (blocks, size, band) in [(7, 5, 3), (2, 3, 3), (1, 4, 2), (9, 24, 1), (6, 2, 5)] {
            for shift in [20.0, 0.3] {
                let a = matrix(blocks, size, band, shift);
                let x: Vec<f64> = (0..a.unknowns()).map(|i| (i as f64 * 0.7).sin()).collect();
                let mut b = vec![0.0; x.len()];
                a.multiply_add(1.0, &x, &mut b);
                a.factor().unwrap().solve(&mut b);
                let error = b
                    .iter()
                    .zip(&x)
                    .map(|(b, x)| (b - x).abs())
                    .fold(0.0, f64::max);
                assert!(
                    error < 1e-8,
                    "{blocks} × {size}, band {band}, shift {shift}: {error}"
                );
            }
        }
    }

    #[test]
    fn negative_pivots_count_negative_eigenvalues() {
        let a = matrix(6, 4, 2, 0.3);
        let dense = faer::Mat::from_fn(24, 24, |i, j| a.entry(i, j));
        let eigenvalues = dense.self_adjoint_eigenvalues(faer::Side::Lower).unwrap();
        let negative = eigenvalues.iter().filter(|&&l| l < 0.0).count();
        assert!(negative > 3);
        assert_eq!(a.factor().unwrap().negative_pivots(), negative);
    }

    #[test]
    fn prescribed_unknowns_keep_their_values() {
        let mut a = matrix(5, 3, 2, 20.0);
        let prescribed: Vec<bool> = (0..15).map(|i| i % 4 == 0).collect();
        a.constrain(&prescribed);
        let mut b: Vec<f64> = (0..15).map(f64::from).collect();
        a.factor().unwrap().solve(&mut b);
        for i in (0..15).step_by(4) {
            assert_eq!(b[i], i as f64);
        }
    }

    #[test]
    fn two_right_hand_sides_are_solved_like_single_ones() {
        for (blocks, size, band) in [(7, 5, 3), (9, 24, 3), (1, 4, 2)] {
            let a = matrix(blocks, size, band, 20.0);
            let x = |phase: f64| -> Vec<f64> {
                (0..a.unknowns())
                    .map(|i| (i as f64 * 0.7 + phase).sin())
                    .collect()
            };
            let (mut x0, mut x1) = (x(0.0), x(1.0));
            let (mut y0, mut y1) = (x0.clone(), x1.clone());
            let factor = a.factor().unwrap();
            factor.solve(&mut y0);
            factor.solve(&mut y1);
            factor.solve_pair([&mut x0, &mut x1]);
            for (x, y) in x0.iter().chain(&x1).zip(y0.iter().chain(&y1)) {
                assert!((x - y).abs() < 1e-14, "{x} {y}");
            }
        }
    }

    #[test]
    fn positive_pivots_make_a_positive_definite_matrix() {
        let x =
            |phase: f64| -> Vec<f64> { (0..24).map(|i| (i as f64 * 0.7 + phase).sin()).collect() };
        let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
        let (mut indefinite, mut positive) = (0, matrix(6, 4, 2, 0.3).factor().unwrap());
        let factor = positive.clone();
        positive.make_positive();
        for b in (0..40).map(|k| x(0.3 * f64::from(k * k))) {
            let (mut before, mut after) = (b.clone(), b.clone());
            factor.solve(&mut before);
            positive.solve(&mut after);
            indefinite += usize::from(dot(&b, &before) < 0.0);
            assert!(dot(&b, &after) > 0.0);
        }
        assert!(indefinite > 0);
    }

    #[test]
    fn a_zero_pivot_is_an_error() {
        let a = BlockBanded::zeros(3, 2, 1);
        assert_eq!(a.factor().unwrap_err(), Singular { unknown: 0 });
    }
}
