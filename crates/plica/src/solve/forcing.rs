//! The accuracy to which the linear system of a step is solved.

/// Accuracy of the first step, and the lowest of all.
const LARGEST: f64 = 0.1;
/// γ of Eisenstat and Walker.
const GAMMA: f64 = 0.9;
/// Residual that the last step may leave, over the tolerance.
const LAST: f64 = 0.5;

/// Forcing terms η that decrease with the residual, so that no system is solved more accurately than
/// the linearisation is: choice 2 of Eisenstat and Walker (1996), η = γ (|Rₙ|/|Rₙ₋₁|)², with their
/// safeguard at every step, and never smaller than the last step needs.
#[derive(Clone, Debug)]
pub(super) struct Forcing {
    tolerance: f64,
    /// η of the step before, and the residual at its start.
    before: Option<(f64, f64)>,
}

impl Forcing {
    /// Takes the tolerance of the residual.
    pub fn new(tolerance: f64) -> Self {
        Self {
            tolerance,
            before: None,
        }
    }

    /// Returns the accuracy of the step that starts at this residual.
    pub fn accuracy(&mut self, residual: f64) -> f64 {
        let mut eta = LARGEST;
        if let Some((eta_before, residual_before)) = self.before {
            let ratio: f64 = residual / residual_before;
            // Safeguard: η is squared at most.
            eta = GAMMA * (ratio * ratio).max(eta_before * eta_before);
        }
        eta = eta.max(LAST * self.tolerance / residual).min(LARGEST);
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
        assert_eq!(forcing.accuracy(1.0), LARGEST);
        // A small decrease asks for a low accuracy.
        assert_eq!(forcing.accuracy(0.8), LARGEST);
        assert!((forcing.accuracy(0.08) - GAMMA * 0.01).abs() < 1e-15);
        // η is squared at most.
        let before = GAMMA * 0.01;
        assert!((forcing.accuracy(1e-4) - GAMMA * before * before).abs() < 1e-15);
        // The last step needs no more.
        assert_eq!(forcing.accuracy(1e-7), LAST * 1e-8 / 1e-7);
        assert_eq!(forcing.accuracy(1.1e-8), LARGEST);
    }
}
