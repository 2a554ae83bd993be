//! The mechanics of a tube: from splines, laws and muscles to the energy, residual and tangent of a discretised tube.
//!
//! Users depend on the crate `plica`, which re-exports these modules and adds solvers, studies and files. Compiling the
//! element kernels takes minutes, so they are a crate of their own.
//!
//! - [`tensor`], [`spline`], [`matrix`]: 3×3 tensors, B-splines, block-banded matrices;
//! - [`material`], [`activation`], [`tube`]: laws, muscles and geometry of a tube;
//! - [`rings`]: control rings in cylindrical components, cyclic sectors, the harmonic solver;
//! - [`assembly`]: energy, residual and tangent of a tube; [`assembly::ReferenceTube`] is the page to start with.

pub mod activation;
pub mod assembly;
pub mod material;
pub mod matrix;
pub mod rings;
pub mod spline;
pub mod tensor;
pub mod tube;
