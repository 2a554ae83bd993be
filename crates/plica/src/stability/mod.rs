//! Which circumferential harmonics the path of an axisymmetric run loses, where, and in what shape;
//! and the lowest eigenpairs of states that are not axisymmetric.
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
//! The tangent of a three-dimensional run does not part into harmonics, and is never assembled. Its
//! lowest eigenpairs K x = ν C x, with the mass C of the whole sector, come from a preconditioned
//! iteration ([`crate::solve::lowest`]); what share each harmonic has in a mode is told afterwards.
//!
//! | letter | meaning | unit | Rust |
//! |---|---|---|---|
//! | n | circumferential harmonic | – | [`Change::harmonic`] |
//! | K_n | block of the tangent | E D | [`crate::assembly::SplineTube::tangent_in_harmonic`] |
//! | M_n | mass of unit density | D³ | [`harmonic_mass`] |
//! | λ | eigenvalue | E/D² | [`Tested::lowest`] |
//! | x | mode: amplitudes (z, r, θ) of the control points | D | [`Mode::shape`] |
//! | ν | eigenvalue of the run's own tangent | E/D² | [`Eigenvalue::value`] |

mod bisection;
mod error;
mod follow;
mod found;
mod harmonics;
mod lowest_modes;
mod mass;
mod observer;
mod quantity;
mod spectra_table;
mod spectrum;
mod table;

pub use error::StabilityError;
pub use follow::{Request, follow};
pub use found::{Change, How, Mode, Stability, Station};
pub use harmonics::{Harmonics, Tested};
pub use lowest_modes::{ModesRequest, lowest_modes};
pub use mass::harmonic_mass;
pub use observer::Observer;
pub use quantity::Quantity;
pub use spectrum::{Eigenvalue, Shown, Spectra, Spectrum};
