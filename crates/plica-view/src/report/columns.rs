//! Columns of numbers for tables and plots.

use super::labels::unit;
use super::selection::Abscissa;
use plica::study::{Row, Scale};

/// Use of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Part of the load.
    Load,
    /// Shown in the table of states and in plots.
    Table,
    /// Shown in plots only.
    Other,
}

/// A quantity with one value per state.
#[derive(Clone, Debug)]
pub struct Column {
    /// Name as in `history.csv`.
    pub name: String,
    /// Label with unit; it may contain the markup of [`crate::draw::Chart`].
    pub label: String,
    /// Use of the column.
    pub role: Role,
    /// Values; `None` if missing or not finite.
    pub values: Vec<Option<f64>>,
}

/// Reads a property of an end from a row.
type OfEnd = fn(&Row) -> f64;
/// Reads a pressure on a wall from a row.
type OfWall = fn(&Row) -> Option<f64>;

impl Column {
    /// Creates a column; values that are not finite become `None`.
    pub(crate) fn new(
        name: &str,
        label: &str,
        role: Role,
        values: impl Iterator<Item = f64>,
    ) -> Self {
        Self {
            name: name.into(),
            label: label.into(),
            role,
            values: values.map(|x| x.is_finite().then_some(x)).collect(),
        }
    }

    /// Returns the columns of a path, the most important ones first, without those that do not occur.
    pub fn of(rows: &[Row], scale: &Scale) -> Vec<Self> {
        let length = |what: &str| format!("{what} ({})", unit(&scale.length_name));
        let energy = |what: &str| format!("{what} ({})", unit(&scale.energy_name));
        let stress = |what: &str| format!("{what} ({})", unit(&scale.stress_name));
        let mut columns = vec![];
        let mut add = |name: &str, label: String, role: Role, of: &dyn Fn(&Row) -> Option<f64>| {
            if rows.iter().any(|row| of(row).is_some()) {
                let values = rows.iter().map(|row| of(row).unwrap_or(f64::NAN));
                columns.push(Self::new(name, &label, role, values));
            }
        };
        let length_ratio = Abscissa::LengthRatio.label(scale);
        let diameter_ratio = Abscissa::DiameterRatio.label(scale);
        add("length_ratio", length_ratio, Role::Load, &|row| {
            Some(row.length_ratio)
        });
        add("diameter_ratio", diameter_ratio, Role::Load, &|row| {
            Some(row.diameter_ratio)
        });
        let ends: [(&str, String, OfEnd); 4] = [
            (
                "colon_displacement",
                length("displacement of the colon end"),
                |row| row.colon_displacement,
            ),
            (
                "ileum_displacement",
                length("displacement of the ileum end"),
                |row| row.ileum_displacement,
            ),
            (
                "colon_twist_deg",
                "twist of the colon end (°)".into(),
                |row| row.colon_twist_deg,
            ),
            (
                "ileum_twist_deg",
                "twist of the ileum end (°)".into(),
                |row| row.ileum_twist_deg,
            ),
        ];
        for (name, label, of) in ends {
            if rows.iter().any(|row| of(row) != 0.0) {
                add(name, label, Role::Load, &|row| Some(of(row)));
            }
        }
        let pressures: [(&str, &str, OfWall); 4] = [
            ("inner_pressure", "pressure on the inner wall", |row| {
                row.inner_pressure
            }),
            ("outer_pressure", "pressure on the outer wall", |row| {
                row.outer_pressure
            }),
            ("inner_dead_load", "dead load on the inner wall", |row| {
                row.inner_dead_load
            }),
            ("outer_dead_load", "dead load on the outer wall", |row| {
                row.outer_dead_load
            }),
        ];
        for (name, words, of) in pressures {
            if rows.iter().any(|row| of(row).is_some_and(|p| p != 0.0)) {
                add(name, stress(words), Role::Load, &of);
            }
        }
        add("energy", energy("strain energy *W*"), Role::Table, &|row| {
            Some(row.energy)
        });
        add(
            "potential",
            energy("strain energy plus potential of the pressures"),
            Role::Other,
            &|row| row.potential,
        );
        add(
            "max_wall_angle_deg",
            "steepest wall angle (°)".into(),
            Role::Table,
            &|row| Some(row.max_wall_angle_deg),
        );
        add("overhang", length("overhang"), Role::Table, &|row| {
            Some(row.overhang)
        });
        add(
            "outer_radius_min",
            length("smallest radius of the outer wall"),
            Role::Table,
            &|row| Some(row.outer_radius_min),
        );
        add("flatness", "flatness".into(), Role::Other, &|row| {
            Some(row.flatness)
        });
        add(
            "gap",
            length("smallest distance between parts of the wall"),
            Role::Table,
            &|row| Some(row.gap),
        );
        add(
            "lumen",
            length("smallest width of the lumen"),
            Role::Table,
            &|row| Some(row.lumen),
        );
        if rows.iter().any(|row| row.asymmetry_mode > 0) {
            add("asymmetry", length("asymmetry"), Role::Table, &|row| {
                Some(row.asymmetry)
            });
        }
        add(
            "min_det_fe",
            "smallest det *F*_{e}".into(),
            Role::Other,
            &|row| Some(row.min_det_fe),
        );
        add(
            "damping_work",
            energy("work of damping"),
            Role::Other,
            &|row| Some(row.damping_work),
        );
        add(
            "residual",
            "relative residual".into(),
            Role::Other,
            &|row| Some(row.residual),
        );
        add("iterations", "linear solves".into(), Role::Other, &|row| {
            Some(row.iterations as f64)
        });
        columns
    }
}
