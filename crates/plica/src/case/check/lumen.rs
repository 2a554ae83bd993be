//! The driven volume of the lumen.

use super::super::course::Course;
use super::super::keys::{Case, Drive, Scheme};
use super::super::problem::Problems;
use super::muscles::ENDS;
use crate::study::{Stage, lumen_volume_at_rest};
use crate::tube::{Load, Mesh, Part, Support, Symmetry, Tube};
use std::f64::consts::PI;

/// The name of the lumen in a stage.
pub(super) const LUMEN: &str = "lumen";
/// Its targets.
pub(super) const TARGETS: [&str; 2] = ["volume_ratio", "volume"];
/// Largest volume over that at rest.
const LARGEST: f64 = 1e4;
/// Smallest volume over that at rest.
const SMALLEST: f64 = 1e-3;

/// Returns the volume of the lumen at rest, in D³, if a stage gives a volume.
pub(super) fn volume_at_rest(
    case: &Case,
    tube: &Tube,
    (mesh, symmetry): (&Mesh, Symmetry),
    problems: &Problems<'_>,
) -> f64 {
    let is_given = |drive: &Drive| drive.volume.is_some();
    let given = case
        .stages
        .iter()
        .any(|stage| stage.drive.values().any(is_given));
    let varies = tube
        .imperfections
        .iter()
        .any(|one| one.of == Part::Geometry);
    let sound = problems.are_sound(&[
        "imperfections",
        "tube",
        "mesh",
        "symmetry",
        "muscles",
        "layers",
    ]);
    if given && varies && sound {
        return lumen_volume_at_rest(tube, mesh, symmetry);
    }
    PI * tube.inner_radius().powi(2) * tube.length
}

/// Returns the volume over that at rest of a target of the lumen. `at_rest` is the volume at rest.
pub(super) fn ratio((target, value): (&str, f64), case: &Case, at_rest: f64) -> f64 {
    match target {
        "volume" => value / case.tube.diameter.powi(3) / at_rest,
        _ => value,
    }
}

/// Checks a target of the lumen, of which the course is over the volume at rest.
pub(super) fn check_target(
    key: &str,
    target: &str,
    course: &Course,
    (case, tube): (&Case, &Tube),
    problems: &mut Problems,
) {
    let is_out = |ratio: f64| !(SMALLEST..=LARGEST).contains(&ratio);
    if target == "volume" && course.values().any(is_out) && problems.are_sound(&[key, "tube"]) {
        let rule = format!("must be from {SMALLEST} to {LARGEST} times the volume at rest");
        problems.value(key, rule, "");
    }
    if let Some(end) = tube.ends.iter().position(|end| *end == Support::Free) {
        let rule = format!(
            "a driven volume needs both ends held, and the {} end is free",
            ENDS[end]
        );
        problems.value(key, rule, "write \"sliding\" or \"fixed\" in [ends]");
    }
    if !matches!(case.solver.scheme, Scheme::Static) && problems.are_sound(&["solver.scheme"]) {
        let rule = "a volume is driven with solver.scheme = \"static\" only";
        problems.value(
            key,
            rule,
            "leave solver.scheme out, or drive inner-wall.pressure",
        );
    }
}

/// Reports a stage with lists of points that begins to drive the volume, or the pressure, elsewhere than at rest.
pub(super) fn report_course(stage: &str, is_volume: bool, problems: &mut Problems) {
    let (driven, before, unknown) = match is_volume {
        true => ("lumen", "pressure", "volume"),
        false => ("inner-wall", "volume", "pressure"),
    };
    let key = format!("{stage}.drive.{driven}");
    if problems.are_sound(&[stage]) {
        let rule = format!(
            "a stage with lists of points cannot take over from a driven {before}: between the points its {unknown} would depend \
             on the {unknown} at its start, which only the run finds"
        );
        let help = format!(
            "take over in a stage of its own before this one, to a {unknown} that you choose"
        );
        problems.key(&key, rule, help);
    }
}

/// Checks what a stage drives beside the volume.
pub(super) fn check_stage(stage: &str, drive: impl Fn(&str) -> bool, problems: &mut Problems) {
    let [volume, ratio] = [1, 0].map(|i| format!("{stage}.{LUMEN}.{}", TARGETS[i]));
    let pressure = format!("{stage}.inner-wall.pressure");
    if drive(&volume) && drive(&ratio) {
        let rule = "is driven already, by volume_ratio";
        problems.key(&volume, rule, "give one of the two");
    }
    if drive(&pressure) && (drive(&volume) || drive(&ratio)) {
        let rule = "the pressure in a lumen of driven volume is a result";
        let help = "drive one of the two, and the other in another stage";
        problems.key(&pressure, rule, help);
    }
}

/// Checks that ends stay in planes while the volume is driven, so that the volume is that between them.
pub(super) fn check_ends(stages: &[Stage], problems: &mut Problems) {
    for (i, stage) in stages.iter().enumerate() {
        let tilted = |load: &Load| {
            let tilted = load.ends.iter().position(|end| end.tilt != [0.0; 2]);
            tilted.filter(|_| load.lumen_volume.is_some())
        };
        let Some(end) = stage.loads().find_map(tilted) else {
            continue;
        };
        let rule = format!(
            "the {} end is tilted in a stage of driven volume",
            ENDS[end]
        );
        let help = "drive inner-wall.pressure, or keep both ends in their planes";
        return problems.key(&format!("stages[{}].drive", i + 1), &*rule, help);
    }
}
