//! The law of contact: an energy per area that rises without bound as a gap closes. With obstacles it is continued by a
//! parabola, which is bounded ([`Barrier::continued`]).

use crate::spline::Basis;

/// Stiffness of the barrier of a mesh, in E.
const STIFFNESS: f64 = 0.1;

/// Gap below which the barrier of an obstacle continues as a parabola, in ranges.
const CONTINUED: f64 = 0.1;

/// The barrier b(g) = −κ d̂ (s − 1)² ln s with s = g/d̂ for gaps g below the range d̂, else 0 (Li et al.
/// 2020, incremental potential contact). It and its first two derivatives are continuous at d̂.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Barrier {
    /// Range d̂, in D.
    pub range: f64,
    /// Stiffness κ, in E.
    pub stiffness: f64,
}

/// Value and derivatives of a barrier over the gap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BarrierJet {
    /// b, in E·D.
    pub value: f64,
    /// b′ ≤ 0, in E.
    pub slope: f64,
    /// b″ ≥ 0, in E/D.
    pub curvature: f64,
}

impl Barrier {
    /// Returns the barrier of a mesh with a range in smallest elements along the tube.
    pub fn of_mesh(axial: &Basis, range: f64) -> Self {
        let lengths = (0..axial.elements()).map(|e| {
            let (from, to) = axial.element(e);
            to - from
        });
        Self {
            range: range * lengths.fold(f64::INFINITY, f64::min),
            stiffness: STIFFNESS,
        }
    }

    /// Returns the barrier of any gap. Below a tenth of the range, also where bodies overlap, it is the parabola with the
    /// value, slope and curvature at that gap: a state may start inside an obstacle that has moved, and is pushed out.
    pub fn continued(&self, gap: f64) -> BarrierJet {
        let least = CONTINUED * self.range;
        if gap >= least {
            return self.at(gap);
        }
        let (at, h) = (self.at(least), gap - least);
        BarrierJet {
            value: at.value + h * (at.slope + 0.5 * h * at.curvature),
            slope: at.slope + h * at.curvature,
            curvature: at.curvature,
        }
    }

    /// Returns the barrier of a gap between zero and the range.
    pub fn at(&self, gap: f64) -> BarrierJet {
        let s = gap / self.range;
        let (rest, ln) = (s - 1.0, s.ln());
        BarrierJet {
            value: -self.stiffness * self.range * rest * rest * ln,
            slope: -self.stiffness * (2.0 * rest * ln + rest * rest / s),
            curvature: -self.stiffness / self.range
                * (2.0 * ln + 4.0 * rest / s - rest * rest / (s * s)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BARRIER: Barrier = Barrier {
        range: 2e-3,
        stiffness: 0.1,
    };

    #[test]
    fn slope_and_curvature_are_derivatives_of_the_value() {
        for gap in [1e-5, 3e-4, 1e-3, 1.9e-3] {
            let error = |h: f64| {
                let [low, high] = [gap - h, gap + h].map(|g| BARRIER.at(g));
                let at = BARRIER.at(gap);
                let slope = (high.value - low.value) / (2.0 * h) - at.slope;
                let curvature = (high.slope - low.slope) / (2.0 * h) - at.curvature;
                [slope.abs(), curvature.abs()]
            };
            let (wide, narrow) = (error(0.1 * gap), error(0.05 * gap));
            for i in 0..2 {
                let order = (wide[i] / narrow[i]).log2();
                assert!((order - 2.0).abs() < 0.1, "{gap} {i}: order {order}");
            }
        }
    }

    #[test]
    fn a_barrier_continues_smoothly_into_overlap() {
        let least = CONTINUED * BARRIER.range;
        let [below, above] = [-1e-9, 1e-9].map(|h| BARRIER.continued(least + h));
        assert!((below.curvature / above.curvature - 1.0).abs() < 1e-4);
        for gap in [-3e-2, -1e-4, 1e-4] {
            let [low, high] = [gap - 1e-5, gap + 1e-5].map(|g| BARRIER.continued(g));
            let at = BARRIER.continued(gap);
            let slope = (high.value - low.value) / 2e-5;
            assert!((slope / at.slope - 1.0).abs() < 1e-8);
            assert!(((high.slope - low.slope) / 2e-5 / at.curvature - 1.0).abs() < 1e-8);
        }
        let outside = BARRIER.continued(1.5e-3);
        assert_eq!(outside, BARRIER.at(1.5e-3));
    }

    #[test]
    fn the_barrier_repels_and_vanishes_smoothly_at_its_range() {
        for gap in [1e-6, 1e-4, 1e-3, 1.99e-3] {
            let at = BARRIER.at(gap);
            assert!(at.value > 0.0 && at.slope < 0.0 && at.curvature > 0.0);
        }
        let end = BARRIER.at(BARRIER.range);
        assert_eq!(
            [end.value, end.slope, end.curvature].map(f64::abs),
            [0.0; 3]
        );
        // −ln ½ / 4 of κ d̂ at half the range.
        let half = BARRIER.at(1e-3).value;
        assert!((half - 0.1 * 2e-3 * 2.0_f64.ln() / 4.0).abs() < 1e-18);
    }
}
