//! The branch that `plica follow` computes.

use super::super::course::Course;
use super::super::key::{Key, Kind, default};
use super::super::keys::{Case, Continuation, Drive};
use super::super::problem::Problems;
use super::super::read::{Read, Table};
use super::super::spelling::nearest;
use super::targets::{self, Driven, Target};
use crate::study::{Condition, Event, Following, PARAMETER, Plan, Stage, Switch};
use crate::tube::{Load, Symmetry, Tube};
use std::collections::HashMap;

const OF: &str = "continuation.of";
const BETWEEN: &str = "continuation.between";

/// The events of the words in `locate`.
const EVENTS: [(&str, Event); 4] = [
    ("fold", Event::Fold),
    ("modes", Event::Modes),
    ("contact", Event::Contact),
    ("energy", Event::Energy),
];

/// Returns the branch of a case in which nothing else is wrong; none without the table.
pub(super) fn following(
    case: &Case,
    tube: &Tube,
    symmetry: Symmetry,
    (begin, stages): (&Load, &[Stage]),
    problems: &mut Problems,
) -> Option<Following> {
    let table = case.continuation.as_ref()?;
    if !problems.is_empty() || stages.is_empty() {
        return None;
    }
    if symmetry != Symmetry::Axisymmetric {
        let rule = "branches are followed in axisymmetric tubes only";
        problems.key(
            "continuation",
            rule,
            "set symmetry = \"axisymmetric\", or remove the table",
        );
        return None;
    }
    let obstacles = case.obstacles.iter();
    if case.friction > 0.0 || obstacles.into_iter().any(|on| on.friction > 0.0) {
        let rule = "friction has no energy, and depends on the way: there are no branches with it";
        problems.key(
            "continuation",
            rule,
            "set friction = 0, or remove the table",
        );
        return None;
    }
    let after = stage_after(table, stages, problems)?;
    let base = stages.get(after).map_or(begin, |stage| &stage.load);
    let [from, to] = table.between;
    if !(from.is_finite() && to.is_finite() && from != to) {
        problems.value(BETWEEN, "must be two different numbers", "");
        return None;
    }
    let loads = [
        load_at(table, from, base, (case, tube), problems)?,
        load_at(table, to, base, (case, tube), problems)?,
    ];
    let following = Following {
        of: table.of.clone(),
        after,
        range: table.between,
        loads,
        events: events(table, problems)?,
        switches: switches(table),
        longest_step: table.longest_step,
        points: table.points,
        plot: table.plot.clone(),
    };
    // The pressure that holds a driven volume is known only when the stage is run.
    if base.lumen_volume.is_none() {
        check_begin(&following, base, problems);
    }
    Some(following)
}

fn stage_after(table: &Continuation, stages: &[Stage], problems: &mut Problems) -> Option<usize> {
    let Some(name) = &table.after else {
        return Some(stages.len() - 1);
    };
    let found = stages.iter().position(|stage| stage.name == *name);
    if found.is_none() {
        let names: Vec<&str> = stages.iter().map(|stage| stage.name.as_str()).collect();
        let help = match nearest(name, names.iter().copied()) {
            Some(near) => format!("did you mean {near}?"),
            None => format!("the stages are {}", names.join(", ")),
        };
        problems.value("continuation.after", "there is no stage of this name", help);
    }
    found
}

/// Returns the load with a value of the parameter.
fn load_at(
    table: &Continuation,
    value: f64,
    base: &Load,
    (case, tube): (&Case, &Tube),
    problems: &mut Problems,
) -> Option<Load> {
    let mut load = base.clone();
    for name in table.of.split(',').map(str::trim) {
        for target in targets_of(name, value, (case, tube), problems)? {
            let value = target.course.values().last()?;
            target.quantity.set(&mut load, value);
        }
    }
    if load.lumen_volume.is_some() {
        let rule = "the volume of the lumen is driven where the branch begins, and it would change its pressure";
        let help = "follow inner-wall.pressure, or let a stage drive the pressure first";
        problems.key(OF, rule, help);
        return None;
    }
    Some(load)
}

/// Returns what a target such as `longitudinal.length_ratio` drives to a value.
fn targets_of(
    name: &str,
    value: f64,
    (case, tube): (&Case, &Tube),
    problems: &mut Problems,
) -> Option<Vec<Target>> {
    let Some((driven, target)) = name.rsplit_once('.') else {
        let rule = "must name a target that a stage can drive";
        problems.value(OF, rule, "for example, \"longitudinal.length_ratio\"");
        return None;
    };
    let muscles = tube.muscles.iter().map(|muscle| muscle.name.as_str());
    let muscles: HashMap<&str, usize> = muscles.zip(0..).collect();
    let found = Driven::find(driven, tube, &muscles);
    let drive = drive(target, value);
    let (Some(found), Some(drive)) = (found, drive) else {
        let what = match found {
            None => format!("there is no `{driven}` that a stage could drive"),
            Some(_) => format!("`{target}` is no number that a branch could be followed in"),
        };
        let help = "write a target as stages do, for example \"longitudinal.length_ratio\"";
        problems.value(OF, what, help);
        return None;
    };
    if matches!(found, Driven::Lumen(_)) {
        let rule = "the volume of the lumen is no parameter of a branch";
        let help = "follow inner-wall.pressure: the branch passes the maximum of the pressure";
        problems.value(OF, rule, help);
        return None;
    }
    // A mistake is one of the range, not of a stage.
    let mut own = Problems::default();
    let path = format!("continuation.{driven}");
    let targets = targets::read(&path, driven, found, &drive, (case, tube), &mut own);
    if let Err(error) = own.into_result() {
        for problem in error.problems {
            let key = match problem.rule.starts_with("not a target") {
                true => OF,
                false => BETWEEN,
            };
            let help = problem.help.unwrap_or_default();
            problems.value(key, problem.rule, help);
        }
        return None;
    }
    Some(targets)
}

/// Returns the targets of a stage that drives one number; none if there is no such number.
fn drive(target: &str, value: f64) -> Option<Drive> {
    let key = Key {
        name: "",
        doc: "",
        kind: Kind::Table(Drive::KEYS),
        rule: default("{}"),
    };
    let mut drive = Drive::fallback(&key);
    let course = match target {
        "diameter_ratio" => &mut drive.diameter_ratio,
        "length_ratio" => &mut drive.length_ratio,
        "stretch" => &mut drive.stretch,
        "tension" => &mut drive.tension,
        "growth_through" => &mut drive.growth_through,
        "shift" => &mut drive.shift,
        "displacement" => &mut drive.displacement,
        "twist_degrees" => &mut drive.twist_degrees,
        "volume_ratio" => &mut drive.volume_ratio,
        "volume" => &mut drive.volume,
        "pressure" => &mut drive.pressure,
        "dead_load" => &mut drive.dead_load,
        "radius" => &mut drive.radius,
        _ => return None,
    };
    *course = Some(Course::Value(value));
    Some(drive)
}

fn events(table: &Continuation, problems: &mut Problems) -> Option<Vec<Event>> {
    let mut events = vec![];
    for text in &table.locate {
        let word = EVENTS.iter().find(|(word, _)| *word == text.trim());
        if let Some((_, event)) = word {
            events.push(event.clone());
            continue;
        }
        let column = text.split_once('=').and_then(|(name, value)| {
            let value: f64 = value.trim().parse().ok()?;
            value
                .is_finite()
                .then(|| Event::Column(name.trim().to_owned(), value))
        });
        let Some(column) = column else {
            let rule = format!("`{text}` is no event");
            let words: Vec<&str> = EVENTS.iter().map(|(word, _)| *word).collect();
            let help = match nearest(text, words.iter().copied()) {
                Some(near) => format!("did you mean {near}?"),
                None => format!(
                    "write {}, or a column with a value, as in \"max_wall_angle_deg = 90\"",
                    words.join(", ")
                ),
            };
            problems.key("continuation.locate", rule, help);
            return None;
        };
        events.push(column);
    }
    Some(events)
}

/// Checks that the columns that are located and plotted are columns of numbers of the plan.
pub(super) fn check_columns(plan: &Plan, problems: &mut Problems) {
    let Some(following) = &plan.following else {
        return;
    };
    let located = following.events.iter().filter_map(|event| match event {
        Event::Column(name, _) if name != PARAMETER => Some(("continuation.locate", name)),
        _ => None,
    });
    let plotted = following.plot.iter();
    let plotted = plotted.map(|name| ("continuation.plot", name));
    for (key, name) in located.chain(plotted) {
        if let Err(rule) = Condition::parse(&format!("{name} < 0"), plan) {
            problems.key(key, rule, "");
        }
    }
}

fn switches(table: &Continuation) -> Vec<Switch> {
    let switch = |switch: &super::super::keys::Switch| Switch {
        mode: switch.mode,
        amplitude: switch.amplitude,
    };
    table.switch.iter().map(switch).collect()
}

/// Checks that the branch begins within its range.
fn check_begin(following: &Following, base: &Load, problems: &mut Problems) {
    let (parameter, apart) = following.parameter_of(base);
    let [a, b] = following.range;
    let room = 1e-9 * (b - a).abs();
    if apart > 1e-9 {
        let rule = "the targets do not have the same value where the branch begins";
        problems.value(OF, rule, "name targets that stages drive to the same value");
    } else if parameter < a.min(b) - room || parameter > a.max(b) + room {
        let rule = format!(
            "the branch begins outside, at {}",
            (parameter * 1e9).round() / 1e9
        );
        let help = "widen the range, or name another stage in `after`";
        problems.value(BETWEEN, rule, help);
    }
}
