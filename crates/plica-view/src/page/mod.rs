//! A run, or several beside each other, as one HTML page that needs nothing else: opened from disk, sent by mail, kept with a
//! paper.
//!
//! | file | holds |
//! |---|---|
//! | `scene` | the walls of all states, sampled, quantised and packed |
//! | `stops` | which states of several runs are shown together |
//! | `known` | what the page's scripts know of a run |
//! | `sheet` | what its template knows: tables and pictures |
//! | `words` | what the run came to, and what to beware of |
//! | `stability` | what `plica stability` has left |
//! | `web/page.html` | the page's template |
//! | `web/page.css` | how it looks: on a phone, in print, by day and by night |
//! | `web/*.js` | what it does: the tube in three dimensions, plots, the slider that moves both |
//! | `web/vendor/` | three.js and uPlot as they come, bundled by `scripts/bundle-page` |
//!
//! The numbers are in the page as JSON and, packed, as base64. Without scripts its words, tables and still pictures are there.

mod known;
mod scene;
mod sheet;
mod stability;
mod stops;
mod words;

use crate::draw::ColourMap;
use crate::draw::line_colour;
use crate::report::{Column, upright};
use known::Known;
use minijinja::value::{Serde, Value};
use minijinja::{Environment, context};
use plica::run_directory::RunDirectory;
use plica::saved_state::SavedState;
use plica::study::{Plan, Row, Scale};
use sheet::Sheet;
use stops::Parts;

/// Colours of the map that the page has.
const COLOURS: usize = 256;
/// Bytes of the states of all runs before they are packed, at most; packed and as text they are between a sixth and two fifths
/// of that.
const LARGEST: usize = 28_000_000;

/// A run to be shown.
#[derive(Clone, Debug)]
pub struct Run<'a> {
    /// What it is called beside another.
    pub name: String,
    /// What was computed.
    pub plan: &'a Plan,
    /// Its history.
    pub rows: &'a [Row],
    /// Those of its saved states that are to be drawn, in the order of their numbers; see [`drawn`].
    pub states: &'a [SavedState],
    /// How many states it has saved.
    pub saved: usize,
    /// How many of these are not to be drawn.
    pub left_out: usize,
    /// What of it could not be read, in words.
    pub unread: &'a [String],
    /// Where its case, its tables and its pictures are.
    pub directory: &'a RunDirectory,
}

/// Why a page could not be made.
#[derive(Debug, thiserror::Error)]
pub enum PageError {
    /// Two runs in different units.
    #[error("`{}` is in {} and `{}` in {}: give both cases the same units, or none", .0[0].0, .0[0].1, .0[1].0, .0[1].1)]
    Units([(String, String); 2]),
    /// The template and what it is given do not fit, which is a fault of the program.
    #[error("the page's template failed, which is a fault of plica: {0}")]
    Template(#[from] minijinja::Error),
}

impl Run<'_> {
    /// The angle around it that points up, in radians.
    fn upwards(&self) -> f64 {
        upright(self.rows, &Scale::of(self.plan.units.as_ref()))
    }

    /// Its states by their loads.
    fn loads(&self) -> Vec<Parts> {
        let scale = Scale::of(self.plan.units.as_ref());
        let rows = self.rows.iter().map(|row| stops::of_row(row, &scale));
        match self.states {
            [] => rows.collect(),
            states => states.iter().map(stops::of_state).collect(),
        }
    }

    fn units(&self) -> String {
        let scale = Scale::of(self.plan.units.as_ref());
        format!("{}, {}", scale.length_name, scale.stress_name)
    }
}

/// A sentence as HTML, what is between backticks as code.
fn code(sentence: &str) -> Value {
    let parts = sentence.split('`').enumerate().map(|(i, part)| {
        let part = part.replace('&', "&amp;").replace('<', "&lt;");
        match i % 2 {
            0 => part,
            _ => format!("<code>{part}</code>"),
        }
    });
    Value::from_safe_string(parts.collect())
}

/// Which of the saved states of one of so many runs a page draws, so that it stays small.
pub fn drawn(plan: &Plan, saved: &[usize], runs: usize) -> Vec<usize> {
    scene::drawn(plan, saved, LARGEST / runs.max(1))
}

/// One run, or several with one slider.
///
/// # Errors
/// [`PageError::Units`] if the runs' tables are in different units.
pub fn page(runs: &[Run<'_>]) -> Result<String, PageError> {
    for pair in runs.windows(2) {
        let [a, b] = [&pair[0], &pair[1]].map(|run| (run.name.clone(), run.units()));
        if a.1 != b.1 {
            return Err(PageError::Units([a, b]));
        }
    }
    let (mut known, mut sheets) = (vec![], vec![]);
    for run in runs {
        let columns = Column::of(run.rows, &Scale::of(run.plan.units.as_ref()));
        let one = Known::of(run, &columns, LARGEST / runs.len());
        sheets.push(Sheet::of(run, &columns, &one));
        known.push(one);
    }
    let loads: Vec<Vec<Parts>> = runs.iter().map(Run::loads).collect();
    let (leader, stops) = stops::stops(&loads);
    let colours = |map: ColourMap| {
        let colour = |i: usize| map.colour(i as f64 / (COLOURS - 1) as f64);
        (0..COLOURS).map(colour).collect::<Vec<_>>()
    };
    let lines = [1, 2, 3, 4].map(line_colour);
    let data = serde_json::json!({
        "runs": known,
        "leader": leader,
        "stops": stops,
        "steps": scene::STEPS,
        "colours": colours(ColourMap::default()),
        "signed": colours(ColourMap::Diverging),
        "lines": lines,
    });
    let mut templates = Environment::new();
    templates.add_filter("code", code);
    templates.add_template("page.html", include_str!("web/page.html"))?;
    let page = templates.get_template("page.html")?;
    Ok(page.render(context! {
        runs => Serde(&sheets),
        drawn => runs.iter().any(|run| !run.states.is_empty()),
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
