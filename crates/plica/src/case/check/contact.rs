//! Rules of contact of the wall with itself.

use super::super::keys::Case;
use super::super::problem::Problems;
use crate::activation::Muscle;
use crate::material::Tone;
use crate::study::Stage;
use crate::tube::{Load, Symmetry, Tube, WallLayer};

const CONTACT: &str = "contact";

/// Checks that the splines of a tube with contact are smooth, and that it is not twisted if it is axisymmetric.
pub(super) fn check(
    case: &Case,
    symmetry: Symmetry,
    tube: &Tube,
    stages: &[Stage],
    problems: &mut Problems,
) {
    if !case.contact {
        if case.friction > 0.0 && problems.are_sound(&["friction"]) {
            let help = "set `contact = true`; an obstacle has a `friction` of its own";
            problems.value("friction", "must be 0 without contact of the wall", help);
        }
        return;
    }
    if case.mesh.degree < 2 && problems.are_sound(&["mesh.degree"]) {
        let help = "set `mesh.degree` to 2 or more, or `contact = false`";
        problems.value(
            CONTACT,
            "must be false if `mesh.degree` is 1, where a wall has corners",
            help,
        );
    }
    if symmetry != Symmetry::Axisymmetric {
        if case.friction > 0.0 && problems.are_sound(&["friction", "symmetry"]) {
            let help = "set `friction = 0.0`, or `symmetry = \"axisymmetric\"`";
            let rule = "must be 0 unless `symmetry` is \"axisymmetric\"";
            problems.value("friction", rule, help);
        }
        return;
    }
    let symmetric = |layer: &WallLayer| layer.material.is_mirror_symmetric();
    let acts_straight = |muscle: &Muscle| {
        let tone = muscle.active_stress.as_ref();
        tone.is_none_or(Tone::is_mirror_symmetric)
    };
    let rule = "must be false if fibres of one hand twist the tube";
    if problems.are_sound(&["layers", "muscles"]) {
        if !tube.layers.iter().all(symmetric) {
            let help =
                "set `contact = false`, or give the fibres of each layer their mirror images";
            problems.value(CONTACT, rule, help);
        } else if !tube.muscles.iter().all(acts_straight) {
            let help = "set `contact = false`, or `active_stress.angle_degrees` of each muscle to 0, 90 or -90";
            problems.value(CONTACT, rule, help);
        }
    }
    let twists = |load: &Load| load.ends.iter().any(|end| end.twist != 0.0);
    if stages.iter().flat_map(Stage::loads).any(twists) {
        let help = "set `contact = false`, leave the ends untwisted, or set `symmetry = \"none\"`";
        problems.value(
            CONTACT,
            "must be false if an end of an axisymmetric tube is twisted",
            help,
        );
    }
}
