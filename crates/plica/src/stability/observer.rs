//! What a test of stability tells while it goes on.

use super::{Spectrum, Station};
use crate::monitor::Monitor;
use crate::tube::Tube;
use std::cell::RefCell;
use std::fmt::Display;

/// Someone who watches, and may stop it.
pub trait Observer {
    /// A saved state of an axisymmetric run was tested.
    fn tested(&mut self, tube: &Tube, station: &Station);
    /// The lowest eigenpairs of a saved state of a three-dimensional run were found.
    fn found(&mut self, tube: &Tube, spectrum: &Spectrum);
    /// Something else happened that takes time: a sentence, and how far it all is (0 to 1).
    fn working(&mut self, what: &str, fraction: f64);
    /// Asked between solves; if true nothing more is done.
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
    fn is_cancelled(&self) -> bool {
        self.0.borrow_mut().stop()
    }
}
