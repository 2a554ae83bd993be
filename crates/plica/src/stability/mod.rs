//! Stability of the states of a run: critical loads of axisymmetric paths by circumferential mode, and the
//! lowest eigenpairs of three-dimensional states.
//!
//! The tangent K of an axisymmetric state without twist is block-circulant around the tube. It decouples
//! into one block K_n per circumferential mode n, for displacements (z cos nφ, r cos nφ, −θ sin nφ). The
//! state is stable if all blocks are positive definite. Where the number of negative eigenvalues of a block
//! differs between two saved states, the path between them is computed again, and the interval is bisected
//! until the critical load is known.
//!
//! The reported eigenvalues are those of K_n x = λ M_n x, with the mass M of unit density. By Sylvester's law of
//! inertia their signs are those of K_n. Two changes between saved states that cancel are not detected.
//!
//! The tangent of a three-dimensional state does not decouple and is not assembled. Its lowest eigenpairs
//! K x = ν C x, with the mass C of the whole sector, are computed by a preconditioned iteration
//! ([`crate::solve::lowest`]).
//!
//! | letter | meaning | unit | Rust |
//! |---|---|---|---|
//! | n | circumferential mode | – | [`StabilityChange::harmonic`] |
//! | K_n | block of the tangent | E D | `SplineTube::tangent_in_harmonic` |
//! | M_n | mass of unit density | D³ | [`harmonic_mass`] |
//! | λ | eigenvalue | E/D² | [`ModeStability::lowest`] |
//! | x | mode: amplitudes (z, r, θ) of the control points | D | [`Mode::shape`] |
//! | ν | eigenvalue of the run's own tangent | E/D² | [`Eigenvalue::value`] |

mod bisection;
mod critical_loads;
mod error;
mod harmonics;
mod lowest_modes;
mod mass;
mod path_stability;
mod path_table;
mod quantity;
mod spectra_table;
mod spectrum;

pub use critical_loads::CriticalLoads;
pub use error::StabilityError;
pub use harmonics::{Harmonics, ModeStability};
pub use lowest_modes::LowestModes;
pub use mass::harmonic_mass;
pub use path_stability::{Mode, PathStability, StabilityChange, TestedState, Transition};
pub use quantity::Quantity;
pub use spectrum::{Eigenvalue, Spectra, Spectrum, StateWithModes};
