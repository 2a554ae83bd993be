//! Symmetric block-banded matrices, their factorisation and lowest eigenpairs, on a library's dense
//! kernels.

mod block_banded;
mod dense;
mod eigen;

pub use block_banded::{BlockBanded, Factor, Singular};
pub use dense::multiply;
pub use eigen::{Eigenpair, NoEigenpairs, lowest_eigenpairs};
