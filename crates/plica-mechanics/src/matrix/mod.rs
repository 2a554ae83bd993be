//! Symmetric block-banded matrices, also with far couplings, with their factorisation and lowest
//! eigenpairs, and dense matrices.

mod block_banded;
mod block_sparse;
mod coupled;
mod dense;
mod eigen;
mod elimination;
mod far_blocks;
mod rank_one;
mod tall_matrix;

pub use block_banded::{BlockBanded, Factor, Singular};
pub use block_sparse::SparseFactor;
pub use coupled::{CoupledBanded, CoupledFactor};
pub use dense::multiply;
pub use eigen::{Eigenpair, NoEigenpairs, lowest_eigenpairs, lowest_eigenpairs_excluding};
pub use far_blocks::FarBlocks;
pub use rank_one::{RankOne, RankOneFactor};
pub use tall_matrix::TallMatrix;
