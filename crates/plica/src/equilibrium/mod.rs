//! The tube as a solver problem: its tangent, its linear solver, its stability, and its transfer to another mesh.

mod buffers;
mod friction_step;
mod harmonic_tangent;
mod lowest_modes;
mod lumen;
mod problem;
mod prolong;
mod stability;
mod verdict;

pub use harmonic_tangent::HarmonicTangent;
pub use lumen::segment_start;
pub use problem::TubeProblem;
pub use prolong::prolong;
pub use stability::test_stability;
pub use verdict::{Instability, Stability, UnstableMode, mode_effect};
