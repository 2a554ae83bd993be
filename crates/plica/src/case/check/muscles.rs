//! The names, zones and profiles of the muscles.

use super::super::key::join;
use super::super::keys::{self, Case};
use super::super::problem::Problems;
use super::lumen::LUMEN;
use super::region;
use super::zone::{ROUNDING, zone};
use crate::activation::{Muscle, Profile};
use std::collections::BTreeSet;

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
        let key = format!("{path}.zone");
        let sector = muscle.sector.as_ref();
        muscles.push(Muscle {
            name: name.clone(),
            direction: muscle.direction,
            zone: zone(&key, case, muscle.zone, length, problems),
            profile: profile(&path, &muscle.profile, problems),
            sector: sector
                .map(|own| region::sector(&format!("{path}.sector"), own, case, problems)),
        });
    }
    check_overlaps(case, problems);
    muscles
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

/// Checks that zones of muscles of the same direction do not overlap in a layer, even where a zone is not within
/// the tube.
fn check_overlaps(case: &Case, problems: &mut Problems) {
    let layers = case.muscles.values().filter_map(|m| m.layer.as_deref());
    let mut layers: Vec<Option<&str>> = layers.map(Some).collect();
    layers.push(None);
    layers.sort_unstable();
    layers.dedup();
    let mut reported = BTreeSet::new();
    for layer in layers {
        // Muscles of a layer, and those that act in all of them.
        let acts = |m: &keys::Muscle| m.layer.is_none() || m.layer.as_deref() == layer;
        check_overlaps_of(case, acts, &mut reported, problems);
    }
}

/// Checks the zones of the muscles that act in a layer.
fn check_overlaps_of(
    case: &Case,
    acts: impl Fn(&keys::Muscle) -> bool,
    reported: &mut BTreeSet<String>,
    problems: &mut Problems,
) {
    let mut zones: [Vec<(f64, f64, usize, &str)>; 2] = Default::default();
    for (i, (name, muscle)) in case.muscles.iter().enumerate() {
        let path = join("muscles", name);
        let is_as_written = |key| problems.is_as_written(&format!("{path}.{key}"));
        let [from, to] = muscle.zone.map(|z| z / case.tube.diameter);
        if from < to && acts(muscle) && is_as_written("direction") && is_as_written("zone") {
            zones[muscle.direction as usize].push((from, to, i, name));
        }
    }
    for mut zones in zones {
        zones.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.2.cmp(&b.2)));
        // Of the zones before, the one that ends last.
        let mut farthest: Option<(f64, f64, usize, &str)> = None;
        for zone in zones {
            if let Some(other) = farthest.filter(|other| zone.0 < other.1 - ROUNDING) {
                let (first, second) = match other.2 < zone.2 {
                    true => (other.3, zone.3),
                    false => (zone.3, other.3),
                };
                let key = format!("{}.zone", join("muscles", second));
                if reported.insert(key.clone()) {
                    let rule =
                        format!("overlaps the zone of {first}, a muscle of the same direction");
                    problems.value(&key, rule, "let one zone end where the other begins");
                }
            }
            if farthest.is_none_or(|other| zone.1 > other.1) {
                farthest = Some(zone);
            }
        }
    }
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
