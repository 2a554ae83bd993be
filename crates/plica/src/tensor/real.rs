//! A real number, alone or eight at a time.

use fearless_simd::{Simd, SimdBase, SimdFloat, SimdFrom, f64x8};
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// Numbers that sit side by side in a vector.
pub const LANES: usize = 8;

/// What the formulas of the kernels need of a number.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
{
    /// A plain number, in every lane of a number like this one.
    fn like(self, value: f64) -> Self;
    /// `self · b + c`, fused where the processor can.
    fn mul_add(self, b: Self, c: Self) -> Self;
    /// Natural logarithm, lane by lane.
    fn ln(self) -> Self;
    /// `self` times a plain number.
    fn times(self, factor: f64) -> Self;
}

impl Real for f64 {
    #[inline(always)]
    fn like(self, value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        f64::mul_add(self, b, c)
    }
    #[inline(always)]
    fn ln(self) -> Self {
        f64::ln(self)
    }
    #[inline(always)]
    fn times(self, factor: f64) -> Self {
        self * factor
    }
}

impl<S: Simd> Real for f64x8<S> {
    #[inline(always)]
    fn like(self, value: f64) -> Self {
        Self::splat(self.simd, value)
    }
    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        SimdFloat::mul_add(self, b, c)
    }
    #[inline(always)]
    fn ln(self) -> Self {
        let mut x = <[f64; LANES]>::from(self);
        for x in &mut x {
            *x = x.ln();
        }
        Self::simd_from(self.simd, x)
    }
    #[inline(always)]
    fn times(self, factor: f64) -> Self {
        self * factor
    }
}

/// Eight numbers at rest in a table, one per element of a pack.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(align(64))]
pub struct Lanes(pub [f64; LANES]);

impl Lanes {
    /// The numbers in vector registers.
    #[inline(always)]
    pub fn load<S: Simd>(&self, simd: S) -> f64x8<S> {
        f64x8::simd_from(simd, self.0)
    }

    /// The numbers of a vector, at rest.
    #[inline(always)]
    pub fn store<S: Simd>(vector: f64x8<S>) -> Self {
        Self(vector.into())
    }

    /// The smallest; NaN if any is NaN, so that a bad element cannot hide.
    #[inline(always)]
    pub fn min(self) -> f64 {
        let mut min = self.0[0];
        for &x in &self.0[1..] {
            min = if min.is_nan() || x >= min { min } else { x };
        }
        min
    }

    /// All added up, first to last.
    #[inline(always)]
    pub fn sum(self) -> f64 {
        self.0.iter().sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_nan_lane_is_the_smallest() {
        let mut x = Lanes([1.0; LANES]);
        x.0[3] = f64::NAN;
        assert!(x.min().is_nan());
        x.0[3] = -2.0;
        assert_eq!(x.min(), -2.0);
        assert_eq!(x.sum(), 5.0);
    }
}
