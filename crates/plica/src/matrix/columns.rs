//! Tall matrices of a few columns, and the small matrices that they leave.

use super::dense;

/// A matrix, column by column.
#[derive(Clone, Debug, PartialEq)]
pub struct Columns {
    rows: usize,
    numbers: Vec<f64>,
}

impl Columns {
    /// No columns yet, of `rows` numbers each; at least one.
    pub fn new(rows: usize) -> Self {
        assert!(rows > 0);
        Self {
            rows,
            numbers: vec![],
        }
    }

    /// A matrix of the given shape, entry by entry (row, column).
    pub fn from_fn(rows: usize, count: usize, entry: impl Fn(usize, usize) -> f64) -> Self {
        let mut columns = Self::new(rows);
        for j in 0..count {
            columns.numbers.extend((0..rows).map(|i| entry(i, j)));
        }
        columns
    }

    /// Numbers in a column.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of columns.
    pub fn count(&self) -> usize {
        self.numbers.len() / self.rows
    }

    /// Column j.
    pub fn column(&self, j: usize) -> &[f64] {
        &self.numbers[j * self.rows..(j + 1) * self.rows]
    }

    /// Column j.
    pub fn column_mut(&mut self, j: usize) -> &mut [f64] {
        &mut self.numbers[j * self.rows..(j + 1) * self.rows]
    }

    /// The entry in row i and column j.
    pub fn entry(&self, i: usize, j: usize) -> f64 {
        self.numbers[j * self.rows + i]
    }

    /// Adds a column.
    pub fn push(&mut self, column: &[f64]) {
        assert_eq!(column.len(), self.rows);
        self.numbers.extend_from_slice(column);
    }

    /// The columns of that number.
    pub fn chosen(&self, which: &[usize]) -> Self {
        let mut columns = Self::new(self.rows);
        for &j in which {
            columns.push(self.column(j));
        }
        columns
    }

    /// Adds the columns of another matrix.
    pub fn append(&mut self, other: &Self) {
        assert_eq!(self.rows, other.rows);
        self.numbers.extend_from_slice(&other.numbers);
    }

    /// Aᵀ B, every product of a column with a column; A has at least one.
    pub fn gram(&self, other: &Self) -> Self {
        assert_eq!(self.rows, other.rows);
        let (m, n) = (self.count(), other.count());
        assert!(m > 0);
        let mut numbers = vec![0.0; m * n];
        dense::transposed_times(&mut numbers, &self.numbers, &other.numbers, self.rows);
        Self { rows: m, numbers }
    }

    /// A B.
    pub fn times(&self, other: &Self) -> Self {
        assert_eq!(self.count(), other.rows);
        let mut product = Self {
            rows: self.rows,
            numbers: vec![0.0; self.rows * other.count()],
        };
        self.times_onto(1.0, other, &mut product);
        product
    }

    /// C += factor · A B.
    pub fn times_onto(&self, factor: f64, other: &Self, onto: &mut Self) {
        assert_eq!(self.count(), other.rows);
        assert_eq!((self.rows, other.count()), (onto.rows, onto.count()));
        dense::add_times(
            &mut onto.numbers,
            factor,
            &self.numbers,
            &other.numbers,
            self.rows,
        );
    }

    /// Eigenvalues, the lowest first, and orthonormal eigenvectors of a square matrix, symmetric
    /// with its lower half. None if its entries are no numbers.
    pub fn eigen(&self) -> Option<(Vec<f64>, Self)> {
        let n = self.rows;
        assert_eq!(self.count(), n);
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
    fn eigenvectors_are_orthonormal_and_put_the_matrix_together() {
        for n in [1, 2, 5, 12] {
            let a = Columns::from_fn(n, n, |i, j| 1.0 / (1 + i + j) as f64 - f64::from(i == j));
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
        assert!(Columns::from_fn(2, 2, |_, _| f64::NAN).eigen().is_none());
    }

    #[test]
    fn products_are_those_of_their_entries() {
        let a = Columns::from_fn(7, 3, |i, j| (i + 10 * j) as f64);
        let b = Columns::from_fn(7, 2, |i, j| (i * i) as f64 - j as f64);
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
