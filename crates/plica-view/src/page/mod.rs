//! Self-contained HTML pages of one or several runs.
//!
//! | file | content |
//! |---|---|
//! | `scene` | walls of all states, sampled, quantised and compressed |
//! | `stops` | positions of the slider: states of several runs under similar loads |
//! | `data` | data of a run for the scripts |
//! | `content` | data of a run for the template: tables and pictures |
//! | `summary` | headline and warnings |
//! | `picture` | pictures of the run directory |
//! | `stability` | results of `plica stability` |
//! | `web/page.html` | template |
//! | `web/page.css` | style for screens, print, light and dark mode |
//! | `web/*.js` | the tube in three dimensions, plots, slider |
//! | `web/vendor/` | three.js and uPlot, bundled by `scripts/bundle-page` |
//!
//! The page contains the numbers as JSON and, compressed, as base64. Without scripts it still shows text, tables and pictures.

mod content;
mod data;
mod picture;
mod scene;
mod stability;
mod stops;
mod summary;

#[cfg(test)]
pub(crate) use scene::scene_of_states;

use crate::draw::ColourMap;
use crate::draw::line_colour;
use crate::report::{Column, FieldScales, upward_angle};
use content::Content;
use data::RunData;
use minijinja::value::{Serde, Value};
use minijinja::{Environment, context};
use plica::run_directory::RunDirectory;
use plica::saved_state::SavedState;
use plica::study::{Plan, Row, Scale};
use stops::Parts;

/// Number of colours per colour map.
const COLOURS: usize = 256;
/// Maximum size of the states of all runs before compression, in bytes. Compressed and as base64 they take between a sixth
/// and two fifths of it.
const MAX_BYTES: usize = 28_000_000;

/// A run shown on a page.
#[derive(Clone, Debug)]
pub struct Run<'a> {
    /// Name of the run in a comparison.
    pub name: String,
    /// Plan of the run.
    pub plan: &'a Plan,
    /// Rows of its history.
    pub rows: &'a [Row],
    /// Saved states to draw, in increasing order; see [`drawn`].
    pub states: &'a [SavedState],
    /// Scales of the fields in all saved states.
    pub scales: &'a FieldScales,
    /// Number of saved states.
    pub saved: usize,
    /// Number of saved states that are not drawn.
    pub left_out: usize,
    /// Descriptions of files that could not be read.
    pub unread: &'a [String],
    /// Directory with the case, tables and pictures.
    pub directory: &'a RunDirectory,
}

/// Errors of making a page.
#[derive(Debug, thiserror::Error)]
pub enum PageError {
    /// Runs with different units.
    #[error("`{}` is in {} and `{}` in {}: give both cases the same units, or none", .0[0].0, .0[0].1, .0[1].0, .0[1].1)]
    Units([(String, String); 2]),
    /// The template failed, which is a bug of this crate.
    #[error("the template of the page failed, which is a bug of plica: {0}")]
    Template(#[from] minijinja::Error),
}

impl Run<'_> {
    /// Returns the angle that points up, in radians.
    fn upwards(&self) -> f64 {
        upward_angle(self.rows, &Scale::of(self.plan.units.as_ref()))
    }

    /// Returns the loads of its states.
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

/// Converts a sentence to HTML, with text between backticks as code.
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

/// Selects the saved states of one of `runs` runs that a page draws, such that the page stays small.
pub fn drawn(plan: &Plan, saved: &[usize], runs: usize) -> Vec<usize> {
    scene::drawn(plan, saved, MAX_BYTES / runs.max(1))
}

/// Returns the HTML page of one run, or of several runs with a common slider.
///
/// # Errors
/// [`PageError::Units`] if the runs have different units.
pub fn page(runs: &[Run<'_>]) -> Result<String, PageError> {
    for pair in runs.windows(2) {
        let [a, b] = [&pair[0], &pair[1]].map(|run| (run.name.clone(), run.units()));
        if a.1 != b.1 {
            return Err(PageError::Units([a, b]));
        }
    }
    let (mut data, mut contents) = (vec![], vec![]);
    for run in runs {
        let columns = Column::of(run.rows, &Scale::of(run.plan.units.as_ref()));
        let one = RunData::of(run, &columns, MAX_BYTES / runs.len());
        contents.push(Content::of(run, &columns, &one));
        data.push(one);
    }
    let loads: Vec<Vec<Parts>> = runs.iter().map(Run::loads).collect();
    let (leader, stops) = stops::stops(&loads);
    let colours = |map: ColourMap| {
        let colour = |i: usize| map.colour(i as f64 / (COLOURS - 1) as f64);
        (0..COLOURS).map(colour).collect::<Vec<_>>()
    };
    let lines = [1, 2, 3, 4].map(line_colour);
    let data = serde_json::json!({
        "runs": data,
        "leader": leader,
        "stops": stops,
        "steps": scene::STEPS,
        "colours": colours(ColourMap::default()),
        "diverging": colours(ColourMap::Diverging),
        "lines": lines,
    });
    let mut templates = Environment::new();
    templates.add_filter("code", code);
    templates.add_template("page.html", include_str!("web/page.html"))?;
    let page = templates.get_template("page.html")?;
    Ok(page.render(context! {
        runs => Serde(&contents),
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
        // `<` is escaped so that the data cannot end the script element.
        data => data.to_string().replace('<', "\\u003c"),
    })?)
}
