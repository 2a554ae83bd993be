//! What a path has come to, in words.

use super::Row;
use super::harmonics::named;
use super::units::Scale;
use std::collections::BTreeMap;

/// The accepted states of a run, and what they come to.
#[derive(Clone, Debug)]
pub struct Findings<'a> {
    /// The accepted states.
    pub rows: &'a [Row],
    /// Their units.
    pub scale: Scale,
}

impl<'a> Findings<'a> {
    /// The state of least energy with a full contraction: a minimum of the energy over the length
    /// ratio, if there is one inside the path.
    pub fn energy_minimum(&self) -> Option<&'a Row> {
        let last = self.rows.last()?;
        let relaxing: Vec<&'a Row> = self
            .rows
            .iter()
            .filter(|r| r.diameter_ratio == last.diameter_ratio)
            .collect();
        let at = (0..relaxing.len())
            .min_by(|&a, &b| relaxing[a].energy.total_cmp(&relaxing[b].energy))?;
        (at > 0 && at + 1 < relaxing.len()).then(|| relaxing[at])
    }

    /// The first state of a shape.
    pub fn first(&self, shape: &str) -> Option<&'a Row> {
        self.rows.iter().find(|row| row.shape == shape)
    }

    /// The first state whose wall overhangs.
    pub fn overhang(&self) -> Option<&'a Row> {
        self.first("invaginated")
    }

    /// The harmonics that any state is unstable to, with those states; as `unknown` those of which it is
    /// not known.
    pub fn lost_harmonics(&self) -> BTreeMap<&'a str, Vec<&'a Row>> {
        let mut lost: BTreeMap<&'a str, Vec<&'a Row>> = BTreeMap::new();
        for row in self.rows {
            for harmonic in row.lost_harmonics() {
                lost.entry(harmonic).or_default().push(row);
            }
        }
        lost
    }

    /// The side the tube invaginates to at the end.
    pub fn side(&self) -> &'a str {
        let invaginated = self.rows.last().filter(|row| row.shape == "invaginated");
        invaginated.map_or("none", |row| &row.side)
    }

    /// Everything, as names and sentences; nothing if there is no state.
    pub fn lines(&self) -> Vec<(&'static str, String)> {
        let Some(last) = self.rows.last() else {
            return vec![];
        };
        let none = || "not on this path".to_owned();
        let energy = |row: &Row| format!("W = {:.6e} {}", row.energy, self.scale.energy_name);
        let mut lines = vec![];
        let mut line = |name: &'static str, value: String| lines.push((name, value));
        let minimum = self.energy_minimum();
        line(
            "energy minimum",
            minimum.map_or_else(none, |row| format!("{} at {}", energy(row), place(row))),
        );
        line(
            "wall turns square",
            self.first("square").map_or_else(none, place),
        );
        line("wall overhangs", self.overhang().map_or_else(none, place));
        let side = match self.side() {
            "none" => "it does not".to_owned(),
            side => format!(
                "toward the {side}, {:.3} {} deep",
                last.overhang, self.scale.length_name
            ),
        };
        line("invaginates", side);
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
                let (count, span) = (counted(states.len(), "state"), span(first, last));
                line(name, format!("at {count}, {span}: {physical}"));
            }
        }
        line(
            "last state",
            format!("{}, {} ({})", energy(last), place(last), last.shape),
        );
        let departs = self.rows.iter().filter(|row| row.asymmetry_mode > 0);
        if let Some(row) = departs.max_by(|a, b| a.asymmetry.total_cmp(&b.asymmetry)) {
            let far = match row.asymmetry {
                x if x < 1e-2 => format!("{x:.1e} {}", self.scale.length_name),
                x => format!("{x:.3} {}", self.scale.length_name),
            };
            let harmonic = named(&row.asymmetry_mode.to_string());
            let most = format!("by at most {far}, in {harmonic}, at {}", place(row));
            line("leaves axisymmetry", most);
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
            "states",
            format!("{states}, {balance} (largest residual after rest {worst:.0e})"),
        );
        let lost = self.lost_harmonics();
        if lost.is_empty() {
            line("unstable", "no state".into());
        }
        for (i, (harmonic, rows)) in lost.iter().enumerate() {
            let (count, span) = (
                counted(rows.len(), "state"),
                span(rows[0], rows[rows.len() - 1]),
            );
            if *harmonic == "unknown" {
                line("stability", format!("not known of {count}, {span}"));
                continue;
            }
            let name = if i == 0 { "unstable" } else { "" };
            let harmonic = named(harmonic);
            line(name, format!("to {harmonic} at {count}, {span}"));
        }
        let relaxed = count(|row| row.method == "relaxation");
        let solves: usize = self.rows.iter().map(|row| row.iterations).sum();
        let seconds: f64 = self.rows.iter().map(|row| row.seconds).sum();
        line(
            "work",
            format!(
                "{} in {seconds:.1} s, {} by relaxation",
                counted(solves, "solve"),
                counted(relaxed, "step")
            ),
        );
        lines
    }
}

/// So many of something.
fn counted(count: usize, what: &str) -> String {
    let more = if count == 1 { "" } else { "s" };
    format!("{count} {what}{more}")
}

/// The pressures that a state is under, if its case has any.
fn pressures(row: &Row) -> [(&'static str, Option<f64>); 4] {
    [
        ("inside", row.inner_pressure),
        ("outside", row.outer_pressure),
        ("dead, inside", row.inner_dead_load),
        ("dead, outside", row.outer_dead_load),
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
