//! The saved state that a case starts from, and its load.

use super::super::files::{Input, InputFile, OpenInput};
use super::super::key::join;
use super::super::keys::{Case, Scheme};
use super::super::problem::Problems;
use super::sideways::check_support;
use super::stages::{check_closed, check_held, check_stretch};
use super::zone::{ROUNDING, length};
use crate::activation::{Muscle, MuscleTarget};
use crate::saved_state::{Layout, SavedState};
use crate::study::Start;
use crate::tube::{Load, Mesh, Obstacle, Patch, Symmetry, Tube};

const KEY: &str = "start.state";

/// Reads the state that a case names, if it fits the tube and the symmetry of the case.
pub(super) fn start(
    case: &Case,
    tube: &Tube,
    mesh: &Mesh,
    symmetry: Symmetry,
    open: &OpenInput<'_>,
    problems: &mut Problems,
) -> Option<Start> {
    let file = case.start.as_ref()?.state.clone();
    if !problems.are_sound(&["start"]) {
        return None;
    }
    let state = match open(InputFile::State(&file)).and_then(Input::state) {
        Ok(state) => state,
        Err(error) => {
            let help = "give the path of states/state-NNNN.safetensors of a run, relative to the case file";
            problems.value(KEY, error.to_string(), help);
            return None;
        }
    };
    if !problems.are_sound(&["tube", "muscles", "ends", "mesh", "symmetry"]) {
        return None;
    }
    let before = problems.len();
    check_size(KEY, &state, case, tube, problems);
    check_layers(KEY, &state.layout, tube, problems);
    check_symmetry(&state.layout, mesh, symmetry, problems);
    let mut load = load(&state, tube, problems);
    if !matches!(case.solver.scheme, Scheme::Static) {
        // The pressure holds the volume as well.
        load.lumen_volume = None;
    }
    (problems.len() == before).then_some(Start { file, load, state })
}

/// Checks that a state, or a mode, belongs to a tube of the same length and thickness.
pub(super) fn check_size(
    key: &str,
    state: &SavedState,
    case: &Case,
    tube: &Tube,
    problems: &mut Problems,
) {
    let layout = &state.layout;
    let sizes = [
        ("long", layout.length, tube.length),
        ("thick", layout.thickness, tube.thickness),
    ];
    for (what, found, expected) in sizes {
        if (found - expected).abs() > ROUNDING * expected {
            let [found, expected] = [found, expected].map(|x| match &case.units {
                Some(_) => length(case, x),
                None => format!("{x} D"),
            });
            let rule = format!("its tube is {found} {what}, and this one is {expected} {what}");
            problems.value(key, rule, "");
        }
    }
}

/// Checks that a state, or a mode, has the layers of the wall.
pub(super) fn check_layers(key: &str, layout: &Layout, tube: &Tube, problems: &mut Problems) {
    let shares = |of: &[f64]| match of.len() {
        0 | 1 => "one layer".to_owned(),
        n => format!("{n} layers, with {of:?} of its thickness"),
    };
    let found: Vec<f64> = layout.mesh.layers.iter().map(|layer| layer.share).collect();
    let expected: Vec<f64> = tube.layers.iter().map(|layer| layer.share).collect();
    let [count, needed] = [&found, &expected].map(|shares| shares.len().max(1));
    let pairs = found.iter().zip(&expected);
    let same = pairs.fold(true, |same, (a, b)| same && (a - b).abs() < 1e-9);
    if count != needed || !same {
        let (found, expected) = (shares(&found), shares(&expected));
        let rule = format!("its wall has {found}, and this one has {expected}");
        problems.value(key, rule, "");
    }
}

/// Checks that a state repeats around the tube as often as the case demands, or a multiple of it.
fn check_symmetry(from: &Layout, mesh: &Mesh, symmetry: Symmetry, problems: &mut Problems) {
    let (has, needs) = (
        from.mesh.around / from.rings,
        mesh.around / mesh.rings(symmetry),
    );
    if from.rings > 1 && (symmetry == Symmetry::Axisymmetric || !has.is_multiple_of(needs)) {
        let has = match has {
            1 => "has no symmetry".to_owned(),
            m => format!("repeats {m} times around its tube"),
        };
        let rule = format!("{has}, which does not fit the symmetry of this case");
        let help = "use symmetry = \"none\", or a fold that divides that of the state";
        problems.value(KEY, rule, help);
    }
}

/// Returns the load of a state on the muscles, ends and surfaces of the tube.
fn load(state: &SavedState, tube: &Tube, problems: &mut Problems) -> Load {
    let mut load = tube.rest();
    let drives = state.load.muscles.iter().zip(&state.load.shifts);
    for ((name, target), (&ratio, &shift)) in state.muscles.iter().zip(drives) {
        let same = |m: &Muscle| m.name == *name && m.target() == *target;
        if let Some(m) = tube.muscles.iter().position(same) {
            check_stretch(KEY, &tube.muscles[m], ratio, tube, problems);
            (load.muscles[m], load.shifts[m]) = (ratio, shift);
        } else if ratio != target.at_rest() {
            let (kind, written) = match target {
                MuscleTarget::DiameterRatio => ("circular muscle", "direction = \"circular\""),
                MuscleTarget::LengthRatio => {
                    ("longitudinal muscle", "direction = \"longitudinal\"")
                }
                MuscleTarget::Tension => ("muscle with active stress", "active_stress = {}"),
            };
            let rule = format!(
                "its {kind} {name} is driven to {ratio}, and this case has no muscle of \
                 that name and direction"
            );
            let help = match tube.muscles.iter().any(|m| m.name == *name) {
                true => format!("write {written} in [muscles.{name}]"),
                false => format!("add [{}]", join("muscles", name)),
            };
            problems.value(KEY, rule, help);
        }
    }
    for (name, placement) in state.obstacles.iter().zip(&state.load.obstacles) {
        let same = |obstacle: &Obstacle| obstacle.name == *name;
        if let Some(i) = tube.obstacles.iter().position(same) {
            load.obstacles[i] = *placement;
        }
    }
    for (name, &growth) in state.patches.iter().zip(&state.load.patches) {
        let same = |patch: &Patch| patch.name == *name;
        if let Some(i) = tube.patches.iter().position(same) {
            load.patches[i] = growth;
        } else if growth != 1.0 {
            let rule = format!(
                "its patch {name} has grown to {growth}, and this case has no patch of that name"
            );
            problems.value(KEY, rule, "add it to [[patches]]");
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
        if motion.is_sideways() {
            check_support(KEY, support, problems);
        }
    }
    load.pressures = state.load.pressures;
    load.lumen_volume = state.load.lumen_volume;
    if load
        .pressures
        .iter()
        .any(|pressure| pressure.follower != 0.0)
    {
        check_closed(KEY, tube, problems);
    }
    load
}
