//! Line searches, judged by the energy.

use super::equilibrium::ResidualEvaluation;

/// Fraction of the linearly predicted decrease of the energy that Armijo's condition requires.
const ARMIJO: f64 = 1e-4;
/// Largest and smallest factor by which one trial shortens a step.
const SHORTENING: (f64, f64) = (0.5, 0.1);
/// Largest displacement of a relaxation step, in D. A nearly singular tangent gives arbitrarily long
/// steps, which may lead to another equilibrium than the nearest.
pub(super) const LONGEST: f64 = 0.1;

/// Rule by which a line search accepts or shortens a step. Lengths are fractions of the whole step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LineSearch {
    /// Armijo's condition with halving, for Newton's method.
    Armijo,
    /// Any decrease of the energy, with a parabola that predicts the next length; for relaxation.
    Decrease,
}

impl LineSearch {
    /// Largest number of lengths that are tried.
    pub fn trials(self) -> usize {
        match self {
            Self::Armijo => 8,
            Self::Decrease => 5,
        }
    }

    /// Returns the first length to try.
    pub fn first_length(self, step: &[f64]) -> f64 {
        match self {
            Self::Armijo => 1.0,
            Self::Decrease => (LONGEST / largest(step)).min(1.0),
        }
    }

    /// Returns whether a step of this length may be taken; `slope` is R · Δu of the whole step.
    pub fn accepts(
        self,
        from: &ResidualEvaluation,
        to: &ResidualEvaluation,
        prescribed: &[bool],
        length: f64,
        slope: f64,
    ) -> bool {
        match self {
            Self::Armijo => to.energy <= from.energy + ARMIJO * length * slope + from.rounding,
            // Where rounding hides the decrease of the energy, the residual must decrease.
            Self::Decrease => {
                to.energy < from.energy - from.rounding
                    || (to.energy <= from.energy + from.rounding
                        && to.relative_residual(prescribed) < from.relative_residual(prescribed))
            }
        }
    }

    /// Returns the factor by which to shorten a rejected step whose energy is `rise` above that of the
    /// start.
    pub fn shortening(self, rise: f64, length: f64, slope: f64) -> f64 {
        match self {
            Self::Armijo => 0.5,
            // Minimum of the parabola with the slope at the start and the value at the end. The order
            // of `min` and `max` maps NaN to the largest factor.
            Self::Decrease => (-0.5 * slope * length / (rise - length * slope))
                .min(SHORTENING.0)
                .max(SHORTENING.1),
        }
    }
}

/// Returns the largest entry of a step in size.
pub(super) fn largest(step: &[f64]) -> f64 {
    step.iter().fold(0.0, |most, x| most.max(x.abs()))
}

#[cfg(test)]
mod tests {
    use super::LineSearch::{Armijo, Decrease};
    use super::*;

    fn evaluation(energy: f64, residual: f64) -> ResidualEvaluation {
        ResidualEvaluation {
            energy,
            residual: vec![residual],
            residual_scale: 1.0,
            rounding: 1e-9,
        }
    }

    fn accepts(rule: LineSearch, to: f64, residual: f64, length: f64) -> bool {
        let (from, to) = (evaluation(1.0, 1.0), evaluation(to, residual));
        rule.accepts(&from, &to, &[false], length, -1.0)
    }

    #[test]
    fn armijo_requires_a_fraction_of_the_predicted_decrease() {
        assert!(accepts(Armijo, 1.0 - 1.01e-4, 1.0, 1.0));
        for energy in [1.0 - 0.99e-4, 1.0, 1.0 + 0.99e-4, f64::NAN] {
            assert!(!accepts(Armijo, energy, 0.0, 1.0), "{energy}");
        }
        // A step of half the length predicts half the decrease.
        assert!(accepts(Armijo, 1.0 - 0.51e-4, 1.0, 0.5));
        assert!(!accepts(Armijo, 1.0 - 0.49e-4, 1.0, 0.5));
    }

    #[test]
    fn relaxation_accepts_no_rise_of_the_energy_beyond_rounding() {
        assert!(accepts(Decrease, 1.0 - 1.1e-9, 2.0, 1.0));
        // Within rounding the residual decides.
        for energy in [1.0 - 0.9e-9, 1.0, 1.0 + 0.9e-9] {
            assert!(accepts(Decrease, energy, 0.9, 1.0), "{energy}");
            assert!(!accepts(Decrease, energy, 1.0, 1.0), "{energy}");
        }
        assert!(!accepts(Decrease, 1.0 + 1.1e-9, 0.0, 1.0));
        assert!(!accepts(Decrease, f64::NAN, 0.0, 1.0));
    }

    #[test]
    fn steps_are_shortened_by_the_parabola_within_bounds() {
        assert_eq!(Armijo.shortening(7.0, 1.0, -1.0), 0.5);
        // 2 s² − s has its minimum at 1/4 and the value 1 at 1.
        assert_eq!(Decrease.shortening(1.0, 1.0, -1.0), 0.25);
        assert_eq!(Decrease.shortening(0.0, 1.0, -1.0), 0.5);
        assert_eq!(Decrease.shortening(100.0, 1.0, -1.0), 0.1);
        assert_eq!(Decrease.shortening(f64::NAN, 1.0, -1.0), 0.5);
    }

    #[test]
    fn only_relaxation_limits_the_displacement() {
        assert_eq!(Armijo.first_length(&[0.0, -5.0]), 1.0);
        assert_eq!(Decrease.first_length(&[0.1, -0.4]), 0.25);
        assert_eq!(Decrease.first_length(&[0.01]), 1.0);
    }
}
