//! A small plan and its states for tests.

use super::{Output, Plan};
use crate::assembly::SplineTube;
use crate::saved_state::SavedState;
use crate::tube::{Symmetry, fixture};

/// The small tube of [`fixture`] under a symmetry, without stages.
pub fn plan(symmetry: Symmetry) -> Plan {
    Plan {
        title: String::new(),
        tube: fixture::short(),
        mesh: fixture::coarse(),
        symmetry,
        contact: false,
        start: None,
        modes: vec![],
        stages: vec![],
        solver: Default::default(),
        output: Output::default(),
        units: None,
        end_names: Plan::usual_end_names(),
    }
}

/// A state of a plan's tube that is wider along it, and twisted, the more so the later.
pub fn state(plan: &Plan, row: usize) -> SavedState {
    let tube = SplineTube::new(&plan.tube, &plan.mesh, plan.mesh.rings(plan.symmetry));
    let late = row as f64;
    SavedState {
        stage: String::new(),
        row,
        along: 0.0,
        muscles: vec![],
        load: plan.tube.rest(),
        layout: plan.layout(),
        u: tube.control_values_from(|z, r, _| {
            [0.1 * z * z, 0.2 * z * r, 0.3 * z * r].map(|x| x * late)
        }),
        arrays: Default::default(),
    }
}
