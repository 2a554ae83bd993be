//! A small tube, plan and state for tests.

use plica::assembly::SplineTube;
use plica::material::{Material, NeoHookean};
use plica::saved_state::SavedState;
use plica::study::{Output, Plan};
use plica::tube::{Mesh, Support, Symmetry, Tube, WallLayer};

/// A tube of length D with free ends and without muscles.
pub fn short() -> Tube {
    Tube {
        length: 1.0,
        thickness: 0.1,
        layers: vec![WallLayer::of(Material::NeoHookean(NeoHookean::new(
            1.0, 0.3,
        )))],
        muscles: vec![],
        ends: [Support::Free; 2],
        imperfections: vec![],
        obstacles: vec![],
        patches: vec![],
        foundations: vec![],
    }
}

/// A coarse cubic mesh: 6 control points along, 12 around, 4 through the wall.
pub fn coarse() -> Mesh {
    Mesh {
        axial: 6,
        around: 12,
        thickness: 4,
        degree: 3,
        refinements: vec![],
        grading: 1.0,
        contact_range: 0.25,
        volumetric: Default::default(),
        layers: vec![],
    }
}

/// A plan of the small tube with a symmetry and without stages.
pub fn plan(symmetry: Symmetry) -> Plan {
    Plan {
        title: String::new(),
        tube: short(),
        mesh: coarse(),
        symmetry,
        contact: false,
        friction: 0.0,
        start: None,
        modes: vec![],
        materials: vec![],
        stages: vec![],
        following: None,
        solver: Default::default(),
        output: Output::default(),
        units: None,
        end_names: Plan::usual_end_names(),
    }
}

/// A state of the tube of a plan that widens along the axis and twists, proportional to `row`.
pub fn state(plan: &Plan, row: usize) -> SavedState {
    let tube = SplineTube::new(&plan.tube, &plan.mesh, plan.mesh.rings(plan.symmetry));
    let factor = row as f64;
    SavedState {
        stage: String::new(),
        row,
        along: 0.0,
        obstacles: vec![],
        patches: vec![],
        muscles: vec![],
        load: plan.tube.rest(),
        layout: plan.layout(),
        u: tube.control_values_from(|z, r, _| {
            [0.1 * z * z, 0.2 * z * r, 0.3 * z * r].map(|x| x * factor)
        }),
        arrays: Default::default(),
    }
}
