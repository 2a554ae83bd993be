//! Symmetric block-banded matrices, their factorisation and lowest eigenpairs, and matrices of a
//! few tall columns, on a library's dense kernels.

mod block_banded;
mod columns;
mod dense;
mod eigen;

pub use block_banded::{BlockBanded, Factor, Singular};
pub use columns::Columns;
pub use dense::multiply;
pub use eigen::{Eigenpair, NoEigenpairs, lowest_eigenpairs, lowest_eigenpairs_beside};
