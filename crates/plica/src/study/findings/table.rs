//! The closing table of a run.

use super::loads::{describe_course, number};
use super::place::{Interval, list};
use super::{
    Contact, Findings, Invagination, LargestForce, ObstacleContacts, Return, SmallestStretch,
    StageEnd, states_in,
};
use crate::contact::{BIOT, CREASE};
use crate::equilibrium::UnstableMode;
use crate::measure::{Shape, Side};
use crate::study::RESOLVED_TURN_DEG;

/// A name and a sentence.
pub type Line = (String, String);

/// Largest number of energy extremes that the table lists.
const LISTED_EXTREMES: usize = 4;

impl Findings {
    /// Returns the lines of the closing table, as names and sentences; none without states.
    pub fn lines(&self) -> Vec<Line> {
        if self.work.states == 0 {
            return vec![];
        }
        let mut lines = vec![];
        lines.extend(self.stages.iter().map(|stage| self.stage_line(stage)));
        lines.extend(self.energy_lines());
        lines.extend(self.pressure_lines());
        lines.extend(self.shape_lines());
        lines.extend(self.returned.iter().map(|found| self.returned_line(found)));
        lines.extend(self.caution_lines());
        lines.extend(self.stability_lines());
        lines.push(self.states_line());
        lines.push(self.work_line());
        lines
    }

    fn energy(&self, energy: f64) -> String {
        let name = match self.has_tension {
            true => "W with tensions",
            false => "W",
        };
        format!("{name} = {} {}", number(energy, 6), self.energy_unit)
    }

    fn length(&self, length: f64) -> String {
        match length {
            x if x != 0.0 && x < 1e-2 => format!("{x:.1e} {}", self.length_unit),
            x => format!("{x:.3} {}", self.length_unit),
        }
    }

    /// Describes the change of load of a stage and its last state.
    fn stage_line(&self, stage: &StageEnd) -> Line {
        let [first, last] = stage.states;
        let states = if first == last {
            format!("state {last}")
        } else {
            format!("states {first} to {last}")
        };
        let loads = if stage.to.is_empty() {
            "no change of load".to_owned()
        } else {
            describe_course(&stage.from, &stage.through, &stage.to)
        };
        let end = match (stage.shape, stage.side) {
            (Shape::Invaginated, Side::Colon | Side::Ileum) => format!(
                "invaginated toward the {}, overhang {}",
                stage.toward,
                self.length(stage.overhang)
            ),
            (shape, _) => shape.to_string(),
        };
        let energy = self.energy(stage.energy);
        let line = format!("{states}, {loads}; at the end {energy}, {end}");
        (format!("stage {}", stage.name), line)
    }

    /// Describes extremes of W.
    fn energy_lines(&self) -> Vec<Line> {
        // With tensions W is not the energy that is stored.
        let names = match self.has_tension {
            true => ["minimum of W", "maximum of W"],
            false => ["energy minimum", "energy maximum"],
        };
        let line = |extreme: &super::Extreme| {
            let name = names[usize::from(!extreme.is_minimum)];
            let jump = match (extreme.is_at_jump, extreme.is_minimum) {
                (false, _) => "",
                (true, true) => ", after a jump",
                (true, false) => ", before a jump",
            };
            let energy = self.energy(extreme.energy);
            (name.to_owned(), format!("{energy} at {}{jump}", extreme.at))
        };
        let mut lines: Vec<Line> = self
            .extremes
            .iter()
            .take(LISTED_EXTREMES)
            .map(line)
            .collect();
        if let Some(more) = self.extremes.len().checked_sub(LISTED_EXTREMES + 1) {
            let others = "of the energy are not listed here";
            lines.push((String::new(), format!("{} extremes {others}", more + 1)));
        }
        if !self.energy_minima().any(|_| true) {
            let none = "none inside a stage".to_owned();
            lines.insert(0, (names[0].into(), none));
        }
        lines
    }

    /// Describes extremes of the pressure in a driven lumen.
    fn pressure_lines(&self) -> impl Iterator<Item = Line> {
        self.pressure_extremes.iter().map(|extreme| {
            let name = match extreme.is_maximum {
                true => "pressure maximum",
                false => "pressure minimum",
            };
            let [pressure, volume] = [extreme.pressure, extreme.volume].map(|x| number(x, 4));
            let (stress, cubic) = (&self.stress_unit, &self.volume_unit);
            let line = format!(
                "{pressure} {stress} at a volume of {volume} {cubic}, near {}",
                extreme.at
            );
            (name.to_owned(), line)
        })
    }

    /// Describes when the wall is square, overhangs and invaginates.
    fn shape_lines(&self) -> Vec<Line> {
        let or_none = |intervals: &[Interval]| match intervals {
            [] => "in no state".to_owned(),
            intervals => list(intervals),
        };
        let mut lines = vec![
            ("wall is square".into(), or_none(&self.square)),
            ("wall overhangs".into(), or_none(&self.overhanging)),
        ];
        if self.invaginations.is_empty() {
            lines.push(("invaginates".into(), "no".into()));
        }
        for (i, Invagination { states, deepest }) in self.invaginations.iter().enumerate() {
            let toward = match deepest.side {
                Side::None => "toward both sides alike".to_owned(),
                _ => format!("toward the {}", deepest.toward),
            };
            let most = self.length(deepest.overhang);
            let text = format!("{toward}, at most by {most} at {}", deepest.at);
            let text = match *states == self.overhanging {
                true => text,
                false => format!("{}: {text}", list(states)),
            };
            let name = if i == 0 { "invaginates" } else { "" };
            lines.push((name.into(), text));
        }
        lines.extend(
            self.contact
                .iter()
                .flat_map(|found| self.contact_lines(found)),
        );
        lines.extend(
            self.obstacles
                .iter()
                .flat_map(|found| self.obstacle_lines(found)),
        );
        if let Some(largest) = &self.asymmetry {
            let [amplitude, start] = [largest.amplitude, largest.at_start].map(|x| self.length(x));
            let mode = UnstableMode::Circumferential(largest.mode).describe();
            // The prescribed imperfection is no result.
            let most = if largest.at_start == 0.0 {
                format!("at most {amplitude}, in {mode}, at {}", largest.at)
            } else if amplitude == start {
                format!("does not exceed the {start} of the first state")
            } else {
                let from = format!("from {start} in the first state to at most {amplitude}");
                format!("grows {from}, in {mode}, at {}", largest.at)
            };
            lines.push(("asymmetry".into(), most));
        }
        lines
    }

    /// Describes where walls touch themselves, and where their surface is so compressed that it creases.
    fn contact_lines(&self, found: &Contact) -> Vec<Line> {
        let first = found.first.iter();
        let first: Vec<String> = first
            .map(|first| {
                let place = self.place(first.from_to, first.angles_deg);
                format!("the {} first at {}, {place}", first.wall, first.at)
            })
            .collect();
        let touches = match first.is_empty() {
            true => "in no state".to_owned(),
            false => format!(
                "{}; {} (energy of contact at most {:.1e} W)",
                list(&self.touching),
                first.join(", "),
                found.largest_energy_share
            ),
        };
        let mut lines = vec![("wall touches itself".to_owned(), touches)];
        if let Some(work) = found.friction_work {
            lines.push(("friction on itself".to_owned(), self.friction(work)));
        }
        if !found.crease.is_empty() {
            let SmallestStretch { wall, stretch, at } = &found.smallest_stretch;
            let mut line = format!(
                "{} with s = λ₁² λ₂ < {CREASE}, where a crease has less energy than a flat surface",
                list(&found.crease)
            );
            if !found.biot.is_empty() {
                let states = list(&found.biot);
                line += &format!("; {states} below {BIOT:.4}, where a flat surface is unstable");
            }
            line += &format!("; least {stretch:.3} at the {wall} at {at}");
            lines.push(("surface creases".into(), line));
        }
        lines
    }

    /// Describes a place of contact.
    fn place(&self, ends: [f64; 2], angles: Option<[f64; 2]>) -> String {
        let [from, to] = ends.map(|z| format!("{z:.3}"));
        let along = match from == to {
            true => format!("at z = {from}"),
            false => format!("from z = {from} to {to}"),
        };
        let unit = &self.length_unit;
        match angles {
            None => format!("{along} {unit}"),
            Some([0.0, 360.0]) => format!("{along} {unit} all around"),
            Some([from, to]) => format!("{along} {unit}, around from {from:.0}° to {to:.0}°"),
        }
    }

    /// Describes the work of friction.
    fn friction(&self, work: f64) -> String {
        let (work, unit) = (number(work, 3), &self.energy_unit);
        format!("{work} {unit} dissipated; the stability test leaves friction out")
    }

    /// Describes when a wall touches an obstacle.
    fn obstacle_lines(&self, found: &ObstacleContacts) -> Vec<Line> {
        let touches = match &found.largest_force {
            None => "in no state".to_owned(),
            Some(LargestForce { force, at }) => format!(
                "{}; with at most {} {} at {at}",
                list(&found.touching),
                number(*force, 3),
                self.force_unit
            ),
        };
        let mut lines = vec![(format!("touches {}", found.name), touches)];
        if let Some(work) = found.friction_work {
            let of = format!("friction on {}", found.name);
            lines.push((of, self.friction(work)));
        }
        if !found.overlapping.is_empty() {
            let states = list(&found.overlapping);
            let overlaps = format!("{states}, which is not physical");
            lines.push((format!("overlaps {}", found.name), overlaps));
        }
        lines
    }

    /// Describes what remains of a cycle of loads.
    fn returned_line(&self, found: &Return) -> Line {
        let Return {
            earlier,
            last,
            energy,
            shape,
            ..
        } = found;
        let load = format!("state {} has the load of {earlier}", last.state);
        let [before, after] = shape;
        let line = if found.is_same {
            format!("{load} and is the same state: the tube has recovered")
        } else {
            let [w, now] = energy.map(|w| number(w, 6));
            let unit = &self.energy_unit;
            let differ = format!("{now} against {w} {unit}, {after} against {before}");
            format!("{load} but is another state: W = {differ}")
        };
        ("return".into(), line)
    }

    /// Describes states that are not physical.
    fn caution_lines(&self) -> Vec<Line> {
        // Contact rules a crossing out, but nothing keeps a wall from the axis.
        let (crossing, closed) = match self.contact {
            None => ["not physical, as there is no contact"; 2].into(),
            Some(_) => (
                "contact rules this out; please report it",
                "not physical, as contact keeps walls apart but not off the axis",
            ),
        };
        let mut reasons = vec![
            ("wall crosses itself", &self.crossing, crossing.to_owned()),
            ("lumen is closed", &self.closed, closed.to_owned()),
        ];
        if let Some(contact) = &self.contact {
            let turn = contact.largest_turn_deg;
            let line = format!(
                "a wall turns by up to {turn:.0}° within one element, more than {RESOLVED_TURN_DEG:.0}°: refine the mesh \
                 there (mesh.refine)"
            );
            reasons.push(("crease finer than mesh", &contact.unresolved, line));
        }
        let found = reasons
            .into_iter()
            .filter(|(_, states, _)| !states.is_empty());
        found
            .map(|(name, states, line)| (name.to_owned(), format!("{}: {line}", list(states))))
            .collect()
    }

    /// Describes unstable states, and states whose stability is not known.
    fn stability_lines(&self) -> Vec<Line> {
        let mut lines = vec![];
        let mut name = "unstable";
        for unstable in &self.unstable {
            let line = format!("to {}: {}", unstable.description, list(&unstable.states));
            lines.push((name.to_owned(), line));
            name = "";
        }
        if let Some(leaves) = &self.leaves {
            let line = format!(
                "from {} on, a tube with a small imperfection leaves this path, by {}",
                leaves.at, leaves.mode
            );
            lines.push(("branch".into(), line));
        }
        if !self.untested.is_empty() {
            let line = format!("not determined: {}", list(&self.untested));
            lines.push(("stability".into(), line));
        } else if self.unstable.is_empty() {
            lines.push((name.to_owned(), "in no state".into()));
        }
        lines
    }

    fn states_line(&self) -> Line {
        let equilibrium = match states_in(&self.out_of_equilibrium) {
            0 => "all in equilibrium".to_owned(),
            _ => format!("not in equilibrium: {}", list(&self.out_of_equilibrium)),
        };
        let (states, residual) = (self.work.states, self.work.largest_residual);
        let line = format!("{states}, {equilibrium} (largest residual {residual:.0e})");
        ("states".into(), line)
    }

    fn work_line(&self) -> Line {
        let line = format!(
            "{} in {:.1} s, {} by relaxation",
            counted(self.work.linear_solves, "linear solve"),
            self.work.seconds,
            counted(self.jumps.len(), "step")
        );
        ("work".into(), line)
    }
}

/// Returns a count with its noun in the singular or plural.
fn counted(count: usize, noun: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{count} {noun}{plural}")
}
