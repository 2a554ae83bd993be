//! Plica simulates soft, active tubes: how a muscular wall that contracts around its axis and relaxes along it deforms,
//! buckles and invaginates.
//!
//! The wall is hyperelastic, its muscles change its stress-free shape (growth, F = Fe Fp), and its displacements are
//! B-splines (isogeometric analysis). Plica follows the equilibria of a tube while its load changes, through snaps, and
//! tests axisymmetric states for stability against the lowest circumferential modes.
//!
//! # Quick start
//!
//! A case describes a tube and the stages of its load. A [`Study`] is an iterator of its states:
//!
//! ```
//! let text = "
//!     mesh.control_points = { axial = 30, around = 12, thickness = 4 }
//!     [muscles.circular]
//!     direction = 'circular'
//!     zone = [0.5, 1.0]
//!     [[stages]]
//!     name = 'contract'
//!     steps = 4
//!     drive.circular.diameter_ratio = 0.8
//! ";
//! for state in plica::Study::new(&plica::case::read(text, "tube")?)? {
//!     let state = state?; // lengths in D, stresses in E, energies in E·D³
//!     println!("{} {:.4} {:.4e}", state.stage, state.diameter_ratio(), state.energy);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The programs in `examples/`, named by subject, show more. [`run_directory`] writes the states of a study to disk; the crate `plica-view`
//! draws them and exports them to VTK; the crate `plica-cli` is the program `plica`.
//!
//! # Modules
//!
//! For users:
//!
//! - [`case`]: reads and checks case files;
//! - [`study`]: [`Study`], its [`study::State`]s and findings;
//! - [`run_directory`]: states on disk, and resuming a run;
//! - [`saved_state`]: the file format of a state;
//! - [`stability`]: critical loads and modes of a run;
//! - [`sweep`]: studies of many tubes;
//! - [`branches`]: branches of equilibria, stable or not, with their folds and branch points;
//! - [`measure`]: radii, angles, overhang and shape of deformed walls;
//! - [`tube`], [`activation`], [`material`]: geometry, muscles and laws of a tube;
//! - [`homogeneous`], [`fit`]: curves of mechanical tests of a law, its ellipticity, and fits to such tests;
//! - [`monitor`]: progress and cancellation.
//!
//! The method, from the ground up:
//!
//! - [`tensor`], [`spline`], [`matrix`]: 3×3 tensors, B-splines, block-banded matrices;
//! - [`rings`]: control rings in cylindrical components, cyclic sectors, the harmonic solver;
//! - [`assembly`]: energy, residual and tangent of a tube; [`assembly::ReferenceTube`] is the page to start with;
//! - [`solve`]: Newton's method, relaxation, and the path of equilibria, for any [`solve::Equilibrium`];
//! - [`equilibrium`]: the tube as such a problem, and the stability test.

pub mod branches;
pub mod case;
pub mod contact;
pub mod equilibrium;
pub mod fit;
pub mod homogeneous;
pub mod measure;
pub mod monitor;
pub mod run_directory;
pub mod saved_state;
pub mod solve;
pub mod stability;
pub mod study;
pub mod sweep;

pub use plica_mechanics::{activation, assembly, material, matrix, rings, spline, tensor, tube};
pub use study::Study;
