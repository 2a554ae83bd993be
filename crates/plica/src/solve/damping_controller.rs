//! The damping of relaxation.

/// Largest factor by which the damping increases; that after a step that was rejected.
const INCREASE: f64 = 8.0;
/// Largest and smallest factor by which the damping decreases.
const DECREASE: (f64, f64) = (0.5, 0.05);
/// Ratios of the decrease of the energy to its prediction by the tangent: from the first on the
/// damping decreases, below the second it increases.
const TRUST: (f64, f64) = (0.6, 0.25);
/// Successive accurate solves after which the lower bound of the damping is halved.
const ACCURATE_SOLVES: usize = 5;
/// Damping, in E/D², above which steps are negligible: forces are below E D², so no step is longer
/// than 1e-12 D.
const LARGEST: f64 = 1e12;

/// Controls the damping α of relaxation, in E/D² per unit volume.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DampingController {
    alpha: f64,
    /// Lower bound of α: twice the damping of the last inaccurate linear solve, halved after every
    /// five successive accurate ones.
    floor: f64,
    accurate_solves: usize,
}

/// An accepted step, as the controller judges it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AcceptedStep {
    /// True if the linear solver reached the required accuracy.
    pub accurate: bool,
    /// Fraction of the step that was taken.
    pub length: f64,
    /// Decrease of the energy, divided by the decrease that the tangent predicts.
    pub trust: f64,
    /// Relative residual after the step, divided by that before.
    pub residual_ratio: f64,
}

impl DampingController {
    /// Begins with a damping.
    pub fn new(alpha: f64) -> Self {
        Self {
            alpha,
            floor: 0.0,
            accurate_solves: 0,
        }
    }

    /// Returns α.
    pub fn alpha(&self) -> f64 {
        self.alpha
    }

    /// Returns whether α is so large that steps are negligible.
    pub fn is_exhausted(&self) -> bool {
        self.alpha > LARGEST
    }

    /// Increases α after a step that was rejected: its matrix was not positive definite, or the energy
    /// did not decrease along it.
    pub fn reject(&mut self) {
        self.alpha *= INCREASE;
    }

    /// Increases α by twice the size of a negative curvature d · (K + α C) d / d · C d, which makes
    /// the matrix positive along d.
    pub fn compensate(&mut self, curvature: f64) {
        self.alpha += 2.0 * curvature.abs();
    }

    /// Increases α after only a fraction `length` of a step could be taken.
    pub fn shortened(&mut self, length: f64) {
        if length < 1.0 {
            self.alpha *= increase(length);
        }
    }

    /// Records whether a linear solve reached the required accuracy.
    pub fn solved(&mut self, accurate: bool) {
        if !accurate {
            (self.floor, self.accurate_solves) = (2.0 * self.alpha, 0);
            return;
        }
        self.accurate_solves += 1;
        if self.accurate_solves.is_multiple_of(ACCURATE_SOLVES) {
            self.floor *= 0.5;
        }
    }

    /// Adapts α to an accepted step. If the energy decreased nearly as predicted, α decreases with the
    /// residual (switched evolution relaxation), though not below its floor.
    pub fn accept(&mut self, step: AcceptedStep) {
        self.alpha *= if !step.accurate {
            INCREASE
        } else if step.trust >= TRUST.0 {
            let floor = (self.floor / self.alpha).clamp(DECREASE.1, 1.0);
            step.residual_ratio.clamp(DECREASE.1, DECREASE.0).max(floor)
        } else if step.trust < TRUST.1 {
            increase(step.length)
        } else {
            1.0
        };
    }
}

/// Returns the factor for α after a step of which this fraction was taken, or that was too long as a
/// whole.
fn increase(length: f64) -> f64 {
    (0.5 / length).clamp(2.0, INCREASE)
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: AcceptedStep = AcceptedStep {
        accurate: true,
        length: 1.0,
        trust: 1.0,
        residual_ratio: 0.25,
    };

    fn after(step: AcceptedStep) -> f64 {
        let mut damping = DampingController::new(1.0);
        damping.accept(step);
        damping.alpha()
    }

    #[test]
    fn damping_decreases_with_the_residual_within_bounds() {
        for (residual_ratio, alpha) in [(0.25, 0.25), (0.9, 0.5), (3.0, 0.5), (1e-9, 0.05)] {
            assert_eq!(
                after(AcceptedStep {
                    residual_ratio,
                    ..GOOD
                }),
                alpha
            );
        }
    }

    #[test]
    fn damping_follows_the_trust_in_the_tangent() {
        let of = |trust| after(AcceptedStep { trust, ..GOOD });
        assert_eq!(
            [0.6, 0.59, 0.25, 0.24, 0.0].map(of),
            [0.25, 1.0, 1.0, 2.0, 2.0]
        );
        // A shortened step has no trust; the shorter it was, the larger the increase.
        for (length, alpha) in [(0.5, 2.0), (0.125, 4.0), (0.01, 8.0)] {
            let shortened = AcceptedStep {
                length,
                trust: 0.0,
                ..GOOD
            };
            assert_eq!(after(shortened), alpha);
        }
    }

    #[test]
    fn rejected_and_inaccurate_steps_increase_damping_eightfold() {
        let mut damping = DampingController::new(3.0);
        damping.reject();
        assert_eq!(damping.alpha(), 24.0);
        assert_eq!(
            after(AcceptedStep {
                accurate: false,
                ..GOOD
            }),
            8.0
        );
    }

    #[test]
    fn negative_curvature_is_compensated_twice() {
        let mut damping = DampingController::new(1.0);
        damping.compensate(-0.75);
        damping.shortened(1.0);
        assert_eq!(damping.alpha(), 2.5);
        damping.shortened(0.25);
        assert_eq!(damping.alpha(), 5.0);
    }

    #[test]
    fn damping_stays_above_twice_that_of_an_inaccurate_solve() {
        let mut damping = DampingController::new(1.0);
        damping.solved(false);
        damping.accept(AcceptedStep {
            accurate: false,
            ..GOOD
        });
        let mut alphas = vec![damping.alpha()];
        for _ in 0..6 {
            damping.solved(true);
            damping.accept(GOOD);
            alphas.push(damping.alpha());
        }
        // The floor of 2 is halved at the fifth accurate solve.
        assert_eq!(alphas, [8.0, 2.0, 2.0, 2.0, 2.0, 1.0, 1.0]);
    }

    #[test]
    fn damping_is_exhausted_beyond_its_largest_value() {
        assert!(!DampingController::new(1e12).is_exhausted());
        assert!(DampingController::new(1.1e12).is_exhausted());
    }
}
