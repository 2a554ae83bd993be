//! Demiray's law (Demiray 1972), exponential in I₁:
//!
//! w = μ/(2b) (exp(b (I₁ − 3)) − 1) − μ ln J + K/4 (J² − 1 − 2 ln J)
//!
//! Elliptic for μ > 0, b > 0 and K ≥ 0.

use super::first_invariant::{self, FirstInvariant};
use super::{Law, Moduli, ModuliData};
use crate::tensor::{Real, Tensor2};

/// Demiray's law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Demiray {
    /// Shear modulus μ at small strains.
    pub shear_modulus: f64,
    /// Stiffening b.
    pub stiffening: f64,
    /// Constant K of the volumetric energy.
    pub bulk: f64,
}

impl FirstInvariant for Demiray {
    #[inline(always)]
    fn shape<S: Real>(&self, x: S) -> [S; 3] {
        let (mu, b) = (self.shear_modulus, self.stiffening);
        let exp = x.times(b).exp();
        let slope = exp.times(0.5 * mu);
        let f = (exp - exp.like(1.0)).times(0.5 * mu / b);
        [f, slope, slope.times(b)]
    }

    fn shear_modulus(&self) -> f64 {
        self.shear_modulus
    }

    fn bulk(&self) -> f64 {
        self.bulk
    }
}

impl Law for Demiray {
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
