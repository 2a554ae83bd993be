//! States from which a run follows the branch of a circumferential mode.

use super::{Follow, SpecialPoint};
use crate::assembly::SplineTube;
use crate::equilibrium::prolong;
use crate::saved_state::SavedState;

/// Returns the state of a special point with its circumferential mode m ≥ 1 added at an amplitude, in D, on the rings of a
/// tube that repeats m times (m = 1: of the whole tube); none if the mode is not known, or m does not divide the rings.
pub fn start_state(follow: &Follow, point: &SpecialPoint, amplitude: f64) -> Option<SavedState> {
    let (harmonic, shape) = point.mode.as_ref().filter(|(harmonic, _)| *harmonic > 0)?;
    let plan = follow.plan();
    if !plan.mesh.around.is_multiple_of(*harmonic) {
        return None;
    }
    let rings = plan.mesh.around / harmonic;
    let tube = SplineTube::new(&plan.tube, &plan.mesh, rings);
    let from = SplineTube::new(&plan.tube, &plan.mesh, 1);
    let mut u = prolong(&from, &tube, &point.state.u);
    for (i, x) in shape.iter().enumerate() {
        for ring in 0..rings {
            let wave = *harmonic as f64 * tube.sector.ring_angle(ring);
            // (z cos mφ, r cos mφ, −θ sin mφ)
            let factor = if i % 3 == 2 { -wave.sin() } else { wave.cos() };
            u[rings * i + ring] += amplitude * factor * x;
        }
    }
    let mut state = point.state.clone();
    state.layout.rings = rings;
    state.u = u;
    Some(state)
}
