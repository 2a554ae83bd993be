//! Plots of columns and of wall profiles.

use super::labels::state_label;
use super::walls::{Wall, walls};
use super::{Column, Shown};
use crate::draw::{Chart, Curve, VerticalLine};
use plica::assembly::SplineTube;
use plica::study::{Plan, Row, Scale};

/// Plots a column against another one or against the number of the state; `None` if a column does not exist.
pub fn plot(plan: &Plan, rows: &[Row], name: &str, against: Option<&str>) -> Option<Chart> {
    let columns = Column::all(rows, &Scale::of(plan.units.as_ref()));
    let find = |name: &str| columns.iter().find(|column| column.name == name);
    let y = find(name)?;
    let (x_label, x): (&str, Vec<Option<f64>>) = match against {
        Some(name) => {
            let x = find(name)?;
            (&x.label, x.values.clone())
        }
        None => (
            "state",
            rows.iter().map(|row| Some(row.step as f64)).collect(),
        ),
    };
    // Starts of the stages, shown only along the number of the state.
    let stages = rows
        .windows(2)
        .filter(|pair| pair[0].stage != pair[1].stage && pair[0].step > 0);
    let vertical_lines = stages.map(|pair| VerticalLine {
        at: pair[0].step as f64,
        label: pair[1].stage.clone(),
    });
    let point =
        |(x, y): (&Option<f64>, &Option<f64>)| (x.unwrap_or(f64::NAN), y.unwrap_or(f64::NAN));
    Some(Chart {
        x_label: x_label.to_owned(),
        y_label: y.label.clone(),
        curves: vec![Curve {
            points: x.iter().zip(&y.values).map(point).collect(),
            dots: true,
            colour: 1,
            ..Curve::default()
        }],
        vertical_lines: vertical_lines
            .take(if against.is_none() { usize::MAX } else { 0 })
            .collect(),
        ..Chart::default()
    })
}

/// Plots the outer and the inner wall at states.
pub fn plot_walls(plan: &Plan, states: &[Shown]) -> Chart {
    let tube = SplineTube::new(&plan.tube, &plan.mesh, plan.mesh.rings(plan.symmetry));
    let chosen: Vec<Wall<'_>> = states.iter().map(wall).collect();
    walls(plan, &tube, &chosen)
}

fn wall((state, row): &Shown) -> Wall<'_> {
    Wall {
        label: state_label(row),
        load: &state.load,
        u: &state.u,
    }
}
