//! A family of fibres (Holzapfel et al. 2000; with dispersion Gasser et al. 2006):
//!
//! w = k₁/(2 k₂) (exp(k₂ ⟨E⟩²) − 1),  E = κ (I₁ − 3) + (1 − 3κ) (I₄ − 1),  I₄ = a · FeᵀFe a
//!
//! ⟨E⟩ is E where it is positive, and else zero: fibres bear no compression. The unit vector a lies in the wall, at the
//! angle β from the circumference toward the axis. It refers to the columns of Fe, so that it is a direction of the
//! stress-free wall. The invariants are those of the whole Fe, not of its isochoric part.
//!
//! Valid for k₁ ≥ 0, k₂ ≥ 0 (with k₂ = 0 it is k₁/2 ⟨E⟩²) and 0 ≤ κ ≤ 1/3, where it is convex in Fe: it adds to the
//! ellipticity of the matrix. κ = 0 has no dispersion, and κ = 1/3 is isotropic.

use super::Moduli;
use super::invariant_tangent::Structure;
use crate::tensor::{Real, Tensor2};

/// A family of fibres, a part of the energy of a [`Composite`](super::Composite).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fibres {
    /// Stiffness k₁, with the unit of a stress.
    pub k1: f64,
    /// Stiffening k₂.
    pub k2: f64,
    /// Dispersion κ.
    pub dispersion: f64,
    /// Components of a along the tube and around it.
    direction: [f64; 2],
}

/// ψ(E), dψ/dE and d²ψ/dE², and H with dE = 2 H : dF.
struct Strained<S> {
    psi: [S; 3],
    H: Tensor2<S>,
}

impl Fibres {
    /// Creates a family at an angle β from the circumference, in radians; positive angles turn toward the axis.
    pub fn new([k1, k2]: [f64; 2], dispersion: f64, angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        Self {
            k1,
            k2,
            dispersion,
            direction: [sin, cos],
        }
    }

    /// Returns the unit vector a: its components along, outwards and around.
    pub fn direction(&self) -> [f64; 3] {
        [self.direction[0], 0.0, self.direction[1]]
    }

    /// Returns the family at the angle −β.
    pub fn mirrored(&self) -> Self {
        let [along, around] = self.direction;
        Self {
            direction: [-along, around],
            ..*self
        }
    }

    /// Returns κ I + (1 − 3κ) a ⊗ a.
    #[inline(always)]
    pub(super) fn structure(&self) -> Structure {
        Structure {
            isotropic: self.dispersion,
            directed: 1.0 - 3.0 * self.dispersion,
            direction: self.direction,
        }
    }

    /// Returns 4 ψ″ and 2 ψ′.
    #[inline(always)]
    pub(super) fn derivatives<S: Real>(&self, F: &Tensor2<S>) -> [S; 2] {
        let [_, slope, curvature] = self.strained(F).psi;
        [curvature.times(4.0), slope.times(2.0)]
    }

    #[inline(always)]
    fn strained<S: Real>(&self, F: &Tensor2<S>) -> Strained<S> {
        let ([along, around], k) = (self.direction, self.dispersion);
        let zero = F.0[0][0].like(0.0);
        let mut Fa = [zero; 3];
        let mut H = F.0;
        let mut I4 = zero;
        for i in 0..3 {
            Fa[i] = F.0[i][0].times(along) + F.0[i][2].times(around);
            I4 = Fa[i].mul_add(Fa[i], I4);
            let part = Fa[i].times(1.0 - 3.0 * k);
            H[i] = [
                F.0[i][0].times(k) + part.times(along),
                F.0[i][1].times(k),
                F.0[i][2].times(k) + part.times(around),
            ];
        }
        let I1 = F.dot(*F);
        let E = (I1 - zero.like(3.0)).times(k) + (I4 - zero.like(1.0)).times(1.0 - 3.0 * k);
        let tension = E.when_positive(E);
        let square = tension * tension;
        let one = zero.like(1.0);
        let psi = if self.k2 == 0.0 {
            [
                square.times(0.5 * self.k1),
                tension.times(self.k1),
                one.times(self.k1),
            ]
        } else {
            let (k1, k2) = (self.k1, self.k2);
            let exp = square.times(k2).exp();
            let stiffness = (square.times(2.0 * k2) + one) * exp;
            [
                (exp - one).times(0.5 * k1 / k2),
                (tension * exp).times(k1),
                stiffness.times(k1),
            ]
        };
        Strained {
            psi: [psi[0], psi[1], E.when_positive(psi[2])],
            H: Tensor2(H),
        }
    }

    /// Returns the energy.
    #[inline(always)]
    pub(super) fn energy<S: Real>(&self, F: &Tensor2<S>) -> S {
        self.strained(F).psi[0]
    }

    /// Adds the stress 2 ψ′ H.
    #[inline(always)]
    pub(super) fn add_stress<S: Real>(&self, F: &Tensor2<S>, P: &mut Tensor2<S>) {
        let Strained { psi, H } = self.strained(F);
        let doubled = psi[1].times(2.0);
        for i in 0..3 {
            for k in 0..3 {
                P.0[i][k] = doubled.mul_add(H.0[i][k], P.0[i][k]);
            }
        }
    }

    /// Adds the moduli 4 ψ″ H_jk H_il + 2 ψ′ δ_ij (κ δ_kl + (1 − 3κ) a_k a_l).
    #[inline(always)]
    pub(super) fn add_moduli<S: Real>(&self, F: &Tensor2<S>, A: &mut Moduli<S>) {
        let Strained { psi, H } = self.strained(F);
        let (doubled, curvature) = (psi[1].times(2.0), psi[2].times(4.0));
        let (a, kappa) = (self.direction(), self.dispersion);
        for k in 0..3 {
            for l in k..3 {
                let structure =
                    (1.0 - 3.0 * kappa) * a[k] * a[l] + if k == l { kappa } else { 0.0 };
                let same = doubled.times(structure);
                for j in 0..3 {
                    for i in 0..3 {
                        let entry = &mut A[3 * k + j][3 * l + i];
                        *entry = (curvature * H.0[j][k]).mul_add(H.0[i][l], *entry);
                        if i == j {
                            *entry += same;
                        }
                    }
                }
            }
        }
    }
}
