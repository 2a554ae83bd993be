//! What the page's scripts know of a run.

use super::scene::Scene;
use super::{Run, words};
use crate::draw::label;
use crate::report::{Column, Role};
use serde::Serialize;

/// A run as numbers.
#[derive(Serialize)]
pub struct Known {
    name: String,
    /// Its walls.
    pub scene: Scene,
    /// Of every row of the history.
    stages: Vec<String>,
    shapes: Vec<String>,
    /// What makes of it less than it seems.
    beware: Vec<Option<&'static str>>,
    columns: Vec<Plotted>,
}

/// A column that may be plotted, its label as plain text.
#[derive(Serialize)]
struct Plotted {
    name: String,
    label: String,
    /// Whether it is part of the load.
    load: bool,
    values: Vec<Option<f64>>,
}

impl Known {
    /// Of a run, its walls sampled to so many bytes at most.
    pub fn of(run: &Run<'_>, columns: &[Column], largest: usize) -> Self {
        let plotted = |column: &Column| Plotted {
            name: column.name.clone(),
            label: label::plain(&column.label),
            load: column.role == Role::Load,
            values: column.values.clone(),
        };
        let all = columns.iter().map(plotted);
        let scene = match run.states {
            [] => Scene::without(run.plan, run.rows.iter().map(|row| row.step).collect()),
            states => Scene::of(run.plan, states, run.upwards(), largest),
        };
        Self {
            name: run.name.clone(),
            scene,
            stages: run.rows.iter().map(|row| row.stage.clone()).collect(),
            shapes: run.rows.iter().map(|row| row.shape.to_string()).collect(),
            beware: run.rows.iter().map(words::beware).collect(),
            columns: all.chain(eigenvalues(run).iter().map(plotted)).collect(),
        }
    }
}

/// The lowest eigenvalue of every harmonic at every state, as `plica stability` has left it.
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
