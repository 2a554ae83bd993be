//! Which circumferential harmonics the path of an axisymmetric run loses, where, and in what shape.
//!
//! The tangent K of an axisymmetric state without twist is block-circulant around the tube: it parts
//! into one block K_n for every harmonic n of displacements (z cos nφ, r cos nφ, −θ sin nφ). The
//! state is stable if all are positive definite. Where a run's path passes from a state with as
//! many negative eigenvalues to one with more, a harmonic is lost, and the path is followed again
//! between the two, halving the interval, until the critical load is known.
//!
//! The eigenvalues told are those of K_n x = λ M_n x, with the mass M of unit density. Their signs
//! are those of K_n (Sylvester); a sign changes where an eigenvalue passes through zero. Changes
//! that undo each other between two saved states are not seen.
//!
//! | letter | meaning | unit | Rust |
//! |---|---|---|---|
//! | n | circumferential harmonic | – | [`Change::harmonic`] |
//! | K_n | block of the tangent | E D | [`crate::assembly::SplineTube::harmonic_tangent`] |
//! | M_n | mass of unit density | D³ | [`harmonic_mass`] |
//! | λ | eigenvalue | E/D² | [`Tested::lowest`] |
//! | x | mode: amplitudes (z, r, θ) of the control points | D | [`Mode::shape`] |

mod bisection;
mod error;
mod follow;
mod found;
mod harmonics;
mod mass;
mod observer;
mod quantity;
mod table;

pub use error::StabilityError;
pub use follow::{Request, follow};
pub use found::{Change, How, Mode, Stability, Station};
pub use harmonics::{Harmonics, Tested};
pub use mass::harmonic_mass;
pub use observer::Observer;
pub use quantity::Quantity;
pub use table::effect;
