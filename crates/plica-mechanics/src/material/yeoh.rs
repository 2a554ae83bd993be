//! Yeoh's law (Yeoh 1993):
//!
//! w = c₁ (I₁ − 3) + c₂ (I₁ − 3)² + c₃ (I₁ − 3)³ − 2 c₁ ln J + K/4 (J² − 1 − 2 ln J)
//!
//! Valid for c₁ > 0. It is elliptic everywhere if c₂ ≥ 0 and c₃ ≥ 0.

use super::first_invariant::{self, FirstInvariant};
use super::{Law, Moduli, ModuliData};
use crate::tensor::{Real, Tensor2};

/// Yeoh's law. All constants have the unit of a stress.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Yeoh {
    /// c₁, c₂ and c₃; the shear modulus at small strains is 2 c₁.
    pub c: [f64; 3],
    /// Constant K of the volumetric energy.
    pub bulk: f64,
}

impl FirstInvariant for Yeoh {
    #[inline(always)]
    fn shape<S: Real>(&self, x: S) -> [S; 3] {
        let [c1, c2, c3] = self.c.map(|c| x.like(c));
        let f = c3.mul_add(x, c2).mul_add(x, c1) * x;
        let slope = c3.times(3.0).mul_add(x, c2.times(2.0)).mul_add(x, c1);
        let curvature = c3.times(6.0).mul_add(x, c2.times(2.0));
        [f, slope, curvature]
    }

    fn shear_modulus(&self) -> f64 {
        2.0 * self.c[0]
    }

    fn bulk(&self) -> f64 {
        self.bulk
    }
}

impl Law for Yeoh {
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
