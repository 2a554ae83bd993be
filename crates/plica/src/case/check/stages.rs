//! The stages: what they drive, and whether a tube can follow.

use super::super::problem::Problems;
use super::super::spec::{Drive, Spec};
use super::super::spelling::nearest;
use super::tube::tidy;
use crate::activation::{Direction, Muscle};
use crate::study::Stage;
use crate::tube::{EndMotion, Load, Support, Tube};

/// Smallest stress-free stretch that a wall is asked to take.
const SMALLEST_STRETCH: f64 = 0.02;
/// Shortest and longest distance of the ends, over the length at rest.
const ENDS_APART: std::ops::RangeInclusive<f64> = 0.05..=10.0;

/// The stages with their loads.
pub(super) fn stages(spec: &Spec, tube: &Tube, problems: &mut Problems) -> Vec<Stage> {
    let mut stages: Vec<Stage> = Vec::new();
    let mut load = tube.rest();
    for (i, stage) in spec.stages.iter().enumerate() {
        let path = format!("stages[{}]", i + 1);
        let name = stage.name.clone();
        let name = name.unwrap_or_else(|| format!("stage-{}", i + 1));
        if stages.iter().any(|other| other.name == name) {
            problems.value(&format!("{path}.name"), "is another stage's name", None);
        }
        for (target, drive) in &stage.drive {
            let key = format!("{path}.drive.{target}");
            apply(&key, target, drive, spec, tube, &mut load, problems);
        }
        stages.push(Stage {
            name,
            load: load.clone(),
            steps: stage.steps,
        });
    }
    if problems.is_empty() {
        check_whole(tube, &stages, problems);
    }
    stages
}

/// What must hold for all stages together.
fn check_whole(tube: &Tube, stages: &[Stage], problems: &mut Problems) {
    if stages.iter().all(|stage| stage.load == tube.rest()) {
        let cure = "write drive.NAME.diameter_ratio = 0.25 in a stage, NAME being a muscle's";
        problems.key(
            "stages",
            "nothing is driven in any stage",
            Some(cure.into()),
        );
    }
    for (i, stage) in stages.iter().enumerate() {
        let [colon, ileum] = stage.load.ends;
        let apart = 1.0 + (ileum.displacement - colon.displacement) / tube.length;
        if !ENDS_APART.contains(&apart) {
            let rule = format!(
                "brings the ends to {} of their distance at rest",
                tidy(apart)
            );
            let (low, high) = (ENDS_APART.start(), ENDS_APART.end());
            let cure = format!("stay between {low} and {high}");
            problems.key(&format!("stages[{}].drive", i + 1), rule, Some(cure));
            return;
        }
    }
}

/// Puts what a stage says about one muscle or end into the load.
fn apply(
    key: &str,
    target: &str,
    drive: &Drive,
    spec: &Spec,
    tube: &Tube,
    load: &mut Load,
    problems: &mut Problems,
) {
    let muscle = tube.muscles.iter().position(|m| m.name == target);
    let end = ["colon", "ileum"].iter().position(|&e| e == target);
    let written = [
        ("diameter_ratio", drive.diameter_ratio),
        ("length_ratio", drive.length_ratio),
        ("displacement", drive.displacement),
        ("twist_degrees", drive.twist_degrees),
    ];
    let targets = match (muscle, end) {
        (_, Some(_)) => ["displacement", "twist_degrees"].as_slice(),
        (Some(m), None) => match tube.muscles[m].direction {
            Direction::Circular => &["diameter_ratio"],
            Direction::Longitudinal => &["length_ratio"],
        },
        (None, None) => {
            let names = tube.muscles.iter().map(|m| m.name.as_str());
            let cure = match nearest(target, names.clone().chain(["colon", "ileum"])) {
                Some(near) => format!("did you mean {near}?"),
                None => format!("add [muscles.{target}], or drive {}", list(names)),
            };
            return problems.key(key, "there is no muscle of this name", Some(cure));
        }
    };
    let mut said = false;
    for (name, value) in written {
        let Some(value) = value else { continue };
        said = true;
        let key = format!("{key}.{name}");
        if !targets.contains(&name) {
            let what = match (muscle, end) {
                (Some(m), None) => match tube.muscles[m].direction {
                    Direction::Circular => "a circular muscle",
                    Direction::Longitudinal => "a longitudinal muscle",
                },
                _ => "an end of the tube",
            };
            let cure = format!("did you mean {}?", targets.join(" or "));
            problems.key(&key, format!("does not drive {what}"), Some(cure));
        } else if !problems.none_about(&[&key]) {
            continue;
        } else if let Some(m) = muscle.filter(|_| end.is_none()) {
            load.muscles[m] = value;
            check_stretch(&key, &tube.muscles[m], value, tube, problems);
        } else if let Some(e) = end {
            move_end(
                &key,
                name,
                value,
                tube.ends[e],
                &mut load.ends[e],
                spec,
                problems,
            );
        }
    }
    if !said {
        let cure = format!("give {}", targets.join(" or "));
        problems.key(key, "drives nothing", Some(cure));
    }
}

fn move_end(
    key: &str,
    name: &str,
    value: f64,
    support: Support,
    end: &mut EndMotion,
    spec: &Spec,
    problems: &mut Problems,
) {
    let (held, rule) = if name == "displacement" {
        end.displacement = value / spec.tube.diameter;
        let rule = "only a fixed or sliding end can be moved, and this one is free";
        (support != Support::Free, rule)
    } else {
        end.twist = value.to_radians();
        let rule = "only a fixed end can be turned";
        (support == Support::Fixed, rule)
    };
    if !held {
        let cure = "hold it, with \"fixed\" in [ends]";
        problems.value(key, rule, Some(cure.into()));
    }
}

/// Whether the wall can take a target.
fn check_stretch(key: &str, muscle: &Muscle, ratio: f64, tube: &Tube, problems: &mut Problems) {
    let zone = format!("muscles.{}.zone", muscle.name);
    let table = format!("muscles.{}.profile.table", muscle.name);
    if !problems.none_about(&[&zone, &table, "tube.length", "tube.diameter"]) {
        return;
    }
    let smallest = muscle.smallest_stretch(ratio, tube.length);
    if smallest < SMALLEST_STRETCH {
        let rule = format!(
            "shrinks the wall to {} of its size in the middle of the zone, {SMALLEST_STRETCH} at least",
            tidy(smallest)
        );
        // The stretch is linear in the ratio, and one at one.
        let least = 1.0 - (1.0 - ratio) * (1.0 - SMALLEST_STRETCH) / (1.0 - smallest);
        let cure = format!("try {:.3}", (least * 1000.0).ceil() / 1000.0);
        problems.value(key, rule, Some(cure));
    }
    // Mirrored at one, growth is shrinkage.
    let largest = 2.0 - muscle.smallest_stretch(2.0 - ratio, tube.length);
    if largest > 100.0 {
        let rule = format!("stretches the wall {largest:.0}-fold in the zone, 100 at most");
        problems.value(key, rule, None);
    }
}

fn list<'a>(names: impl Iterator<Item = &'a str>) -> String {
    names
        .chain(["colon", "ileum"])
        .collect::<Vec<_>>()
        .join(", ")
}
