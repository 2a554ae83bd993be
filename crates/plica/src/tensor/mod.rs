//! Small plain algebra: numbers on lanes and 3×3 tensors over them.
//!
//! Every formula of the element kernel is written once, for any [`Real`]: `f64` in tests and
//! reports, [`Lanes`] (eight numbers side by side) in the kernels.

mod lanes;
mod tensor2;

pub use lanes::{LANES, Lanes, Real};
pub use tensor2::Tensor2;
