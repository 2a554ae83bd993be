//! The figures, each with its runs and its evaluation.

mod appendix_a;
mod appendix_b;
mod fig3;
mod fig4;
mod fig5;
mod fig6;
mod fig7;
mod ramps;

use super::job::Job;
use super::{Figure, Fineness, ReproductionError};
use plica::measure::{Shape, Side};
use plica::study::Row;

/// All figures, in the order of the paper.
pub const FIGURES: &[Figure] = &[
    fig3::FIGURE,
    fig4::FIGURE,
    fig5::FIGURE,
    fig6::FIGURE,
    fig7::FIGURE,
    appendix_a::FIGURE,
    appendix_b::FIGURE,
];

/// Returns the mesh of axisymmetric tubes: that of the paper, or a coarser one.
fn mesh(fineness: Fineness) -> [usize; 3] {
    fineness.choose([205, 60, 6], [305, 60, 8])
}

/// A mesh for series of many runs.
const COARSE: [usize; 3] = [155, 60, 5];

/// A mesh for runs of many solves in the quick reproduction.
const COARSER: [usize; 3] = [105, 60, 4];

/// Creates a run of a case on the mesh of axisymmetric tubes.
fn axisymmetric(case: &'static str, fineness: Fineness) -> Job {
    Job::of(case).on(mesh(fineness))
}

/// Describes the shape of a state, with the end that it invaginates towards and the overhang.
fn side(row: &Row) -> String {
    if row.shape == Shape::Invaginated {
        let crosses = if row.crosses_itself() {
            " (the wall has met itself)"
        } else {
            ""
        };
        format!(
            "invaginated toward the {}, overhang {:.3} D{crosses}",
            row.side, row.overhang
        )
    } else {
        row.shape.to_string()
    }
}

/// Overhang above which a wall counts as folded over, in D: its thickness.
const FOLD: f64 = 0.06;

/// Returns whether a state is invaginated towards an end by more than the thickness of its wall.
fn is_folded(row: &Row, side: Side) -> bool {
    row.shape == Shape::Invaginated && row.side == side && row.overhang > FOLD
}

/// Lists the unstable states of an axisymmetric path and their circumferential modes.
fn unstable(rows: &[Row]) -> String {
    let mut places = vec![];
    for row in rows {
        let modes = row.stability.unstable_modes();
        let modes: Vec<String> = modes.map(|mode| mode.to_string()).collect();
        if !modes.is_empty() {
            places.push(format!(
                "{:.2} (n = {})",
                row.length_ratio,
                modes.join(", ")
            ));
        }
    }
    if places.is_empty() {
        "nowhere".into()
    } else {
        places.join(", ")
    }
}

/// Returns the first state of a shape.
fn first(rows: &[Row], shape: Shape) -> Option<&Row> {
    rows.iter().find(|row| row.shape == shape)
}

/// Returns the state of least energy inside the path.
fn minimum(rows: &[Row]) -> Result<&Row, ReproductionError> {
    let least = (0..rows.len()).min_by(|&a, &b| rows[a].energy.total_cmp(&rows[b].energy));
    match least {
        Some(at) if at > 0 && at + 1 < rows.len() => Ok(&rows[at]),
        _ => Err(ReproductionError::State(
            "the energy has no minimum inside the path".into(),
        )),
    }
}

/// Formats the length ratio of a state, or `none`.
fn ratio(row: Option<&Row>) -> String {
    row.map_or("none".into(), |row| format!("{:.2}", row.length_ratio))
}
