//! Symmetric block-banded matrices and their factorisation, on a library's dense kernels.

mod block_banded;
mod dense;

pub use block_banded::{BlockBanded, Factor, Singular};
pub use dense::multiply;
