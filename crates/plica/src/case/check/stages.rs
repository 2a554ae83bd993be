//! The stages: what they drive, and whether a tube can follow.

use super::super::keys::join;
use super::super::problem::Problems;
use super::super::spec::{self, Drive, Spec};
use super::super::spelling::nearest;
use super::tube::tidy;
use crate::activation::{Direction, Muscle};
use crate::study::Stage;
use crate::tube::{Load, Part, Push, Support, Tube};
use std::collections::HashMap;

/// The names of the ends, in the order of the load.
pub(super) const ENDS: [&str; 2] = ["colon", "ileum"];
/// The names of the walls, in the order of the load.
pub(super) const WALLS: [&str; 2] = ["inner-wall", "outer-wall"];
/// So many names are told where one of them may be meant.
const SOME: usize = 12;
/// So many problems are many.
const MANY: usize = 200;
/// Largest pressure, in E.
const LARGEST_PRESSURE: f64 = 10.0;
/// Smallest stress-free stretch that a wall is asked to take.
pub(super) const SMALLEST_STRETCH: f64 = 0.02;
/// Shortest and longest distance of the ends, over the length at rest.
const ENDS_APART: std::ops::RangeInclusive<f64> = 0.05..=10.0;

/// The stages with their loads, the first from `begin` on.
pub(super) fn stages(
    spec: &Spec,
    tube: &Tube,
    begin: &Load,
    problems: &mut Problems,
) -> Vec<Stage> {
    let mut stages: Vec<Stage> = Vec::new();
    let mut load = begin.clone();
    let mut names: HashMap<String, usize> = HashMap::new();
    let muscles: HashMap<&str, usize> = tube
        .muscles
        .iter()
        .map(|m| m.name.as_str())
        .zip(0..)
        .collect();
    for (i, stage) in spec.stages.iter().enumerate() {
        let path = format!("stages[{}]", i + 1);
        let name = stage.name.clone();
        let name = name.unwrap_or_else(|| format!("stage-{}", i + 1));
        let key = format!("{path}.name");
        let other = *names.entry(name.clone()).or_insert(i);
        if other < i
            && problems.is_as_written(&key)
            && problems.is_as_written(&format!("stages[{}].name", other + 1))
        {
            problems.value(&key, "another stage has this name already", None);
        }
        for (target, drive) in &stage.drive {
            let key = join(&format!("{path}.drive"), target);
            let driven = Driven::find(target, tube, &muscles);
            apply(
                (&key, target, driven),
                drive,
                spec,
                tube,
                &mut load,
                problems,
            );
        }
        stages.push(Stage {
            name,
            load: load.clone(),
            steps: stage.steps,
        });
    }
    stages
}

/// What must hold for all stages together.
pub(super) fn check_whole(tube: &Tube, begin: &Load, stages: &[Stage], problems: &mut Problems) {
    let of_all = |what: &str| {
        (1..=stages.len())
            .map(|i| format!("stages[{i}].drive{what}"))
            .collect()
    };
    let none_about = |keys: Vec<String>, problems: &Problems| {
        keys.iter().all(|key| problems.none_about(&[key])) && problems.is_as_written("start")
    };
    let nothing = stages.iter().all(|stage| stage.load == *begin);
    if nothing && problems.is_as_written("stages") && none_about(of_all(""), problems) {
        let cure = "write drive.NAME.diameter_ratio = 0.25 in a stage, NAME being a muscle's";
        problems.key(
            "stages",
            "nothing is driven in any stage to anything but where it begins",
            Some(cure.into()),
        );
    }
    let moved: Vec<String> = ENDS
        .iter()
        .flat_map(|end| -> Vec<String> { of_all(&format!(".{end}")) })
        .chain(["tube.length", "tube.diameter"].map(String::from))
        .collect();
    if !none_about(moved, problems) {
        return;
    }
    for (i, stage) in stages.iter().enumerate() {
        let [colon, ileum] = stage.load.ends;
        let apart = 1.0 + (ileum.displacement - colon.displacement) / tube.length;
        let before = i.checked_sub(1).map_or(begin, |j| &stages[j].load);
        let [was, will] = [before, &stage.load].map(|load| load.ends.map(|end| end.displacement));
        if !ENDS_APART.contains(&apart) && (i == 0 || was != will) {
            let rule = format!(
                "leaves the ends at {} times their distance at rest",
                tidy(apart)
            );
            let (low, high) = (ENDS_APART.start(), ENDS_APART.end());
            let cure = format!("stay between {low} and {high}");
            let moved = [0, 1].map(|end| (will[end] - was[end]).abs());
            let end = usize::from(moved[1] >= moved[0]);
            let key = format!("stages[{}].drive.{}.displacement", i + 1, ENDS[end]);
            problems.value(&key, rule, Some(cure));
        }
    }
}

/// What a stage drives.
#[derive(Clone, Copy)]
enum Driven {
    /// A muscle, by its place in the tube.
    Muscle(usize, Direction),
    /// The colon end or the ileum end.
    End(usize),
    /// The inner wall or the outer wall.
    Wall(usize),
}

impl Driven {
    fn find(name: &str, tube: &Tube, muscles: &HashMap<&str, usize>) -> Option<Self> {
        if let Some(end) = ENDS.iter().position(|&end| end == name) {
            return Some(Self::End(end));
        }
        if let Some(wall) = WALLS.iter().position(|&wall| wall == name) {
            return Some(Self::Wall(wall));
        }
        let m = *muscles.get(name)?;
        Some(Self::Muscle(m, tube.muscles[m].direction))
    }

    fn targets(self) -> &'static [&'static str] {
        match self {
            Self::Muscle(_, Direction::Circular) => &["diameter_ratio"],
            Self::Muscle(_, Direction::Longitudinal) => &["length_ratio"],
            Self::End(_) => &["displacement", "twist_degrees"],
            Self::Wall(_) => &["pressure", "dead_load"],
        }
    }

    fn words(self) -> &'static str {
        match self {
            Self::Muscle(_, Direction::Circular) => "a circular muscle",
            Self::Muscle(_, Direction::Longitudinal) => "a longitudinal muscle",
            Self::End(_) => "an end of the tube",
            Self::Wall(_) => "a wall of the tube",
        }
    }
}

/// Puts what a stage says about one muscle or end into the load.
fn apply(
    (path, name, driven): (&str, &str, Option<Driven>),
    drive: &Drive,
    spec: &Spec,
    tube: &Tube,
    load: &mut Load,
    problems: &mut Problems,
) {
    let muscle = join("muscles", name);
    let Some(driven) = driven else {
        if !problems.none_about(&[&muscle]) {
            return problems.replaced(path.to_owned());
        }
        let muscles = || tube.muscles.iter().map(|m| m.name.as_str());
        let names = || muscles().chain(ENDS).chain(WALLS);
        // Nobody reads on among so many.
        let near = match problems.len() < MANY {
            true => nearest(name, names()),
            false => None,
        };
        let cure = match near {
            Some(near) => format!("did you mean {near}?"),
            None => {
                let some: Vec<&str> = names().take(SOME).collect();
                let more = if names().count() > SOME { ", …" } else { "" };
                format!("add [{muscle}], or drive {}{more}", some.join(", "))
            }
        };
        return problems.key(path, "there is no muscle of this name", Some(cure));
    };
    if !matches!(driven, Driven::Muscle(..)) && spec.muscles.contains_key(name) {
        // A muscle of a name that it cannot have.
        return problems.replaced(path.to_owned());
    }
    let targets = driven.targets();
    let written = [
        ("diameter_ratio", drive.diameter_ratio),
        ("length_ratio", drive.length_ratio),
        ("displacement", drive.displacement),
        ("twist_degrees", drive.twist_degrees),
        ("pressure", drive.pressure),
        ("dead_load", drive.dead_load),
    ];
    if written.iter().all(|(_, value)| value.is_none()) && problems.none_about(&[path]) {
        let cure = format!("give {}", targets.join(" or "));
        problems.key(path, "drives nothing", Some(cure));
    }
    for (target, value) in written {
        let Some(value) = value else { continue };
        let key = format!("{path}.{target}");
        if !targets.contains(&target) {
            if !problems.is_as_written(&format!("{muscle}.direction")) {
                problems.replaced(key);
                continue;
            }
            let rule = format!("not a target of {}", driven.words());
            let cure = format!("did you mean {}?", targets.join(" or "));
            problems.key(&key, rule, Some(cure));
            continue;
        }
        match driven {
            Driven::Muscle(m, _) => {
                load.muscles[m] = value;
                check_stretch(&key, &tube.muscles[m], value, tube, problems);
            }
            Driven::End(e) => {
                let end = &mut load.ends[e];
                match target {
                    "displacement" => end.displacement = value / spec.tube.diameter,
                    _ => end.twist = value.to_radians(),
                }
                check_held(&key, target, tube.ends[e], problems);
            }
            Driven::Wall(w) => {
                let spec::Material::NeoHookean(law) = &spec.material;
                let (wall, value) = (&mut load.pressures[w], value / law.youngs_modulus);
                match target {
                    "pressure" => wall.follower = value,
                    _ => wall.dead = value,
                }
                check_pressure(&key, value, law.youngs_modulus, problems);
                if target == "pressure" && value != 0.0 {
                    check_closed(&key, tube, problems);
                }
            }
        }
    }
}

/// Whether a pressure, in E, is one that a wall may be put under.
fn check_pressure(key: &str, pressure: f64, youngs_modulus: f64, problems: &mut Problems) {
    let material = "material.neo-hookean.youngs_modulus";
    if pressure.abs() > LARGEST_PRESSURE && problems.none_about(&[key, material]) {
        let largest = tidy(LARGEST_PRESSURE * youngs_modulus);
        let rule = format!("must be from -{largest} to {largest}, ten times Young's modulus");
        problems.value(key, rule, None);
    }
}

/// Whether the work of a true pressure depends on the state alone.
pub(super) fn check_closed(key: &str, tube: &Tube, problems: &mut Problems) {
    let free = tube.ends.iter().position(|end| *end == Support::Free);
    if let Some(name) = free.map(|end| ENDS[end]) {
        let rule = format!(
            "the work of a true pressure depends on what closes an end that moves, and the {name} end is free"
        );
        let cure = "hold it, with \"sliding\" or \"fixed\" in [ends], or give dead_load";
        problems.value(key, rule, Some(cure.into()));
    }
}

/// Whether ends that slide under a true pressure stay in their planes.
pub(super) fn check_planes(tube: &Tube, stages: &[Stage], problems: &mut Problems) {
    let pressed = |stage: &Stage| stage.load.pressures.iter().any(|p| p.follower != 0.0);
    let none = problems.none_about(&["imperfections", "ends", "stages", "start"]);
    if !none || !stages.iter().any(pressed) {
        return;
    }
    for (i, imperfection) in tube.imperfections.iter().enumerate() {
        let Part::End(end, Push::Axial) = imperfection.of else {
            continue;
        };
        let slides = tube.ends[end as usize] == Support::Sliding;
        let waves = imperfection.shape.waves();
        if slides && waves.iter().any(|wave| wave.harmonic > 0) {
            let rule =
                "an end that slides out of its plane does not close a tube under true pressure";
            let cure = "fix the end, or give dead_load in the stages";
            problems.key(
                &format!("imperfections[{}]", i + 1),
                rule,
                Some(cure.into()),
            );
        }
    }
}

/// Whether an end is held as its motion needs.
pub(super) fn check_held(key: &str, target: &str, support: Support, problems: &mut Problems) {
    let rule = match (target, support) {
        (_, Support::Fixed) | ("displacement", Support::Sliding) => return,
        ("displacement", _) => "only a fixed or sliding end can be moved, and this one is free",
        _ => "only a fixed end can be turned",
    };
    let cure = "hold it, with \"fixed\" in [ends]";
    problems.value(key, rule, Some(cure.into()));
}

/// Whether the wall can take a target.
pub(super) fn check_stretch(
    key: &str,
    muscle: &Muscle,
    ratio: f64,
    tube: &Tube,
    problems: &mut Problems,
) {
    let own = join("muscles", &muscle.name);
    if !problems.none_about(&[key, &own, "tube.length", "tube.diameter"]) {
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
