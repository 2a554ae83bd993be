//! What a run tells while it goes on.

use super::Row;

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
