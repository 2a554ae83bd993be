//! The factorisation of a symmetric block-banded matrix with couplings outside its band.
//!
//! Block rows and columns are eliminated in an order of small fill, see [`super::elimination`]. Panel k of
//! the factor holds the diagonal block of step k and, under it, the blocks of L in the rows below,
//! column-major. As for [`BlockBanded`], A = L D Lᵀ without pivoting within the order, panel by panel
//! with the dense kernels of [`super::dense`]: the update by a panel is one product for each block column
//! and each run of rows that are neighbours in the panel updated. The signs of D are those of the
//! eigenvalues of A.
//!
//! Cost of a panel with s blocks under the diagonal: m³ (1/3 + s + s (s+1)) flops and (s+1) m² numbers.
//! Inside the band s = p, in the flanks of a fold in contact about twice that.

use super::dense;
use super::elimination::Elimination;
use super::{BlockBanded, FarBlocks, Singular};
use fearless_simd::{Level, dispatch};

/// The factorisation L D Lᵀ of the sum of a [`BlockBanded`] matrix and [`FarBlocks`].
#[derive(Clone, Debug)]
pub struct SparseFactor {
    size: usize,
    elimination: Elimination,
    /// For each step, the begin of its panel; at last the end of all.
    begins: Vec<usize>,
    panels: Vec<f64>,
    negative_pivots: usize,
}

impl SparseFactor {
    /// Factors the sum of a band and blocks outside it.
    ///
    /// # Errors
    ///
    /// If a pivot is zero or NaN.
    pub fn of(band: &BlockBanded, far: &FarBlocks) -> Result<Self, Singular> {
        assert_eq!((band.size(), band.band()), (far.size(), far.band()));
        let couplings = far.blocks().map(|(at, _)| at);
        let elimination = Elimination::of(band.blocks(), band.band(), couplings);
        let m = band.size();
        let mut begins = vec![0];
        for below in &elimination.below {
            begins.push(begins[begins.len() - 1] + (below.len() + 1) * m * m);
        }
        let mut factor = Self {
            size: m,
            panels: vec![0.0; begins[begins.len() - 1]],
            begins,
            elimination,
            negative_pivots: 0,
        };
        factor.copy(band, far);
        factor.eliminate()?;
        Ok(factor)
    }

    /// Copies the blocks of a matrix into the panels.
    fn copy(&mut self, band: &BlockBanded, far: &FarBlocks) {
        let m = self.size;
        let step = self.elimination.steps();
        for j in 0..band.blocks() {
            for d in 0..=band.band().min(band.blocks() - 1 - j) {
                let column = |c| band.column_of_block(j, d, c);
                self.copy_block(step[j + d], step[j], column);
            }
        }
        for ((i, j), block) in far.blocks() {
            self.copy_block(step[i], step[j], |c| &block[c * m..][..m]);
        }
    }

    /// Copies the block in the row of step `i` and the column of step `j`, given by its columns.
    fn copy_block<'a>(&mut self, i: usize, j: usize, column: impl Fn(usize) -> &'a [f64]) {
        let m = self.size;
        let (i, j, transposed) = if i < j { (j, i, true) } else { (i, j, false) };
        let place = match i == j {
            true => 0,
            false => {
                let at = self.elimination.below[j].binary_search(&i);
                (1 + at.expect("the factor has every block of the matrix")) * m
            }
        };
        let height = self.height(j);
        let panel = &mut self.panels[self.begins[j]..self.begins[j + 1]];
        for c in 0..m {
            if transposed {
                for (r, &a) in column(c).iter().enumerate() {
                    panel[r * height + place + c] = a;
                }
            } else {
                panel[c * height + place..][..m].copy_from_slice(column(c));
            }
        }
    }

    /// Returns the rows of the panel of step `k`, which are its leading dimension.
    fn height(&self, k: usize) -> usize {
        (self.elimination.below[k].len() + 1) * self.size
    }

    /// Replaces the matrix in the panels by its factor.
    fn eliminate(&mut self) -> Result<(), Singular> {
        let m = self.size;
        let Elimination { order, below } = &self.elimination;
        let tallest = below.iter().map(Vec::len).max().unwrap_or(0);
        let mut kernels = dense::Kernels::new(m, tallest * m);
        for (k, rows) in below.iter().enumerate() {
            let height = (rows.len() + 1) * m;
            let (head, tail) = self.panels.split_at_mut(self.begins[k + 1]);
            let panel = &mut head[self.begins[k]..];
            self.negative_pivots += kernels
                .factor_panel(panel, height, m, rows.len() * m)
                .map_err(|unknown| Singular {
                    unknown: order[k] * m + unknown,
                })?;
            // Subtract X_{c..} L_cᵀ from the panel of the step below[c].
            for (c, &step) in rows.iter().enumerate() {
                let target = &mut tail[self.begins[step] - self.begins[k + 1]..];
                let target_height = (below[step].len() + 1) * m;
                for_each_run(&rows[c..], step, &below[step], |from, len, at| {
                    kernels.update_rows(
                        (&mut target[at * m..], target_height),
                        m,
                        (c + from) * m..(c + from + len) * m,
                        (panel, height),
                        c * m,
                    );
                });
            }
        }
        Ok(())
    }

    /// Returns the number of negative eigenvalues of the factored matrix.
    pub fn negative_pivots(&self) -> usize {
        self.negative_pivots
    }

    /// Replaces every pivot by its size. The result is positive definite, and unchanged if the factored
    /// matrix was.
    pub fn make_positive(&mut self) {
        for k in 0..self.elimination.order.len() {
            let height = self.height(k);
            for c in 0..self.size {
                let pivot = &mut self.panels[self.begins[k] + c * height + c];
                *pivot = pivot.abs();
            }
        }
    }

    /// Solves A x = b in place.
    pub fn solve(&self, b: &mut [f64]) {
        dispatch!(Level::new(), _simd => self.solve_in([b]));
    }

    /// Solves A x = b in place for two right-hand sides at once, so that the factor is read once.
    pub fn solve_pair(&self, b: [&mut [f64]; 2]) {
        dispatch!(Level::new(), _simd => self.solve_in(b));
    }

    #[inline(always)]
    fn solve_in<const N: usize>(&self, mut b: [&mut [f64]; N]) {
        let m = self.size;
        let steps = self.elimination.order.len();
        let tallest = (0..steps).map(|k| self.height(k)).max().unwrap_or(0);
        // The unknowns of a panel, one after the other.
        let mut gathered = [(); N].map(|()| vec![0.0; tallest]);
        for k in 0..steps {
            let height = self.height(k);
            let panel = &self.panels[self.begins[k]..];
            for (b, x) in b.iter_mut().zip(&mut gathered) {
                let x = &mut x[..height];
                self.gather(k, b, x);
                for c in 0..m {
                    let (above, under) = x.split_at_mut(c + 1);
                    let column = &panel[c * height..][c + 1..height];
                    for (y, l) in under.iter_mut().zip(column) {
                        *y -= l * above[c];
                    }
                }
                self.scatter(k, x, b);
            }
        }
        for k in (0..steps).rev() {
            let height = self.height(k);
            let panel = &self.panels[self.begins[k]..];
            for (b, x) in b.iter_mut().zip(&mut gathered) {
                let x = &mut x[..height];
                self.gather(k, b, x);
                for c in (0..m).rev() {
                    let column = &panel[c * height..][c..height];
                    x[c] = x[c] / column[0] - dot(&column[1..], &x[c + 1..]);
                }
                let row = self.elimination.order[k];
                b[row * m..][..m].copy_from_slice(&x[..m]);
            }
        }
    }

    /// Returns the block rows of the matrix that the panel of step `k` has, from top to bottom.
    fn rows(&self, k: usize) -> impl Iterator<Item = usize> {
        let Elimination { order, below } = &self.elimination;
        std::iter::once(order[k]).chain(below[k].iter().map(|&step| order[step]))
    }

    /// Copies the unknowns of the panel of step `k` from a vector of all.
    fn gather(&self, k: usize, b: &[f64], x: &mut [f64]) {
        let m = self.size;
        for (row, x) in self.rows(k).zip(x.chunks_exact_mut(m)) {
            x.copy_from_slice(&b[row * m..][..m]);
        }
    }

    /// Copies the unknowns of the panel of step `k` back.
    fn scatter(&self, k: usize, x: &[f64], b: &mut [f64]) {
        let m = self.size;
        for (row, x) in self.rows(k).zip(x.chunks_exact(m)) {
            b[row * m..][..m].copy_from_slice(x);
        }
    }
}

/// Calls `run(from, len, at)` for each run of rows `rows[from..from + len]` that lie one under the other
/// in the panel of step `step`, from its block `at` on. The first row is `step`; `below` has all others.
fn for_each_run(
    rows: &[usize],
    step: usize,
    below: &[usize],
    mut run: impl FnMut(usize, usize, usize),
) {
    debug_assert_eq!(rows[0], step);
    let (mut from, mut begin, mut at) = (0, 0, 0);
    for (i, &row) in rows.iter().enumerate().skip(1) {
        let last = at;
        while below[at] != row {
            at += 1;
        }
        at += 1;
        if at != last + 1 {
            run(from, i - from, begin);
            (from, begin) = (i, at);
        }
    }
    run(from, rows.len() - from, begin);
}

/// Returns x · y, in eight partial sums that are added in order.
#[inline(always)]
fn dot(x: &[f64], y: &[f64]) -> f64 {
    const LANES: usize = 8;
    let (x8, y8) = (x.chunks_exact(LANES), y.chunks_exact(LANES));
    let tail = x8.remainder().iter().zip(y8.remainder());
    let rest: f64 = tail.map(|(x, y)| x * y).sum();
    let mut sums = [0.0; LANES];
    for (x, y) in x8.zip(y8) {
        for i in 0..LANES {
            sums[i] += x[i] * y[i];
        }
    }
    sums.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns pseudo-random numbers between -1/2 and 1/2.
    fn random() -> impl FnMut() -> f64 {
        let mut state = 1_u64;
        move || {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (state >> 33) as f64 / (1_u64 << 31) as f64 - 0.5
        }
    }

    /// Makes a band of random entries with `shift` added to the diagonal, and random far blocks in the
    /// places `couplings`.
    fn matrix(
        [blocks, size, band]: [usize; 3],
        shift: f64,
        couplings: &[(usize, usize)],
    ) -> (BlockBanded, FarBlocks) {
        let mut next = random();
        let mut near = BlockBanded::zeros(blocks, size, band);
        let mut far = FarBlocks::new(size, band);
        for j in 0..blocks {
            for d in 0..=band.min(blocks - 1 - j) {
                for c in 0..size {
                    for r in if d == 0 { c } else { 0 }..size {
                        let diagonal = d == 0 && r == c;
                        near.add_at(j, d, r, c, next() + if diagonal { shift } else { 0.0 });
                    }
                }
            }
        }
        for &(i, j) in couplings {
            for entry in far.block_mut(i.max(j), i.min(j)) {
                *entry += next();
            }
        }
        (near, far)
    }

    /// Returns the couplings of row i with the mirror image of rows around it, for `contact` rows on
    /// either side of the middle.
    fn fold(blocks: usize, contact: usize, band: usize) -> Vec<(usize, usize)> {
        let flank = blocks / 2 - contact..blocks / 2;
        flank
            .flat_map(|i| (i.saturating_sub(1)..=i + 1).map(move |j| (blocks - 1 - j, i)))
            .filter(|(i, j)| i.saturating_sub(*j) > band)
            .collect()
    }

    /// Shapes, far couplings and shifts of the diagonal, which make definite and indefinite matrices.
    fn examples() -> Vec<(BlockBanded, FarBlocks)> {
        let shapes = [
            ([9, 5, 3], vec![(8, 0), (7, 1), (5, 0)]),
            ([7, 4, 1], vec![(6, 0), (6, 1), (6, 2), (6, 3)]),
            ([2, 3, 3], vec![]),
            ([1, 4, 2], vec![]),
            ([5, 3, 0], vec![(4, 0), (3, 1), (2, 0)]),
            ([100, 6, 3], fold(100, 40, 3)),
            ([30, 8, 2], fold(30, 10, 2)),
        ];
        let shapes = shapes.iter();
        shapes
            .flat_map(|(shape, far)| [20.0, 0.3].map(|shift| matrix(*shape, shift, far)))
            .collect()
    }

    fn times((near, far): &(BlockBanded, FarBlocks), x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; x.len()];
        near.multiply_add(1.0, x, &mut y);
        far.multiply_add(1.0, x, &mut y);
        y
    }

    fn wave(unknowns: usize, phase: f64) -> Vec<f64> {
        (0..unknowns)
            .map(|i| (i as f64 * 0.7 + phase).sin())
            .collect()
    }

    fn norm(x: &[f64]) -> f64 {
        x.iter().map(|x| x * x).sum::<f64>().sqrt()
    }

    fn difference(x: &[f64], y: &[f64]) -> f64 {
        norm(&x.iter().zip(y).map(|(x, y)| x - y).collect::<Vec<_>>())
    }

    #[test]
    fn the_solution_satisfies_the_equations() {
        for (number, a) in examples().iter().enumerate() {
            let b = wave(a.0.unknowns(), 0.0);
            let mut x = b.clone();
            let factor = SparseFactor::of(&a.0, &a.1).unwrap();
            factor.solve(&mut x);
            let residual = difference(&times(a, &x), &b) / norm(&b);
            // Without pivoting an indefinite matrix loses digits to small pivots.
            let definite = factor.negative_pivots() == 0;
            let limit = if definite { 1e-13 } else { 1e-9 };
            assert!(residual < limit, "{number}: {residual}");
        }
    }

    #[test]
    fn negative_pivots_count_negative_eigenvalues() {
        let (mut definite, mut indefinite) = (0, 0);
        for a in examples().iter().filter(|a| a.0.unknowns() < 300) {
            let n = a.0.unknowns();
            let mut dense = vec![0.0; n * n];
            for (j, column) in dense.chunks_exact_mut(n).enumerate() {
                let mut unit = vec![0.0; n];
                unit[j] = 1.0;
                column.copy_from_slice(&times(a, &unit));
            }
            let values = dense::eigen(&dense, &mut vec![0.0; n * n], n).unwrap();
            let negative = values.iter().filter(|&&l| l < 0.0).count();
            let factor = SparseFactor::of(&a.0, &a.1).unwrap();
            assert_eq!(factor.negative_pivots(), negative);
            *if negative == 0 {
                &mut definite
            } else {
                &mut indefinite
            } += 1;
        }
        assert!(definite > 3 && indefinite > 3);
    }

    #[test]
    fn without_far_blocks_the_factor_is_the_banded_one() {
        for shift in [20.0, 0.3] {
            let (near, far) = matrix([20, 8, 3], shift, &[]);
            let mut x = wave(160, 0.0);
            let mut y = x.clone();
            let sparse = SparseFactor::of(&near, &far).unwrap();
            let banded = near.factor().unwrap();
            assert_eq!(sparse.negative_pivots(), banded.negative_pivots());
            sparse.solve(&mut x);
            banded.solve(&mut y);
            assert!(difference(&x, &y) < 1e-9 * norm(&y));
        }
    }

    #[test]
    fn two_right_hand_sides_are_solved_like_single_ones() {
        let (near, far) = matrix([30, 8, 2], 20.0, &fold(30, 10, 2));
        let factor = SparseFactor::of(&near, &far).unwrap();
        let (mut x0, mut x1) = (wave(240, 0.0), wave(240, 1.0));
        let (mut y0, mut y1) = (x0.clone(), x1.clone());
        factor.solve(&mut y0);
        factor.solve(&mut y1);
        factor.solve_pair([&mut x0, &mut x1]);
        assert_eq!([x0, x1], [y0, y1]);
    }

    #[test]
    fn prescribed_unknowns_keep_their_values() {
        let mut a = matrix([30, 4, 2], 20.0, &fold(30, 10, 2));
        let prescribed: Vec<bool> = (0..120).map(|i| i % 5 == 0 || i < 4).collect();
        a.0.constrain(&prescribed);
        a.1.constrain(&prescribed);
        let b = wave(120, 0.3);
        let mut x = b.clone();
        SparseFactor::of(&a.0, &a.1).unwrap().solve(&mut x);
        for i in (0..120).filter(|&i| prescribed[i]) {
            assert_eq!(x[i], b[i]);
        }
        assert!(difference(&times(&a, &x), &b) < 1e-13 * norm(&b));
    }

    #[test]
    fn positive_pivots_make_a_positive_definite_matrix() {
        let (near, far) = matrix([30, 4, 2], 0.3, &fold(30, 10, 2));
        let factor = SparseFactor::of(&near, &far).unwrap();
        let mut positive = factor.clone();
        positive.make_positive();
        let mut indefinite = 0;
        for k in 0..40 {
            let b = wave(120, 0.3 * f64::from(k * k));
            let energy = |factor: &SparseFactor| -> f64 {
                let mut x = b.clone();
                factor.solve(&mut x);
                b.iter().zip(&x).map(|(b, x)| b * x).sum()
            };
            indefinite += usize::from(energy(&factor) < 0.0);
            assert!(energy(&positive) > 0.0);
        }
        assert!(indefinite > 0);
    }

    #[test]
    fn a_zero_pivot_is_an_error_at_its_unknown() {
        let couplings = fold(30, 10, 2);
        // Rows of the fold are eliminated out of their order.
        for singular in [0, 50, 61, 119] {
            let (mut near, mut far) = matrix([30, 4, 2], 20.0, &couplings);
            let prescribed: Vec<bool> = (0..120).map(|i| i == singular).collect();
            near.constrain(&prescribed);
            far.constrain(&prescribed);
            near.add_at(singular / 4, 0, singular % 4, singular % 4, -1.0);
            let error = SparseFactor::of(&near, &far).unwrap_err();
            assert_eq!(error, Singular { unknown: singular });
        }
        let (near, mut far) = matrix([30, 4, 2], 20.0, &couplings);
        far.add_at(60, 40, f64::NAN);
        assert!(SparseFactor::of(&near, &far).is_err());
    }

    #[test]
    fn the_factor_is_the_same_to_the_bit_every_time() {
        let couplings = fold(100, 40, 3);
        let (near, far) = matrix([100, 6, 3], 0.3, &couplings);
        let mut reversed = couplings.clone();
        reversed.reverse();
        let mut other = FarBlocks::new(6, 3);
        for (i, j) in reversed {
            let (_, block) = far.blocks().find(|(at, _)| *at == (i, j)).unwrap();
            other.block_mut(i, j).copy_from_slice(block);
        }
        let bits = |far: &FarBlocks| -> Vec<u64> {
            let factor = SparseFactor::of(&near, far).unwrap();
            let mut x = wave(600, 0.0);
            factor.solve(&mut x);
            let numbers = factor.panels.iter().chain(&x);
            numbers.map(|x| x.to_bits()).collect()
        };
        assert_eq!(bits(&far), bits(&far));
        assert_eq!(bits(&far), bits(&other));
    }
}
