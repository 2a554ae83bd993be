//! Distribution of the activity of a muscle over its zone.

use std::f64::consts::PI;

/// A profile s(x) over the zone, x from 0 to 1; s is between 0 and 1.
#[derive(Clone, Debug, PartialEq)]
pub enum Profile {
    /// ½ (1 − cos 2πx): smooth at both edges. The paper says "sinusoidal"; this profile has the
    /// energy minimum of its Fig. 4A.
    RaisedCosine,
    /// sin πx: with a kink at both edges.
    HalfSine,
    /// One, with a raised-cosine rise and fall at either end of the zone.
    SmoothBox {
        /// Fraction of the zone over which it rises, and over which it falls; at most ½.
        edge: f64,
    },
    /// Linear interpolation between points (x, s), x rising from 0 to 1.
    Table(Vec<(f64, f64)>),
}

impl Profile {
    /// Returns s(x) for x in [0, 1].
    pub fn value(&self, x: f64) -> f64 {
        match self {
            Self::RaisedCosine => 0.5 * (1.0 - (2.0 * PI * x).cos()),
            Self::HalfSine => (PI * x).sin(),
            Self::SmoothBox { edge } => {
                let from_end = x.min(1.0 - x).max(0.0);
                if from_end >= *edge {
                    1.0
                } else {
                    0.5 * (1.0 - (PI * from_end / edge).cos())
                }
            }
            Self::Table(points) => {
                let next = points
                    .partition_point(|p| p.0 <= x)
                    .clamp(1, points.len() - 1);
                let ((x0, s0), (x1, s1)) = (points[next - 1], points[next]);
                s0 + (s1 - s0) * (x - x0) / (x1 - x0)
            }
        }
    }

    /// Returns ∫ s dx over [0, 1].
    pub fn integral(&self) -> f64 {
        match self {
            Self::RaisedCosine => 0.5,
            Self::HalfSine => 2.0 / PI,
            Self::SmoothBox { edge } => 1.0 - edge,
            Self::Table(points) => points
                .windows(2)
                .map(|w| 0.5 * (w[0].1 + w[1].1) * (w[1].0 - w[0].0))
                .sum(),
        }
    }

    /// Returns the largest value of s.
    pub fn largest(&self) -> f64 {
        match self {
            Self::Table(points) => points.iter().fold(0.0, |m: f64, p| m.max(p.1)),
            _ => 1.0,
        }
    }

    /// Returns the positions in (0, 1) where the profile is not smooth: elements should end there.
    pub fn kinks(&self) -> Vec<f64> {
        match self {
            Self::RaisedCosine | Self::HalfSine => vec![],
            Self::SmoothBox { edge } => vec![*edge, 1.0 - edge],
            Self::Table(points) => points[1..points.len() - 1].iter().map(|p| p.0).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all() -> [Profile; 4] {
        [
            Profile::RaisedCosine,
            Profile::HalfSine,
            Profile::SmoothBox { edge: 0.25 },
            Profile::Table(vec![(0.0, 0.0), (0.25, 0.5), (0.75, 0.1), (1.0, 0.2)]),
        ]
    }

    #[test]
    fn profiles_have_their_values() {
        let half = 0.5_f64.sqrt();
        let at = [0.0, 0.125, 0.25, 0.5, 0.875, 1.0];
        for (profile, expected) in all().iter().zip([
            [0.0, 0.5 - 0.5 * half, 0.5, 1.0, 0.5 - 0.5 * half, 0.0],
            [0.0, (PI / 8.0).sin(), half, 1.0, (PI / 8.0).sin(), 0.0],
            [0.0, 0.5, 1.0, 1.0, 0.5, 0.0],
            [0.0, 0.25, 0.5, 0.3, 0.15, 0.2],
        ]) {
            for (x, expected) in at.into_iter().zip(expected) {
                let found = profile.value(x);
                assert!((found - expected).abs() < 1e-15, "{profile:?} {x}: {found}");
            }
        }
        // Beyond the zone only rounding occurs.
        let smooth = Profile::SmoothBox { edge: 0.25 };
        assert_eq!([smooth.value(-1e-17), smooth.value(1.0 + 1e-16)], [0.0; 2]);
    }

    #[test]
    fn integral_and_largest_value_are_those_of_the_profile() {
        for profile in all() {
            let n = 40_000;
            let values: Vec<f64> = (0..n)
                .map(|i| profile.value((f64::from(i) + 0.5) / f64::from(n)))
                .collect();
            let mean = values.iter().sum::<f64>() / f64::from(n);
            assert!((profile.integral() - mean).abs() < 1e-8, "{profile:?}");
            let largest = values.iter().copied().fold(0.0, f64::max);
            assert!((profile.largest() - largest).abs() < 1e-4, "{profile:?}");
        }
    }

    #[test]
    fn kinks_are_the_inner_points_where_the_slope_or_the_curvature_jumps() {
        let kinks = all().map(|profile| profile.kinks());
        assert_eq!(kinks, [vec![], vec![], vec![0.25, 0.75], vec![0.25, 0.75]]);
        assert!(
            Profile::Table(vec![(0.0, 1.0), (1.0, 0.0)])
                .kinks()
                .is_empty()
        );
    }
}
