//! The driven quantities of a state, with their names.

use crate::study::{Row, Scale};
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
            _ if self.value == 0.0 => "0".into(),
            _ => format!("{:.4e}", self.value),
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

/// Returns all driven quantities of a state, in the order in which they are named.
pub fn loads(row: &Row, scale: &Scale) -> Vec<NamedLoad> {
    let load = |name: &str, value: f64, unit: &str| NamedLoad {
        name: name.into(),
        value,
        unit: unit.into(),
    };
    let (length, stress) = (scale.length_name.as_str(), scale.stress_name.as_str());
    let pressure = |name: &str, value: Option<f64>| load(name, value.unwrap_or(0.0), stress);
    vec![
        load("Lmax/L", row.length_ratio, ""),
        load("Dmin/D", row.diameter_ratio, ""),
        load("colon end at", row.colon_displacement, length),
        load("ileum end at", row.ileum_displacement, length),
        load("colon end twisted", row.colon_twist_deg, "°"),
        load("ileum end twisted", row.ileum_twist_deg, "°"),
        pressure("pressure inside", row.inner_pressure),
        pressure("pressure outside", row.outer_pressure),
        pressure("dead load inside", row.inner_dead_load),
        pressure("dead load outside", row.outer_dead_load),
    ]
}

/// Describes the loads of a state, each as `name = value`.
pub fn describe(loads: &[NamedLoad]) -> String {
    let one = |load: &NamedLoad| format!("{} = {}", load.name, load.with_unit());
    loads.iter().map(one).collect::<Vec<_>>().join(", ")
}

/// Describes the loads of two states with the same quantities, each as `name = value to value`.
pub fn describe_range(from: &[NamedLoad], to: &[NamedLoad]) -> String {
    let one = |(from, to): (&NamedLoad, &NamedLoad)| {
        if from.value == to.value {
            format!("{} = {}", to.name, to.with_unit())
        } else {
            format!(
                "{} = {} to {}",
                from.name,
                from.formatted(),
                to.with_unit()
            )
        }
    };
    from.iter().zip(to).map(one).collect::<Vec<_>>().join(", ")
}
