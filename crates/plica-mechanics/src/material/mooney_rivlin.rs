//! Compressible Mooney–Rivlin law, after Mooney (1940) and Rivlin (1948):
//!
//! w = a/2 (I₁ − 3) + b/2 (I₂ − 3) − (a + 2b) ln J + λ/2 (ln J)²
//!
//! with I₁ = tr C, I₂ = (I₁² − C : C)/2, C = FeᵀFe, J = det Fe. Small strains have the Lamé constants
//! a + b and λ + 2b. With b = 0 it is the neo-Hookean law.
//!
//! Valid for J > 0, a ≥ 0, b ≥ 0 and λ ≥ 0: with λ < 0 the energy of J → 0 has no lower bound.

use super::{Law, Moduli, ModuliData};
use crate::tensor::{Real, Tensor2};

/// The compressible Mooney–Rivlin law. All constants have the unit of a stress.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MooneyRivlin {
    /// Weight a of I₁.
    pub a: f64,
    /// Weight b of I₂.
    pub b: f64,
    /// Volumetric constant λ.
    pub lambda: f64,
}

impl MooneyRivlin {
    /// Creates the law from Young's modulus E, Poisson's ratio ν and the share s of I₂ in the shear
    /// modulus μ = E / 2(1+ν): a = (1−s) μ, b = s μ, λ = 2μν / (1−2ν) − 2b.
    ///
    /// 0 ≤ ν < 0.5 and 0 ≤ s ≤ 1; λ ≥ 0 requires s ≤ ν / (1−2ν), which ν ≥ 1/3 ensures.
    pub fn new(youngs_modulus: f64, poisson_ratio: f64, share: f64) -> Self {
        let (E, nu) = (youngs_modulus, poisson_ratio);
        let mu = E / (2.0 * (1.0 + nu));
        let b = share * mu;
        Self {
            a: mu - b,
            b,
            lambda: E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)) - 2.0 * b,
        }
    }

    /// Returns the parts with λ = 0 and with a = b = 0.
    pub(super) fn parts(self) -> [Self; 2] {
        let (a, b, lambda) = (0.0, 0.0, 0.0);
        [Self { lambda, ..self }, Self { a, b, ..self }]
    }

    /// Returns a + 2b − λ ln J, λ and a + b I₁, and 2b.
    #[inline(always)]
    pub(super) fn coefficients<S: Real>(&self, F: &Tensor2<S>) -> ([S; 3], S) {
        let Self { a, b, lambda } = *self;
        let (I1, J) = (F.dot(*F), F.determinant());
        let m = J.like(a + 2.0 * b) - J.ln().times(lambda);
        let e = I1.times(b) + J.like(a);
        ([m, J.like(lambda), e], J.like(2.0 * b))
    }
}

impl Law for MooneyRivlin {
    type TangentData = ModuliData;

    #[inline(always)]
    fn energy<S: Real>(&self, F: &Tensor2<S>) -> S {
        let Self { a, b, lambda } = *self;
        let C = F.transpose().times(*F);
        let I1 = F.dot(*F);
        let I2 = (I1 * I1 - C.dot(C)).times(0.5);
        let ln_J = F.determinant().ln();
        let shape = (I1 - I1.like(3.0)).times(0.5 * a) + (I2 - I2.like(3.0)).times(0.5 * b);
        ln_J.mul_add(ln_J.times(0.5 * lambda) - I1.like(a + 2.0 * b), shape)
    }

    // P = a F + b (I₁ F − F C) + (λ ln J − a − 2b) F⁻ᵀ
    #[inline(always)]
    fn stress<S: Real>(&self, F: &Tensor2<S>) -> Tensor2<S> {
        let Self { a, b, lambda } = *self;
        let FC = F.times(F.transpose().times(*F));
        let I1 = F.dot(*F);
        let cofactor = F.cofactor();
        let J = F.determinant_with(cofactor);
        let p = (J.ln().times(lambda) - J.like(a + 2.0 * b)) / J;
        let mut P = F.0;
        for i in 0..3 {
            for k in 0..3 {
                let shape = (I1.times(b) + J.like(a)) * F.0[i][k] - FC.0[i][k].times(b);
                P[i][k] = p.mul_add(cofactor.0[i][k], shape);
            }
        }
        Tensor2(P)
    }

    // A_{jk il} = (a + b I₁) δ_ij δ_kl + b (2 F_jk F_il − δ_ij C_kl − F_jl F_ik − δ_kl B_ij)
    //           + (a + 2b − λ ln J) F⁻ᵀ_{jl} F⁻ᵀ_{ik} + λ F⁻ᵀ_{jk} F⁻ᵀ_{il},   B = F Fᵀ
    #[inline(always)]
    fn moduli<S: Real>(&self, F: &Tensor2<S>) -> Moduli<S> {
        let Self { a, b, lambda } = *self;
        let (B, C) = (F.times(F.transpose()).0, F.transpose().times(*F).0);
        let I1 = F.dot(*F);
        let cofactor = F.cofactor();
        let J = F.determinant_with(cofactor);
        let G = cofactor.scaled(J.like(1.0) / J).0; // F⁻ᵀ
        let m = J.like(a + 2.0 * b) - J.ln().times(lambda);
        let F = F.0;
        let mut A = [[J.like(0.0); 9]; 9];
        for k in 0..3 {
            for l in k..3 {
                for j in 0..3 {
                    for i in 0..3 {
                        let mut shape = (F[j][k] * F[i][l]).times(2.0) - F[j][l] * F[i][k];
                        if i == j {
                            shape = shape - C[k][l];
                        }
                        if k == l {
                            shape = shape - B[i][j];
                        }
                        let volume = m * G[j][l] * G[i][k] + (G[j][k] * G[i][l]).times(lambda);
                        let mut entry = shape.times(b) + volume;
                        if i == j && k == l {
                            entry = entry + I1.times(b) + J.like(a);
                        }
                        A[3 * k + j][3 * l + i] = entry;
                    }
                }
            }
        }
        A
    }
}
