//! Fung's orthotropic law (Fung et al. 1979), here with shear:
//!
//! w = c/2 (exp(Q) − 1) + K/4 (J² − 1 − 2 ln J),
//! Q = Σ a_ij E_ii E_jj + 4 Σ s_ij E_ij² over i < j,  E = ½ (FeᵀFe − I)
//!
//! The directions i are along the tube, outwards and around it. Without s_ij = (a_ii + a_jj − 2 a_ij)/4 of its own, the
//! shear stiffness is that with which the law is isotropic where the a_ij are.
//!
//! Valid for c > 0 and a positive definite form Q. The form is convex in E, not in Fe: under compression the law may lose
//! ellipticity.

use super::{Law, Moduli, ModuliData, NeoHookean, Volumetric};
use crate::tensor::{Real, Tensor2};

/// Fung's orthotropic law. Directions are in the order along, outwards, around.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fung {
    /// Stiffness c, with the unit of a stress.
    pub c: f64,
    /// Coefficients a_ij, symmetric.
    pub a: [[f64; 3]; 3],
    /// Coefficients s_ij of the shear between the directions (0, 1), (0, 2) and (1, 2).
    pub shear: [f64; 3],
    /// Constant K of the volumetric energy.
    pub bulk: f64,
}

/// The pairs of directions.
const PAIRS: [(usize, usize); 3] = [(0, 1), (0, 2), (1, 2)];

impl Fung {
    /// Creates a law with the shear stiffness that follows from the other coefficients.
    pub fn new(c: f64, a: [[f64; 3]; 3], bulk: f64) -> Self {
        let shear = PAIRS.map(|(i, j)| 0.25 * (a[i][i] + a[j][j] - 2.0 * a[i][j]));
        Self { c, a, shear, bulk }
    }

    /// Returns the shear modulus in the plane of the wall at small strains, c s.
    pub fn shear_modulus(&self) -> f64 {
        self.c * self.shear[1]
    }

    /// Returns whether Q is positive definite in the strains along and around. If there are coefficients of the strain
    /// outwards, it is required in all three; without them the volumetric energy bears that strain.
    pub fn is_positive_definite(&self) -> bool {
        let a = &self.a;
        let plane = a[0][0] * a[2][2] - a[0][2] * a[0][2];
        let in_plane = a[0][0] > 0.0 && a[2][2] > 0.0 && plane > 0.0;
        let radial = [a[0][1], a[1][1], a[1][2]];
        let whole = Tensor2(*a).determinant();
        let shear = self.shear.iter().all(|s| *s > 0.0);
        in_plane && shear && (radial == [0.0; 3] || whole > 0.0)
    }

    fn volumetric(&self) -> NeoHookean {
        NeoHookean {
            mu: 0.0,
            lambda: self.bulk,
            volumetric: Volumetric::Quadratic,
        }
    }

    /// Returns c exp(Q), and B = ½ ∂Q/∂E.
    #[inline(always)]
    fn strained<S: Real>(&self, F: &Tensor2<S>) -> (S, [[S; 3]; 3], S) {
        let zero = F.0[0][0].like(0.0);
        let mut E = F.transpose().times(*F).0;
        for i in 0..3 {
            E[i][i] = E[i][i] - zero.like(1.0);
            for j in 0..3 {
                E[i][j] = E[i][j].times(0.5);
            }
        }
        let mut B = [[zero; 3]; 3];
        for i in 0..3 {
            for j in 0..3 {
                B[i][i] += E[j][j].times(self.a[i][j]);
            }
        }
        for ((i, j), s) in PAIRS.into_iter().zip(self.shear) {
            B[i][j] = E[i][j].times(2.0 * s);
            B[j][i] = B[i][j];
        }
        let Q = Tensor2(E).dot(Tensor2(B));
        (Q.exp().times(self.c), B, Q)
    }
}

impl Law for Fung {
    type TangentData = ModuliData;

    #[inline(always)]
    fn energy<S: Real>(&self, F: &Tensor2<S>) -> S {
        let (stiffness, ..) = self.strained(F);
        let shape = (stiffness - stiffness.like(self.c)).times(0.5);
        shape + self.volumetric().energy(F)
    }

    // P = c exp(Q) F B + ∂U/∂F
    #[inline(always)]
    fn stress<S: Real>(&self, F: &Tensor2<S>) -> Tensor2<S> {
        let (stiffness, B, _) = self.strained(F);
        let mut P = self.volumetric().stress(F);
        let G = F.times(Tensor2(B));
        for i in 0..3 {
            for k in 0..3 {
                P.0[i][k] = stiffness.mul_add(G.0[i][k], P.0[i][k]);
            }
        }
        P
    }

    // A_{jk il} = c exp(Q) (δ_ij B_kl + 2 G_jk G_il + a_kl F_jk F_il
    //           + δ_kl Σ_{m ≠ k} s_mk F_jm F_im + [k ≠ l] s_kl F_jl F_ik) + ∂²U/∂F∂F,  G = F B
    #[inline(always)]
    fn moduli<S: Real>(&self, F: &Tensor2<S>) -> Moduli<S> {
        let (stiffness, B, _) = self.strained(F);
        let G = F.times(Tensor2(B)).0;
        let F0 = &F.0;
        let mut s = [[0.0; 3]; 3];
        for ((i, j), own) in PAIRS.into_iter().zip(self.shear) {
            (s[i][j], s[j][i]) = (own, own);
        }
        let mut A = self.volumetric().moduli(F);
        for k in 0..3 {
            for l in k..3 {
                for j in 0..3 {
                    for i in 0..3 {
                        let mut sum = (G[j][k] * G[i][l]).times(2.0);
                        sum += (F0[j][k] * F0[i][l]).times(self.a[k][l]);
                        if i == j {
                            sum += B[k][l];
                        }
                        if k == l {
                            for m in 0..3 {
                                sum += (F0[j][m] * F0[i][m]).times(s[m][k]);
                            }
                        } else {
                            sum += (F0[j][l] * F0[i][k]).times(s[k][l]);
                        }
                        let entry = &mut A[3 * k + j][3 * l + i];
                        *entry = stiffness.mul_add(sum, *entry);
                    }
                }
            }
        }
        A
    }
}
