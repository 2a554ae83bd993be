//! Bifurcation diagrams.

use super::Column;
use crate::draw::{Chart, Curve, Marker, Stroke};
use plica::branches::{Branch, BranchState, Branches};
use plica::study::{Plan, Row, Scale};

/// Draws each column against the parameter of branches: stable parts solid, unstable parts dashed, special points labelled.
/// Returns the names of the columns with their charts; columns that do not exist are left out.
pub fn branch_diagrams(plan: &Plan, found: &Branches, columns: &[String]) -> Vec<(String, Chart)> {
    let scale = Scale::of(plan.units.as_ref());
    let first = found.branches.iter().flat_map(|branch| &branch.states);
    let rows: Vec<Row> = first.take(1).map(|state| state.row.clone()).collect();
    let all = Column::all(&rows, &scale);
    let chart = |name: &String| {
        let column = all.iter().find(|column| column.name == *name)?;
        Some((name.clone(), diagram(found, name, &column.label)))
    };
    columns.iter().filter_map(chart).collect()
}

fn diagram(found: &Branches, name: &str, label: &str) -> Chart {
    let several = found.branches.len() > 1;
    let mut chart = Chart {
        x_label: found.parameter.clone(),
        y_label: label.to_owned(),
        width_pt: 340.0,
        ..Chart::default()
    };
    for branch in &found.branches {
        let mut is_named = !several;
        for (stable, states) in parts(branch) {
            let text = match (&branch.from, is_named) {
                (_, true) => String::new(),
                (None, false) => format!("branch {}", branch.number),
                (Some(from), false) => format!("branch {} from {from}", branch.number),
            };
            is_named = true;
            chart.curves.push(Curve {
                label: text,
                points: states.iter().map(|state| point(state, name)).collect(),
                colour: branch.number,
                stroke: if stable {
                    Stroke::Solid
                } else {
                    Stroke::Dashed
                },
                dots: false,
            });
        }
        let labelled = branch.states.iter().filter_map(|state| {
            let label = state.label.clone()?;
            Some(Marker {
                at: point(state, name),
                label,
                colour: branch.number,
            })
        });
        chart.markers.extend(labelled);
    }
    chart
}

fn point(state: &BranchState, column: &str) -> (f64, f64) {
    (state.parameter, state.column(column).unwrap_or(f64::NAN))
}

/// Returns the parts of a branch with the same stability; neighbouring parts share a state.
fn parts(branch: &Branch) -> Vec<(bool, &[BranchState])> {
    let states = &branch.states;
    // Between a special point, where an eigenvalue is zero, and another state, that state decides.
    let is_stable = |i: usize| match (&states[i].label, &states[i + 1].label) {
        (None, _) => states[i].is_stable(),
        _ => states[i + 1].is_stable(),
    };
    let mut parts = vec![];
    let mut begin = 0;
    for i in 1..states.len() {
        if i + 1 == states.len() || is_stable(i) != is_stable(begin) {
            parts.push((is_stable(begin), &states[begin..=i]));
            begin = i;
        }
    }
    parts
}
