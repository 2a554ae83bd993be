//! Laws of the first invariant I₁ = tr(FeᵀFe):
//!
//! w = f(I₁ − 3) − μ ln J + K/4 (J² − 1 − 2 ln J),  μ = 2 f′(0),  J = det Fe
//!
//! μ is the shear modulus at small strains, and K Lamé's first constant. The volumetric energy is convex in J, and grows
//! without bounds as J vanishes.

use super::{Law, Moduli, NeoHookean, Volumetric};
use crate::tensor::{Real, Tensor2};

/// The energy f of a law of the first invariant.
pub(super) trait FirstInvariant {
    /// Returns f, f′ and f″ at x = I₁ − 3.
    fn shape<S: Real>(&self, x: S) -> [S; 3];
    /// Returns the shear modulus μ at small strains.
    fn shear_modulus(&self) -> f64;
    /// Returns the constant K of the volumetric energy.
    fn bulk(&self) -> f64;
}

/// Returns the law of the volumetric energy alone.
fn volumetric(law: &impl FirstInvariant) -> NeoHookean {
    NeoHookean {
        mu: 0.0,
        lambda: law.bulk(),
        volumetric: Volumetric::Quadratic,
    }
}

/// Returns I₁ − 3.
#[inline(always)]
fn strain<S: Real>(F: &Tensor2<S>) -> S {
    let I1 = F.dot(*F);
    I1 - I1.like(3.0)
}

/// Returns μ − J U′, J (J U′)′ and 2 f′, and 4 f″.
#[inline(always)]
pub(super) fn coefficients<S: Real>(law: &impl FirstInvariant, F: &Tensor2<S>) -> ([S; 3], S) {
    let [_, slope, curvature] = law.shape(strain(F));
    let volume = NeoHookean {
        mu: law.shear_modulus(),
        ..volumetric(law)
    };
    let [m, bulk, _] = volume.coefficients(F);
    ([m, bulk, slope.times(2.0)], curvature.times(4.0))
}

#[inline(always)]
pub(super) fn energy<S: Real>(law: &impl FirstInvariant, F: &Tensor2<S>) -> S {
    let [f, ..] = law.shape(strain(F));
    let ln_J = F.determinant().ln();
    f - ln_J.times(law.shear_modulus()) + volumetric(law).energy(F)
}

// P = 2 f′ F − μ F⁻ᵀ + J U′ F⁻ᵀ
#[inline(always)]
pub(super) fn stress<S: Real>(law: &impl FirstInvariant, F: &Tensor2<S>) -> Tensor2<S> {
    let [_, slope, _] = law.shape(strain(F));
    let doubled = slope.times(2.0);
    let cofactor = F.cofactor();
    let J = F.determinant_with(cofactor);
    let K = 0.5 * law.bulk();
    let pressure = (J * J).times(K) - J.like(K + law.shear_modulus());
    let G = cofactor.scaled(pressure / J);
    let mut P = F.0;
    for i in 0..3 {
        for k in 0..3 {
            P[i][k] = doubled.mul_add(F.0[i][k], G.0[i][k]);
        }
    }
    Tensor2(P)
}

// A_{jk il} = 2 f′ δ_ij δ_kl + 4 f″ F_jk F_il + (μ − J U′) F⁻ᵀ_{jl} F⁻ᵀ_{ik} + J (J U′)′ F⁻ᵀ_{jk} F⁻ᵀ_{il}
#[inline(always)]
pub(super) fn moduli<S: Real>(law: &impl FirstInvariant, F: &Tensor2<S>) -> Moduli<S> {
    let [_, slope, curvature] = law.shape(strain(F));
    let (doubled, curvature) = (slope.times(2.0), curvature.times(4.0));
    let volume = NeoHookean {
        mu: law.shear_modulus(),
        ..volumetric(law)
    };
    // The neo-Hookean moduli hold μ δ_ij δ_kl instead of the first term.
    let mut A = volume.moduli(F);
    let excess = doubled - doubled.like(law.shear_modulus());
    for k in 0..3 {
        for l in k..3 {
            for j in 0..3 {
                for i in 0..3 {
                    let entry = &mut A[3 * k + j][3 * l + i];
                    *entry = (curvature * F.0[j][k]).mul_add(F.0[i][l], *entry);
                    if i == j && k == l {
                        *entry += excess;
                    }
                }
            }
        }
    }
    A
}
