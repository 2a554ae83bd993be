//! A real number, alone or eight at a time.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// Numbers that sit side by side in one [`Lanes`].
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
    + SubAssign
    + Send
    + Sync
    + 'static
{
    /// The same value in every lane.
    fn splat(value: f64) -> Self;
    /// `self · b + c`, rounded once.
    fn mul_add(self, b: Self, c: Self) -> Self;
    /// Natural logarithm, lane by lane.
    fn ln(self) -> Self;
    /// Zero.
    #[inline(always)]
    fn zero() -> Self {
        Self::splat(0.0)
    }
}

impl Real for f64 {
    #[inline(always)]
    fn splat(value: f64) -> Self {
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
}

/// Eight numbers, one per element of a pack; plain arrays that the compiler keeps in vector
/// registers.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(64))]
pub struct Lanes(pub [f64; LANES]);

impl Default for Lanes {
    fn default() -> Self {
        Self([0.0; LANES])
    }
}

impl Lanes {
    /// The smallest lane; NaN if any lane is NaN, so that a bad element cannot hide.
    pub fn min(self) -> f64 {
        self.0.iter().fold(
            f64::INFINITY,
            |m, &x| if m.is_nan() || x >= m { m } else { x },
        )
    }
    /// The lanes added up, first to last.
    pub fn sum(self) -> f64 {
        self.0.iter().sum()
    }
}

macro_rules! lane_by_lane {
    ($trait:ident, $method:ident, $op:tt) => {
        impl $trait for Lanes {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                let mut out = self;
                for l in 0..LANES {
                    out.0[l] = self.0[l] $op other.0[l];
                }
                out
            }
        }
    };
}
lane_by_lane!(Add, add, +);
lane_by_lane!(Sub, sub, -);
lane_by_lane!(Mul, mul, *);
lane_by_lane!(Div, div, /);

impl Neg for Lanes {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        let mut out = self;
        for l in 0..LANES {
            out.0[l] = -self.0[l];
        }
        out
    }
}
impl AddAssign for Lanes {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
impl SubAssign for Lanes {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Real for Lanes {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self([value; LANES])
    }
    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        let mut out = self;
        for l in 0..LANES {
            out.0[l] = f64::mul_add(self.0[l], b.0[l], c.0[l]);
        }
        out
    }
    #[inline(always)]
    fn ln(self) -> Self {
        let mut out = self;
        for l in 0..LANES {
            out.0[l] = f64::ln(self.0[l]);
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_nan_lane_is_the_smallest() {
        let mut x = Lanes::splat(1.0);
        x.0[3] = f64::NAN;
        assert!(x.min().is_nan());
        x.0[3] = -2.0;
        assert_eq!(x.min(), -2.0);
        assert_eq!(x.sum(), 5.0);
    }
}
