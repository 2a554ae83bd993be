//! The stages: their targets, and whether the wall can be loaded so.

use super::super::key::join;
use super::super::keys::{Case, Drive};
use super::super::problem::Problems;
use super::super::spelling::{nearest, target};
use super::lumen::{self, LUMEN};
use super::material::youngs_modulus;
use super::muscles::{ENDS, WALLS};
use super::obstacles::in_tube;
use super::sideways;
use super::zone::{stress, tidy};
use crate::activation::{Direction, Muscle};
use crate::study::Stage;
use crate::tube::{EndDirection, Load, ObstacleShape, Part, Support, Tube};
use std::collections::HashMap;

/// Names of state 0 in tables, which no stage may have.
const RESERVED: [&str; 2] = ["rest", "start"];
/// Number of names that a message lists.
const NAMES: usize = 12;
/// Number of problems from which on no similar names are searched for.
const MANY: usize = 200;
/// Largest pressure, in E.
const LARGEST_PRESSURE: f64 = 10.0;
/// Smallest and largest stress-free stretch.
pub(super) const SMALLEST_STRETCH: f64 = 0.02;
const LARGEST_STRETCH: f64 = 100.0;
/// Smallest and largest distance of the ends over that at rest.
const DISTANCES: std::ops::RangeInclusive<f64> = 0.05..=10.0;

/// Returns the stages with the loads at their ends; the first begins at `begin`.
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
        for (target, drive) in &stage.drive {
            let key = join(&format!("{path}.drive"), target);
            let driven = match Driven::find(target, tube, &muscles) {
                Some(Driven::Lumen(_)) => Some(Driven::Lumen(volume_at_rest)),
                driven => driven,
            };
            match driven {
                Some(driven) => apply(&key, target, driven, drive, case, tube, &mut load, problems),
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
        stages.push(Stage {
            name,
            load: load.clone(),
            steps: stage.steps,
        });
    }
    stages
}

/// Checks the rules that concern all stages: something is driven, and the ends keep a distance.
pub(super) fn check_all(tube: &Tube, begin: &Load, stages: &[Stage], problems: &mut Problems) {
    if !problems.is_as_written("start") {
        return;
    }
    let drives: Vec<String> = (1..=stages.len())
        .map(|i| format!("stages[{i}].drive"))
        .collect();
    let nothing = stages.iter().all(|stage| stage.load == *begin);
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
        let [colon, ileum] = stage.load.ends;
        let distance = 1.0 + (ileum.displacement - colon.displacement) / tube.length;
        let before = i.checked_sub(1).map_or(begin, |j| &stages[j].load);
        let [was, is] = [before, &stage.load].map(|load| load.ends.map(|end| end.displacement));
        if !DISTANCES.contains(&distance) && (i == 0 || was != is) {
            let distance = tidy(distance);
            let rule = format!("the distance of the ends becomes {distance} times that at rest");
            let help = format!("stay between {} and {}", DISTANCES.start(), DISTANCES.end());
            let moved = [0, 1].map(|end| (is[end] - was[end]).abs());
            let end = ENDS[usize::from(moved[1] >= moved[0])];
            let key = format!("stages[{}].drive.{end}.displacement", i + 1);
            problems.value(&key, rule, help);
        }
    }
}

/// What a name in a stage stands for.
#[derive(Clone, Copy)]
enum Driven {
    /// A muscle, by its index in the tube.
    Muscle(usize, Direction),
    /// The colon end or the ileum end.
    End(usize),
    /// The inner wall or the outer wall.
    Wall(usize),
    /// The lumen, with its volume at rest in D³.
    Lumen(f64),
    /// An obstacle, by its index in the tube, and whether it has a radius.
    Obstacle(usize, bool),
    /// A patch, by its index in the tube.
    Patch(usize),
}

impl Driven {
    fn find(name: &str, tube: &Tube, muscles: &HashMap<&str, usize>) -> Option<Self> {
        if let Some(end) = ENDS.iter().position(|&end| end == name) {
            return Some(Self::End(end));
        }
        if let Some(wall) = WALLS.iter().position(|&wall| wall == name) {
            return Some(Self::Wall(wall));
        }
        if name == LUMEN {
            return Some(Self::Lumen(f64::NAN));
        }
        if let Some(i) = tube
            .obstacles
            .iter()
            .position(|obstacle| obstacle.name == name)
        {
            let is_plate = matches!(tube.obstacles[i].shape, ObstacleShape::Plate { .. });
            return Some(Self::Obstacle(i, !is_plate));
        }
        if let Some(i) = tube.patches.iter().position(|patch| patch.name == name) {
            return Some(Self::Patch(i));
        }
        let m = *muscles.get(name)?;
        Some(Self::Muscle(m, tube.muscles[m].direction))
    }

    fn targets(self) -> &'static [&'static str] {
        match self {
            Self::Muscle(_, Direction::Circular) => &["diameter_ratio"],
            Self::Muscle(_, Direction::Longitudinal) => &["length_ratio"],
            Self::End(_) => &["displacement", "twist_degrees", "offset", "tilt_degrees"],
            Self::Wall(_) => &["pressure", "dead_load"],
            Self::Lumen(_) => &lumen::TARGETS,
            Self::Obstacle(_, true) => &["radius", "position"],
            Self::Obstacle(_, false) => &["position"],
            Self::Patch(_) => &["growth_through"],
        }
    }

    fn words(self) -> &'static str {
        match self {
            Self::Muscle(_, Direction::Circular) => "a circular muscle",
            Self::Muscle(_, Direction::Longitudinal) => "a longitudinal muscle",
            Self::End(_) => "an end of the tube",
            Self::Wall(_) => "a surface of the tube",
            Self::Lumen(_) => "the lumen",
            Self::Obstacle(_, true) => "an obstacle",
            Self::Obstacle(_, false) => "a plate",
            Self::Patch(_) => "a patch",
        }
    }
}

/// Reports a name that is neither a muscle, nor an end, nor a surface, nor the lumen.
fn unknown_name(path: &str, name: &str, tube: &Tube, problems: &mut Problems) {
    let muscle = join("muscles", name);
    if !problems.are_sound(&[&muscle, "obstacles", "patches"]) {
        return problems.replaced(path);
    }
    let names = || {
        let muscles = tube.muscles.iter().map(|muscle| muscle.name.as_str());
        // A muscle of such a name is reported by itself.
        let is_free = |name: &&str| !ENDS.contains(name) && !WALLS.contains(name) && *name != LUMEN;
        let obstacles = tube.obstacles.iter().map(|obstacle| obstacle.name.as_str());
        let patches = tube.patches.iter().map(|patch| patch.name.as_str());
        muscles
            .filter(is_free)
            .chain(obstacles)
            .chain(patches)
            .chain(ENDS)
            .chain(WALLS)
            .chain([LUMEN])
    };
    let near = match problems.len() < MANY {
        true => nearest(name, names()),
        false => None,
    };
    let help = match near {
        Some(near) => format!("did you mean {near}?"),
        None if target(name).is_some() => {
            let drive = path.rsplit_once('.').map_or(path, |(drive, _)| drive);
            format!("write {drive}.{}", target(name).unwrap_or_default())
        }
        None => {
            let some: Vec<&str> = names().take(NAMES).collect();
            let more = if names().count() > NAMES { ", …" } else { "" };
            format!("add [{muscle}], or drive {}{more}", some.join(", "))
        }
    };
    let rule = match tube.patches.is_empty() {
        true => "there is no muscle or obstacle of this name",
        false => "there is no muscle, obstacle or patch of this name",
    };
    problems.key(path, rule, help);
}

/// Applies the targets of one muscle, end or surface to the load.
#[expect(clippy::too_many_arguments, reason = "all of it is context of one key")]
fn apply(
    path: &str,
    name: &str,
    driven: Driven,
    drive: &Drive,
    case: &Case,
    tube: &Tube,
    load: &mut Load,
    problems: &mut Problems,
) {
    if !matches!(driven, Driven::Muscle(..)) && case.muscles.contains_key(name) {
        // A muscle of a name that is taken, which has been reported.
        return problems.replaced(path);
    }
    let targets = driven.targets();
    if problems.is_as_written(&format!("{}.direction", join("muscles", name))) {
        problems.advise_unknown(path, |unknown| {
            match nearest(unknown, targets.iter().copied()) {
                Some(near) => format!("did you mean {near}?"),
                None => format!("{} has {}", driven.words(), targets.join(" and ")),
            }
        });
    }
    let written = [
        ("diameter_ratio", drive.diameter_ratio),
        ("length_ratio", drive.length_ratio),
        ("growth_through", drive.growth_through),
        ("displacement", drive.displacement),
        ("twist_degrees", drive.twist_degrees),
        ("offset", drive.offset.map(|_| f64::NAN)),
        ("tilt_degrees", drive.tilt_degrees.map(|_| f64::NAN)),
        ("volume_ratio", drive.volume_ratio),
        ("volume", drive.volume),
        ("pressure", drive.pressure),
        ("dead_load", drive.dead_load),
        ("radius", drive.radius),
        // Its value is applied below.
        ("position", drive.position.map(|_| f64::NAN)),
    ];
    let nothing = written.iter().all(|(_, value)| value.is_none()) && drive.position.is_none();
    if nothing && problems.are_sound(&[path]) {
        let help = format!("add {}", targets.join(" or "));
        problems.key(path, "has no target", help);
    }
    for (target, value) in written {
        let Some(value) = value else { continue };
        let key = format!("{path}.{target}");
        if !targets.contains(&target) {
            if !problems.is_as_written(&key) {
                // A misspelt key, which has been reported.
                continue;
            }
            if !problems.is_as_written(&format!("{}.direction", join("muscles", name))) {
                problems.replaced(key);
                continue;
            }
            let rule = format!("not a target of {}", driven.words());
            problems.key(
                &key,
                rule,
                format!("did you mean {}?", targets.join(" or ")),
            );
            continue;
        }
        match driven {
            Driven::Lumen(at_rest) => {
                lumen::apply(&key, (target, value), (case, tube), at_rest, load, problems);
            }
            Driven::End(e) if matches!(target, "offset" | "tilt_degrees") => {
                let (diameter, support) = (case.tube.diameter, tube.ends[e]);
                sideways::apply(
                    &key,
                    target,
                    drive,
                    diameter,
                    support,
                    &mut load.ends[e],
                    problems,
                );
            }
            Driven::Muscle(m, _) => {
                load.muscles[m] = value;
                check_stretch(&key, &tube.muscles[m], value, tube, problems);
            }
            Driven::End(e) => {
                let end = &mut load.ends[e];
                match target {
                    "displacement" => end.displacement = value / case.tube.diameter,
                    _ => end.twist = value.to_radians(),
                }
                check_held(&key, target, tube.ends[e], problems);
            }
            Driven::Obstacle(i, _) => {
                let placement = &mut load.obstacles[i];
                match (target, drive.position) {
                    ("position", Some(position)) => placement.position = in_tube(position, case),
                    _ => placement.radius = value / case.tube.diameter,
                }
            }
            Driven::Patch(i) => load.patches[i] = value,
            Driven::Wall(w) => {
                let modulus = youngs_modulus(case);
                let (wall, value) = (&mut load.pressures[w], value / modulus);
                match target {
                    "pressure" => wall.follower = value,
                    _ => wall.dead = value,
                }
                if (w, target) == (0, "pressure") {
                    load.lumen_volume = None;
                }
                check_pressure(&key, value, case, problems);
                if target == "pressure" && value != 0.0 {
                    check_closed(&key, tube, problems);
                }
            }
        }
    }
}

/// Checks the size of a pressure in E.
fn check_pressure(key: &str, pressure: f64, case: &Case, problems: &mut Problems) {
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
    let pressed = |stage: &Stage| {
        let load = &stage.load;
        load.lumen_volume.is_some() || load.pressures.iter().any(|p| p.follower != 0.0)
    };
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
