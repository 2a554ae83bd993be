//! Small plain algebra: numbers alone or eight side by side, and 3×3 tensors over them.
//!
//! Every formula of the element kernel is written once, for any [`Real`]: `f64` in tests and
//! reports, eight-lane vectors in the kernels. The vectors are those of `fearless_simd`, chosen
//! for the processor at run time, so that a plain release build is fast everywhere. (Arrays of
//! eight left to the compiler's own vectorisation took twice as long: it vectorised the loops
//! around them instead, with gathers.)

mod real;
mod symmetric;
mod tensor2;

pub use real::{LANES, Lanes, Real};
pub use tensor2::Tensor2;
