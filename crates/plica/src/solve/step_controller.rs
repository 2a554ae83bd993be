//! The subdivision of a step of the path.

/// Halvings of a step before relaxation is tried.
const NEWTON_HALVINGS: usize = 5;

/// Divides a step of the path into 2^level equal parts, of which some are done. A failure halves the
/// parts; whenever an accepted part completes a pair, the parts are doubled again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct StepController {
    begin: f64,
    target: f64,
    level: usize,
    max_level: usize,
    done: u64,
}

impl StepController {
    /// Divides the step from `begin` to `target` into 2^`level` parts.
    pub fn new([begin, target]: [f64; 2], level: usize, max_level: usize) -> Self {
        Self {
            begin,
            target,
            level,
            max_level,
            done: 0,
        }
    }

    /// Returns the end of the next part, or None if the step is complete.
    pub fn next(&self) -> Option<f64> {
        let (next, parts) = (self.done + 1, 1_u64 << self.level);
        if next > parts {
            None
        } else if next == parts {
            Some(self.target)
        } else {
            let whole = self.target - self.begin;
            Some(self.begin + whole * next as f64 / parts as f64)
        }
    }

    /// Returns how often the step is halved.
    pub fn level(&self) -> usize {
        self.level
    }

    /// Returns whether a part at which Newton fails is halved before relaxation is tried.
    pub fn halves_before_relaxation(&self) -> bool {
        self.level < NEWTON_HALVINGS.min(self.max_level)
    }

    /// Completes a part.
    pub fn accept(&mut self) {
        self.done += 1;
        if self.level > 0 && self.done.is_multiple_of(2) {
            (self.level, self.done) = (self.level - 1, self.done / 2);
        }
    }

    /// Halves the parts and returns true, or returns false if they may not be halved further.
    pub fn halve(&mut self) -> bool {
        let may_halve = self.level < self.max_level;
        if may_halve {
            (self.level, self.done) = (self.level + 1, 2 * self.done);
        }
        may_halve
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_undivided_step_ends_at_its_target() {
        let mut step = StepController::new([0.25, 0.75], 0, 8);
        assert_eq!(step.next(), Some(0.75));
        step.accept();
        assert_eq!((step.next(), step.level()), (None, 0));
    }

    #[test]
    fn parts_are_halved_on_failure_and_doubled_after_each_pair() {
        let mut step = StepController::new([0.0, 1.0], 0, 8);
        assert!(step.halve() && step.halve());
        let mut way = vec![];
        while let Some(t) = step.next() {
            way.push((t, step.level()));
            step.accept();
        }
        assert_eq!(way, [(0.25, 2), (0.5, 2), (1.0, 1)]);
        assert_eq!(step.level(), 0);
    }

    #[test]
    fn a_failure_within_a_step_keeps_the_accepted_parts() {
        let mut step = StepController::new([0.0, 1.0], 1, 8);
        step.accept();
        assert_eq!(step.next(), Some(1.0));
        assert!(step.halve());
        assert_eq!((step.next(), step.level()), (Some(0.75), 2));
        step.accept();
        assert_eq!((step.next(), step.level()), (Some(1.0), 2));
    }

    #[test]
    fn a_step_is_halved_max_level_times_and_no_more() {
        for max_level in [0, 3, 8] {
            let mut step = StepController::new([0.0, 1.0], 0, max_level);
            let halvings = std::iter::repeat_with(|| step.halve()).take_while(|&h| h);
            assert_eq!(halvings.count(), max_level);
            assert_eq!(step.next(), Some(0.5_f64.powi(max_level as i32)));
        }
    }

    #[test]
    fn relaxation_is_tried_from_the_fifth_halving_or_the_last_on() {
        for (max_level, first) in [(8, 5), (5, 5), (3, 3), (0, 0)] {
            let halves = |level| {
                StepController::new([0.0, 1.0], level, max_level).halves_before_relaxation()
            };
            assert_eq!((0..9).position(|level| !halves(level)), Some(first));
        }
    }
}
