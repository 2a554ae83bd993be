//! The state that a case starts from, and the load it brings.

use super::super::keys::join;
use super::super::problem::Problems;
use super::super::spec::Spec;
use super::super::{Open, Wanted};
use super::stages::{check_closed, check_held, check_stretch};
use crate::activation::Direction;
use crate::saved_state::{Layout, SavedState};
use crate::study::Start;
use crate::tube::{Load, Mesh, Symmetry, Tube};

const KEY: &str = "start.state";
/// What writing a length down and reading it may do to it.
const ROUNDING: f64 = 1e-12;

/// The state that a case names, if it can be one of the case's tube and symmetry.
pub(super) fn start(
    spec: &Spec,
    tube: &Tube,
    mesh: &Mesh,
    symmetry: Symmetry,
    open: &Open<'_>,
    problems: &mut Problems,
) -> Option<Start> {
    if !problems.none_about(&[KEY]) {
        return None;
    }
    let file = spec.start.as_ref()?.state.clone();
    let state = match open(Wanted::State(&file)) {
        Ok(state) => state,
        Err(error) => {
            let cure =
                "give the path of a run's states/state-NNNN.safetensors, from the case file on";
            problems.value(KEY, error.to_string(), Some(cure.into()));
            return None;
        }
    };
    // What is wrong with the tube itself comes first.
    if !problems.none_about(&["tube", "muscles", "ends", "mesh", "symmetry"]) {
        return None;
    }
    let before = problems.len();
    check_size(KEY, &state, tube, problems);
    check_symmetry(&state.layout, mesh, symmetry, problems);
    let load = load(&state, tube, problems)?;
    (problems.len() == before).then_some(Start { file, load, state })
}

/// Whether a state, or a mode, is of a tube of this size.
pub(super) fn check_size(key: &str, state: &SavedState, tube: &Tube, problems: &mut Problems) {
    let Layout {
        length, thickness, ..
    } = state.layout;
    let sizes = [
        ("long", length, tube.length),
        ("thick", thickness, tube.thickness),
    ];
    for (what, found, expected) in sizes {
        if (found - expected).abs() > ROUNDING * expected {
            let rule =
                format!("is of a tube {found} D {what}, and this one is {expected} D {what}");
            problems.value(key, rule, None);
        }
    }
}

/// The state repeats around the tube; the case may ask for as often, or less often.
fn check_symmetry(from: &Layout, mesh: &Mesh, symmetry: Symmetry, problems: &mut Problems) {
    let (had, wanted) = (
        from.mesh.around / from.rings,
        mesh.around / mesh.rings(symmetry),
    );
    if from.rings > 1 && (symmetry == Symmetry::Axisymmetric || !had.is_multiple_of(wanted)) {
        let has = match had {
            1 => "repeats nowhere around its tube".to_owned(),
            m => format!("repeats {m} times around its tube"),
        };
        let rule = format!("{has}, and cannot take the symmetry of this case");
        let cure =
            "symmetry = \"none\" takes any state, fold = m one that repeats a multiple of m times";
        problems.value(KEY, rule, Some(cure.into()));
    }
}

/// The load of a state on the muscles and ends of a tube.
fn load(state: &SavedState, tube: &Tube, problems: &mut Problems) -> Option<Load> {
    let before = problems.len();
    let mut load = tube.rest();
    for ((name, direction), &ratio) in state.muscles.iter().zip(&state.load.muscles) {
        let same = |m: &&crate::activation::Muscle| m.name == *name && m.direction == *direction;
        match tube.muscles.iter().find(same) {
            Some(muscle) => check_stretch(KEY, muscle, ratio, tube, problems),
            None if ratio == 1.0 => {}
            None => {
                let kind = match direction {
                    Direction::Circular => "circular",
                    Direction::Longitudinal => "longitudinal",
                };
                let rule = format!(
                    "is under a {kind} muscle {name} driven to {ratio}, and this case has none of \
                     that name and direction"
                );
                let cure = match tube.muscles.iter().any(|m| m.name == *name) {
                    true => format!("write direction = \"{kind}\" in [muscles.{name}]"),
                    false => format!("add [{}]", join("muscles", name)),
                };
                problems.value(KEY, rule, Some(cure));
            }
        }
        if let Some(m) = tube.muscles.iter().position(|m| same(&m)) {
            load.muscles[m] = ratio;
        }
    }
    load.ends = state.load.ends;
    for (motion, support) in load.ends.iter().zip(tube.ends) {
        if motion.displacement != 0.0 {
            check_held(KEY, "displacement", support, problems);
        }
        if motion.twist != 0.0 {
            check_held(KEY, "twist_degrees", support, problems);
        }
    }
    load.pressures = state.load.pressures;
    if load.pressures.iter().any(|p| p.follower != 0.0) {
        check_closed(KEY, tube, problems);
    }
    (problems.len() == before).then_some(load)
}
