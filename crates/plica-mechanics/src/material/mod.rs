//! Hyperelastic laws: the strain energy density of an elastic deformation and its derivatives.
//!
//! A law is a function w(Fe) of the elastic part of the deformation gradient, energy per unit
//! *grown* volume, with its exact first and second derivatives. The columns of Fe are its components (along,
//! outwards, around) in the stress-free wall, so that a direction of a law, such as that of fibres, is a constant vector. Each file holds one law;
//! CONTRIBUTING.md shows how to add one.
//!
//! | letter | meaning | unit | Rust |
//! |---|---|---|---|
//! | Fe | elastic deformation gradient | – | `F` |
//! | J | det Fe | – | `J` |
//! | w | strain energy density | E | [`Law::energy`] |
//! | P | first Piola–Kirchhoff stress ∂w/∂Fe | E | [`Law::stress`] |
//! | A | tangent moduli ∂²w/∂Fe∂Fe | E | [`Law::moduli`] |
//!
//! The laws are generic over [`Real`]: one number, or eight in a vector. They are defined for
//! J > 0 and give NaN otherwise; callers check J.
#![allow(non_snake_case)] // the formulas keep the letters of their sources

mod check;
mod composite;
mod custom;
mod demiray;
mod fibres;
mod first_invariant;
mod fung;
mod gent;
mod invariant_tangent;
mod length_tension;
mod mooney_rivlin;
mod neo_hookean;
mod tangent_data;
mod tone;
mod yeoh;

pub use check::{LawError, check_law};
pub use composite::{Composite, Matrix};
pub use custom::CustomLaw;
pub use demiray::Demiray;
pub use fibres::Fibres;
pub use fung::Fung;
pub use gent::Gent;
pub use invariant_tangent::MaterialData;
pub use length_tension::LengthTension;
pub use mooney_rivlin::MooneyRivlin;
pub use neo_hookean::{NeoHookean, NeoHookeanData, Volumetric};
pub use tangent_data::{ModuliData, TangentData};
pub use tone::Tone;
pub use yeoh::Yeoh;

use custom::ByLanes;

use crate::tensor::{Real, Tensor2};

/// Second derivatives of a law: `moduli[3 k + j][3 l + i]` is ∂²w/∂F_{jk}∂F_{il} for columns
/// k ≤ l of F. The blocks k > l follow by symmetry and are not filled.
pub type Moduli<S> = [[S; 9]; 9];

/// A hyperelastic law.
pub trait Law: Sized + Send + Sync {
    /// Data that the matrix-free product stores at each quadrature point.
    /// [`ModuliData`] suits every law; a law may define smaller data for speed.
    type TangentData: TangentData<Self>;

    /// The kernels of the law are compiled for processors with wide vectors only; others use those for any law.
    const WIDE_VECTORS_ONLY: bool = false;

    /// Returns the strain energy density w(Fe).
    fn energy<S: Real>(&self, F: &Tensor2<S>) -> S;
    /// Returns the first Piola–Kirchhoff stress P = ∂w/∂Fe.
    fn stress<S: Real>(&self, F: &Tensor2<S>) -> Tensor2<S>;
    /// Returns the tangent moduli A = ∂²w/∂Fe∂Fe.
    fn moduli<S: Real>(&self, F: &Tensor2<S>) -> Moduli<S>;
}

/// The law of a wall.
#[derive(Clone, Debug, PartialEq)]
pub enum Material {
    /// Compressible neo-Hookean.
    NeoHookean(NeoHookean),
    /// Compressible Mooney–Rivlin.
    MooneyRivlin(MooneyRivlin),
    /// Another law, or one with fibres.
    Composite(Composite),
    /// A law of a user's own.
    Custom(CustomLaw),
}

/// Evaluates an expression with the law of a [`Material`]. A new law adds one line.
macro_rules! with_law {
    ($material:expr, $law:ident => $value:expr) => {
        match $material {
            Material::NeoHookean($law) => $value,
            Material::MooneyRivlin($law) => $value,
            Material::Composite(law) => {
                let $law = &ByLanes(law);
                $value
            }
            Material::Custom($law) => $value,
        }
    };
}

impl Material {
    /// Returns λ + 2μ at small strains: the stiffness under uniaxial strain.
    pub fn longitudinal_modulus(&self) -> f64 {
        match self {
            Self::NeoHookean(law) => law.lambda + 2.0 * law.mu,
            _ => self.moduli(&Tensor2::IDENTITY)[0][0],
        }
    }

    /// Returns whether the law is known to be the same after reflection in a plane through the axis. A custom law is
    /// not known to be.
    pub fn is_mirror_symmetric(&self) -> bool {
        match self {
            Self::NeoHookean(_) | Self::MooneyRivlin(_) => true,
            Self::Composite(law) => law.is_mirror_symmetric(),
            Self::Custom(_) => false,
        }
    }

    /// Returns whether the law has an active tension, so that it is not free of stress at rest.
    pub fn has_tone(&self) -> bool {
        matches!(self, Self::Composite(law) if !law.tones.is_empty())
    }

    /// Splits the law into the part without and the part with its volumetric constant λ, to which
    /// reduced integration applies; their sum is the law. A custom law has no such parts.
    pub fn parts(&self) -> Option<[Self; 2]> {
        match self {
            Self::NeoHookean(law) => Some(law.parts().map(Self::NeoHookean)),
            Self::MooneyRivlin(law) => Some(law.parts().map(Self::MooneyRivlin)),
            Self::Composite(law) => Some(law.parts().map(Self::Composite)),
            Self::Custom(_) => None,
        }
    }
}

impl Law for Material {
    type TangentData = MaterialData;

    #[inline(always)]
    fn energy<S: Real>(&self, F: &Tensor2<S>) -> S {
        with_law!(self, law => law.energy(F))
    }

    #[inline(always)]
    fn stress<S: Real>(&self, F: &Tensor2<S>) -> Tensor2<S> {
        with_law!(self, law => law.stress(F))
    }

    #[inline(always)]
    fn moduli<S: Real>(&self, F: &Tensor2<S>) -> Moduli<S> {
        with_law!(self, law => law.moduli(F))
    }
}

#[cfg(test)]
mod tests;
