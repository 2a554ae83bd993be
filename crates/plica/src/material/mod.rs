//! Hyperelastic laws: how much energy an elastic deformation stores.
//!
//! A law is a function w(Fe) of the elastic part of the deformation gradient, energy per unit
//! *grown* volume, with its exact first and second derivatives. One law per file; to add one,
//! see CONTRIBUTING.md.
//!
//! | letter | meaning | unit | Rust |
//! |---|---|---|---|
//! | Fe | elastic deformation gradient | – | `F` |
//! | J | det Fe | – | `J` |
//! | w | strain energy density | E | [`Law::energy`] |
//! | P | first Piola–Kirchhoff stress ∂w/∂Fe | E | [`Law::stress`] |
//! | A | tangent moduli ∂²w/∂Fe∂Fe | E | [`Law::moduli`] |
//!
//! The laws are written for any [`Real`]; the callers check that J > 0 (at J ≤ 0 a law has no
//! meaning and gives NaN).
#![allow(non_snake_case)] // the formulas keep the letters of their sources

mod neo_hookean;

pub use neo_hookean::{NeoHookean, Volumetric};

use crate::tensor::{Real, Tensor2};

/// The second derivatives of a law: `moduli[3 k + j][3 l + i]` is ∂²w/∂F_{jk}∂F_{il} for columns
/// k ≤ l of F; the blocks below the diagonal follow by symmetry and are not filled.
pub type Moduli<S> = [[S; 9]; 9];

/// A hyperelastic law.
pub trait Law: Copy + Send + Sync {
    /// Strain energy density w(Fe).
    fn energy<S: Real>(&self, F: &Tensor2<S>) -> S;
    /// First Piola–Kirchhoff stress P = ∂w/∂Fe.
    fn stress<S: Real>(&self, F: &Tensor2<S>) -> Tensor2<S>;
    /// Tangent moduli A = ∂²w/∂Fe∂Fe.
    fn moduli<S: Real>(&self, F: &Tensor2<S>) -> Moduli<S>;
    /// What [`Law::change`] needs to know of Fe; unused places are zero.
    fn keep<S: Real>(&self, F: &Tensor2<S>) -> Kept<S>;
    /// Change of the stress A : dF with a change of Fe. Symmetric in dF and what it is contracted
    /// with, whatever rounding `kept` has seen.
    fn change<S: Real>(&self, kept: &Kept<S>, dF: &Tensor2<S>) -> Tensor2<S>;
}

/// What a law keeps of a state at a point, to multiply with its tangent moduli again and again.
/// Ten numbers, where the moduli are 45: memory is what a matrix-free product waits for.
pub type Kept<S> = [S; 10];

/// The law of a wall, as a case chooses it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Material {
    /// Compressible neo-Hookean.
    NeoHookean(NeoHookean),
}

impl Material {
    /// Stiffness against small longitudinal strains without lateral ones, λ + 2μ: the largest.
    pub fn longitudinal_modulus(&self) -> f64 {
        match self {
            Self::NeoHookean(law) => law.lambda + 2.0 * law.mu,
        }
    }

    /// The law as a sum of two: what resists a change of shape, and what a change of volume.
    pub fn parts(&self) -> [Self; 2] {
        match *self {
            Self::NeoHookean(law) => {
                let (shape, volume) = (
                    NeoHookean { lambda: 0.0, ..law },
                    NeoHookean { mu: 0.0, ..law },
                );
                [Self::NeoHookean(shape), Self::NeoHookean(volume)]
            }
        }
    }
}

#[cfg(test)]
mod tests;
