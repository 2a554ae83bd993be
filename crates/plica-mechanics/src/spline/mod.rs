//! B-splines: bases, graded meshes, quadrature, approximation of a circle, and transfer between bases.
//!
//! Non-rational splines of degree p (Okino et al. 2025 use p = 3): open knots along the tube and
//! through the wall, periodic uniform knots around it.
//!
//! | letter | meaning | Rust |
//! |---|---|---|
//! | p | degree | [`Basis::degree`] |
//! | t | knots | inside [`Basis`] |
//! | N, N' | basis functions and their slopes | [`Values`] |
//!
//! ```
//! use plica_mechanics::spline::Basis;
//! let axial = Basis::open(3, &[0.0, 0.5, 1.0, 3.0]);
//! assert_eq!(axial.functions(), 6); // 3 elements + degree
//! let at = axial.evaluate(0.7);
//! assert!((at.value.iter().sum::<f64>() - 1.0).abs() < 1e-15);
//! ```

mod basis;
mod circle;
mod grading;
mod quadrature;
mod transfer;

pub use basis::{Basis, Values};
pub use circle::{Circle, control_wave};
pub use grading::{Refinement, geometric_breakpoints, graded_breakpoints};
pub use quadrature::{gauss_legendre, reduced_rule};
pub use transfer::{interpolate, transfer};
