//! How a run ended, and the short table it closes with.

use super::units::Scale;
use super::{Plan, Row};
use crate::assembly::Inverted;
use crate::solve::PathError;
use crate::tube::Load;
use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// Every stage was done.
    Complete,
    /// Someone asked to stop.
    Stopped,
    /// The tube could not be followed further.
    Lost {
        /// The stage it was lost in.
        stage: String,
        /// What was tried.
        error: PathError<Inverted>,
    },
}

impl Ending {
    /// In one word.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Complete => "complete",
            Self::Stopped => "stopped",
            Self::Lost { .. } => "lost",
        }
    }
}

impl fmt::Display for Ending {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Complete => f.write_str("every stage was done"),
            Self::Stopped => f.write_str("stopped on request; every state so far is kept"),
            Self::Lost { stage, error } => write!(
                f,
                "the tube could not be followed further in stage `{stage}` ({error}); the last good \
                 state is kept. Try more steps in this stage, more solver.halvings or \
                 solver.relaxation_steps, or a finer mesh in the zone"
            ),
        }
    }
}

/// An accepted state in full.
#[derive(Clone, Debug, PartialEq)]
pub struct Snapshot {
    /// The load it is under.
    pub load: Load,
    /// Its unknowns.
    pub u: Vec<f64>,
}

/// What a run found.
#[derive(Clone, Debug)]
pub struct Summary {
    rows: Vec<Row>,
    snapshots: Vec<Snapshot>,
    ending: Ending,
    scale: Scale,
    directory: PathBuf,
}

impl Summary {
    /// Of a run.
    pub fn new(
        plan: &Plan,
        rows: Vec<Row>,
        snapshots: Vec<Snapshot>,
        ending: Ending,
        directory: &Path,
    ) -> Self {
        let scale = Scale::of(plan.units.as_ref());
        Self {
            rows,
            snapshots,
            ending,
            scale,
            directory: directory.to_owned(),
        }
    }

    /// Whether every stage was done.
    pub fn finished(&self) -> bool {
        self.ending == Ending::Complete
    }

    /// How it ended.
    pub fn ending(&self) -> &Ending {
        &self.ending
    }

    /// The accepted states.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// The accepted states in full, one per row; none if the case wants no pictures.
    pub fn snapshots(&self) -> &[Snapshot] {
        &self.snapshots
    }

    /// The state of least energy with a full contraction: a minimum of the energy over the length
    /// ratio, if there is one inside the path.
    pub fn energy_minimum(&self) -> Option<&Row> {
        let last = self.rows.last()?;
        let relaxing: Vec<&Row> = self
            .rows
            .iter()
            .filter(|r| r.diameter_ratio == last.diameter_ratio)
            .collect();
        let at = (0..relaxing.len())
            .min_by(|&a, &b| relaxing[a].energy.total_cmp(&relaxing[b].energy))?;
        (at > 0 && at + 1 < relaxing.len()).then(|| relaxing[at])
    }

    /// The first state of a shape.
    pub fn first(&self, shape: &str) -> Option<&Row> {
        self.rows.iter().find(|row| row.shape == shape)
    }

    /// The first state whose wall overhangs.
    pub fn overhang(&self) -> Option<&Row> {
        self.first("invaginated")
    }

    /// The harmonics that any state is unstable to, with those states; as `unknown` those of which it is
    /// not known.
    pub fn lost_harmonics(&self) -> BTreeMap<&str, Vec<&Row>> {
        let mut lost: BTreeMap<&str, Vec<&Row>> = BTreeMap::new();
        for row in &self.rows {
            for harmonic in row.lost_harmonics() {
                lost.entry(harmonic).or_default().push(row);
            }
        }
        lost
    }

    /// The side the tube invaginates to at the end.
    pub fn side(&self) -> &str {
        let invaginated = self.rows.last().filter(|row| row.shape == "invaginated");
        invaginated.map_or("none", |row| &row.side)
    }
}

/// What a harmonic does to a tube.
fn named(harmonic: &str) -> String {
    match harmonic {
        "0" => "harmonic 0 (along or around the axis)".into(),
        "1" => "harmonic 1 (sideways)".into(),
        "2" => "harmonic 2 (oval)".into(),
        "any" => "its own lowest mode".into(),
        n => format!("harmonic {n} ({n} lobes)"),
    }
}

/// The pressures that a state is under, if its case has any.
fn pressures(row: &Row) -> [(&'static str, Option<f64>); 4] {
    [
        ("inside", row.inner_pressure),
        ("outside", row.outer_pressure),
        ("dead, inside", row.inner_dead_pressure),
        ("dead, outside", row.outer_dead_pressure),
    ]
}

/// Where along the path a state lies.
fn place(row: &Row) -> String {
    let mut place = format!(
        "Lmax/L = {:.4}, Dmin/D = {:.4}",
        row.length_ratio, row.diameter_ratio
    );
    for (name, pressure) in pressures(row) {
        if let Some(pressure) = pressure.filter(|p| *p != 0.0) {
            place += &format!(", pressure {name} {pressure:.4e}");
        }
    }
    place
}

/// From one state to another, told by what differs where that is one quantity alone.
fn span(first: &Row, last: &Row) -> String {
    let of = |row: &Row| pressures(row).map(|(_, pressure)| pressure);
    let ratios = |row: &Row| (row.length_ratio, row.diameter_ratio);
    if first.step == last.step {
        return place(first);
    }
    if first.diameter_ratio == last.diameter_ratio && of(first) == of(last) {
        let [from, to] = [first, last].map(|row| row.length_ratio);
        return format!("Lmax/L = {from:.4} to {to:.4}");
    }
    let differ: Vec<_> = (0..4).filter(|&i| of(first)[i] != of(last)[i]).collect();
    if let ([i], true) = (&differ[..], ratios(first) == ratios(last)) {
        let [from, to] = [first, last].map(|row| of(row)[*i].unwrap_or(0.0));
        return format!("pressure {} {from:.4e} to {to:.4e}", pressures(first)[*i].0);
    }
    format!("{} to {}", place(first), place(last))
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some(last) = self.rows.last() else {
            return write!(f, "no state was accepted");
        };
        let none = || "not on this path".to_owned();
        let energy = |row: &Row| format!("W = {:.6e} {}", row.energy, self.scale.energy_name);
        let line = |f: &mut fmt::Formatter<'_>, name: &str, value: String| {
            writeln!(f, "  {name:<22} {value}")
        };
        let minimum = self.energy_minimum();
        line(
            f,
            "energy minimum",
            minimum.map_or_else(none, |row| format!("{} at {}", energy(row), place(row))),
        )?;
        line(
            f,
            "wall turns square",
            self.first("square").map_or_else(none, place),
        )?;
        line(
            f,
            "wall overhangs",
            self.overhang().map_or_else(none, place),
        )?;
        let side = match self.side() {
            "none" => "it does not".to_owned(),
            side => format!(
                "toward the {side}, {:.3} {} deep",
                last.overhang, self.scale.length_name
            ),
        };
        line(f, "invaginates", side)?;
        let physical = "nothing holds it apart, and what it does there is not physical";
        let crosses: Vec<&Row> = self
            .rows
            .iter()
            .filter(|row| row.crosses_itself())
            .collect();
        let closed: Vec<&Row> = self.rows.iter().filter(|row| row.has_closed()).collect();
        for (name, states) in [
            ("wall crosses itself", crosses),
            ("lumen is closed", closed),
        ] {
            if let [first, .., last] | [first @ last] = states.as_slice() {
                let (count, span) = (states.len(), span(first, last));
                line(f, name, format!("at {count} state(s), {span}: {physical}"))?;
            }
        }
        line(
            f,
            "last state",
            format!("{}, {} ({})", energy(last), place(last), last.shape),
        )?;
        let departs = self.rows.iter().filter(|row| row.departure_harmonic > 0);
        if let Some(row) = departs.max_by(|a, b| a.departure.total_cmp(&b.departure)) {
            let far = format!("{:.1e} {}", row.departure, self.scale.length_name);
            let harmonic = named(&row.departure_harmonic.to_string());
            let most = format!("by at most {far}, in {harmonic}, at {}", place(row));
            line(f, "leaves axisymmetry", most)?;
        }
        let count = |what: fn(&&Row) -> bool| self.rows.iter().filter(what).count();
        let found = self.rows.iter().filter(|row| row.method != "rest");
        let worst = found.map(|row| row.residual).fold(0.0, f64::max);
        let balance = match count(|row| row.equilibrium == "no") {
            0 => "all in equilibrium".to_owned(),
            out => format!("{out} out of equilibrium"),
        };
        let states = self.rows.len();
        line(
            f,
            "states",
            format!("{states}, {balance} (largest residual {worst:.0e})"),
        )?;
        let lost = self.lost_harmonics();
        if lost.is_empty() {
            line(f, "unstable", "no state".into())?;
        }
        for (i, (harmonic, rows)) in lost.iter().enumerate() {
            let (count, span) = (rows.len(), span(rows[0], rows[rows.len() - 1]));
            if *harmonic == "unknown" {
                line(
                    f,
                    "stability",
                    format!("not known of {count} state(s), {span}"),
                )?;
                continue;
            }
            let name = if i == 0 { "unstable" } else { "" };
            let harmonic = named(harmonic);
            line(
                f,
                name,
                format!("to {harmonic} at {count} state(s), {span}"),
            )?;
        }
        let relaxed = count(|row| row.method == "relaxation");
        let solves: usize = self.rows.iter().map(|row| row.iterations).sum();
        let seconds: f64 = self.rows.iter().map(|row| row.seconds).sum();
        line(
            f,
            "work",
            format!("{solves} solves in {seconds:.1} s, {relaxed} steps by relaxation"),
        )?;
        line(f, "written to", self.directory.display().to_string())?;
        Ok(())
    }
}
