//! A run, or two beside each other, as one HTML page that needs nothing else: opened from disk, sent by mail, kept with a
//! paper.
//!
//! | file | holds |
//! |---|---|
//! | `scene` | the walls of all states, sampled, quantised and packed |
//! | `words` | what the run came to, and what to beware of |
//! | `web/page.html` | the page's template |
//! | `web/page.css` | how it looks: on a phone, in print, by day and by night |
//! | `web/*.js` | what it does: the tube in three dimensions, plots, the slider that moves both |
//! | `web/vendor/` | three.js and uPlot as they come, bundled by `scripts/bundle-page` |
//!
//! The numbers are in the page as JSON and, packed, as base64. Without scripts its words, tables and still pictures are there.

mod scene;
mod words;

use crate::draw::{self, Map, label};
use crate::report::Column;
use crate::study::{Findings, Plan, Row, RunDirectory, SavedState, Scale};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use minijinja::{Environment, context};
use scene::Scene;
use serde::Serialize;

/// Departure from axisymmetry, in D, above which its crest is turned up.
const VISIBLE: f64 = 2e-3;
/// Colours of the map that the page has.
const COLOURS: usize = 256;

/// A run to be told.
#[derive(Clone, Debug)]
pub struct Told<'a> {
    /// What it is called beside another.
    pub name: String,
    /// What was computed.
    pub plan: &'a Plan,
    /// Its history.
    pub rows: &'a [Row],
    /// Its saved states; at least one.
    pub states: &'a [SavedState],
    /// Where its case, its tables and its pictures are.
    pub directory: &'a RunDirectory,
}

/// Why a page could not be made.
#[derive(Debug, thiserror::Error)]
pub enum PageError {
    /// Two runs in different units.
    #[error("`{}` is in {} and `{}` in {}: give both cases the same units, or none", .0[0].0, .0[0].1, .0[1].0, .0[1].1)]
    Units([(String, String); 2]),
    /// The template and what it is given do not fit.
    #[error("the page's template failed: {0}")]
    Template(#[from] minijinja::Error),
}

/// What the scripts know of a run.
#[derive(Serialize)]
struct Known {
    name: String,
    scene: Scene,
    /// Names of the states: stage, shape.
    stages: Vec<String>,
    shapes: Vec<String>,
    columns: Vec<Plotted>,
    /// The loads of every state, by which states of two runs are told to be alike.
    loads: Vec<[f64; 8]>,
}

/// A column that may be plotted, its label as plain text.
#[derive(Serialize)]
struct Plotted {
    name: String,
    label: String,
    values: Vec<Option<f64>>,
}

/// What the template knows of a run.
#[derive(Serialize)]
struct Shelf {
    name: String,
    title: String,
    headline: String,
    complete: bool,
    findings: Vec<(&'static str, String)>,
    warnings: Vec<String>,
    case: String,
    manifest: serde_json::Value,
    mesh: String,
    unknowns: usize,
    seconds: String,
    table: Vec<Line>,
    heads: Vec<String>,
    critical: Vec<Vec<String>>,
    pictures: Vec<Picture>,
    stability_pictures: Vec<Picture>,
}

#[derive(Serialize)]
struct Line {
    step: usize,
    stage: String,
    shape: String,
    unstable: String,
    method: String,
    numbers: Vec<String>,
    drawn: bool,
}

#[derive(Serialize)]
struct Picture {
    name: &'static str,
    words: &'static str,
    data: String,
}

/// One run, or several with one slider.
///
/// # Errors
/// [`PageError::Units`] if the runs' tables are in different units.
pub fn page(runs: &[Told<'_>]) -> Result<String, PageError> {
    for pair in runs.windows(2) {
        let units = [&pair[0], &pair[1]].map(|told| {
            let scale = Scale::of(told.plan.units.as_ref());
            (
                told.name.clone(),
                format!("{}, {}", scale.length_name, scale.stress_name),
            )
        });
        if units[0].1 != units[1].1 {
            return Err(PageError::Units(units));
        }
    }
    let (known, shelves): (Vec<Known>, Vec<Shelf>) = runs.iter().map(told).unzip();
    let colour = |i: usize| Map::default().colour(i as f64 / (COLOURS - 1) as f64);
    let lines = [1, 2, 3, 4].map(draw::colour::line_colour);
    let data = serde_json::json!({
        "runs": known,
        "colours": (0..COLOURS).map(colour).collect::<Vec<_>>(),
        "lines": lines,
    });
    let mut templates = Environment::new();
    templates.add_template("page.html", include_str!("web/page.html"))?;
    let page = templates.get_template("page.html")?;
    Ok(page.render(context! {
        runs => minijinja::value::Serde(&shelves),
        version => env!("CARGO_PKG_VERSION"),
        style => include_str!("web/page.css"),
        plot_style => include_str!("web/vendor/uplot.css"),
        scripts => [
            include_str!("web/vendor/three.js"),
            include_str!("web/vendor/uplot.js"),
            include_str!("web/scene.js"),
            include_str!("web/view.js"),
            include_str!("web/plots.js"),
            include_str!("web/page.js"),
        ],
        // Nothing in it may end the script it stands in.
        data => data.to_string().replace('<', "\\u003c"),
    })?)
}

fn told(told: &Told<'_>) -> (Known, Shelf) {
    let scale = Scale::of(told.plan.units.as_ref());
    let findings = Findings {
        rows: told.rows,
        scale: scale.clone(),
    };
    let leans = told
        .rows
        .iter()
        .rev()
        .find(|row| row.departure > VISIBLE * scale.length);
    let upwards = leans.map_or(0.0, |row| row.departure_angle_deg.to_radians());
    let scene = Scene::of(told.plan, told.states, upwards);
    let mut columns = Column::of(told.rows, &scale);
    let tabled: Vec<&Column> = columns.iter().filter(|m| m.tabled).collect();
    let line = |(i, row): (usize, &Row)| Line {
        step: row.step,
        stage: row.stage.clone(),
        shape: row.shape.clone(),
        unstable: row.unstable_harmonics.clone(),
        method: row.method.clone(),
        numbers: tabled.iter().map(|m| number(m.values[i])).collect(),
        drawn: scene.rows.contains(&row.step),
    };
    let [axial, around, thickness] = [
        told.plan.mesh.axial,
        told.plan.mesh.around,
        told.plan.mesh.thickness,
    ];
    let rings = told.plan.mesh.rings(told.plan.symmetry);
    let seconds: f64 = told.rows.iter().map(|row| row.seconds).sum();
    let shelf = Shelf {
        name: told.name.clone(),
        title: told.plan.title.clone(),
        headline: words::headline(told, &findings),
        complete: told.directory.verdict() == "complete",
        findings: findings.lines().into_iter().map(raised).collect(),
        warnings: words::warnings(told, scene.left_out),
        case: String::from_utf8_lossy(&told.directory.read("case.toml").unwrap_or_default())
            .into_owned(),
        manifest: told.directory.manifest(),
        mesh: format!(
            "{axial} × {around} × {thickness} control points, {}",
            match rings {
                1 => "axisymmetric".to_owned(),
                n if n == around => "nothing repeats around".into(),
                n => format!("a sector of {n} rings that repeats {} times", around / n),
            }
        ),
        unknowns: 3 * axial * rings * thickness,
        seconds: format!("{seconds:.1}"),
        table: told.rows.iter().enumerate().map(line).collect(),
        heads: tabled.iter().map(|m| label::html(&m.label)).collect(),
        critical: told.directory.records("stability.csv").unwrap_or_default(),
        pictures: pictures(
            told,
            &[
                (
                    "tube.png",
                    "The tube cut open at chosen states, coloured by strain energy density.",
                ),
                ("walls.png", "Outer and inner wall at the same states."),
            ],
        ),
        stability_pictures: pictures(
            told,
            &[
                (
                    "stability.png",
                    "Lowest eigenvalues along the path; where one falls below zero the tube leaves it in that harmonic.",
                ),
                ("mode.png", "The shape in which it does."),
            ],
        ),
    };
    columns.extend(eigenvalues(told));
    let known = Known {
        name: told.name.clone(),
        scene,
        stages: told.rows.iter().map(|row| row.stage.clone()).collect(),
        shapes: told.rows.iter().map(|row| row.shape.clone()).collect(),
        columns: columns.into_iter().map(plotted).collect(),
        loads: told.rows.iter().map(loads).collect(),
    };
    (known, shelf)
}

fn plotted(column: Column) -> Plotted {
    Plotted {
        name: column.name,
        label: label::plain(&column.label),
        values: column.values,
    }
}

/// A finding with its power raised.
fn raised((name, words): (&'static str, String)) -> (&'static str, String) {
    (name, words.replace("D^3", "D³"))
}

fn loads(row: &Row) -> [f64; 8] {
    [
        row.length_ratio,
        row.diameter_ratio,
        row.colon_displacement,
        row.ileum_displacement,
        row.colon_twist_deg,
        row.ileum_twist_deg,
        row.inner_pressure.unwrap_or(0.0),
        row.outer_pressure.unwrap_or(0.0),
    ]
}

/// The lowest eigenvalue of every harmonic at every state, as `plica stability` has left it.
fn eigenvalues(told: &Told<'_>) -> Vec<Column> {
    let Some(records) = told.directory.records("eigenvalues.csv") else {
        return vec![];
    };
    let Some((heads, rows)) = records.split_first() else {
        return vec![];
    };
    let Some(state) = heads.iter().position(|head| head == "state") else {
        return vec![];
    };
    let lowest = heads.iter().enumerate();
    let lowest = lowest.filter_map(|(column, head)| Some((column, head.strip_prefix("lowest_")?)));
    let of = |column: usize, step: usize| {
        let own = |row: &&Vec<String>| row.get(state).is_some_and(|s| s.parse() == Ok(step));
        rows.iter().find(own)?.get(column)?.parse().ok()
    };
    lowest
        .map(|(column, n)| {
            let values = told
                .rows
                .iter()
                .map(|row| of(column, row.step).unwrap_or(f64::NAN));
            Column::new(
                &format!("lowest_{n}"),
                &format!("lowest eigenvalue, *n* = {n} (*E*/*D*^{{2}})"),
                false,
                values,
            )
        })
        .collect()
}

/// Those of a run's pictures that are there.
fn pictures(told: &Told<'_>, names: &[(&'static str, &'static str)]) -> Vec<Picture> {
    let read = |&(name, words): &(&'static str, &'static str)| {
        Some(Picture {
            name,
            words,
            data: STANDARD.encode(told.directory.read(name)?),
        })
    };
    names.iter().filter_map(read).collect()
}

/// A number in a table, with as many digits as a reader compares.
fn number(value: Option<f64>) -> String {
    match value {
        None => "–".into(),
        Some(0.0) => "0".into(),
        Some(x) if (1e-2..1e4).contains(&x.abs()) => format!("{x:.4}").replace('-', "−"),
        Some(x) => format!("{x:.3e}").replace('-', "−"),
    }
}
