//! Numbers of states that are tabled and plotted.

use super::Abscissa;
use plica::study::{Row, Scale};

/// What a column is good for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Part of the load.
    Load,
    /// Worth a place in a table of states.
    Tabled,
    /// Worth a plot.
    Other,
}

/// A number of every state.
#[derive(Clone, Debug)]
pub struct Column {
    /// Its name in `history.csv`, or the like.
    pub name: String,
    /// What it is called, with its unit, in the markup of [`crate::draw::label`].
    pub label: String,
    /// What it is good for.
    pub role: Role,
    /// Its values; none where there is none, or none finite.
    pub values: Vec<Option<f64>>,
}

/// What is read off a row of an end, and of a wall.
type Held = fn(&Row) -> f64;
type Pressed = fn(&Row) -> Option<f64>;

impl Column {
    /// Under a label with markup.
    pub fn new(name: &str, label: &str, role: Role, values: impl Iterator<Item = f64>) -> Self {
        Self {
            name: name.into(),
            label: label.into(),
            role,
            values: values.map(|x| x.is_finite().then_some(x)).collect(),
        }
    }

    /// Those of a path that are plotted, those first that a reader asks for first; those that a run has not are left out.
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
        let ends: [(&str, String, Held); 4] = [
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
        let pressures: [(&str, &str, Pressed); 4] = [
            ("inner_pressure", "pressure on the inner wall", |row| {
                row.inner_pressure
            }),
            ("outer_pressure", "pressure on the outer wall", |row| {
                row.outer_pressure
            }),
            (
                "inner_dead_load",
                "dead pressure on the inner wall",
                |row| row.inner_dead_load,
            ),
            (
                "outer_dead_load",
                "dead pressure on the outer wall",
                |row| row.outer_dead_load,
            ),
        ];
        for (name, words, of) in pressures {
            if rows.iter().any(|row| of(row).is_some_and(|p| p != 0.0)) {
                add(name, stress(words), Role::Load, &of);
            }
        }
        add(
            "energy",
            energy("strain energy *W*"),
            Role::Tabled,
            &|row| Some(row.energy),
        );
        add(
            "potential",
            energy("strain energy and potential of the pressures"),
            Role::Other,
            &|row| row.potential,
        );
        add(
            "max_wall_angle_deg",
            "steepest wall angle (°)".into(),
            Role::Tabled,
            &|row| Some(row.max_wall_angle_deg),
        );
        add("overhang", length("overhang"), Role::Tabled, &|row| {
            Some(row.overhang)
        });
        add(
            "outer_radius_min",
            length("smallest radius of the outer wall"),
            Role::Tabled,
            &|row| Some(row.outer_radius_min),
        );
        add("flatness", "flatness".into(), Role::Other, &|row| {
            Some(row.flatness)
        });
        add(
            "gap",
            length("nearest approach of the wall to itself"),
            Role::Tabled,
            &|row| Some(row.gap),
        );
        add(
            "lumen",
            length("narrowest width of the lumen"),
            Role::Tabled,
            &|row| Some(row.lumen),
        );
        if rows.iter().any(|row| row.asymmetry_mode > 0) {
            add(
                "asymmetry",
                length("asymmetry from axisymmetry"),
                Role::Tabled,
                &|row| Some(row.asymmetry),
            );
        }
        add(
            "min_det_fe",
            "smallest det *F*_{e}".into(),
            Role::Other,
            &|row| Some(row.min_det_fe),
        );
        add(
            "damping_work",
            energy("energy spent on drag"),
            Role::Other,
            &|row| Some(row.damping_work),
        );
        add(
            "residual",
            "residual over the forces in play".into(),
            Role::Other,
            &|row| Some(row.residual),
        );
        add("iterations", "linear solves".into(), Role::Other, &|row| {
            Some(row.iterations as f64)
        });
        columns
    }
}

/// A length that tells the scale of a picture: in D, and in words.
pub(super) fn bar(scale: &Scale) -> (f64, String) {
    if scale.length_name == "D" {
        return (1.0, "*D*".into());
    }
    // The round length that is next below a diameter.
    let ten = 10f64.powf(scale.length.log10().floor());
    let round = [5.0, 2.0, 1.0]
        .into_iter()
        .find(|n| n * ten <= scale.length * (1.0 + 1e-9));
    let length = round.unwrap_or(1.0) * ten;
    (
        length / scale.length,
        format!("{length} {}", unit(&scale.length_name)),
    )
}

/// A unit as it is set, with markup.
pub(super) fn unit(name: &str) -> String {
    match name {
        "E D^3" => "*E* *D*^{3}".into(),
        "E" | "D" => format!("*{name}*"),
        other => other.replace('u', "µ"),
    }
}
