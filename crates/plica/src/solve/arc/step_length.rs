//! The length of steps along a branch.

/// Corrections of a step that is long enough.
const AIM: f64 = 4.0;
/// Angle between the tangents of two points at which a step is long enough, in degrees.
const AIMED_ANGLE: f64 = 8.0;
/// Largest angle between the tangents of two points, in degrees.
const LARGEST_ANGLE: f64 = 15.0;

/// Chooses the lengths of steps: short where many corrections are needed, and where the branch bends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct StepLength {
    /// Length of the next step.
    pub length: f64,
    /// Shortest length.
    pub shortest: f64,
    /// Longest length.
    pub longest: f64,
}

impl StepLength {
    /// Returns whether the angle between tangents permits a step; the shortest may bend by any angle up to a right one.
    pub fn permits(&self, degrees: f64) -> bool {
        let largest = match self.length > self.shortest {
            true => LARGEST_ANGLE,
            false => 90.0,
        };
        degrees <= largest
    }

    /// Halves the length. Returns false if it was the shortest.
    pub fn shorten(&mut self) -> bool {
        let more = self.length > self.shortest;
        self.length = (0.5 * self.length).max(self.shortest);
        more
    }

    /// Chooses the length of the step after one that took some corrections and bent by an angle in degrees.
    pub fn accept(&mut self, corrections: usize, degrees: f64) {
        let by_corrections = 2.0_f64.powf((AIM - corrections as f64) / 3.0);
        let by_angle = AIMED_ANGLE / degrees.max(1e-3);
        let factor = by_corrections.min(by_angle).clamp(0.5, 2.0);
        self.length = (factor * self.length).clamp(self.shortest, self.longest);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(length: f64) -> StepLength {
        StepLength {
            length,
            shortest: 0.1,
            longest: 10.0,
        }
    }

    fn after(corrections: usize, degrees: f64) -> f64 {
        let mut step = of(1.0);
        step.accept(corrections, degrees);
        step.length
    }

    #[test]
    fn steps_shrink_with_corrections_and_with_the_angle() {
        assert_eq!(after(4, 1.0), 1.0);
        assert_eq!(after(1, 1.0), 2.0);
        assert_eq!(after(7, 1.0), 0.5);
        assert_eq!(after(1, 8.0), 1.0);
        assert_eq!(after(1, 10.0), 0.8);
        assert_eq!(after(0, 0.0), 2.0);
        assert_eq!(after(99, 90.0), 0.5);
    }

    #[test]
    fn lengths_stay_within_their_bounds() {
        let mut step = of(0.15);
        assert!(!step.permits(20.0) && step.permits(15.0));
        assert!(step.shorten());
        assert_eq!(step.length, 0.1);
        assert!(!step.shorten());
        assert!(step.permits(20.0) && !step.permits(91.0));
        let mut step = of(9.0);
        step.accept(1, 1.0);
        assert_eq!(step.length, 10.0);
    }
}
