//! Numbers, alone or eight in a vector, and 3×3 tensors of them.
//!
//! Every formula of the element kernel is written once, for any [`Real`]: `f64` in tests and
//! reports, eight-lane vectors in the kernels. `fearless_simd` selects the vectors at run time for
//! the processor. (Arrays of eight, vectorised by the compiler, took twice as long: it vectorised
//! the loops around them, with gathers.)

mod processor;
mod real;
mod symmetric;
mod tensor2;

pub use processor::has_wide_vectors;
pub(crate) use processor::with_vectors;
pub use real::{LANES, Lanes, Real};
pub use tensor2::Tensor2;
