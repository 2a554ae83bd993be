//! Progress of a long computation, and the request to cancel it.

use std::fmt::Display;

/// Receives the progress of a long computation and may cancel it.
///
/// Every method has a default that does nothing, so `()` is a monitor that never cancels.
pub trait Monitor {
    /// Reports the current activity and the completed fraction of the whole computation, 0 to 1.
    ///
    /// Called after every linear solve and between steps.
    fn working(&mut self, activity: &dyn Display, fraction: f64) {
        let _ = (activity, fraction);
    }

    /// Reports something that the user should know although the computation goes on.
    fn notice(&mut self, message: &str) {
        let _ = message;
    }

    /// Returns whether the computation should stop as soon as it can.
    ///
    /// Called after every iteration, also inside linear solves; it must be cheap. Once it has
    /// returned true it must go on doing so.
    fn is_cancelled(&self) -> bool {
        false
    }
}

impl Monitor for () {}

/// A monitor of a part of a computation: it prefixes activities and maps fractions of the part to
/// fractions of the whole.
pub struct Part<'a> {
    whole: &'a mut dyn Monitor,
    prefix: String,
    start: f64,
    length: f64,
}

impl<'a> Part<'a> {
    /// Returns a monitor of the part of `whole` from the fraction `start` on, of the given length.
    pub fn new(
        whole: &'a mut dyn Monitor,
        prefix: impl Into<String>,
        start: f64,
        length: f64,
    ) -> Self {
        Self {
            whole,
            prefix: prefix.into(),
            start,
            length,
        }
    }
}

impl Monitor for Part<'_> {
    fn working(&mut self, activity: &dyn Display, fraction: f64) {
        let activity = format_args!("{}: {activity}", self.prefix);
        self.whole
            .working(&activity, self.start + self.length * fraction);
    }

    fn notice(&mut self, message: &str) {
        self.whole.notice(message);
    }

    fn is_cancelled(&self) -> bool {
        self.whole.is_cancelled()
    }
}
