//! Plica simulates soft, active tubes: how a muscular wall that contracts around and relaxes
//! along itself deforms, buckles and invaginates.
//!
//! The rooms, from the ground up (ARCHITECTURE.md draws the arrows):
//!
//! - [`tensor`]: numbers on lanes, 3×3 tensors.
//! - [`spline`]: bases, quadrature, the circle a spline draws.
//! - [`matrix`]: block-banded matrices and their factorisation.
//! - [`material`]: hyperelastic laws, one per file.
//! - [`activation`]: muscles and their profiles.
//! - [`tube`]: what a person means by a tube, its mesh and its load.
//! - [`rings`]: control rings in cylindrical components, and sectors that repeat.
//! - [`assembly`]: the element kernel; energy, residual and tangent of a tube.
//! - [`solve`]: Newton, relaxation, pseudo-time, the way through a snap.
//! - [`measure`]: walls, angles, overhang, shape of a deformed tube.
//! - [`study`]: stages, accepted states, the run directory.
//! - [`stability`]: which harmonics a run loses, where, and in what shape.
//! - [`case`]: the case file as written, and what it means.

pub mod activation;
pub mod assembly;
pub mod case;
pub mod equilibrium;
pub mod material;
pub mod matrix;
pub mod measure;
pub mod monitor;
pub mod rings;
pub mod run_directory;
pub mod saved_state;
pub mod solve;
pub mod spline;
pub mod stability;
pub mod study;
pub mod tensor;
pub mod tube;

pub use study::Study;
