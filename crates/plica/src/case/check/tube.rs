//! The size of the tube, its wall and its ends.

use super::super::keys::Case;
use super::super::problem::Problems;
use super::layers::{layers, whole_thickness};
use super::muscles::muscles;
use super::patches::{foundations, patches};
use super::zone::{length, tidy};
use crate::tube::Tube;

/// Returns the tube without its imperfections, dimensionless.
pub(super) fn tube(case: &Case, problems: &mut Problems) -> Tube {
    let diameter = case.tube.diameter;
    let length = case.tube.length.map_or(3.0, |x| x / diameter);
    let thickness = whole_thickness(case, problems);
    if problems.are_sound(&["tube.thickness", "tube.diameter", "layers"]) {
        if thickness >= 0.5 {
            let rule = format!(
                "must be below half the diameter, {}",
                self::length(case, 0.5)
            );
            let help = format!("try {}", tidy(0.06 * diameter));
            problems.value("tube.thickness", rule, help);
        } else if thickness < 1e-3 {
            let rule = format!(
                "must be at least a thousandth of the diameter, {} (a thinner wall is a shell)",
                self::length(case, 1e-3)
            );
            problems.value("tube.thickness", rule, "");
        }
    }
    if problems.are_sound(&["tube.length", "tube.diameter"]) && !(0.01..=1000.0).contains(&length) {
        let (low, high) = (tidy(0.01 * diameter), self::length(case, 1000.0));
        let rule = format!("must be from 0.01 to 1000 diameters, {low} to {high}");
        let help = format!("try {}", tidy(3.0 * diameter));
        problems.value("tube.length", rule, help);
    }
    let muscles = muscles(case, length, problems);
    let tube = Tube {
        length,
        thickness,
        layers: layers(case, thickness, &muscles, problems),
        muscles,
        ends: [case.ends.colon, case.ends.ileum],
        imperfections: vec![],
        obstacles: vec![],
        patches: vec![],
        foundations: vec![],
    };
    Tube {
        patches: patches(case, &tube, problems),
        foundations: foundations(case, &tube, problems),
        ..tube
    }
}
