//! Homogeneous deformations of a law: tension, biaxial tension, inflation of a thin tube; loss of ellipticity.
//!
//! Deformations are stretches along, outwards and around, without shear: Fe = diag(λz, λr, λθ). The stress through the wall
//! is zero, and so is that in a direction whose stretch is not prescribed. A material with fibres of one hand would shear;
//! here it is held.
//!
//! | letter | meaning | Rust |
//! |---|---|---|
//! | λ | stretches along, outwards and around | [`Homogeneous::stretches`] |
//! | σ, P | Cauchy stress and nominal stress, P = J σ/λ | [`Homogeneous::cauchy`], [`Homogeneous::nominal`] |
//! | p R/H | pressure in a thin tube of radius R and thickness H at rest, σθ λr/λθ | [`Homogeneous::thin_tube_pressure`] |
#![allow(non_snake_case)] // the formulas keep the letters of their sources

mod ellipticity;
mod equilibrium_stretch;
mod scaled;
mod test_curve;

pub use ellipticity::{least_wave_stiffness, loses_ellipticity};
pub use equilibrium_stretch::{Homogeneous, Prescribed, Volume, homogeneous};
pub use scaled::scaled;
pub use test_curve::{MechanicalTest, curve};

#[cfg(test)]
mod tests;
