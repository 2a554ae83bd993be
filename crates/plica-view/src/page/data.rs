//! Data of a run for the scripts of the page.

use super::scene::Scene;
use super::{Run, summary};
use crate::draw::label;
use crate::report::{Column, Role};
use serde::Serialize;

/// Numbers of a run.
#[derive(Serialize)]
pub struct RunData {
    name: String,
    /// Names of the ends at z = 0 and z = L.
    ends: [String; 2],
    /// Walls of all drawn states.
    pub scene: Scene,
    /// Stage of every row of the history.
    stages: Vec<String>,
    shapes: Vec<String>,
    /// Reason why a state is not physical or not an equilibrium.
    caution: Vec<Option<&'static str>>,
    columns: Vec<Plotted>,
}

/// A column for the plots; its label is plain text.
#[derive(Serialize)]
struct Plotted {
    name: String,
    label: String,
    /// True for a part of the load.
    load: bool,
    values: Vec<Option<f64>>,
}

impl RunData {
    /// Collects the data of a run; the walls take at most `max_bytes`.
    pub fn of(run: &Run<'_>, columns: &[Column], max_bytes: usize) -> Self {
        let plotted = |column: &Column| Plotted {
            name: column.name.clone(),
            label: label::plain(&column.label),
            load: column.role == Role::Load,
            values: column.values.clone(),
        };
        let all = columns.iter().map(plotted);
        let scene = match run.states {
            [] => Scene::without(run.plan, run.rows.iter().map(|row| row.step).collect()),
            states => Scene::of(run.plan, states, run.scales, run.upwards(), max_bytes),
        };
        Self {
            name: run.name.clone(),
            ends: run.plan.end_names.clone(),
            scene,
            stages: run.rows.iter().map(|row| row.stage.clone()).collect(),
            shapes: run.rows.iter().map(|row| row.shape.to_string()).collect(),
            caution: run.rows.iter().map(summary::caution).collect(),
            columns: all.chain(eigenvalues(run).iter().map(plotted)).collect(),
        }
    }
}

/// Reads the lowest eigenvalue of every circumferential mode and state from the results of `plica stability`.
fn eigenvalues(run: &Run<'_>) -> Vec<Column> {
    let table = run.directory.records("eigenvalues.csv").unwrap_or_default();
    let Some((heads, lines)) = table.split_first() else {
        return vec![];
    };
    let Some(state) = heads.iter().position(|head| head == "state") else {
        return vec![];
    };
    let lowest = heads.iter().enumerate();
    let lowest = lowest.filter_map(|(column, head)| Some((column, head.strip_prefix("lowest_")?)));
    let of = |column: usize, step: usize| {
        let own = |line: &&Vec<String>| line.get(state).is_some_and(|s| s.parse() == Ok(step));
        lines.iter().find(own)?.get(column)?.parse().ok()
    };
    lowest
        .map(|(column, n)| {
            let values = run
                .rows
                .iter()
                .map(|row| of(column, row.step).unwrap_or(f64::NAN));
            let label = format!("lowest eigenvalue, *n* = {n} (*E*/*D*^{{2}})");
            Column::new(&format!("lowest_{n}"), &label, Role::Other, values)
        })
        .collect()
}
