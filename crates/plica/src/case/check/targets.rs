//! The targets of a stage: what a name in it stands for, and the quantities of the load that it drives.

use super::super::course::{Course, VectorCourse};
use super::super::key::join;
use super::super::keys::{Case, Drive};
use super::super::problem::Problems;
use super::super::spelling::{nearest, target};
use super::lumen::{self, LUMEN};
use super::material::youngs_modulus;
use super::muscles::{ENDS, WALLS};
use super::obstacles::in_tube;
use super::sideways;
use super::stages::{check_closed, check_held, check_pressure, check_stretch, check_tension};
use crate::activation::MuscleTarget;
use crate::tube::{Load, ObstacleShape, Tube};
use std::collections::HashMap;

/// Number of names that a message lists.
const NAMES: usize = 12;
/// Number of problems from which on no similar names are searched for.
const MANY: usize = 200;

/// A quantity of the load that a stage drives.
pub(super) struct Target {
    /// The key of the case.
    pub key: String,
    /// The quantity.
    pub quantity: Quantity,
    /// Its values in the stage, dimensionless.
    pub course: Course,
}

/// A number of a load, with the index of its muscle, end, wall or obstacle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Quantity {
    /// The target of a muscle: Dmin/D, Lmax/L, or a tension in E.
    Muscle(usize),
    /// The shift of a muscle's zone.
    Shift(usize),
    /// The axial displacement of an end.
    Displacement(usize),
    /// The twist of an end.
    Twist(usize),
    /// The follower pressure on a wall.
    Pressure(usize),
    /// The dead load on a wall.
    DeadLoad(usize),
    /// The radius of an obstacle.
    Radius(usize),
    /// A coordinate of an obstacle's position.
    Position(usize, usize),
    /// The growth of a patch.
    Patch(usize),
    /// The volume of the lumen, over that at rest.
    LumenVolume,
    /// A displacement of an end across the axis, along x or y.
    Offset(usize, usize),
    /// A rotation of an end about x or y.
    Tilt(usize, usize),
}

impl Quantity {
    /// Returns its value in a load.
    pub fn get(self, load: &Load) -> f64 {
        *self.of(&mut load.clone())
    }

    /// Sets its value in a load. Of the volume of the lumen and the pressure in it, the one that was set last is driven.
    pub fn set(self, load: &mut Load, value: f64) {
        *self.of(load) = value;
        match self {
            Self::LumenVolume => load.pressures[0].follower = 0.0,
            Self::Pressure(0) => load.lumen_volume = None,
            _ => {}
        }
    }

    fn of(self, load: &mut Load) -> &mut f64 {
        match self {
            Self::Muscle(m) => &mut load.muscles[m],
            Self::Shift(m) => &mut load.shifts[m],
            Self::Displacement(end) => &mut load.ends[end].displacement,
            Self::Twist(end) => &mut load.ends[end].twist,
            Self::Pressure(wall) => &mut load.pressures[wall].follower,
            Self::DeadLoad(wall) => &mut load.pressures[wall].dead,
            Self::Radius(i) => &mut load.obstacles[i].radius,
            Self::Position(i, k) => &mut load.obstacles[i].position[k],
            Self::Patch(i) => &mut load.patches[i],
            Self::LumenVolume => load.lumen_volume.get_or_insert(1.0),
            Self::Offset(end, i) => &mut load.ends[end].shift[i],
            Self::Tilt(end, i) => &mut load.ends[end].tilt[i],
        }
    }
}

/// The thing that a name in a stage stands for.
#[derive(Clone, Copy)]
pub(super) enum Driven {
    /// A muscle, by its index in the tube.
    Muscle(usize, MuscleTarget),
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
    /// Returns what a name stands for; none if there is nothing of this name.
    pub fn find(name: &str, tube: &Tube, muscles: &HashMap<&str, usize>) -> Option<Self> {
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
        Some(Self::Muscle(m, tube.muscles[m].target()))
    }

    fn targets(self) -> &'static [&'static str] {
        match self {
            Self::Muscle(_, MuscleTarget::DiameterRatio) => &["diameter_ratio", "stretch", "shift"],
            Self::Muscle(_, MuscleTarget::LengthRatio) => &["length_ratio", "stretch", "shift"],
            Self::Muscle(_, MuscleTarget::Tension) => &["tension", "shift"],
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
            Self::Muscle(_, MuscleTarget::DiameterRatio) => "a circular muscle",
            Self::Muscle(_, MuscleTarget::LengthRatio) => "a longitudinal muscle",
            Self::Muscle(_, MuscleTarget::Tension) => "a muscle with active stress",
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
pub(super) fn unknown_name(path: &str, name: &str, tube: &Tube, problems: &mut Problems) {
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

/// Returns the components of a target by their numbers.
fn components<const N: usize>(
    course: Option<VectorCourse<N>>,
) -> impl Iterator<Item = (usize, Course)> {
    let component = |course: VectorCourse<N>| (0..N).map(move |i| (i, course.component(i)));
    course.into_iter().flat_map(component)
}

/// Returns words as a list in a sentence.
fn list(words: &[&str], before_last: &str) -> String {
    match words {
        [rest @ .., last] if rest.len() > 1 => {
            format!("{}, {before_last} {last}", rest.join(", "))
        }
        _ => words.join(&format!(" {before_last} ")),
    }
}

/// Returns the targets of one muscle, end, surface or obstacle of a stage.
pub(super) fn read(
    path: &str,
    name: &str,
    driven: Driven,
    drive: &Drive,
    (case, tube): (&Case, &Tube),
    problems: &mut Problems,
) -> Vec<Target> {
    if !matches!(driven, Driven::Muscle(..)) && case.muscles.contains_key(name) {
        // A muscle of a name that is taken, which has been reported.
        problems.replaced(path);
        return vec![];
    }
    let targets = driven.targets();
    let own = ["direction", "active_stress"].map(|key| format!("{}.{key}", join("muscles", name)));
    let is_known = |problems: &Problems| own.iter().all(|key| problems.is_as_written(key));
    if is_known(problems) {
        problems.advise_unknown(path, |unknown| {
            match nearest(unknown, targets.iter().copied()) {
                Some(near) => format!("did you mean {near}?"),
                None => format!("{} has {}", driven.words(), list(targets, "and")),
            }
        });
    }
    let given = |is_given: bool| is_given.then_some(Course::Value(f64::NAN));
    let position = given(drive.position.is_some());
    let [offset, tilt] = [&drive.offset, &drive.tilt_degrees].map(|pair| given(pair.is_some()));
    let written = [
        ("diameter_ratio", drive.diameter_ratio.as_ref()),
        ("length_ratio", drive.length_ratio.as_ref()),
        ("stretch", drive.stretch.as_ref()),
        ("tension", drive.tension.as_ref()),
        ("growth_through", drive.growth_through.as_ref()),
        ("shift", drive.shift.as_ref()),
        ("displacement", drive.displacement.as_ref()),
        ("twist_degrees", drive.twist_degrees.as_ref()),
        ("offset", offset.as_ref()),
        ("tilt_degrees", tilt.as_ref()),
        ("volume_ratio", drive.volume_ratio.as_ref()),
        ("volume", drive.volume.as_ref()),
        ("pressure", drive.pressure.as_ref()),
        ("dead_load", drive.dead_load.as_ref()),
        ("radius", drive.radius.as_ref()),
        ("position", position.as_ref()),
    ];
    if written.iter().all(|(_, course)| course.is_none()) && problems.are_sound(&[path]) {
        let help = format!("add {}", list(targets, "or"));
        problems.key(path, "has no target", help);
    }
    let mut all = vec![];
    for (target, course) in written {
        let Some(course) = course else { continue };
        let key = format!("{path}.{target}");
        if !targets.contains(&target) {
            if !problems.is_as_written(&key) {
                // A misspelt key, which has been reported.
                continue;
            }
            if !is_known(problems) {
                problems.replaced(key);
                continue;
            }
            let rule = format!("not a target of {}", driven.words());
            let help = format!("did you mean {}?", list(targets, "or"));
            problems.key(&key, rule, help);
            continue;
        }
        let kind = target;
        let target = |quantity, course| Target {
            key: key.clone(),
            quantity,
            course,
        };
        let diameter = case.tube.diameter;
        match (driven, kind) {
            (Driven::Muscle(m, _), "shift") => {
                all.push(target(
                    Quantity::Shift(m),
                    course.map(|shift| shift / diameter),
                ));
            }
            (Driven::Muscle(m, MuscleTarget::Tension), _) => {
                let modulus = youngs_modulus(case);
                let course = course.map(|tension| tension / modulus);
                for tension in course.values() {
                    check_tension(&key, tension, case, problems);
                }
                all.push(target(Quantity::Muscle(m), course));
            }
            (Driven::Muscle(m, _), kind) => {
                let muscle = &tube.muscles[m];
                let ratio = |value| match kind {
                    "stretch" => muscle.ratio_of(value, tube.length),
                    _ => value,
                };
                let course = course.map(ratio);
                for ratio in course.values() {
                    check_stretch(&key, muscle, ratio, tube, problems);
                }
                let is_taken = all
                    .iter()
                    .any(|other: &Target| other.quantity == Quantity::Muscle(m));
                if is_taken && problems.are_sound(&[&key]) {
                    let rule = format!("{} gives the same target", targets[0]);
                    problems.key(&key, rule, "write one of the two");
                }
                all.push(target(Quantity::Muscle(m), course));
            }
            (Driven::Lumen(at_rest), kind) => {
                let ratio = |value| lumen::ratio((kind, value), case, at_rest);
                let course = course.map(ratio);
                lumen::check_target(&key, kind, &course, (case, tube), problems);
                all.push(target(Quantity::LumenVolume, course));
            }
            (Driven::End(e), "offset") => {
                sideways::check_support(&key, tube.ends[e], problems);
                let offset = drive.offset.as_ref();
                let offset = offset.map(|course| course.map(|x| x.map(|x| x / diameter)));
                for (i, course) in components(offset) {
                    all.push(target(Quantity::Offset(e, i), course));
                }
            }
            (Driven::End(e), "tilt_degrees") => {
                let tilt = drive.tilt_degrees.as_ref();
                for tilt in tilt.map(VectorCourse::values).unwrap_or_default() {
                    sideways::check_tilt(&key, tilt, problems);
                }
                sideways::check_support(&key, tube.ends[e], problems);
                let tilt = tilt.map(|course| course.map(|x| x.map(f64::to_radians)));
                for (i, course) in components(tilt) {
                    all.push(target(Quantity::Tilt(e, i), course));
                }
            }
            (Driven::End(e), kind) => {
                all.push(match kind {
                    "displacement" => {
                        target(Quantity::Displacement(e), course.map(|x| x / diameter))
                    }
                    _ => target(Quantity::Twist(e), course.map(f64::to_radians)),
                });
                check_held(&key, kind, tube.ends[e], problems);
            }
            (Driven::Obstacle(i, _), "radius") => {
                all.push(target(Quantity::Radius(i), course.map(|x| x / diameter)));
            }
            (Driven::Obstacle(i, _), _) => {
                let position = drive.position.as_ref();
                let position = position.map(|course| course.map(|x| in_tube(x, case)));
                for (k, course) in components(position) {
                    all.push(target(Quantity::Position(i, k), course));
                }
            }
            (Driven::Patch(i), _) => all.push(target(Quantity::Patch(i), course.clone())),
            (Driven::Wall(w), kind) => {
                let modulus = youngs_modulus(case);
                let course = course.map(|value| value / modulus);
                for value in course.values() {
                    check_pressure(&key, value, case, problems);
                }
                let is_follower = kind == "pressure";
                if is_follower && course.values().any(|value| value != 0.0) {
                    check_closed(&key, tube, problems);
                }
                all.push(match is_follower {
                    true => target(Quantity::Pressure(w), course),
                    false => target(Quantity::DeadLoad(w), course),
                });
            }
        }
    }
    all
}
