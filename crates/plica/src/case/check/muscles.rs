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
        // A zone outside the tube, or in one that is not known, may overlap another none the less.
        let written = |name: &str| spec.muscles[name].zone.map(|z| z / spec.tube.diameter);
        let clear = |path: &str, problems: &Problems| {
            let is_as_written = |what| problems.is_as_written(&format!("{path}.{what}"));
            is_as_written("direction") && is_as_written("zone")
        };
        let ([from, to], own) = (written(name), clear(&path, problems));
        let rival = muscles.iter().find(|other| {
            let [its_from, its_to] = written(&other.name);
            own && from < to
                && its_from < its_to
                && other.direction == direction
                && from < its_to - ROUNDING
                && its_from < to - ROUNDING
                && clear(&join("muscles", &other.name), problems)
        });
        if let Some(rival) = rival {
            let rule = format!(
                "overlaps the zone of {}, a muscle of the same direction",
                rival.name
            );
            problems.value(
                &key,
                rule,
                Some("let one end where the other begins".into()),
            );
        }
        muscles.push(Muscle {
            name: name.clone(),
            direction,
            zone,
            profile,
        });
    }
    muscles
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
