//! Numbers of states that are tabled and plotted.

use super::Abscissa;
use crate::study::{Row, Scale};

/// A number of every state.
#[derive(Clone, Debug)]
pub struct Column {
    /// Its name in `history.csv`, or the like.
    pub name: String,
    /// What it is called, with its unit, in the markup of [`crate::draw::label`].
    pub label: String,
    /// Whether it belongs in the table of states.
    pub tabled: bool,
    /// Its values; none where there is none, or none finite.
    pub values: Vec<Option<f64>>,
}

impl Column {
    /// Under a label with markup.
    pub fn new(name: &str, label: &str, tabled: bool, values: impl Iterator<Item = f64>) -> Self {
        Self {
            name: name.into(),
            label: label.into(),
            tabled,
            values: values.map(|x| x.is_finite().then_some(x)).collect(),
        }
    }

    /// All of a path, those first that a reader asks for first; those that a run has not are left out.
    pub fn of(rows: &[Row], scale: &Scale) -> Vec<Self> {
        let length = |what: &str| format!("{what} ({})", unit(&scale.length_name));
        let energy = |what: &str| format!("{what} ({})", unit(&scale.energy_name));
        let stress = |what: &str| format!("{what} ({})", unit(&scale.stress_name));
        let mut columns = vec![];
        let mut add =
            |name: &str, label: String, tabled: bool, of: &dyn Fn(&Row) -> Option<f64>| {
                if rows.iter().any(|row| of(row).is_some()) {
                    let values = rows.iter().map(|row| of(row).unwrap_or(f64::NAN));
                    columns.push(Self::new(name, &label, tabled, values));
                }
            };
        let length_ratio = Abscissa::LengthRatio.label().into();
        let diameter_ratio = Abscissa::DiameterRatio.label().into();
        add("length_ratio", length_ratio, true, &|row| {
            Some(row.length_ratio)
        });
        add("diameter_ratio", diameter_ratio, true, &|row| {
            Some(row.diameter_ratio)
        });
        let moved = |row: &Row| row.ileum_displacement != 0.0 || row.colon_displacement != 0.0;
        if rows.iter().any(moved) {
            let ends = [
                (
                    "colon_displacement",
                    "displacement of the colon end",
                    (|row| row.colon_displacement) as fn(&Row) -> f64,
                ),
                (
                    "ileum_displacement",
                    "displacement of the ileum end",
                    |row| row.ileum_displacement,
                ),
            ];
            for (name, words, of) in ends {
                add(name, length(words), true, &|row| Some(of(row)));
            }
        }
        add(
            "inner_pressure",
            stress("pressure on the inner wall"),
            true,
            &|row| row.inner_pressure,
        );
        add(
            "outer_pressure",
            stress("pressure on the outer wall"),
            true,
            &|row| row.outer_pressure,
        );
        add("energy", energy("strain energy *W*"), true, &|row| {
            Some(row.energy)
        });
        add(
            "potential",
            energy("strain energy and potential of the pressures"),
            false,
            &|row| row.potential,
        );
        add(
            "max_wall_angle_deg",
            "steepest wall angle (°)".into(),
            true,
            &|row| Some(row.max_wall_angle_deg),
        );
        add("overhang", length("overhang"), true, &|row| {
            Some(row.overhang)
        });
        add(
            "outer_radius_min",
            length("smallest radius of the outer wall"),
            true,
            &|row| Some(row.outer_radius_min),
        );
        add("flatness", "flatness".into(), false, &|row| {
            Some(row.flatness)
        });
        add(
            "gap",
            length("gap between folds of the wall"),
            true,
            &|row| Some(row.gap),
        );
        add(
            "lumen",
            length("narrowest width of the lumen"),
            true,
            &|row| Some(row.lumen),
        );
        if rows.iter().any(|row| row.departure_harmonic > 0) {
            add(
                "departure",
                length("departure from axisymmetry"),
                true,
                &|row| Some(row.departure),
            );
        }
        add("min_det_fe", "smallest det *F*_{e}".into(), false, &|row| {
            Some(row.min_det_fe)
        });
        add("drag_work", energy("energy spent on drag"), false, &|row| {
            Some(row.drag_work)
        });
        add(
            "residual",
            "residual over the forces in play".into(),
            false,
            &|row| Some(row.residual),
        );
        add("iterations", "linear solves".into(), false, &|row| {
            Some(row.iterations as f64)
        });
        columns
    }
}

/// A unit as it is set, with markup.
fn unit(name: &str) -> String {
    match name {
        "E D^3" => "*E* *D*^{3}".into(),
        "E" | "D" => format!("*{name}*"),
        other => other.replace('u', "µ"),
    }
}
