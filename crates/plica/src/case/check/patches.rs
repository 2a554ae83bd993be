//! The patches of the wall and the foundations of the outer wall.

use super::super::key::join;
use super::super::keys::{self, Case};
use super::super::problem::Problems;
use super::material::youngs_modulus;
use super::muscles::{ENDS, WALLS, is_name};
use super::region::region;
use super::stages::broken_by_strength;
use crate::study::Stage;
use crate::tube::{Foundation, Patch, SpringDirection, Support, Symmetry, Tube};

/// Factors on the activity of a muscle.
const FACTORS: std::ops::RangeInclusive<f64> = 0.0..=10.0;

/// Returns the patches of a tube that has its layers and muscles.
pub(super) fn patches(case: &Case, tube: &Tube, problems: &mut Problems) -> Vec<Patch> {
    let mut patches: Vec<Patch> = vec![];
    for (i, written) in case.patches.iter().enumerate() {
        let path = format!("patches[{}]", i + 1);
        check_name(&path, &written.name, i, case, problems);
        let place = (Some(written.zone), written.edge, written.sector.as_ref());
        patches.push(Patch {
            name: written.name.clone(),
            region: region(&path, case, place, tube.length, problems),
            layers: layers(&path, written, tube, problems),
            stiffness: written.stiffness,
            muscles: factors(&path, written, tube, problems),
        });
    }
    patches
}

fn check_name(path: &str, name: &str, i: usize, case: &Case, problems: &mut Problems) {
    let key = format!("{path}.name");
    if !problems.is_as_written(&key) {
        return;
    }
    let is_taken = ENDS.contains(&name)
        || WALLS.contains(&name)
        || [&case.ends.colon_name, &case.ends.ileum_name].contains(&&name.to_owned())
        || case.muscles.contains_key(name)
        || case.obstacles.iter().any(|obstacle| obstacle.name == name)
        || case.patches[..i].iter().any(|patch| patch.name == name);
    if !is_name(name) {
        let rule = "must consist of letters, digits, - and _, at most 40 of them";
        problems.value(&key, rule, "try scar");
    } else if is_taken {
        let rule = "a muscle, an end, a surface, an obstacle or another patch has this name";
        problems.value(&key, rule, "choose another name");
    }
}

/// Returns the layers that a patch acts in, by their numbers.
fn layers(path: &str, written: &keys::Patch, tube: &Tube, problems: &mut Problems) -> Vec<usize> {
    let all = 0..tube.layers.len();
    let Some(name) = &written.layer else {
        return all.collect();
    };
    let own: Vec<usize> = all.filter(|&l| tube.layers[l].name == *name).collect();
    let key = format!("{path}.layer");
    if own.is_empty() && problems.are_sound(&[&key, "layers"]) {
        let names: Vec<&str> = tube
            .layers
            .iter()
            .map(|layer| layer.name.as_str())
            .collect();
        let help = match names.len() {
            1 => "add [[layers]], or leave it out".to_owned(),
            _ => format!("the layers are {}", names.join(", ")),
        };
        problems.value(&key, "no layer has this name", help);
    }
    own
}

/// Returns the factor of a patch on each muscle.
fn factors(path: &str, written: &keys::Patch, tube: &Tube, problems: &mut Problems) -> Vec<f64> {
    let names: Vec<&str> = tube.muscles.iter().map(|m| m.name.as_str()).collect();
    for (name, &factor) in &written.muscles {
        let key = join(&format!("{path}.muscles"), name);
        if !names.contains(&name.as_str()) && problems.are_sound(&[&key, "muscles"]) {
            let help = match &names[..] {
                [] => "add a muscle, or leave it out".to_owned(),
                names => format!("the muscles are {}", names.join(", ")),
            };
            problems.key(&key, "no muscle has this name", help);
        } else if !FACTORS.contains(&factor) && problems.are_sound(&[&key]) {
            let rule = format!("must be from {} to {}", FACTORS.start(), FACTORS.end());
            problems.value(&key, rule, "try 0.2");
        }
    }
    let factor = |name: &&str| written.muscles.get(*name).copied().unwrap_or(1.0);
    names.iter().map(factor).collect()
}

/// Checks the smallest stress-free stretch where patches make a muscle stronger.
pub(super) fn check_stretches(tube: &Tube, stages: &[Stage], problems: &mut Problems) {
    if !problems.are_sound(&["patches", "muscles", "stages", "start", "tube"]) {
        return;
    }
    for (m, muscle) in tube.muscles.iter().enumerate() {
        let factors = tube.patches.iter().map(|patch| patch.muscles[m]);
        let strongest: f64 = factors.map(|factor| factor.max(1.0)).product();
        let Some(last) = tube.patches.iter().rposition(|p| p.muscles[m] > 1.0) else {
            continue;
        };
        if let Some(rule) = broken_by_strength(tube, m, strongest, stages) {
            let key = join(&format!("patches[{}].muscles", last + 1), &muscle.name);
            problems.value(&key, rule, "make it smaller");
        }
    }
}

/// Returns the foundations of a tube.
pub(super) fn foundations(case: &Case, tube: &Tube, problems: &mut Problems) -> Vec<Foundation> {
    let foundation = |(i, written): (usize, &keys::Foundation)| {
        let path = format!("foundations[{}]", i + 1);
        let place = (written.zone, written.edge, written.sector.as_ref());
        let direction = match (written.direction, written.tension_only) {
            (SpringDirection::Normal, true) => SpringDirection::Inward,
            (direction, _) => direction,
        };
        if written.tension_only {
            check_tension(&path, written, (case, tube), problems);
        }
        Foundation {
            region: region(&path, case, place, tube.length, problems),
            stiffness: written.stiffness * case.tube.diameter / youngs_modulus(case),
            direction,
        }
    };
    case.foundations
        .iter()
        .enumerate()
        .map(foundation)
        .collect()
}

fn check_tension(
    path: &str,
    written: &keys::Foundation,
    (case, tube): (&Case, &Tube),
    problems: &mut Problems,
) {
    let key = format!("{path}.tension_only");
    if !problems.are_sound(&[path, "ends", "symmetry"]) {
        return;
    }
    if written.direction == SpringDirection::All {
        let rule = "springs that resist all displacements push and pull";
        problems.value(&key, rule, "write direction = \"normal\"");
    } else if case.symmetry == Symmetry::None && !tube.ends.contains(&Support::Fixed) {
        let rule = "springs that only pull do not hold the tube sideways, and no end does";
        problems.value(&key, rule, "write \"fixed\" for an end in [ends]");
    }
}
