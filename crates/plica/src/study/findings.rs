//! Statements about a whole path.

use super::{Row, Scale};
use crate::equilibrium::{Stability, UnstableMode};
use crate::measure::{Shape, Side};
use crate::solve::Method;
use std::collections::BTreeMap;

/// Statements about the accepted states of a path.
#[derive(Clone, Debug)]
pub struct Findings<'a> {
    /// The accepted states.
    pub rows: &'a [Row],
    /// Units of the rows.
    pub scale: Scale,
}

impl<'a> Findings<'a> {
    /// Returns the state of least energy among those with the final diameter ratio, if it lies inside that part of the
    /// path.
    pub fn energy_minimum(&self) -> Option<&'a Row> {
        let last = self.rows.last()?;
        let relaxing: Vec<&'a Row> = self
            .rows
            .iter()
            .filter(|row| row.diameter_ratio == last.diameter_ratio)
            .collect();
        let at = (0..relaxing.len())
            .min_by(|&a, &b| relaxing[a].energy.total_cmp(&relaxing[b].energy))?;
        (at > 0 && at + 1 < relaxing.len()).then(|| relaxing[at])
    }

    /// Returns the first state of a shape.
    pub fn first(&self, shape: Shape) -> Option<&'a Row> {
        self.rows.iter().find(|row| row.shape == shape)
    }

    /// Returns the states that are unstable to each mode, for the modes to which any state is unstable.
    pub fn unstable_states(&self) -> BTreeMap<UnstableMode, Vec<&'a Row>> {
        let mut unstable: BTreeMap<UnstableMode, Vec<&'a Row>> = BTreeMap::new();
        for row in self.rows {
            for mode in row.stability.unstable_modes() {
                unstable.entry(mode).or_default().push(row);
            }
        }
        unstable
    }

    /// Returns the side to which the final state invaginates.
    pub fn side(&self) -> Side {
        let last = self.rows.last();
        let invaginated = last.filter(|row| row.shape == Shape::Invaginated);
        invaginated.map_or(Side::None, |row| row.side)
    }

    /// Returns the lines of the closing table, as names and sentences; none without states.
    pub fn lines(&self) -> Vec<(&'static str, String)> {
        let Some(last) = self.rows.last() else {
            return vec![];
        };
        let mut lines = vec![];
        let mut line = |name: &'static str, value: String| lines.push((name, value));
        let place_or_none =
            |row: Option<&Row>| row.map_or_else(|| "not on this path".to_owned(), place);
        let energy = |row: &Row| format!("W = {:.6e} {}", row.energy, self.scale.energy_name);
        let minimum = self.energy_minimum();
        let described = |row| format!("{} at {}", energy(row), place(row));
        line(
            "energy minimum",
            minimum.map_or_else(|| place_or_none(None), described),
        );
        line(
            "wall becomes square",
            place_or_none(self.first(Shape::Square)),
        );
        line(
            "wall overhangs",
            place_or_none(self.first(Shape::Invaginated)),
        );
        let side = match self.side() {
            Side::None => "no".to_owned(),
            side => format!(
                "toward the {side}, overhang {:.3} {}",
                last.overhang, self.scale.length_name
            ),
        };
        line("invaginates", side);
        for (name, states) in [
            ("wall crosses itself", self.span_of(Row::crosses_itself)),
            ("lumen is closed", self.span_of(Row::has_closed)),
        ] {
            if let Some(states) = states {
                line(
                    name,
                    format!("{states}: not physical, as there is no contact"),
                );
            }
        }
        line(
            "final state",
            format!("{}, {} ({})", energy(last), place(last), last.shape),
        );
        let asymmetric = self.rows.iter().filter(|row| row.asymmetry_mode > 0);
        if let Some(row) = asymmetric.max_by(|a, b| a.asymmetry.total_cmp(&b.asymmetry)) {
            let amplitude = match row.asymmetry {
                x if x < 1e-2 => format!("{x:.1e} {}", self.scale.length_name),
                x => format!("{x:.3} {}", self.scale.length_name),
            };
            let mode = UnstableMode::Circumferential(row.asymmetry_mode).describe();
            let most = format!("at most {amplitude}, in {mode}, at {}", place(row));
            line("asymmetry", most);
        }
        let count = |condition: fn(&&Row) -> bool| self.rows.iter().filter(condition).count();
        let found = self.rows.iter().filter(|row| row.method != Method::Rest);
        let largest = found.map(|row| row.residual).fold(0.0, f64::max);
        let equilibrium = match count(|row| !row.in_equilibrium) {
            0 => "all in equilibrium".to_owned(),
            out => format!("{out} out of equilibrium"),
        };
        let states = self.rows.len();
        line(
            "states",
            format!("{states}, {equilibrium} (largest residual {largest:.0e})"),
        );
        let mut name = "unstable";
        for mode in self.unstable_states().into_keys() {
            let unstable_to = |row: &Row| row.stability.unstable_modes().any(|one| one == mode);
            let states = self.span_of(unstable_to).unwrap_or_default();
            line(name, format!("to {} {states}", mode.describe()));
            name = "";
        }
        let unknown = self.span_of(|row| row.stability == Stability::Unknown);
        match unknown {
            Some(states) => line("stability", format!("not determined {states}")),
            None if name == "unstable" => line(name, "no state".into()),
            None => {}
        }
        let relaxed = count(|row| row.method == Method::Relaxation);
        let solves: usize = self.rows.iter().map(|row| row.iterations).sum();
        let seconds: f64 = self.rows.iter().map(|row| row.seconds).sum();
        line(
            "work",
            format!(
                "{} in {seconds:.1} s, {} by relaxation",
                counted(solves, "linear solve"),
                counted(relaxed, "step")
            ),
        );
        lines
    }

    /// Describes the states that meet a condition; none if no state does.
    fn span_of(&self, condition: impl Fn(&Row) -> bool) -> Option<String> {
        let states: Vec<&Row> = self.rows.iter().filter(|row| condition(row)).collect();
        let (first, last) = (states.first()?, states.last()?);
        let count = counted(states.len(), "state");
        Some(format!("at {count}, {}", span(first, last)))
    }
}

/// Returns a count with its noun in the singular or plural.
fn counted(count: usize, noun: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{count} {noun}{plural}")
}

/// Returns the pressures of a state with their names.
fn pressures(row: &Row) -> [(&'static str, Option<f64>); 4] {
    [
        ("pressure inside", row.inner_pressure),
        ("pressure outside", row.outer_pressure),
        ("dead load inside", row.inner_dead_load),
        ("dead load outside", row.outer_dead_load),
    ]
}

/// Describes the load of a state.
fn place(row: &Row) -> String {
    let mut place = format!(
        "Lmax/L = {:.4}, Dmin/D = {:.4}",
        row.length_ratio, row.diameter_ratio
    );
    for (name, pressure) in pressures(row) {
        if let Some(pressure) = pressure.filter(|p| *p != 0.0) {
            place += &format!(", {name} {pressure:.4e}");
        }
    }
    place
}

/// Describes the loads from one state to another, by the one quantity that differs if there is only one.
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
        return format!("{} {from:.4e} to {to:.4e}", pressures(first)[*i].0);
    }
    format!("{} to {}", place(first), place(last))
}
