//! Dense matrices with many rows and few columns, and their small products.

use super::dense;

/// A dense matrix with many rows and few columns, stored by columns.
#[derive(Clone, Debug, PartialEq)]
pub struct TallMatrix {
    rows: usize,
    numbers: Vec<f64>,
}

impl TallMatrix {
    /// Makes a matrix with `rows` > 0 rows and no columns yet.
    pub fn new(rows: usize) -> Self {
        assert!(rows > 0);
        Self {
            rows,
            numbers: vec![],
        }
    }

    /// Makes a matrix from its entries (row, column).
    pub fn from_fn(rows: usize, columns: usize, entry: impl Fn(usize, usize) -> f64) -> Self {
        let mut matrix = Self::new(rows);
        for j in 0..columns {
            matrix.numbers.extend((0..rows).map(|i| entry(i, j)));
        }
        matrix
    }

    /// Returns the number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Returns the number of columns.
    pub fn columns(&self) -> usize {
        self.numbers.len() / self.rows
    }

    /// Returns column j.
    pub fn column(&self, j: usize) -> &[f64] {
        &self.numbers[j * self.rows..(j + 1) * self.rows]
    }

    /// Returns column j, mutably.
    pub fn column_mut(&mut self, j: usize) -> &mut [f64] {
        &mut self.numbers[j * self.rows..(j + 1) * self.rows]
    }

    /// Returns the entry in row i and column j.
    pub fn entry(&self, i: usize, j: usize) -> f64 {
        self.numbers[j * self.rows + i]
    }

    /// Appends a column.
    pub fn push(&mut self, column: &[f64]) {
        assert_eq!(column.len(), self.rows);
        self.numbers.extend_from_slice(column);
    }

    /// Returns the matrix of some of the columns.
    pub fn select(&self, which: &[usize]) -> Self {
        let mut selected = Self::new(self.rows);
        for &j in which {
            selected.push(self.column(j));
        }
        selected
    }

    /// Appends the columns of another matrix.
    pub fn append(&mut self, other: &Self) {
        assert_eq!(self.rows, other.rows);
        self.numbers.extend_from_slice(&other.numbers);
    }

    /// Returns Aᵀ B; A must have a column.
    pub fn gram(&self, other: &Self) -> Self {
        assert_eq!(self.rows, other.rows);
        let (m, n) = (self.columns(), other.columns());
        assert!(m > 0);
        let mut numbers = vec![0.0; m * n];
        dense::transposed_times(&mut numbers, &self.numbers, &other.numbers, self.rows);
        Self { rows: m, numbers }
    }

    /// Returns A B.
    pub fn times(&self, other: &Self) -> Self {
        assert_eq!(self.columns(), other.rows);
        let mut product = Self {
            rows: self.rows,
            numbers: vec![0.0; self.rows * other.columns()],
        };
        self.add_product(1.0, other, &mut product);
        product
    }

    /// Adds `factor` · A B to `sum`.
    pub fn add_product(&self, factor: f64, other: &Self, sum: &mut Self) {
        assert_eq!(self.columns(), other.rows);
        assert_eq!((self.rows, other.columns()), (sum.rows, sum.columns()));
        dense::add_times(
            &mut sum.numbers,
            factor,
            &self.numbers,
            &other.numbers,
            self.rows,
        );
    }

    /// Returns the eigenvalues, the lowest first, and orthonormal eigenvectors of a symmetric matrix, of
    /// which the lower half is read. None if an entry is not finite.
    pub fn eigen(&self) -> Option<(Vec<f64>, Self)> {
        let n = self.rows;
        assert_eq!(self.columns(), n);
        if !self.numbers.iter().all(|x| x.is_finite()) {
            return None;
        }
        let mut vectors = Self {
            rows: n,
            numbers: vec![0.0; n * n],
        };
        let values = dense::eigen(&self.numbers, &mut vectors.numbers, n)?;
        Some((values, vectors))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eigenvectors_are_orthonormal_and_diagonalise_the_matrix() {
        for n in [1, 2, 5, 12] {
            let a = TallMatrix::from_fn(n, n, |i, j| 1.0 / (1 + i + j) as f64 - f64::from(i == j));
            let (values, vectors) = a.eigen().unwrap();
            assert!(values.windows(2).all(|pair| pair[0] <= pair[1]));
            let orthonormal = vectors.gram(&vectors);
            let image = vectors.gram(&a.times(&vectors));
            for i in 0..n {
                for j in 0..n {
                    let (one, value) = if i == j { (1.0, values[i]) } else { (0.0, 0.0) };
                    assert!((orthonormal.entry(i, j) - one).abs() < 1e-14);
                    assert!((image.entry(i, j) - value).abs() < 1e-14);
                }
            }
        }
        assert!(TallMatrix::from_fn(2, 2, |_, _| f64::NAN).eigen().is_none());
    }

    #[test]
    fn products_equal_sums_over_entries() {
        let a = TallMatrix::from_fn(7, 3, |i, j| (i + 10 * j) as f64);
        let b = TallMatrix::from_fn(7, 2, |i, j| (i * i) as f64 - j as f64);
        let gram = a.gram(&b);
        for i in 0..3 {
            for j in 0..2 {
                let sum: f64 = (0..7).map(|k| a.entry(k, i) * b.entry(k, j)).sum();
                assert_eq!(gram.entry(i, j), sum);
            }
        }
        let product = a.times(&gram);
        for i in 0..7 {
            for j in 0..2 {
                let sum: f64 = (0..3).map(|k| a.entry(i, k) * gram.entry(k, j)).sum();
                assert_eq!(product.entry(i, j), sum);
            }
        }
    }
}
