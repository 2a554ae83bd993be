//! Ends that leave their axis.

use super::super::problem::Problems;
use super::muscles::ENDS;
use crate::study::Stage;
use crate::tube::{EndMotion, Load, Support, Symmetry};

/// Largest angle of a tilt, in degrees.
const LARGEST: f64 = 180.0;

/// Checks the size of a tilt, in degrees.
pub(super) fn check_tilt(key: &str, tilt: [f64; 2], problems: &mut Problems) {
    if tilt[0].hypot(tilt[1]) > LARGEST {
        let rule = format!("must be a rotation by at most {LARGEST} degrees");
        problems.value(key, rule, "");
    }
}

/// Checks that an end is held in all directions.
pub(super) fn check_support(key: &str, support: Support, problems: &mut Problems) {
    if support != Support::Fixed {
        let rule = "only a fixed end can leave its axis";
        problems.value(key, rule, "write \"fixed\" in [ends]");
    }
}

/// Checks that the symmetry allows ends to leave their axis.
pub(super) fn check(symmetry: Symmetry, stages: &[Stage], problems: &mut Problems) {
    if symmetry == Symmetry::None || !problems.are_sound(&["symmetry", "start"]) {
        return;
    }
    for (i, stage) in stages.iter().enumerate() {
        let sideways = |load: &Load| load.ends.iter().position(EndMotion::is_sideways);
        let Some(end) = stage.loads().find_map(sideways) else {
            continue;
        };
        let rule = "an end leaves its axis only in a tube without symmetry";
        let key = format!("stages[{}].drive.{}", i + 1, ENDS[end]);
        return problems.key(&key, rule, "write symmetry = \"none\"");
    }
}
