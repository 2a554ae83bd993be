//! The stages: their loads over time, and whether the wall can be loaded so.

use super::super::course::{Course, value_at};
use super::super::key::join;
use super::super::keys::Case;
use super::super::problem::Problems;
use super::lumen;
use super::muscles::ENDS;
use super::targets::{self, Driven, Target, unknown_name};
use super::zone::{ROUNDING, length, stress, tidy};
use crate::activation::Muscle;
use crate::study::Stage;
use crate::tube::{EndDirection, Load, Part, Support, Tube};
use std::collections::HashMap;

/// Names of state 0 in tables, which no stage may have.
const RESERVED: [&str; 2] = ["rest", "start"];
/// Largest pressure, in E.
const LARGEST_PRESSURE: f64 = 10.0;
/// Largest tension of a muscle, in E.
const LARGEST_TENSION: f64 = 1000.0;
/// Smallest and largest stress-free stretch.
const SMALLEST_STRETCH: f64 = 0.02;
const LARGEST_STRETCH: f64 = 100.0;
/// Smallest and largest distance of the ends over that at rest.
const DISTANCES: std::ops::RangeInclusive<f64> = 0.05..=10.0;

/// Returns the stages with their loads; the first begins at `begin`.
pub(super) fn stages(
    case: &Case,
    tube: &Tube,
    begin: &Load,
    volume_at_rest: f64,
    problems: &mut Problems,
) -> Vec<Stage> {
    let mut stages: Vec<Stage> = Vec::new();
    let mut load = begin.clone();
    let mut names: HashMap<String, usize> = HashMap::new();
    let muscles = tube.muscles.iter().map(|muscle| muscle.name.as_str());
    let muscles: HashMap<&str, usize> = muscles.zip(0..).collect();
    let have_durations = case.stages.iter().any(|stage| stage.duration.is_some());
    for (i, stage) in case.stages.iter().enumerate() {
        let path = format!("stages[{}]", i + 1);
        let name = stage.name.clone();
        let name = name.unwrap_or_else(|| format!("stage-{}", i + 1));
        let key = format!("{path}.name");
        let other = *names.entry(name.clone()).or_insert(i);
        if other < i
            && problems.is_as_written(&key)
            && problems.is_as_written(&format!("stages[{}].name", other + 1))
        {
            problems.value(&key, "another stage has this name", "");
        }
        if RESERVED.contains(&name.as_str()) && problems.is_as_written(&key) {
            let rule = "state 0 has this name";
            problems.value(&key, rule, "choose another name");
        }
        let mut driven = vec![];
        for (target, drive) in &stage.drive {
            let key = join(&format!("{path}.drive"), target);
            let found = match Driven::find(target, tube, &muscles) {
                Some(Driven::Lumen(_)) => Some(Driven::Lumen(volume_at_rest)),
                found => found,
            };
            match found {
                Some(name) => {
                    let context = (case, tube);
                    driven.extend(targets::read(&key, target, name, drive, context, problems));
                }
                None => unknown_name(&key, target, tube, problems),
            }
        }
        let is_driven =
            |key: &str, problems: &Problems| problems.is_given(key) && problems.is_as_written(key);
        let given: Vec<String> = ["lumen.volume", "lumen.volume_ratio", "inner-wall.pressure"]
            .map(|key| format!("{path}.drive.{key}"))
            .into_iter()
            .filter(|key| is_driven(key, problems))
            .collect();
        lumen::check_stage(
            &format!("{path}.drive"),
            |key| given.iter().any(|one| one == key),
            problems,
        );
        let duration = stage.duration.unwrap_or(1.0);
        let (end, course) = course(&load, &driven, duration, problems);
        let switches = load.lumen_volume.is_some() != end.lumen_volume.is_some();
        // The volume at rest is known.
        let from_rest = i == 0 && case.start.is_none() && end.lumen_volume.is_some();
        if switches && !course.is_empty() && !from_rest {
            lumen::report_course(&path, end.lumen_volume.is_some(), problems);
        }
        load = end;
        stages.push(Stage {
            course,
            duration: have_durations.then_some(duration),
            ..Stage::new(name, load.clone(), stage.steps)
        });
    }
    check_waves(case, tube, begin, &stages, problems);
    stages
}

/// Returns the load at the end of a stage that begins at a load, and the loads at the corners of its course.
fn course(
    begin: &Load,
    driven: &[Target],
    duration: f64,
    problems: &mut Problems,
) -> (Load, Vec<(f64, Load)>) {
    let mut end = begin.clone();
    let mut courses = vec![];
    for target in driven {
        let before = target.quantity.get(begin);
        if let Some((rule, help)) = target.course.broken_by(duration) {
            if problems.are_sound(&[&target.key]) {
                problems.value(&target.key, rule, help);
            }
            continue;
        }
        if let Course::Points(points) = &target.course
            && let Some(&[0.0, first]) = points.first()
            && (first - before).abs() > ROUNDING * before.abs().max(1.0)
            && problems.are_sound(&[&target.key, "start"])
        {
            let rule = "its value at time 0 is not the one at which the stage begins";
            let help = "begin at that value, or with a later time: loads do not jump";
            problems.value(&target.key, rule, help);
        }
        let points = target.course.fractions(before, duration);
        target.quantity.set(&mut end, value_at(&points, 1.0));
        courses.push((target.quantity, points));
    }
    let mut corners: Vec<f64> = courses
        .iter()
        .flat_map(|(_, points)| points.iter().map(|point| point[0]))
        .filter(|fraction| 0.0 < *fraction && *fraction < 1.0)
        .collect();
    corners.sort_by(f64::total_cmp);
    corners.dedup();
    let at = |fraction: f64| {
        let mut load = begin.towards(&end, fraction);
        for (quantity, points) in &courses {
            quantity.set(&mut load, value_at(points, fraction));
        }
        (fraction, load)
    };
    let corners = corners.into_iter().map(at).collect();
    (end, corners)
}

/// Checks that the zones of muscles are where their targets need them.
fn check_waves(case: &Case, tube: &Tube, begin: &Load, stages: &[Stage], problems: &mut Problems) {
    for (m, muscle) in tube.muscles.iter().enumerate() {
        let own = join("muscles", &muscle.name);
        if muscle.repeat.is_none() && problems.are_sound(&[&own, "tube", "start"]) {
            check_run_off(case, tube, m, stages, problems);
        }
        let [from, to] = muscle.zone;
        let is_whole = |load: &Load| {
            let (from, to) = (from + load.shifts[m], to + load.shifts[m]);
            let within = from >= -ROUNDING && to <= tube.length * (1.0 + ROUNDING);
            muscle.repeat.is_none() && (within || load.muscles[m] == 1.0)
        };
        let mut loads = stages.iter().flat_map(Stage::loads).chain([begin]);
        if loads.all(is_whole) {
            continue;
        }
        for i in 1..=case.stages.len() {
            let key = format!("stages[{i}].drive.{}.length_ratio", muscle.name);
            let drive = case.stages[i - 1].drive.get(&muscle.name);
            let is_written = drive.is_some_and(|drive| drive.length_ratio.is_some());
            if is_written && problems.are_sound(&[&key, &own, "tube"]) {
                let rule = "the length of the tube is not defined by a zone that repeats, or leaves the tube";
                let help = "write `stretch`, the largest stretch in the zone, instead";
                problems.key(&key, rule, help);
            }
        }
    }
}

/// Checks that no stage moves the zone of a muscle farther out of the tube than by its own length.
fn check_run_off(case: &Case, tube: &Tube, m: usize, stages: &[Stage], problems: &mut Problems) {
    let muscle = &tube.muscles[m];
    let [from, to] = muscle.zone;
    for (i, stage) in stages.iter().enumerate() {
        let key = format!("stages[{}].drive.{}.shift", i + 1, muscle.name);
        let drive = case.stages[i].drive.get(&muscle.name);
        if drive.is_none_or(|drive| drive.shift.is_none()) || !problems.are_sound(&[&key]) {
            continue;
        }
        for load in stage.loads() {
            let shift = load.shifts[m];
            let leaves = if shift > 0.0 { tube.length - from } else { -to };
            let beyond = if shift > 0.0 {
                shift - leaves
            } else {
                leaves - shift
            };
            if shift != 0.0 && beyond > to - from + ROUNDING {
                let rule = format!("the zone has left the tube at {}", length(case, leaves));
                let help = "let it go on by its own length at most, or set `repeat` in the muscle";
                problems.value(&key, rule, help);
                break;
            }
        }
    }
}

/// Checks the rules that concern all stages: something is driven, and the ends keep a distance.
pub(super) fn check_all(tube: &Tube, begin: &Load, stages: &[Stage], problems: &mut Problems) {
    if !problems.is_as_written("start") {
        return;
    }
    let drives: Vec<String> = (1..=stages.len())
        .map(|i| format!("stages[{i}].drive"))
        .collect();
    let nothing = stages
        .iter()
        .flat_map(Stage::loads)
        .all(|load| load == begin);
    if nothing
        && problems.is_as_written("stages")
        && drives.iter().all(|drive| problems.are_sound(&[drive]))
    {
        let rule = "no stage changes the load";
        let help = "write drive.NAME.diameter_ratio = 0.25 in a stage, with the name of a muscle";
        problems.key("stages", rule, help);
    }
    let ends = |drive: &String| {
        ENDS.iter()
            .all(|end| problems.are_sound(&[&format!("{drive}.{end}")]))
    };
    if !problems.are_sound(&["tube.length", "tube.diameter"]) || !drives.iter().all(ends) {
        return;
    }
    for (i, stage) in stages.iter().enumerate() {
        let before = i.checked_sub(1).map_or(begin, |j| &stages[j].load);
        for load in stage.loads() {
            let [was, is] = [before, load].map(|load| load.ends.map(|end| end.displacement));
            let distance = 1.0 + (is[1] - is[0]) / tube.length;
            if DISTANCES.contains(&distance) || (i > 0 && was == is) {
                continue;
            }
            let distance = tidy(distance);
            let rule = format!("the distance of the ends becomes {distance} times that at rest");
            let help = format!("stay between {} and {}", DISTANCES.start(), DISTANCES.end());
            let moved = [0, 1].map(|end| (is[end] - was[end]).abs());
            let end = ENDS[usize::from(moved[1] >= moved[0])];
            let key = format!("stages[{}].drive.{end}.displacement", i + 1);
            problems.value(&key, rule, help);
            break;
        }
    }
}

/// Checks the size of a pressure in E.
pub(super) fn check_pressure(key: &str, pressure: f64, case: &Case, problems: &mut Problems) {
    if pressure.abs() > LARGEST_PRESSURE && problems.are_sound(&[key, "material", "layers"]) {
        let largest = stress(case, LARGEST_PRESSURE);
        let rule = format!("must be from -{largest} to {largest}, ten times Young's modulus");
        problems.value(key, rule, "");
    }
}

/// Checks that both ends are held under a follower pressure, so that its work depends on the state
/// alone.
pub(super) fn check_closed(key: &str, tube: &Tube, problems: &mut Problems) {
    let free = tube.ends.iter().position(|end| *end == Support::Free);
    if let Some(name) = free.map(|end| ENDS[end]) {
        let rule = format!("a follower pressure needs both ends held, and the {name} end is free");
        let help = "write \"sliding\" or \"fixed\" in [ends], or use dead_load";
        problems.value(key, rule, help);
    }
}

/// Checks that ends which slide under a follower pressure stay in their planes.
pub(super) fn check_end_planes(tube: &Tube, stages: &[Stage], problems: &mut Problems) {
    let has_follower = |load: &Load| {
        load.lumen_volume.is_some() || load.pressures.iter().any(|p| p.follower != 0.0)
    };
    let pressed = |stage: &Stage| stage.loads().any(has_follower);
    let sound = problems.are_sound(&["imperfections", "ends", "stages", "start"]);
    if !sound || !stages.iter().any(pressed) {
        return;
    }
    for (i, imperfection) in tube.imperfections.iter().enumerate() {
        let Part::End(end, EndDirection::Axial) = imperfection.of else {
            continue;
        };
        let slides = tube.ends[end as usize] == Support::Sliding;
        let waves = imperfection.shape.waves();
        if slides && waves.iter().any(|wave| wave.harmonic > 0) {
            let rule = "under a follower pressure a sliding end must stay in its plane";
            let help = "fix the end, or use dead_load in the stages";
            problems.key(&format!("imperfections[{}]", i + 1), rule, help);
        }
    }
}

/// Checks that an end is held as its motion needs.
pub(super) fn check_held(key: &str, target: &str, support: Support, problems: &mut Problems) {
    let rule = match (target, support) {
        (_, Support::Fixed) | ("displacement", Support::Sliding) => return,
        ("displacement", _) => "only a fixed or sliding end can be moved, and this one is free",
        _ => "only a fixed end can be turned",
    };
    problems.value(key, rule, "write \"fixed\" in [ends]");
}

/// Returns the rule that the smallest stress-free stretch breaks where a muscle is stronger by a factor than elsewhere.
pub(super) fn broken_by_strength(
    tube: &Tube,
    m: usize,
    strongest: f64,
    stages: &[Stage],
) -> Option<String> {
    let muscle = &tube.muscles[m];
    let loads = stages.iter().flat_map(Stage::loads);
    let stretches = loads.map(|load| muscle.smallest_stretch(load.muscles[m], tube.length));
    let smallest = 1.0 - strongest * (1.0 - stretches.fold(1.0, f64::min));
    (smallest < SMALLEST_STRETCH).then(|| {
        format!(
            "where it is strongest, {} shrinks the wall to {} of its size, {SMALLEST_STRETCH} at least",
            muscle.name,
            tidy(smallest)
        )
    })
}

/// Checks the tension of a muscle with active stress, in E.
pub(super) fn check_tension(key: &str, tension: f64, case: &Case, problems: &mut Problems) {
    if tension > LARGEST_TENSION && problems.are_sound(&[key, "material", "layers"]) {
        let largest = stress(case, LARGEST_TENSION);
        let rule = format!("must be at most {largest}, {LARGEST_TENSION} times Young's modulus");
        problems.value(key, rule, "");
    }
}

/// Checks the stress-free stretches that a muscle gives the wall.
pub(super) fn check_stretch(
    key: &str,
    muscle: &Muscle,
    ratio: f64,
    tube: &Tube,
    problems: &mut Problems,
) {
    let own = join("muscles", &muscle.name);
    if !problems.are_sound(&[key, &own, "tube.length", "tube.diameter"]) {
        return;
    }
    let smallest = muscle.smallest_stretch(ratio, tube.length);
    if smallest < SMALLEST_STRETCH {
        let rule = format!(
            "shrinks the wall to {} of its size in the middle of the zone, {SMALLEST_STRETCH} at least",
            tidy(smallest)
        );
        // The stretch is linear in the ratio, and 1 at 1.
        let least = 1.0 - (1.0 - ratio) * (1.0 - SMALLEST_STRETCH) / (1.0 - smallest);
        let help = format!("try {:.3}", (least * 1000.0).ceil() / 1000.0);
        problems.value(key, rule, help);
    }
    // The largest stretch minus 1 is the shrinkage at the ratio mirrored at 1.
    let largest = 2.0 - muscle.smallest_stretch(2.0 - ratio, tube.length);
    if largest > LARGEST_STRETCH {
        let rule =
            format!("stretches the wall {largest:.0}-fold in the zone, {LARGEST_STRETCH} at most");
        problems.value(key, rule, "");
    }
}
