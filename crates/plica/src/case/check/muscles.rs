//! The muscles: their names, zones and profiles.

use super::super::keys::join;
use super::super::problem::Problems;
use super::super::spec::{self, Spec};
use super::stages::{ENDS, WALLS};
use super::{ROUNDING, zone};
use crate::activation::{Direction, Muscle, Profile};

/// The muscles, in the order of their names.
pub(super) fn muscles(spec: &Spec, length: f64, problems: &mut Problems) -> Vec<Muscle> {
    let mut muscles: Vec<Muscle> = Vec::new();
    for (name, muscle) in &spec.muscles {
        let path = join("muscles", name);
        check_name(&path, name, problems);
        let key = format!("{path}.zone");
        let zone = zone(&key, spec, muscle.zone, length, problems);
        let profile = profile(&path, &muscle.profile, problems);
        let direction = match muscle.direction {
            spec::Direction::Circular => Direction::Circular,
            spec::Direction::Longitudinal => Direction::Longitudinal,
        };
        muscles.push(Muscle {
            name: name.clone(),
            direction,
            zone,
            profile,
        });
    }
    check_overlaps(spec, problems);
    muscles
}

/// Whether zones of muscles of one direction overlap. One outside the tube, or in one that is not known, may do so none the less.
fn check_overlaps(spec: &Spec, problems: &mut Problems) {
    let mut zones: [Vec<(f64, f64, usize, &str)>; 2] = Default::default();
    for (i, (name, muscle)) in spec.muscles.iter().enumerate() {
        let path = join("muscles", name);
        let is_as_written = |what| problems.is_as_written(&format!("{path}.{what}"));
        let [from, to] = muscle.zone.map(|z| z / spec.tube.diameter);
        if from < to && is_as_written("direction") && is_as_written("zone") {
            zones[muscle.direction as usize].push((from, to, i, name));
        }
    }
    for mut zones in zones {
        zones.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.2.cmp(&b.2)));
        // Of those before, the one that goes farthest.
        let mut farthest: Option<(f64, f64, usize, &str)> = None;
        for zone in zones {
            if let Some(other) = farthest.filter(|other| zone.0 < other.1 - ROUNDING) {
                let (first, second) = match other.2 < zone.2 {
                    true => (other.3, zone.3),
                    false => (zone.3, other.3),
                };
                let key = format!("{}.zone", join("muscles", second));
                let rule = format!("overlaps the zone of {first}, a muscle of the same direction");
                let cure = "let one end where the other begins";
                problems.value(&key, rule, Some(cure.into()));
            }
            if farthest.is_none_or(|other| zone.1 > other.1) {
                farthest = Some(zone);
            }
        }
    }
}

fn check_name(path: &str, name: &str, problems: &mut Problems) {
    let letter = |c: char| c.is_alphanumeric() || c == '-' || c == '_';
    if ENDS.contains(&name) || WALLS.contains(&name) {
        let rule = "the name of an end or a wall of the tube cannot be a muscle's";
        problems.key(path, rule, Some("give the muscle another name".into()));
    } else if name.is_empty() || name.chars().count() > 40 || !name.chars().all(letter) {
        let rule = "a muscle's name must be letters, digits, - and _, at most 40 of them";
        problems.key(path, rule, None);
    }
}

fn profile(path: &str, profile: &spec::Profile, problems: &mut Problems) -> Profile {
    match profile {
        spec::Profile::RaisedCosine => Profile::RaisedCosine,
        spec::Profile::HalfSine => Profile::HalfSine,
        spec::Profile::SmoothBox(b) => Profile::SmoothBox { edge: b.edge },
        spec::Profile::Table(points) => {
            let key = format!("{path}.profile.table");
            if let Some(rule) = broken_rule(points) {
                if problems.none_about(&[&key]) {
                    let cure = "try [[0.0, 0.0], [0.5, 1.0], [1.0, 0.0]]";
                    problems.value(&key, rule, Some(cure.into()));
                }
                return Profile::RaisedCosine; // anything that can be evaluated
            }
            Profile::Table(points.iter().map(|&[x, s]| (x, s)).collect())
        }
    }
}

fn broken_rule(points: &[[f64; 2]]) -> Option<&'static str> {
    let (Some(first), Some(last)) = (points.first(), points.last()) else {
        return Some("must have at least two points");
    };
    if points.len() < 2 {
        Some("must have at least two points")
    } else if points.len() > 1000 {
        Some("must have at most 1000 points")
    } else if first[0] != 0.0 || last[0] != 1.0 || !points.is_sorted_by(|a, b| a[0] < b[0]) {
        Some("positions must rise from 0 to 1 (they are fractions of the zone)")
    } else if points.iter().any(|p| !(0.0..=1.0).contains(&p[1])) {
        Some("activities must be from 0 to 1")
    } else if !points.iter().any(|p| p[1] >= 1e-3) {
        Some("must be active somewhere")
    } else {
        None
    }
}
