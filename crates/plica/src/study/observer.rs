//! What a run tells while it goes on.

use super::Row;
use crate::monitor::Monitor;
use std::cell::RefCell;
use std::fmt::Display;

/// Someone who watches a run, and may stop it. The library itself never prints.
pub trait Observer {
    /// A state was accepted.
    fn accepted(&mut self, row: &Row);
    /// Something else happened that takes time: a sentence, and how far the run is (0 to 1).
    fn working(&mut self, what: &str, fraction: f64);
    /// Something that whoever watches should know.
    fn noticed(&mut self, _what: &str) {}
    /// Asked between solves; if true the run ends after the last accepted state.
    fn stop(&mut self) -> bool {
        false
    }
}

/// An observer as a monitor.
pub(super) struct Relay<'a>(RefCell<&'a mut dyn Observer>);

impl<'a> Relay<'a> {
    pub fn new(observer: &'a mut dyn Observer) -> Self {
        Self(RefCell::new(observer))
    }
}

impl Monitor for Relay<'_> {
    fn working(&mut self, activity: &dyn Display, fraction: f64) {
        self.0.get_mut().working(&activity.to_string(), fraction);
    }
    fn notice(&mut self, message: &str) {
        self.0.get_mut().noticed(message);
    }
    fn is_cancelled(&self) -> bool {
        self.0.borrow_mut().stop()
    }
}
