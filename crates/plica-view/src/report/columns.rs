//! Columns of numbers for tables and plots.

use super::labels::unit;
use plica::study::{Cell, Quantity, Row, Scale};

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

/// Words for W where it includes the potential of tensions, and is not the strain energy.
pub(super) const WITH_TENSIONS: &str = "energy *W* with tensions";

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

/// The columns that come first, in this order: name, words, use.
const FIRST: [(&str, &str, Role); 22] = [
    ("length_ratio", "*L*_{max}/*L*", Role::Load),
    ("diameter_ratio", "*D*_{min}/*D*", Role::Load),
    ("energy", "strain energy *W*", Role::Table),
    (
        "potential",
        "strain energy plus potential of the pressures and foundations",
        Role::Other,
    ),
    ("max_wall_angle_deg", "steepest wall angle", Role::Table),
    ("overhang", "overhang", Role::Table),
    ("outer_radius_min", "smallest outer radius", Role::Table),
    ("outer_radius_max", "largest outer radius", Role::Other),
    (
        "outer_radius_mid",
        "outer radius at mid-length",
        Role::Other,
    ),
    ("flatness", "flatness", Role::Other),
    (
        "gap",
        "smallest distance between parts of the wall",
        Role::Table,
    ),
    ("lumen", "smallest width of the lumen", Role::Table),
    ("lumen_volume", "volume of the lumen", Role::Other),
    ("lumen_pressure", "pressure in the lumen", Role::Other),
    (
        "lumen_area_min",
        "smallest cross-section of the lumen",
        Role::Other,
    ),
    ("asymmetry", "asymmetry", Role::Table),
    ("min_det_fe", "smallest det *F*_{e}", Role::Other),
    ("damping_work", "work of damping", Role::Other),
    ("released_energy", "energy set free in jumps", Role::Other),
    ("residual", "relative residual", Role::Other),
    ("iterations", "linear solves", Role::Other),
    ("step", "state", Role::Other),
];

/// Columns of the load whose names are fixed: name and words.
const LOADS: [(&str, &str); 5] = [
    ("time", "time"),
    ("inner_pressure", "pressure on the inner wall"),
    ("outer_pressure", "pressure on the outer wall"),
    ("inner_dead_load", "dead load on the inner wall"),
    ("outer_dead_load", "dead load on the outer wall"),
];

/// Columns of muscles and ends: prefix of the name, words before the name, words after it, use.
const NAMED: [(&str, &str, &str, Role); 15] = [
    ("displacement_", "displacement of the ", " end", Role::Load),
    ("twist_deg_", "twist of the ", " end", Role::Load),
    (
        "offset_x_",
        "displacement along x of the ",
        " end",
        Role::Load,
    ),
    (
        "offset_y_",
        "displacement along y of the ",
        " end",
        Role::Load,
    ),
    ("tilt_x_deg_", "tilt about x of the ", " end", Role::Load),
    ("tilt_y_deg_", "tilt about y of the ", " end", Role::Load),
    ("shift_", "shift of the zone of ", "", Role::Load),
    ("target_", "target of the muscle ", "", Role::Other),
    (
        "stretch_",
        "extreme growth stretch of the muscle ",
        "",
        Role::Other,
    ),
    ("axial_force_", "axial force at the ", " end", Role::Other),
    ("shear_force_", "shear force at the ", " end", Role::Other),
    (
        "bending_moment_",
        "bending moment at the ",
        " end",
        Role::Other,
    ),
    ("torque_", "torque at the ", " end", Role::Other),
    ("growth_through_", "growth of the patch ", "", Role::Other),
    ("work_", "work of ", "", Role::Other),
];

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

    /// Returns every column of numbers of a path, the most important ones first.
    pub fn all(rows: &[Row], scale: &Scale) -> Vec<Self> {
        let cells: Vec<Vec<Cell>> = rows.iter().map(Row::cells).collect();
        let Some(first) = cells.first() else {
            return vec![];
        };
        let of_muscles = rows.iter().flat_map(|row| &row.muscles);
        let has_tension = of_muscles.map(|muscle| muscle.stretch).any(|s| s.is_none());
        let numbers = first.iter().zip(0..);
        let numbers = numbers.filter(|(cell, _)| cell.quantity != Quantity::Text);
        let mut columns: Vec<(usize, Self)> = numbers
            .map(|(cell, i)| {
                let (rank, mut words, role) = meaning(&cell.name);
                if has_tension && ["energy", "potential"].contains(&cell.name.as_str()) {
                    words = words.replace("strain energy *W*", WITH_TENSIONS);
                    words = words.replace("strain energy", WITH_TENSIONS);
                }
                let label = match scale.unit(cell.quantity) {
                    Some(name) => format!("{words} ({})", unit(name)),
                    None => words,
                };
                let values = cells.iter().map(|cells| cells[i].number());
                let values = values.map(|x| x.unwrap_or(f64::NAN));
                (rank, Self::new(&cell.name, &label, role, values))
            })
            .collect();
        columns.sort_by_key(|(rank, _)| *rank);
        columns.into_iter().map(|(_, column)| column).collect()
    }

    /// Returns the columns of a path, the most important ones first, without those that are zero throughout and add nothing:
    /// motions of ends, pressures and the asymmetry.
    pub fn of(rows: &[Row], scale: &Scale) -> Vec<Self> {
        let mut columns = Self::all(rows, scale);
        let asymmetric = rows.iter().any(|row| row.asymmetry_mode > 0);
        columns.retain(|column| {
            let zero = || column.values.iter().all(|x| *x == Some(0.0));
            let ratio = ["length_ratio", "diameter_ratio"].contains(&column.name.as_str());
            match column.name.as_str() {
                name if name.starts_with("asymmetry") => asymmetric,
                "step" => false,
                _ => column.role != Role::Load || ratio || !zero(),
            }
        });
        columns
    }
}

/// Returns rank, words and use of a column.
fn meaning(name: &str) -> (usize, String, Role) {
    if let Some(i) = FIRST.iter().position(|(first, ..)| *first == name) {
        let (_, words, role) = FIRST[i];
        // The other columns of the load come after the second.
        return (if i < 2 { 0 } else { 2 + i }, words.into(), role);
    }
    if let Some((_, words)) = LOADS.iter().find(|(load, _)| *load == name) {
        return (2, (*words).into(), Role::Load);
    }
    for (prefix, before, after, role) in NAMED {
        if let Some(of) = name.strip_prefix(prefix) {
            let rank = if role == Role::Load {
                1
            } else {
                2 + FIRST.len()
            };
            return (rank, format!("{before}{of}{after}"), role);
        }
    }
    (3 + FIRST.len(), name.replace('_', " "), Role::Other)
}
