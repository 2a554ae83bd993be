//! Dense kernels of the other matrices, from the library faer, which no other file uses. All run on the
//! calling thread, so that sums have one order.

use faer::diag::DiagMut;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::ldlt::factor;
use faer::linalg::{evd, matmul, triangular_solve};
use faer::reborrow::{Reborrow, ReborrowMut};
use faer::{Accum, Mat, MatMut, MatRef, Par, Side};
use std::ops::Range;

/// Returns the eigenvalues, the lowest first, and eigenvectors of a small symmetric matrix; None if it is
/// not finite.
pub fn symmetric_eigen(
    size: usize,
    entry: impl Fn(usize, usize) -> f64,
) -> Option<(Vec<f64>, Vec<Vec<f64>>)> {
    let matrix = Mat::from_fn(size, size, entry);
    let eigen = matrix.self_adjoint_eigen(Side::Lower).ok()?;
    let (values, vectors) = (eigen.S(), eigen.U());
    let column = |j: usize| (0..size).map(|i| vectors[(i, j)]).collect();
    Some((
        (0..size).map(|i| values[i]).collect(),
        (0..size).map(column).collect(),
    ))
}

/// Kernels of the block-banded and block-sparse factorisations, with their buffers.
pub struct Kernels {
    /// X = L D below the diagonal block of the current panel, column-major.
    scaled: Vec<f64>,
    /// The rows of X.
    below: usize,
    memory: MemBuffer,
}

impl Kernels {
    /// Allocates for panels of `size` columns with at most `below` rows under the diagonal block.
    pub fn new(size: usize, below: usize) -> Self {
        let need = factor::cholesky_in_place_scratch::<f64>(size, Par::Seq, Default::default());
        Self {
            scaled: vec![0.0; size * below],
            below: 0,
            memory: MemBuffer::new(need),
        }
    }

    /// Factors the diagonal block of a panel (`size` columns, leading dimension `height`), replaces the
    /// `below` rows under it by L, and stores X = L D for [`Kernels::update`]. Returns the number of
    /// negative pivots, or as error the index of a pivot that is zero or NaN.
    pub fn factor_panel(
        &mut self,
        panel: &mut [f64],
        height: usize,
        size: usize,
        below: usize,
    ) -> Result<usize, usize> {
        let panel =
            MatMut::from_column_major_slice_with_stride_mut(panel, size + below, size, height);
        let (mut diagonal, mut under) = panel.split_at_row_mut(size);
        let stack = MemStack::new(&mut self.memory);
        factor::cholesky_in_place(
            diagonal.rb_mut(),
            Default::default(),
            Par::Seq,
            stack,
            Default::default(),
        )
        .map_err(|factor::LdltError::ZeroPivot { index }| index)?;
        let mut negative = 0;
        for i in 0..size {
            let pivot = diagonal[(i, i)];
            if !pivot.is_finite() {
                return Err(i);
            }
            negative += usize::from(pivot < 0.0);
        }
        triangular_solve::solve_unit_lower_triangular_in_place(
            diagonal.rb(),
            under.rb_mut().transpose_mut(),
            Par::Seq,
        );
        self.below = below;
        let mut scaled =
            MatMut::from_column_major_slice_mut(&mut self.scaled[..below * size], below, size);
        scaled.copy_from(under.rb());
        for i in 0..size {
            let inverse = 1.0 / diagonal[(i, i)];
            for x in under.rb_mut().col_mut(i).iter_mut() {
                *x *= inverse;
            }
        }
        Ok(negative)
    }

    /// Subtracts X L_cᵀ from the panel `target`: the product of the rows `from..from + rows` below the
    /// diagonal block of `panel` with the `size` rows that begin at `from`.
    pub fn update(
        &self,
        target: &mut [f64],
        height: usize,
        size: usize,
        from: usize,
        rows: usize,
        panel: &[f64],
    ) {
        self.update_rows(
            (target, height),
            size,
            from..from + rows,
            (panel, height),
            from,
        );
    }

    /// Subtracts X L_cᵀ from `target`: the product of the `rows` below the diagonal block of `panel`, the
    /// one factored last, with the `size` rows that begin at `from`. Slices come with their leading
    /// dimension.
    pub fn update_rows(
        &self,
        (target, target_height): (&mut [f64], usize),
        size: usize,
        rows: Range<usize>,
        (panel, height): (&[f64], usize),
        from: usize,
    ) {
        let below = self.below;
        let scaled = MatRef::from_column_major_slice(&self.scaled[..below * size], below, size);
        let lower = MatRef::from_column_major_slice_with_stride(panel, size + below, size, height);
        matmul::matmul(
            MatMut::from_column_major_slice_with_stride_mut(
                target,
                rows.len(),
                size,
                target_height,
            ),
            Accum::Add,
            scaled.subrows(rows.start, rows.len()),
            lower.subrows(size + from, size).transpose(),
            -1.0,
            Par::Seq,
        );
    }
}

/// A matrix in a slice: its entries, its numbers of rows and columns, and the strides from row to row
/// and from column to column, one of which is 1.
type Strided<'a> = (&'a [f64], [usize; 2], [usize; 2]);

/// Writes A B into C, which comes with its strides.
pub fn multiply(a: Strided<'_>, b: Strided<'_>, c: (&mut [f64], [usize; 2])) {
    let (rows, columns) = (a.1[0], b.1[1]);
    let (numbers, [down, right]) = c;
    let target = if right == 1 && down >= columns {
        MatMut::from_column_major_slice_with_stride_mut(numbers, columns, rows, down)
            .transpose_mut()
    } else {
        MatMut::from_column_major_slice_with_stride_mut(numbers, rows, columns, right)
    };
    matmul::matmul(target, Accum::Replace, view(a), view(b), 1.0, Par::Seq);
}

fn view((numbers, [rows, columns], [down, right]): Strided<'_>) -> MatRef<'_, f64> {
    if right == 1 && down >= columns {
        MatRef::from_column_major_slice_with_stride(numbers, columns, rows, down).transpose()
    } else {
        MatRef::from_column_major_slice_with_stride(numbers, rows, columns, right)
    }
}

/// Writes Aᵀ B into `out`, for column-major A and B of `rows` rows.
pub fn transposed_times(out: &mut [f64], a: &[f64], b: &[f64], rows: usize) {
    let (m, n) = (a.len() / rows, b.len() / rows);
    matmul::matmul(
        MatMut::from_column_major_slice_mut(out, m, n),
        Accum::Replace,
        MatRef::from_column_major_slice(a, rows, m).transpose(),
        MatRef::from_column_major_slice(b, rows, n),
        1.0,
        Par::Seq,
    );
}

/// Adds `factor` · A B to `out`, for column-major A of `rows` rows.
pub fn add_times(out: &mut [f64], factor: f64, a: &[f64], b: &[f64], rows: usize) {
    let (m, n) = (a.len() / rows, out.len() / rows);
    matmul::matmul(
        MatMut::from_column_major_slice_mut(out, rows, n),
        Accum::Add,
        MatRef::from_column_major_slice(a, rows, m),
        MatRef::from_column_major_slice(b, m, n),
        factor,
        Par::Seq,
    );
}

/// Returns the eigenvalues, the lowest first, of a symmetric n × n matrix of which the lower half is
/// read, and writes orthonormal eigenvectors into `vectors`. None if that does not converge.
pub fn eigen(matrix: &[f64], vectors: &mut [f64], n: usize) -> Option<Vec<f64>> {
    let mut values = vec![0.0; n];
    let need = evd::self_adjoint_evd_scratch::<f64>(
        n,
        evd::ComputeEigenvectors::Yes,
        Par::Seq,
        Default::default(),
    );
    evd::self_adjoint_evd(
        MatRef::from_column_major_slice(matrix, n, n),
        DiagMut::from_slice_mut(&mut values),
        Some(MatMut::from_column_major_slice_mut(vectors, n, n)),
        Par::Seq,
        MemStack::new(&mut MemBuffer::new(need)),
        Default::default(),
    )
    .ok()?;
    Some(values)
}
