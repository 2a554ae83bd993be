//! The driven quantities of a state, with their names.

use crate::study::{MuscleRow, Row, Scale};
use serde::Serialize;

/// A driven quantity and its value at a state.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NamedLoad {
    /// Name in a sentence, for example `Lmax/L` or `pressure inside`.
    pub name: String,
    /// Value in the unit of the table.
    pub value: f64,
    /// Unit; empty for a ratio.
    pub unit: String,
}

impl NamedLoad {
    /// Formats the value without its unit.
    pub fn formatted(&self) -> String {
        match self.unit.as_str() {
            "" => format!("{:.4}", self.value),
            "°" => format!("{:.2}", self.value),
            _ => number(self.value, 4),
        }
    }

    /// Formats the value with its unit.
    fn with_unit(&self) -> String {
        match self.unit.as_str() {
            "" => self.formatted(),
            "°" => format!("{}°", self.formatted()),
            unit => format!("{} {unit}", self.formatted()),
        }
    }
}

/// Formats a number with a count of digits after the first: in scientific notation, unless it lies between 0.1 and 10⁴.
pub fn number(value: f64, digits: usize) -> String {
    match value.abs() {
        0.0 => "0".into(),
        0.1..1e4 => {
            let before = value.abs().log10().floor() as i32;
            let after = digits as i32 - before;
            format!("{value:.*}", usize::try_from(after).unwrap_or(0))
        }
        _ => format!("{value:.digits$e}"),
    }
}

/// Returns all driven quantities of a state, in the order in which they are named. Muscles are `Lmax/L` and `Dmin/D`, or
/// each has its own name.
pub fn loads(row: &Row, scale: &Scale, muscles_by_name: bool) -> Vec<NamedLoad> {
    let load = |name: String, value: f64, unit: &str| NamedLoad {
        name,
        value,
        unit: unit.into(),
    };
    let (length, stress) = (scale.length_name.as_str(), scale.stress_name.as_str());
    let mut loads = if muscles_by_name {
        let target = |muscle: &MuscleRow| load(muscle.name.clone(), muscle.target, "");
        growing(row).map(target).collect()
    } else {
        vec![
            load("Lmax/L".into(), row.length_ratio, ""),
            load("Dmin/D".into(), row.diameter_ratio, ""),
        ]
    };
    for muscle in row.muscles.iter().filter(|muscle| muscle.stretch.is_none()) {
        loads.push(load(
            format!("tension of {}", muscle.name),
            muscle.target,
            stress,
        ));
    }
    for muscle in &row.muscles {
        if let Some(shift) = muscle.shift {
            loads.push(load(format!("shift of {}", muscle.name), shift, length));
        }
    }
    for end in &row.ends {
        let (moved, twist) = (
            format!("{} end moved", end.name),
            format!("{} end twisted", end.name),
        );
        loads.push(load(moved, end.displacement, length));
        loads.push(load(twist, end.twist_deg, "°"));
    }
    for end in row.ends.iter().filter(|end| end.sideways.is_some()) {
        let sideways = end.sideways.clone().unwrap_or_default();
        for (axis, shift, tilt) in [
            ("x", sideways.shift[0], sideways.tilt_deg[0]),
            ("y", sideways.shift[1], sideways.tilt_deg[1]),
        ] {
            loads.push(load(
                format!("{} end along {axis}", end.name),
                shift,
                length,
            ));
            loads.push(load(
                format!("{} end tilted about {axis}", end.name),
                tilt,
                "°",
            ));
        }
    }
    if row.lumen_pressure.is_some() {
        let unit = format!("{length}³");
        loads.push(load("volume of the lumen".into(), row.lumen_volume, &unit));
    }
    for (name, value) in [
        ("pressure inside", row.inner_pressure),
        ("pressure outside", row.outer_pressure),
        ("dead load inside", row.inner_dead_load),
        ("dead load outside", row.outer_dead_load),
    ] {
        loads.push(load(name.into(), value.unwrap_or(0.0), stress));
    }
    for obstacle in &row.obstacles {
        let name = &obstacle.name;
        loads.push(load(format!("radius of {name}"), obstacle.radius, length));
        for (axis, x) in ["x", "y", "z"].iter().zip(obstacle.position) {
            loads.push(load(format!("{axis} of {name}"), x, length));
        }
    }
    for patch in &row.patches {
        let name = format!("growth of {}", patch.name);
        loads.push(load(name, patch.growth_through, ""));
    }
    loads
}

/// Returns the muscles that change the stress-free state.
fn growing(row: &Row) -> impl Iterator<Item = &MuscleRow> {
    row.muscles.iter().filter(|muscle| muscle.stretch.is_some())
}

/// Returns whether Lmax/L and Dmin/D do not say where each muscle stands, as when several shorten the circumference.
pub fn needs_names(rows: &[Row]) -> bool {
    let explained = |row: &Row| {
        let ratios = [row.length_ratio, row.diameter_ratio];
        match growing(row).collect::<Vec<_>>()[..] {
            [] => true,
            [one] => ratios == [one.target, 1.0] || ratios == [1.0, one.target],
            [a, b] => ratios == [a.target, b.target] || ratios == [b.target, a.target],
            _ => false,
        }
    };
    !rows.iter().all(explained)
}

/// Describes the loads of a state, each as `name = value`.
pub fn describe(loads: &[NamedLoad]) -> String {
    let one = |load: &NamedLoad| format!("{} = {}", load.name, load.with_unit());
    loads.iter().map(one).collect::<Vec<_>>().join(", ")
}

/// Describes the loads of two states with the same quantities, each as `name = value to value`.
pub fn describe_range(from: &[NamedLoad], to: &[NamedLoad]) -> String {
    describe_course(from, &[], to)
}

/// Describes the loads of two states, each as `name = value to value`, with extreme values in between: `by way of value`.
pub fn describe_course(from: &[NamedLoad], through: &[NamedLoad], to: &[NamedLoad]) -> String {
    let one = |(from, to): (&NamedLoad, &NamedLoad)| {
        let between = through.iter().filter(|load| load.name == to.name);
        let between: Vec<String> = between.map(NamedLoad::formatted).collect();
        let between = between.join(" and ");
        match (between.is_empty(), from.value == to.value) {
            (true, true) => format!("{} = {}", to.name, to.with_unit()),
            (true, false) => format!("{} = {} to {}", from.name, from.formatted(), to.with_unit()),
            (false, true) => {
                format!("{} = {} to {between} and back", from.name, to.with_unit())
            }
            (false, false) => format!(
                "{} = {} to {} by way of {between}",
                from.name,
                from.formatted(),
                to.with_unit()
            ),
        }
    };
    from.iter().zip(to).map(one).collect::<Vec<_>>().join(", ")
}
