//! Active tension over the stretch of muscle cells, relative to the largest, and its integral.

use crate::tensor::{Lanes, Real};
use std::f64::consts::FRAC_2_SQRT_PI;

/// Relation between the stretch λ of muscle cells and their nominal stress, as a fraction f of the tension T.
#[derive(Clone, Debug, PartialEq)]
pub enum LengthTension {
    /// f = 1.
    Constant,
    /// f = 1 − ((λM − λ)/(λM − λ0))² where that is positive, and else zero (Rachev and Hayashi 1999).
    Rachev {
        /// λM.
        best: f64,
        /// λ0, below λM.
        least: f64,
    },
    /// f = exp(−(λ − λM)²/(2 b²)).
    Gaussian {
        /// λM.
        best: f64,
        /// Width b.
        width: f64,
    },
    /// Linear interpolation between points (λ, f), λ rising; constant beyond them.
    Table(Vec<[f64; 2]>),
}

impl LengthTension {
    /// Returns the stretch beyond which the tension falls, so that its energy is not convex.
    pub fn falls_beyond(&self) -> Option<f64> {
        match self {
            Self::Constant => None,
            Self::Rachev { best, .. } | Self::Gaussian { best, .. } => Some(*best),
            Self::Table(points) => {
                let falls = |pair: &&[[f64; 2]]| pair[1][1] < pair[0][1];
                points.windows(2).find(falls).map(|pair| pair[0][0])
            }
        }
    }

    /// Returns ∫ f dλ from 1 to λ, f and f′.
    #[inline(always)]
    pub(super) fn at<S: Real>(&self, stretch: S) -> [S; 3] {
        match self {
            Self::Constant => {
                let one = stretch.like(1.0);
                [stretch - one, one, stretch.like(0.0)]
            }
            Self::Rachev { best, least } => rachev(*best, *least, stretch),
            Self::Gaussian { best, width } => {
                by_lane(stretch, |stretch| gaussian(*best, *width, stretch))
            }
            Self::Table(points) => by_lane(stretch, |stretch| table(points, stretch)),
        }
    }
}

/// Evaluates numbers one by one.
fn by_lane<S: Real>(x: S, f: impl Fn(f64) -> [f64; 3]) -> [S; 3] {
    let values = x.to_lanes().0.map(f);
    [0, 1, 2].map(|n| x.like_lanes(Lanes(values.map(|value| value[n]))))
}

#[inline(always)]
fn rachev<S: Real>(best: f64, least: f64, stretch: S) -> [S; 3] {
    let range = best - least;
    // x = (λM − λ)/(λM − λ0) between −1 and 1, where f > 0: ∫ f dλ = (λM − λ0) (2/3 − x + x³/3) from λ0 on.
    let one = stretch.like(1.0);
    let scaled = |stretch: S| (stretch.like(best) - stretch).times(1.0 / range);
    let clamped = |x: S| {
        let above = (x - one).when_positive(x - one);
        let below = (-one - x).when_positive(-one - x);
        x - above + below
    };
    let integral = |x: S| {
        let cube = x * x * x;
        (one.times(2.0 / 3.0) - x + cube.times(1.0 / 3.0)).times(range)
    };
    let x = scaled(stretch);
    let inside = (one - x * x).when_positive(one);
    let x = clamped(x);
    let rest = integral(clamped(scaled(one)));
    [
        integral(x) - rest,
        one - x * x,
        inside * x.times(2.0 / range),
    ]
}

fn gaussian(best: f64, width: f64, stretch: f64) -> [f64; 3] {
    let scaled = |stretch: f64| (stretch - best) / width;
    let x = scaled(stretch);
    let f = (-0.5 * x * x).exp();
    // ∫ exp(−x²/2) dx = √(π/2) erf(x/√2)
    let factor = width / (FRAC_2_SQRT_PI * std::f64::consts::FRAC_1_SQRT_2);
    let integral = |x: f64| factor * libm::erf(x * std::f64::consts::FRAC_1_SQRT_2);
    [integral(x) - integral(scaled(1.0)), f, -f * x / width]
}

fn table(points: &[[f64; 2]], stretch: f64) -> [f64; 3] {
    let (first, last) = (points[0], points[points.len() - 1]);
    // ∫ f from the first point on.
    let integral = |x: f64| {
        let mut sum = (x - first[0]).min(0.0) * first[1] + (x - last[0]).max(0.0) * last[1];
        for pair in points.windows(2) {
            let [[a, f], [b, g]] = [pair[0], pair[1]];
            let part = x.clamp(a, b) - a;
            sum += part * (f + 0.5 * (g - f) / (b - a) * part);
        }
        sum
    };
    let (f, slope) = if stretch < first[0] {
        (first[1], 0.0)
    } else if stretch >= last[0] {
        (last[1], 0.0)
    } else {
        let next = points.partition_point(|point| point[0] <= stretch);
        let [[a, f], [b, g]] = [points[next - 1], points[next]];
        let slope = (g - f) / (b - a);
        (f + slope * (stretch - a), slope)
    };
    [integral(stretch) - integral(1.0), f, slope]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_relation_has_its_values_and_derivatives() {
        let points = vec![[0.5, 0.0], [1.2, 1.0], [1.6, 0.4]];
        for (relation, at, f, falls) in [
            (LengthTension::Constant, 1.3, 1.0, None),
            (
                LengthTension::Rachev {
                    best: 1.4,
                    least: 0.8,
                },
                1.1,
                0.75,
                Some(1.4),
            ),
            (
                LengthTension::Gaussian {
                    best: 1.1,
                    width: 0.2,
                },
                1.3,
                (-0.5_f64).exp(),
                Some(1.1),
            ),
            (LengthTension::Table(points.clone()), 1.4, 0.7, Some(1.2)),
            (LengthTension::Table(points.clone()), 0.3, 0.0, Some(1.2)),
            (LengthTension::Table(points), 2.0, 0.4, Some(1.2)),
        ] {
            let own = |x: f64| relation.at(x);
            assert!((own(at)[1] - f).abs() < 1e-14, "{relation:?}");
            assert!(own(1.0)[0].abs() < 1e-15 && relation.falls_beyond() == falls);
            for x in [0.45, 0.9, 1.0, 1.13, 1.33, 1.7] {
                let h = 1e-6;
                let slope = |n: usize| (own(x + h)[n] - own(x - h)[n]) / (2.0 * h);
                for n in [0, 1] {
                    let off = slope(n) - own(x)[n + 1];
                    assert!(off.abs() < 1e-8, "{relation:?} at {x}: {off}");
                }
            }
        }
    }
}
