//! Gent's law (Gent 1996), with a limit of the extension:
//!
//! w = −μ/2 j ln(1 − (I₁ − 3)/j) − μ ln J + K/4 (J² − 1 − 2 ln J)
//!
//! Elliptic where I₁ < 3 + j, the limit, for μ > 0 and K ≥ 0. Beyond it the energy does not exist: it is NaN.

use super::first_invariant::{self, FirstInvariant};
use super::{Law, Moduli, ModuliData};
use crate::tensor::{Real, Tensor2};

/// Gent's law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gent {
    /// Shear modulus μ at small strains.
    pub shear_modulus: f64,
    /// Limit j of I₁ − 3.
    pub limit: f64,
    /// Constant K of the volumetric energy.
    pub bulk: f64,
}

impl FirstInvariant for Gent {
    #[inline(always)]
    fn shape<S: Real>(&self, x: S) -> [S; 3] {
        let (mu, limit) = (self.shear_modulus, self.limit);
        let left = x.like(1.0) - x.times(1.0 / limit);
        let slope = x.like(0.5 * mu) / left;
        let f = left.ln().times(-0.5 * mu * limit);
        [f, slope, (slope / left).times(1.0 / limit)]
    }

    fn shear_modulus(&self) -> f64 {
        self.shear_modulus
    }

    fn bulk(&self) -> f64 {
        self.bulk
    }
}

impl Law for Gent {
    type TangentData = ModuliData;

    #[inline(always)]
    fn energy<S: Real>(&self, F: &Tensor2<S>) -> S {
        first_invariant::energy(self, F)
    }

    #[inline(always)]
    fn stress<S: Real>(&self, F: &Tensor2<S>) -> Tensor2<S> {
        first_invariant::stress(self, F)
    }

    #[inline(always)]
    fn moduli<S: Real>(&self, F: &Tensor2<S>) -> Moduli<S> {
        first_invariant::moduli(self, F)
    }
}
