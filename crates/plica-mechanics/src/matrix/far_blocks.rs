//! The blocks of a symmetric block matrix that lie outside its band.

use std::collections::BTreeMap;

/// The blocks (i, j), i > j + p, of a symmetric matrix of m × m blocks whose band of p blocks on either
/// side of the diagonal is a [`BlockBanded`](super::BlockBanded) matrix. Walls that touch couple distant
/// rows of control points. Only blocks to which something was added are stored.
#[derive(Clone, Debug)]
pub struct FarBlocks {
    size: usize,
    band: usize,
    /// Blocks (row, column) of the lower half, each column-major.
    blocks: BTreeMap<(usize, usize), Vec<f64>>,
}

impl FarBlocks {
    /// Makes a matrix without entries, of blocks of `size` × `size` outside a band of half-width `band`.
    pub fn new(size: usize, band: usize) -> Self {
        Self {
            size,
            band,
            blocks: BTreeMap::new(),
        }
    }

    /// Returns true if no block is stored.
    pub fn is_empty(&self) -> bool {
        self.blocks.is_empty()
    }

    /// Returns the number of unknowns of a block.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Returns the half-width, in blocks, of the band that these blocks lie outside.
    pub fn band(&self) -> usize {
        self.band
    }

    /// Returns true if two blocks along the diagonal are too far apart for the band.
    pub fn is_far(&self, i: usize, j: usize) -> bool {
        i.abs_diff(j) > self.band
    }

    /// Returns the stored blocks with their numbers (row, column), row > column, ordered by these. Row r
    /// and column c of a block are at c · `size` + r.
    pub fn blocks(&self) -> impl Iterator<Item = ((usize, usize), &[f64])> {
        self.blocks.iter().map(|(&at, block)| (at, &block[..]))
    }

    /// Returns the block in block row `row` and block column `column` < `row`, which is stored from now on.
    pub fn block_mut(&mut self, row: usize, column: usize) -> &mut [f64] {
        assert!(row > column && self.is_far(row, column));
        self.blocks
            .entry((row, column))
            .or_insert_with(|| vec![0.0; self.size * self.size])
    }

    /// Adds to the entry in row `row` and column `column` of the whole matrix and, as the matrix is
    /// symmetric, to the entry in row `column` and column `row`.
    pub fn add_at(&mut self, row: usize, column: usize, value: f64) {
        let (row, column) = (row.max(column), row.min(column));
        let m = self.size;
        self.block_mut(row / m, column / m)[column % m * m + row % m] += value;
    }

    /// Adds `factor` times another matrix with blocks of the same size.
    pub fn add_scaled(&mut self, factor: f64, other: &Self) {
        assert_eq!(self.size, other.size);
        for ((row, column), block) in other.blocks() {
            for (a, b) in self.block_mut(row, column).iter_mut().zip(block) {
                *a += factor * b;
            }
        }
    }

    /// Adds `factor` · A x to `y`.
    pub fn multiply_add(&self, factor: f64, x: &[f64], y: &mut [f64]) {
        let m = self.size;
        for ((row, column), block) in self.blocks() {
            for (c, entries) in block.chunks_exact(m).enumerate() {
                let xc = factor * x[column * m + c];
                let mut sum = 0.0;
                for (r, a) in entries.iter().enumerate() {
                    y[row * m + r] += a * xc;
                    sum += a * x[row * m + r];
                }
                y[column * m + c] += factor * sum;
            }
        }
    }

    /// Sets the rows and columns of prescribed unknowns to zero. Their unit diagonal is in the band, see
    /// [`BlockBanded::constrain`](super::BlockBanded::constrain).
    pub fn constrain(&mut self, prescribed: &[bool]) {
        let m = self.size;
        for (&(row, column), block) in &mut self.blocks {
            for (c, entries) in block.chunks_exact_mut(m).enumerate() {
                for (r, a) in entries.iter_mut().enumerate() {
                    if prescribed[row * m + r] || prescribed[column * m + c] {
                        *a = 0.0;
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns column `j` of a matrix of `unknowns` unknowns.
    fn column(a: &FarBlocks, unknowns: usize, j: usize) -> Vec<f64> {
        let (mut x, mut y) = (vec![0.0; unknowns], vec![0.0; unknowns]);
        x[j] = 1.0;
        a.multiply_add(1.0, &x, &mut y);
        y
    }

    fn example() -> FarBlocks {
        let mut a = FarBlocks::new(3, 1);
        a.add_at(13, 2, 5.0);
        a.add_at(1, 14, -2.0);
        a.add_at(2, 13, 0.5);
        a.add_at(7, 0, 1.5);
        a
    }

    #[test]
    fn an_entry_is_stored_once_and_multiplies_both_halves() {
        let a = example();
        let numbers: Vec<_> = a.blocks().map(|(at, _)| at).collect();
        assert_eq!(numbers, [(2, 0), (4, 0)]);
        let entries = [(13, 2, 5.5), (14, 1, -2.0), (7, 0, 1.5)];
        for j in 0..15 {
            for (i, &y) in column(&a, 15, j).iter().enumerate() {
                let entry = entries
                    .iter()
                    .find(|e| (e.0, e.1) == (i.max(j), i.min(j)))
                    .map_or(0.0, |e| e.2);
                assert_eq!(y, entry, "{i} {j}");
            }
        }
    }

    #[test]
    fn sums_contain_the_blocks_of_both_terms() {
        let mut a = example();
        let mut b = FarBlocks::new(3, 1);
        assert!(b.is_empty());
        b.add_at(14, 4, 3.0);
        b.add_at(13, 2, 1.0);
        a.add_scaled(2.0, &b);
        assert_eq!(column(&a, 15, 4)[14], 6.0);
        assert_eq!(column(&a, 15, 2)[13], 7.5);
        assert_eq!(a.blocks().count(), 3);
    }

    #[test]
    fn prescribed_unknowns_have_no_far_couplings() {
        let mut a = example();
        let prescribed: Vec<bool> = (0..15).map(|i| i == 2 || i == 14).collect();
        a.constrain(&prescribed);
        assert!(column(&a, 15, 2).iter().all(|&y| y == 0.0));
        assert!(column(&a, 15, 14).iter().all(|&y| y == 0.0));
        assert_eq!(column(&a, 15, 0)[7], 1.5);
    }

    #[test]
    #[should_panic(expected = "is_far")]
    fn entries_inside_the_band_are_refused() {
        FarBlocks::new(3, 1).add_at(5, 0, 1.0);
    }
}
