//! Symmetric block-banded matrices with their factorisation and lowest eigenpairs, and dense matrices.

mod block_banded;
mod dense;
mod eigen;
mod tall_matrix;

pub use block_banded::{BlockBanded, Factor, Singular};
pub use dense::multiply;
pub use eigen::{Eigenpair, NoEigenpairs, lowest_eigenpairs, lowest_eigenpairs_excluding};
pub use tall_matrix::TallMatrix;
