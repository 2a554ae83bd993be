//! How exactly the linear system of a Newton step is solved.

/// Accuracy of the first step, and the loosest ever.
const LOOSEST: f64 = 0.1;
/// γ of Eisenstat and Walker.
const GAMMA: f64 = 0.9;
/// What the last step may leave, over the tolerance.
const LAST: f64 = 0.5;

/// Accuracies that tighten as the residual falls, so that no step is solved more exactly than the
/// linearisation is worth: choice 2 of Eisenstat and Walker (1996), η = γ (|Rₙ|/|Rₙ₋₁|)², with
/// their safeguard at every step, and never tighter than the last step needs.
#[derive(Clone, Debug)]
pub struct Forcing {
    tolerance: f64,
    /// η of the step before, and the residual that it began from.
    before: Option<(f64, f64)>,
}

impl Forcing {
    /// For residuals that are to fall to `tolerance`.
    pub fn new(tolerance: f64) -> Self {
        Self {
            tolerance,
            before: None,
        }
    }

    /// The accuracy of the step from a state with this residual.
    pub fn accuracy(&mut self, residual: f64) -> f64 {
        let mut eta = LOOSEST;
        if let Some((eta_before, residual_before)) = self.before {
            let ratio: f64 = residual / residual_before;
            // One lucky step does not ask for an exact one: the accuracy is squared at most.
            eta = GAMMA * (ratio * ratio).max(eta_before * eta_before);
        }
        eta = eta.max(LAST * self.tolerance / residual).min(LOOSEST);
        self.before = Some((eta, residual));
        eta
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn accuracy_follows_the_residual_and_stops_at_the_tolerance() {
        let mut forcing = Forcing::new(1e-8);
        assert_eq!(forcing.accuracy(1.0), LOOSEST);
        // Little progress, little accuracy.
        assert_eq!(forcing.accuracy(0.8), LOOSEST);
        assert!((forcing.accuracy(0.08) - GAMMA * 0.01).abs() < 1e-15);
        // A lucky step: no more than squared.
        let before = GAMMA * 0.01;
        assert!((forcing.accuracy(1e-4) - GAMMA * before * before).abs() < 1e-15);
        // No more than the last step needs.
        assert_eq!(forcing.accuracy(1e-7), LAST * 1e-8 / 1e-7);
        assert_eq!(forcing.accuracy(1.1e-8), LOOSEST);
    }
}
