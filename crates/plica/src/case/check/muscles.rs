//! The names, zones and profiles of the muscles.

use super::super::key::join;
use super::super::keys::{self, Case};
use super::super::problem::Problems;
use super::lumen::LUMEN;
use super::material::relation;
use super::region;
use super::zone::{ROUNDING, moving_zone, zone};
use crate::activation::{Direction, Muscle, Profile};
use crate::material::LengthTension;

/// The names of the ends in a stage, in the order of the load.
pub(super) const ENDS: [&str; 2] = ["colon", "ileum"];
/// The names of the surfaces in a stage, in the order of the load.
pub(super) const WALLS: [&str; 2] = ["inner-wall", "outer-wall"];

/// Returns the muscles in the order of their names.
pub(super) fn muscles(case: &Case, length: f64, problems: &mut Problems) -> Vec<Muscle> {
    let mut muscles: Vec<Muscle> = Vec::new();
    for (name, muscle) in &case.muscles {
        let path = join("muscles", name);
        check_name(&path, name, problems);
        let drives = case.stages.iter().filter_map(|stage| stage.drive.get(name));
        let is_shifted = drives.into_iter().any(|drive| drive.shift.is_some());
        let key = format!("{path}.zone");
        // A stage with a mistake may move it.
        let may_move = is_shifted || muscle.repeat.is_some() || !problems.are_sound(&["stages"]);
        let zone = match may_move {
            true => moving_zone(&key, case, muscle.zone, problems),
            false => zone(&key, case, muscle.zone, length, problems),
        };
        let profile = profile(&path, &muscle.profile, problems);
        let repeat = repeat(&path, case, zone, muscle.repeat, problems);
        let sector = muscle.sector.as_ref();
        let active = muscle.active_stress.as_ref();
        let made = Muscle::new(name.clone(), muscle.direction, zone, profile);
        let made = match active {
            Some(active) => active_stress(made, active, &path, problems),
            None => made,
        };
        muscles.push(Muscle {
            repeat,
            sector: sector
                .map(|own| region::sector(&format!("{path}.sector"), own, case, problems)),
            ..made
        });
    }
    muscles
}

/// Returns a muscle with an active stress.
fn active_stress(
    muscle: Muscle,
    written: &keys::ActiveStress,
    path: &str,
    problems: &mut Problems,
) -> Muscle {
    let along = match muscle.direction {
        Direction::Circular => 0.0,
        Direction::Longitudinal => 90.0,
    };
    let stretches = [written.best_stretch, written.least_stretch, written.width];
    let path = format!("{path}.active_stress");
    let relation = relation(stretches, written.table.as_ref(), &path, problems);
    muscle.with_active_stress(
        relation.unwrap_or(LengthTension::Constant),
        written.angle_degrees.unwrap_or(along).to_radians(),
    )
}

/// Checks the names of the ends and returns them.
pub(super) fn end_names(case: &Case, problems: &mut Problems) -> [String; 2] {
    let names = [&case.ends.colon_name, &case.ends.ileum_name];
    let keys = ["ends.colon_name", "ends.ileum_name"];
    for (i, (name, key)) in names.into_iter().zip(keys).enumerate() {
        let other = names[1 - i];
        let is_taken = case.muscles.contains_key(name)
            || WALLS.contains(&name.as_str())
            || name == ENDS[1 - i]
            || name == "none"
            || (i == 1 && name == other);
        if !problems.is_as_written(key) || !problems.are_sound(&["muscles"]) {
            continue;
        }
        if !is_name(name) {
            let rule = "must consist of letters, digits, - and _, at most 40 of them";
            problems.value(key, rule, "try proximal or distal");
        } else if is_taken {
            let rule = "a muscle, a surface, the other end or the absence of a side has this name";
            problems.value(key, rule, "choose another name");
        }
    }
    names.map(String::clone)
}

/// Returns whether a text may be a part of the name of a column.
pub(super) fn is_name(name: &str) -> bool {
    let allowed = |c: char| c.is_alphanumeric() || c == '-' || c == '_';
    !name.is_empty() && name.chars().count() <= 40 && name.chars().all(allowed)
}

fn check_name(path: &str, name: &str, problems: &mut Problems) {
    if ENDS.contains(&name) || WALLS.contains(&name) || name == LUMEN {
        let rule = "an end, a surface or the lumen of the tube has this name";
        problems.key(path, rule, "choose another name for the muscle");
    } else if !is_name(name) {
        let rule = "a muscle's name must consist of letters, digits, - and _, at most 40 of them";
        problems.key(path, rule, "");
    }
}

/// Checks the distance between repeats of a zone, and returns it in D.
fn repeat(
    path: &str,
    case: &Case,
    [from, to]: [f64; 2],
    repeat: Option<f64>,
    problems: &mut Problems,
) -> Option<f64> {
    let repeat = repeat? / case.tube.diameter;
    let (key, zone) = (format!("{path}.repeat"), format!("{path}.zone"));
    if repeat < (to - from) * (1.0 - ROUNDING) && problems.are_sound(&[&key, &zone]) {
        let least = super::zone::length(case, to - from);
        let rule = format!("must be at least the length of the zone, {least}");
        problems.value(&key, rule, "");
    }
    // A repeat as long as the zone leaves no gap by rounding.
    Some(repeat.max(to - from))
}

/// Checks a profile. Returns another one if it cannot be evaluated.
fn profile(path: &str, profile: &Profile, problems: &mut Problems) -> Profile {
    let Profile::Table(points) = profile else {
        return profile.clone();
    };
    let Some(rule) = rule_broken_by(points) else {
        return profile.clone();
    };
    let key = format!("{path}.profile.table");
    if problems.are_sound(&[&key]) {
        problems.value(&key, rule, "try [[0.0, 0.0], [0.5, 1.0], [1.0, 0.0]]");
    }
    Profile::RaisedCosine
}

fn rule_broken_by(points: &[(f64, f64)]) -> Option<&'static str> {
    let (Some(first), Some(last), 2..) = (points.first(), points.last(), points.len()) else {
        return Some("must have at least two points");
    };
    if points.len() > 1000 {
        Some("must have at most 1000 points")
    } else if first.0 != 0.0 || last.0 != 1.0 || !points.is_sorted_by(|a, b| a.0 < b.0) {
        Some("positions must rise from 0 to 1 (they are fractions of the zone)")
    } else if points.iter().any(|point| !(0.0..=1.0).contains(&point.1)) {
        Some("activities must be from 0 to 1")
    } else if !points.iter().any(|point| point.1 >= 1e-3) {
        Some("some activity must be at least 0.001")
    } else {
        None
    }
}
