//! Compressible neo-Hookean law, Okino et al. (2025), Eqs. (8)–(10), after Bonet and Wood (2008):
//!
//! w = μ/2 (I₁ − 3) − μ ln J + λ/2 (ln J)²,  I₁ = tr(FeᵀFe),  J = det Fe
//!
//! Valid for J > 0. It loses ellipticity under strong expansion (ln J > 1), far from where a
//! nearly incompressible wall goes.

use super::{Law, Moduli};
use crate::tensor::{Real, Tensor2};

/// The compressible neo-Hookean law. Both constants have the unit of a stress.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NeoHookean {
    /// Shear modulus μ.
    pub mu: f64,
    /// Lamé's first constant λ.
    pub lambda: f64,
}

impl NeoHookean {
    /// From Young's modulus E and Poisson's ratio ν, −1 < ν < 0.5:
    /// μ = E / 2(1+ν), λ = Eν / (1+ν)(1−2ν).
    pub fn new(youngs_modulus: f64, poisson_ratio: f64) -> Self {
        let (E, nu) = (youngs_modulus, poisson_ratio);
        Self {
            mu: E / (2.0 * (1.0 + nu)),
            lambda: E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
        }
    }
}

impl Law for NeoHookean {
    #[inline(always)]
    fn energy<S: Real>(&self, F: &Tensor2<S>) -> S {
        let (mu, lambda) = (S::splat(self.mu), S::splat(self.lambda));
        let half = S::splat(0.5);
        let I1 = F.dot(*F);
        let ln_J = F.determinant().ln();
        half * mu * (I1 - S::splat(3.0)) + ln_J * (half * lambda * ln_J - mu)
    }

    // P = μ (F − F⁻ᵀ) + λ ln J F⁻ᵀ
    #[inline(always)]
    fn stress<S: Real>(&self, F: &Tensor2<S>) -> Tensor2<S> {
        let (mu, lambda) = (S::splat(self.mu), S::splat(self.lambda));
        let cofactor = F.cofactor();
        let J = F.determinant_with(cofactor);
        let p = lambda.mul_add(J.ln(), -mu) / J;
        let mut P = Tensor2::zero();
        for i in 0..3 {
            for k in 0..3 {
                P.0[i][k] = mu.mul_add(F.0[i][k], p * cofactor.0[i][k]);
            }
        }
        P
    }

    // A_{jk il} = μ δ_ij δ_kl + (μ − λ ln J) F⁻ᵀ_{jl} F⁻ᵀ_{ik} + λ F⁻ᵀ_{jk} F⁻ᵀ_{il}
    #[inline(always)]
    fn moduli<S: Real>(&self, F: &Tensor2<S>) -> Moduli<S> {
        let (mu, lambda) = (S::splat(self.mu), S::splat(self.lambda));
        let cofactor = F.cofactor();
        let J = F.determinant_with(cofactor);
        let G = cofactor.scaled(S::splat(1.0) / J).0; // F⁻ᵀ
        let m = lambda.mul_add(-J.ln(), mu);
        let mut A = [[S::zero(); 9]; 9];
        for k in 0..3 {
            for l in k..3 {
                for j in 0..3 {
                    for i in 0..3 {
                        let mut a = m * G[j][l] * G[i][k];
                        a = lambda.mul_add(G[j][k] * G[i][l], a);
                        if i == j && k == l {
                            a += mu;
                        }
                        A[3 * k + j][3 * l + i] = a;
                    }
                }
            }
        }
        A
    }
}
