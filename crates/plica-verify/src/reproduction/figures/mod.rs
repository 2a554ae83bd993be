//! The figures, each with its runs and what it tells of them.

mod appendix_a;
mod appendix_b;
mod fig3;
mod fig4;
mod fig5;
mod fig6;
mod fig7;
mod ramps;

use super::job::Job;
use super::{Figure, Fineness, Trouble};
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

/// The mesh of axisymmetric tubes: of the paper, or coarser.
fn mesh(fineness: Fineness) -> [usize; 3] {
    fineness.choose([205, 60, 6], [305, 60, 8])
}

/// A mesh for what takes many runs.
const COARSE: [usize; 3] = [155, 60, 5];

/// A mesh for what takes many solves, in a hurry.
const COARSER: [usize; 3] = [105, 60, 4];

/// A case on the mesh of axisymmetric tubes.
fn axisymmetric(case: &'static str, fineness: Fineness) -> Job {
    Job::of(case).on(mesh(fineness))
}

/// Whether a wall overhangs, and towards which end: told of a state.
fn side(row: &Row) -> String {
    if row.shape == Shape::Invaginated {
        let crosses = if row.crosses_itself() {
            " (the wall has met itself)"
        } else {
            ""
        };
        format!(
            "invaginated toward the {}, {:.3} D deep{crosses}",
            row.side, row.overhang
        )
    } else {
        row.shape.to_string()
    }
}

/// Overhang from which a wall counts as folded over, in D: its thickness.
const FOLD: f64 = 0.06;

/// Whether a state is invaginated toward an end, by more than its wall is thick.
fn is_folded(row: &Row, side: Side) -> bool {
    row.shape == Shape::Invaginated && row.side == side && row.overhang > FOLD
}

/// In words, where an axisymmetric path is unstable, and to which harmonics: the whole tube would leave it there.
fn unstable(rows: &[Row]) -> String {
    let mut places = vec![];
    for row in rows {
        let modes = row.stability.unstable_modes();
        let harmonics: Vec<String> = modes.map(|mode| mode.to_string()).collect();
        if !harmonics.is_empty() {
            places.push(format!(
                "{:.2} (n = {})",
                row.length_ratio,
                harmonics.join(", ")
            ));
        }
    }
    if places.is_empty() {
        "nowhere".into()
    } else {
        places.join(", ")
    }
}

/// The first state of a shape.
fn first(rows: &[Row], shape: Shape) -> Option<&Row> {
    rows.iter().find(|row| row.shape == shape)
}

/// The state of least energy, if it lies inside.
fn minimum(rows: &[Row]) -> Result<&Row, Trouble> {
    let least = (0..rows.len()).min_by(|&a, &b| rows[a].energy.total_cmp(&rows[b].energy));
    match least {
        Some(at) if at > 0 && at + 1 < rows.len() => Ok(&rows[at]),
        _ => Err(Trouble::State(
            "the energy has no minimum inside the path".into(),
        )),
    }
}

/// A length ratio, or that there is none.
fn ratio(row: Option<&Row>) -> String {
    row.map_or("none".into(), |row| format!("{:.2}", row.length_ratio))
}
