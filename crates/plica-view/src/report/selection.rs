//! Selection of the abscissa and of the states shown in the pictures of a run.

use super::labels::unit;
use crate::draw::format_number;
use plica::measure::Shape;
use plica::run_directory::Summary;
use plica::study::{Row, Scale};

/// Quantity that varies along a path, used as abscissa.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Abscissa {
    /// Lmax/L.
    LengthRatio,
    /// Dmin/D.
    DiameterRatio,
    /// Displacement of the ileum end minus that of the colon end.
    Stretch,
    /// Follower pressure on the inner wall.
    InnerPressure,
    /// Follower pressure on the outer wall.
    OuterPressure,
    /// Number of the state.
    Step,
}

impl Abscissa {
    /// Returns the value at a state.
    pub fn of(self, row: &Row) -> f64 {
        match self {
            Self::LengthRatio => row.length_ratio,
            Self::DiameterRatio => row.diameter_ratio,
            Self::Stretch => row.ends[1].displacement - row.ends[0].displacement,
            Self::InnerPressure => row.inner_pressure.unwrap_or(0.0),
            Self::OuterPressure => row.outer_pressure.unwrap_or(0.0),
            Self::Step => row.step as f64,
        }
    }

    /// Returns the axis label with the unit.
    pub fn label(self, scale: &Scale) -> String {
        let length = unit(&scale.length_name);
        let stress = unit(&scale.stress_name);
        match self {
            Self::LengthRatio => "*L*_{max}/*L*".into(),
            Self::DiameterRatio => "*D*_{min}/*D*".into(),
            Self::Stretch => format!("relative displacement of the ends ({length})"),
            Self::InnerPressure => format!("pressure on the inner wall ({stress})"),
            Self::OuterPressure => format!("pressure on the outer wall ({stress})"),
            Self::Step => "state".into(),
        }
    }

    /// Formats the value at a state.
    pub fn format(self, row: &Row) -> String {
        let value = self.of(row);
        match self {
            Self::LengthRatio | Self::DiameterRatio => format!("{value:.2}"),
            Self::Step => row.step.to_string(),
            _ if value == 0.0 => "0".into(),
            _ => format_number(value, 3),
        }
    }
}

/// The plotted part of a path and the states shown in detail.
#[derive(Clone, Debug)]
pub(super) struct Selection<'a> {
    /// Abscissa of the plots.
    pub abscissa: Abscissa,
    /// States of the plotted part.
    pub rows: Vec<&'a Row>,
    /// Up to four states shown in detail: the first one, the minimum of the energy, the last square wall, the last one.
    pub chosen: Vec<&'a Row>,
}

impl<'a> Selection<'a> {
    /// Selects the last part of a run in which a single quantity changes. Twists and dead loads, which are no abscissae, are
    /// ignored.
    pub fn of(summary: &'a Summary) -> Self {
        let all = summary.rows();
        let quantities = [
            Abscissa::LengthRatio,
            Abscissa::DiameterRatio,
            Abscissa::Stretch,
            Abscissa::InnerPressure,
            Abscissa::OuterPressure,
        ];
        let tail = |quantity: Abscissa| {
            let others = quantities.iter().filter(move |&&other| other != quantity);
            let last = &all[all.len() - 1];
            let same = |row: &&Row| others.clone().all(|other| other.of(row) == other.of(last));
            let count = all.iter().rev().take_while(same).count();
            let rows = &all[all.len() - count..];
            let changes = rows
                .windows(2)
                .filter(|w| quantity.of(&w[0]) != quantity.of(&w[1]));
            if changes.count() + 1 >= rows.len() {
                rows.len()
            } else {
                0
            }
        };
        let best = quantities
            .into_iter()
            .max_by_key(|&quantity| (tail(quantity), rank(quantity)));
        let (abscissa, count) = match best {
            Some(quantity) if tail(quantity) > 2 => (quantity, tail(quantity)),
            _ => (Abscissa::Step, all.len()),
        };
        let rows: Vec<&Row> = all[all.len() - count..].iter().collect();

        let first = rows.first().copied();
        let mut chosen: Vec<&Row> = first.into_iter().collect();
        let inside = |row: &&Row| rows.iter().any(|r| r.step == row.step);
        chosen.extend(summary.findings().energy_minimum().filter(inside));
        chosen.extend(
            rows.iter()
                .rev()
                .find(|row| row.shape == Shape::Square)
                .copied(),
        );
        chosen.extend(rows.last().copied());
        chosen.sort_by_key(|row| row.step);
        chosen.dedup_by_key(|row| row.step);
        Self {
            abscissa,
            rows,
            chosen,
        }
    }
}

/// Preference among quantities that vary over equally many states.
fn rank(quantity: Abscissa) -> usize {
    match quantity {
        Abscissa::LengthRatio => 3,
        Abscissa::DiameterRatio => 2,
        _ => 1,
    }
}
