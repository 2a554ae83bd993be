//! What a test of stability tells while it goes on.

use super::{Spectrum, Station};
use crate::tube::Tube;

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
