//! Selection of the abscissa and of the states shown in the pictures of a run.

use super::labels::unit;
use crate::draw::format_number;
use plica::run_directory::Summary;
use plica::study::findings::Interval;
use plica::study::{Findings, Row, Scale};

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

    /// Returns the value at a state as text; the number of a state follows the word.
    pub fn place(self, row: &Row) -> String {
        let value = self.of(row);
        match self {
            Self::LengthRatio | Self::DiameterRatio => format!("{value:.2}"),
            Self::Step => format!("state {}", row.step),
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
    /// The states shown in detail, in the order of the path: see [`chosen`].
    pub chosen: Vec<&'a Row>,
}

/// Largest number of states shown in detail.
const MOST_CHOSEN: usize = 6;

impl<'a> Selection<'a> {
    /// Selects the last part of a run in which a single quantity changes, if all that is found on the path lies in that part, or
    /// else the whole path. Twists and dead loads, which are no abscissae, are ignored.
    pub fn of(summary: &'a Summary) -> Self {
        Self::of_path(summary.rows(), summary.findings())
    }

    fn of_path(rows: &'a [Row], findings: &Findings) -> Self {
        let (abscissa, count) = last_part(rows);
        let begin = rows[rows.len() - count].step;
        let (abscissa, count) = if events(findings).all(|state| state >= begin) {
            (abscissa, count)
        } else {
            (Abscissa::Step, rows.len())
        };
        let rows = &rows[rows.len() - count..];
        let chosen = chosen(rows, findings);
        Self {
            abscissa,
            rows: rows.iter().collect(),
            chosen: rows
                .iter()
                .filter(|row| chosen.contains(&row.step))
                .collect(),
        }
    }
}

/// The part of a path that its pictures show.
#[derive(Clone, Debug, PartialEq)]
pub struct Excerpt {
    /// Label of the abscissa.
    pub label: String,
    /// Number and abscissa of every state in the part.
    pub states: Vec<(usize, f64)>,
    /// Numbers of the states that are drawn.
    pub chosen: Vec<usize>,
}

impl Excerpt {
    /// Selects the part of a path as for the pictures of a run; none if there is no state.
    pub fn of(rows: &[Row], findings: &Findings, scale: &Scale) -> Option<Self> {
        if rows.is_empty() {
            return None;
        }
        let selection = Selection::of_path(rows, findings);
        let of = |row: &&Row| (row.step, selection.abscissa.of(row));
        Some(Self {
            label: selection.abscissa.label(scale),
            states: selection.rows.iter().map(of).collect(),
            chosen: selection.chosen.iter().map(|row| row.step).collect(),
        })
    }
}

/// Returns the numbers of the states at which something is found.
fn events(findings: &Findings) -> impl Iterator<Item = usize> + '_ {
    let intervals = [
        &findings.square,
        &findings.overhanging,
        &findings.crossing,
        &findings.closed,
    ];
    let first = |interval: &Interval| interval.first.state;
    let intervals = intervals.into_iter().flatten().map(first);
    let extremes = findings.extremes.iter().map(|extreme| extreme.at.state);
    let unstable = findings
        .unstable
        .iter()
        .flat_map(|unstable| &unstable.states);
    intervals.chain(extremes).chain(unstable.map(first))
}

/// Returns the numbers of the states shown in detail: the last one, the one with the deepest invagination, the first one, the ends
/// of the stages, the energy minima, and the last square wall; of many, those named first.
fn chosen(rows: &[Row], findings: &Findings) -> Vec<usize> {
    let (Some(first), Some(last)) = (rows.first(), rows.last()) else {
        return vec![];
    };
    let deepest = findings.deepest.iter().map(|deepest| deepest.at.state);
    let ends = findings.stages.iter().map(|stage| stage.states[1]);
    let minima = findings.energy_minima().map(|minimum| minimum.at.state);
    let square = findings.square.last().map(|interval| interval.last.state);
    let candidates = std::iter::once(last.step)
        .chain(deepest)
        .chain([first.step])
        .chain(ends)
        .chain(minima)
        .chain(square);
    let mut chosen = vec![];
    for state in candidates.filter(|state| (first.step..=last.step).contains(state)) {
        if !chosen.contains(&state) && chosen.len() < MOST_CHOSEN {
            chosen.push(state);
        }
    }
    chosen
}

/// Returns the quantity that alone changes in the last part of a path, and the number of states of that part; the number of the
/// state and the whole path if no single quantity changes.
fn last_part(all: &[Row]) -> (Abscissa, usize) {
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
    match best {
        Some(quantity) if tail(quantity) > 2 => (quantity, tail(quantity)),
        _ => (Abscissa::Step, all.len()),
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
