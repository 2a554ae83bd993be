//! What a test of stability tells while it goes on.

use super::Station;
use crate::tube::Tube;

/// Someone who watches, and may stop it.
pub trait Observer {
    /// A saved state was tested.
    fn tested(&mut self, tube: &Tube, station: &Station);
    /// Something else happened that takes time: a sentence, and how far it all is (0 to 1).
    fn working(&mut self, what: &str, fraction: f64);
    /// Asked between solves; if true nothing more is done.
    fn stop(&mut self) -> bool {
        false
    }
}
