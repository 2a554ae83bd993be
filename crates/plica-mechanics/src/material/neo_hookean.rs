//! Compressible neo-Hookean law, Okino et al. (2025), Eqs. (9)–(11), after Bonet and Wood (2008):
//!
//! w = μ/2 (I₁ − 3) − μ ln J + U(J),  I₁ = tr(FeᵀFe),  J = det Fe
//!
//! with U = λ/2 (ln J)², the paper's, or U = λ/4 (J² − 1 − 2 ln J) (Simo and Hughes 1998).
//!
//! Valid for J > 0. At a stretch s in some direction, a longitudinal wave in that direction has the
//! stiffness μ (1 + s⁻²) + λ (1 − ln J) s⁻² with the first U. It is negative where
//! ln J > 1 + (μ/λ)(1 + s²): at ν = 0.495 beyond a J between 2.75 and 3.0, which nearly incompressible walls do not reach.
//! The second U is convex in J for λ ≥ 0; its stiffness μ (1 + s⁻²) + λ/2 (1 + J²) s⁻² is positive.

use super::{Law, Moduli, TangentData};
use crate::tensor::{Real, Tensor2};

/// The compressible neo-Hookean law. Both constants have the unit of a stress.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NeoHookean {
    /// Shear modulus μ.
    pub mu: f64,
    /// Lamé's first constant λ.
    pub lambda: f64,
    /// Volumetric energy U(J).
    pub volumetric: Volumetric,
}

/// A volumetric energy U(J).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Volumetric {
    /// U = λ/2 (ln J)².
    #[default]
    Logarithmic,
    /// U = λ/4 (J² − 1 − 2 ln J).
    Quadratic,
}

impl NeoHookean {
    /// Creates the law from Young's modulus E and Poisson's ratio ν, −1 < ν < 0.5:
    /// μ = E / 2(1+ν), λ = Eν / (1+ν)(1−2ν).
    pub fn new(youngs_modulus: f64, poisson_ratio: f64) -> Self {
        let (E, nu) = (youngs_modulus, poisson_ratio);
        Self {
            mu: E / (2.0 * (1.0 + nu)),
            lambda: E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
            volumetric: Volumetric::Logarithmic,
        }
    }

    /// Returns the part in μ and the part in λ.
    pub(super) fn parts(self) -> [Self; 2] {
        [
            Self {
                lambda: 0.0,
                ..self
            },
            Self { mu: 0.0, ..self },
        ]
    }

    /// Returns μ − J U′, J (J U′)′ and μ.
    #[inline(always)]
    pub(super) fn coefficients<S: Real>(&self, F: &Tensor2<S>) -> [S; 3] {
        let J = F.determinant();
        let m = J.like(self.mu) - self.pressure(J);
        [m, self.bulk(m), J.like(self.mu)]
    }

    /// Returns J U′, a pressure times J.
    #[inline(always)]
    fn pressure<S: Real>(&self, J: S) -> S {
        match self.volumetric {
            Volumetric::Logarithmic => J.ln().times(self.lambda),
            Volumetric::Quadratic => (J * J - J.like(1.0)).times(0.5 * self.lambda),
        }
    }

    /// Returns J (J U′)′ from μ − J U′: λ, or λ J² = λ + 2 J U′.
    #[inline(always)]
    fn bulk<S: Real>(&self, m: S) -> S {
        let doubled = match self.volumetric {
            Volumetric::Logarithmic => 0.0,
            Volumetric::Quadratic => 2.0,
        };
        m.times(-doubled) + m.like(self.lambda + doubled * self.mu)
    }
}

impl Law for NeoHookean {
    type TangentData = NeoHookeanData;
    const WIDE_VECTORS_ONLY: bool = true;

    #[inline(always)]
    fn energy<S: Real>(&self, F: &Tensor2<S>) -> S {
        let (mu, lambda) = (self.mu, self.lambda);
        let I1 = F.dot(*F);
        let J = F.determinant();
        let ln_J = J.ln();
        let shape = (I1 - I1.like(3.0)).times(0.5 * mu);
        match self.volumetric {
            Volumetric::Logarithmic => ln_J.mul_add(ln_J.times(0.5 * lambda) - I1.like(mu), shape),
            Volumetric::Quadratic => {
                let volume = (J * J - J.like(1.0)).times(0.25 * lambda);
                ln_J.mul_add(I1.like(-mu - 0.5 * lambda), shape + volume)
            }
        }
    }

    // P = μ (F − F⁻ᵀ) + J U′ F⁻ᵀ
    #[inline(always)]
    fn stress<S: Real>(&self, F: &Tensor2<S>) -> Tensor2<S> {
        let mu = self.mu;
        let cofactor = F.cofactor();
        let J = F.determinant_with(cofactor);
        let p = (self.pressure(J) - J.like(mu)) / J;
        let mut P = F.0;
        for i in 0..3 {
            for k in 0..3 {
                P[i][k] = p.mul_add(cofactor.0[i][k], F.0[i][k].times(mu));
            }
        }
        Tensor2(P)
    }

    // A_{jk il} = μ δ_ij δ_kl + (μ − J U′) F⁻ᵀ_{jl} F⁻ᵀ_{ik} + J (J U′)′ F⁻ᵀ_{jk} F⁻ᵀ_{il}
    #[inline(always)]
    fn moduli<S: Real>(&self, F: &Tensor2<S>) -> Moduli<S> {
        let mu = self.mu;
        let cofactor = F.cofactor();
        let J = F.determinant_with(cofactor);
        let G = cofactor.scaled(J.like(1.0) / J); // F⁻ᵀ
        let m = J.like(mu) - self.pressure(J);
        let (shifted, scaled) = (G.scaled(m).0, G.scaled(self.bulk(m)).0);
        let mut A = [[J.like(0.0); 9]; 9];
        for k in 0..3 {
            for l in k..3 {
                for j in 0..3 {
                    for i in 0..3 {
                        let a = shifted[j][l] * G.0[i][k];
                        let a = scaled[j][k].mul_add(G.0[i][l], a);
                        A[3 * k + j][3 * l + i] = if i == j && k == l { a + J.like(mu) } else { a };
                    }
                }
            }
        }
        A
    }
}

/// Tangent data of the neo-Hookean law: F⁻ᵀ row by row, then μ − J U′.
pub enum NeoHookeanData {}

impl TangentData<NeoHookean> for NeoHookeanData {
    #[inline(always)]
    fn count(_: &NeoHookean) -> usize {
        10
    }

    #[inline(always)]
    fn linearise<S: Real>(law: &NeoHookean, F: &Tensor2<S>, mut store: impl FnMut([S; 2])) {
        let cofactor = F.cofactor();
        let J = F.determinant_with(cofactor);
        let m = J.like(law.mu) - law.pressure(J);
        let [a, b, c] = cofactor.scaled(J.like(1.0) / J).0;
        store([a[0], a[1]]);
        store([a[2], b[0]]);
        store([b[1], b[2]]);
        store([c[0], c[1]]);
        store([c[2], m]);
    }

    // A : dF = μ dF + (μ − J U′) F⁻ᵀ dFᵀ F⁻ᵀ + J (J U′)′ (F⁻ᵀ : dF) F⁻ᵀ
    #[inline(always)]
    fn tangent_product<S: Real>(
        law: &NeoHookean,
        pair: impl Fn(usize) -> [S; 2],
        dF: &Tensor2<S>,
    ) -> Tensor2<S> {
        let ([a0, a1], [a2, b0], [b1, b2]) = (pair(0), pair(1), pair(2));
        let ([c0, c1], [c2, m]) = (pair(3), pair(4));
        let G = Tensor2([[a0, a1, a2], [b0, b1, b2], [c0, c1, c2]]);
        let H = dF.transpose().times(G);
        let trace = G.dot(*dF) * law.bulk(m);
        let mut middle = H;
        for i in 0..3 {
            for j in 0..3 {
                middle.0[i][j] = H.0[i][j] * m;
            }
            middle.0[i][i] = m.mul_add(H.0[i][i], trace);
        }
        let mut P = G.times(middle);
        for i in 0..3 {
            for j in 0..3 {
                P.0[i][j] += dF.0[i][j].times(law.mu);
            }
        }
        P
    }
}
