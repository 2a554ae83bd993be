//! Real numbers, alone or eight in a vector.

use fearless_simd::{Bytes, Select, Simd, SimdBase, SimdFloat, SimdFrom, f64x8, i64x8};
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// Numbers in a vector.
pub const LANES: usize = 8;

/// A number, or a vector of numbers, with the operations that the formulas need.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
{
    /// Returns `value` in every lane of a vector like this one.
    fn like(self, value: f64) -> Self;
    /// Returns `self · b + c`, fused where the processor can.
    fn mul_add(self, b: Self, c: Self) -> Self;
    /// Returns the natural logarithm.
    fn ln(self) -> Self;
    /// Returns the exponential function.
    fn exp(self) -> Self;
    /// Returns `value` where this number is positive, else zero.
    fn when_positive(self, value: Self) -> Self;
    /// Returns `self · factor`.
    fn times(self, factor: f64) -> Self;
    /// Returns the numbers of the eight lanes; a single number fills all of them.
    fn to_lanes(self) -> Lanes;
    /// Returns a vector of `lanes` like this one; of a single number, the first lane.
    fn like_lanes(self, lanes: Lanes) -> Self;
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
    fn exp(self) -> Self {
        f64::exp(self)
    }
    #[inline(always)]
    fn when_positive(self, value: Self) -> Self {
        if self > 0.0 { value } else { 0.0 }
    }
    #[inline(always)]
    fn times(self, factor: f64) -> Self {
        self * factor
    }
    #[inline(always)]
    fn to_lanes(self) -> Lanes {
        Lanes([self; LANES])
    }
    #[inline(always)]
    fn like_lanes(self, lanes: Lanes) -> Self {
        lanes.0[0]
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
    // x = 2ᵉ (1 + f) with 1 + f between √½ and √2; ln (1 + f) from the odd series of
    // s = f/(2 + f), with the coefficients of fdlibm's `e_log.c` (error below one unit in the last
    // place). For positive, normal, finite x; otherwise NaN.
    #[inline(always)]
    fn ln(self) -> Self {
        const LN2_HIGH: f64 = 6.931_471_803_691_238e-1;
        const LN2_LOW: f64 = 1.908_214_929_270_587_7e-10;
        const EVEN: [f64; 3] = [
            3.999_999_999_940_942e-1,
            2.222_219_843_214_978_4e-1,
            1.531_383_769_920_937_3e-1,
        ];
        const ODD: [f64; 4] = [
            6.666_666_666_666_735e-1,
            2.857_142_874_366_239e-1,
            1.818_357_216_161_805e-1,
            1.479_819_860_511_658_6e-1,
        ];
        let simd = self.simd;
        let splat = |x: f64| Self::splat(simd, x);
        let bits: i64x8<S> = self.bitcast();
        // Bits of √½, nearly.
        let root = 0x3fe6_a09e_0000_0000_i64;
        let exponent = (bits - i64x8::splat(simd, root)) >> 52;
        let mantissa: Self = (bits - (exponent << 52)).bitcast();
        let e = simd.cvt_f64_i64x8(exponent);
        let f = mantissa - splat(1.0);
        let s = f / (mantissa + splat(1.0));
        let z = s * s;
        let w = z * z;
        let even = Real::mul_add(
            Real::mul_add(splat(EVEN[2]), w, splat(EVEN[1])),
            w,
            splat(EVEN[0]),
        ) * w;
        let odd = Real::mul_add(splat(ODD[3]), w, splat(ODD[2]));
        let odd = Real::mul_add(Real::mul_add(odd, w, splat(ODD[1])), w, splat(ODD[0])) * z;
        let half = f * f * 0.5;
        let small = Real::mul_add(s, half + even + odd, e * LN2_LOW);
        let ln = Real::mul_add(e, splat(LN2_HIGH), f - (half - small));
        let valid = self.simd_gt(splat(0.0)) & self.simd_lt(splat(f64::MAX));
        valid.select(ln, splat(f64::NAN))
    }
    // x = k ln 2 + r with |r| ≤ ½ ln 2, and exp r from the rational function of fdlibm's `e_exp.c` (error below one
    // unit in the last place). Below −708 it is zero.
    #[inline(always)]
    fn exp(self) -> Self {
        const LN2_HIGH: f64 = 6.931_471_803_691_238e-1;
        const LN2_LOW: f64 = 1.908_214_929_270_587_7e-10;
        const P: [f64; 5] = [
            1.666_666_666_666_660_2e-1,
            -2.777_777_777_701_559_3e-3,
            6.613_756_321_437_934e-5,
            -1.653_390_220_546_525_2e-6,
            4.138_136_797_057_238_5e-8,
        ];
        // Adding it rounds a number to an integer, which its last bits then hold.
        const ROUND: f64 = 6_755_399_441_055_744.0;
        const LARGEST: f64 = 709.7;
        const SMALLEST: f64 = -708.0;
        let simd = self.simd;
        let splat = |x: f64| Self::splat(simd, x);
        let rounded = Real::mul_add(self, splat(std::f64::consts::LOG2_E), splat(ROUND));
        let k = rounded - splat(ROUND);
        let high = Real::mul_add(k, splat(-LN2_HIGH), self);
        let low = k * LN2_LOW;
        let r = high - low;
        let t = r * r;
        let mut series = splat(P[4]);
        for p in [P[3], P[2], P[1], P[0]] {
            series = Real::mul_add(series, t, splat(p));
        }
        let c = r - t * series;
        let y = splat(1.0) - ((low - (r * c) / (splat(2.0) - c)) - high);
        let bits: i64x8<S> = y.bitcast();
        let shift: i64x8<S> = rounded.bitcast();
        let shift = (shift - i64x8::splat(simd, ROUND.to_bits() as i64)) << 52;
        let exp: Self = (bits + shift).bitcast();
        let above = self.simd_gt(splat(LARGEST));
        let below = self.simd_lt(splat(SMALLEST));
        let within = self.simd_le(splat(LARGEST)) & self.simd_ge(splat(SMALLEST));
        let outside = above.select(
            splat(f64::INFINITY),
            below.select(splat(0.0), splat(f64::NAN)),
        );
        within.select(exp, outside)
    }
    #[inline(always)]
    fn when_positive(self, value: Self) -> Self {
        let zero = Self::splat(self.simd, 0.0);
        self.simd_gt(zero).select(value, zero)
    }
    #[inline(always)]
    fn times(self, factor: f64) -> Self {
        self * factor
    }
    #[inline(always)]
    fn to_lanes(self) -> Lanes {
        Lanes::store(self)
    }
    #[inline(always)]
    fn like_lanes(self, lanes: Lanes) -> Self {
        lanes.load(self.simd)
    }
}

/// Eight numbers in memory, one per lane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(align(64))]
pub struct Lanes(pub [f64; LANES]);

impl Lanes {
    /// Loads the numbers into a vector.
    #[inline(always)]
    pub fn load<S: Simd>(&self, simd: S) -> f64x8<S> {
        f64x8::simd_from(simd, self.0)
    }

    /// Stores the numbers of a vector.
    #[inline(always)]
    pub fn store<S: Simd>(vector: f64x8<S>) -> Self {
        Self(vector.into())
    }

    /// Returns the smallest number; NaN if any is NaN.
    #[inline(always)]
    pub fn min(self) -> f64 {
        let mut min = self.0[0];
        for &x in &self.0[1..] {
            min = if min.is_nan() || x >= min { min } else { x };
        }
        min
    }

    /// Returns the sum, added from first to last.
    #[inline(always)]
    pub fn sum(self) -> f64 {
        self.0.iter().sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tensor::with_vectors;

    #[test]
    fn the_logarithm_of_a_vector_is_that_of_each_lane() {
        let check = |x: [f64; LANES]| {
            let ln = with_vectors!(simd => {
                <[f64; LANES]>::from(Real::ln(f64x8::simd_from(simd, x)))
            });
            for (ln, x) in ln.iter().zip(x) {
                let exact = x.ln();
                assert!(
                    (ln - exact).abs() <= 2.0 * f64::EPSILON * exact.abs(),
                    "ln {x} = {ln}"
                );
            }
        };
        check([
            1.0,
            0.5,
            2.0,
            1e-300,
            1e300,
            0.5_f64.sqrt() - 1e-6,
            0.5_f64.sqrt() + 1e-6,
            2.0_f64.sqrt(),
        ]);
        for i in 1..2000 {
            let x = f64::from(i) * 1e-3;
            check([
                x,
                1.0 + 1e-5 * x,
                1.0 - 1e-5 * x,
                1.0 + 1e-12 * x,
                3.0 * x,
                x * x,
                1e5 * x,
                0.1 / x,
            ]);
        }
        let invalid = with_vectors!(simd => {
            <[f64; LANES]>::from(Real::ln(f64x8::simd_from(
                simd,
                [0.0, -1.0, f64::NAN, f64::INFINITY, -0.0, -1e-300, -2.0, f64::NEG_INFINITY],
            )))
        });
        assert!(invalid.iter().all(|x| x.is_nan()), "{invalid:?}");
    }

    #[test]
    fn the_exponential_of_a_vector_is_that_of_each_lane() {
        let exp = |x: [f64; LANES]| {
            with_vectors!(simd => {
                <[f64; LANES]>::from(Real::exp(f64x8::simd_from(simd, x)))
            })
        };
        for i in -7000..7000 {
            let x = 0.1 * f64::from(i);
            let x = [
                x,
                x + 0.013,
                1e-3 * x,
                1e-6 * x,
                1e-9 * x,
                1e-17 * x,
                -x,
                0.01 * x,
            ];
            for (found, x) in exp(x).iter().zip(x) {
                let exact = x.exp();
                assert!(
                    (found - exact).abs() <= 2.0 * f64::EPSILON * exact,
                    "exp {x} = {found}"
                );
            }
        }
        let found = exp([
            0.0,
            -0.0,
            710.0,
            f64::INFINITY,
            -709.0,
            f64::NEG_INFINITY,
            -1e9,
            1e9,
        ]);
        let (inf, one) = (f64::INFINITY, 1.0);
        assert_eq!(found, [one, one, inf, inf, 0.0, 0.0, 0.0, inf]);
        assert!(exp([f64::NAN; LANES]).iter().all(|x| x.is_nan()));
    }

    #[test]
    fn a_value_is_kept_where_a_number_is_positive() {
        let x = [
            1.0,
            0.0,
            -1.0,
            f64::NAN,
            1e-300,
            -0.0,
            f64::INFINITY,
            -1e-300,
        ];
        let kept = with_vectors!(simd => {
            let x = f64x8::simd_from(simd, x);
            <[f64; LANES]>::from(Real::when_positive(x, x.like(3.0)))
        });
        assert_eq!(kept, x.map(|x| Real::when_positive(x, 3.0)));
        assert_eq!(kept, [3.0, 0.0, 0.0, 0.0, 3.0, 0.0, 3.0, 0.0]);
    }

    #[test]
    fn the_minimum_of_lanes_with_nan_is_nan() {
        let mut x = Lanes([1.0; LANES]);
        x.0[3] = f64::NAN;
        assert!(x.min().is_nan());
        x.0[3] = -2.0;
        assert_eq!(x.min(), -2.0);
        assert_eq!(x.sum(), 5.0);
    }
}
