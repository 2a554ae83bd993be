//! What checks add to: rows, pictures, and a word with whoever waits.

use super::row::{Row, Tolerance, in_columns, in_markdown};
use plica::assembly::Inverted;
use plica::matrix::NoEigenpairs;
use plica::run_directory::RunError;
use plica::solve::PathError;
use plica_view::draw::{Chart, DrawError};

/// Is told what goes on, and may ask to stop.
pub trait Observer {
    /// A check begins: what it is, and how many of all are behind.
    fn begins(&mut self, _about: &str, _done: usize, _of: usize) {}
    /// A row is there.
    fn found(&mut self, _row: &Row) {}
    /// Whether to stop.
    fn stop(&mut self) -> bool {
        false
    }
}

impl Observer for () {}

/// Why a check could not be held.
#[derive(Debug, thiserror::Error)]
pub enum Trouble {
    /// Someone asked to stop.
    #[error("stopped")]
    Stopped,
    /// A path ended.
    #[error("{0}")]
    Path(#[from] PathError<Inverted>),
    /// A solver ended.
    #[error("{0}")]
    Solve(String),
    /// A state is inside out.
    #[error("{0}")]
    Inverted(#[from] Inverted),
    /// No lowest eigenvalue.
    #[error("{0}")]
    Eigenpairs(#[from] NoEigenpairs),
    /// The reference has no answer.
    #[error("{0}")]
    Reference(#[from] super::one_dimension::Unbalanced),
    /// A run ended.
    #[error("{0}")]
    Study(#[from] RunError),
}

/// What was found so far.
pub struct Findings<'a> {
    /// Whether time does not matter.
    pub full: bool,
    observer: &'a mut dyn Observer,
    pub(super) case: String,
    pub(super) rows: Vec<Row>,
    pub(super) charts: Vec<(String, String, Chart)>,
}

impl<'a> Findings<'a> {
    pub(super) fn new(full: bool, observer: &'a mut dyn Observer) -> Self {
        Self {
            full,
            observer,
            case: String::new(),
            rows: vec![],
            charts: vec![],
        }
    }

    pub(super) fn begins(&mut self, about: &str, done: usize, of: usize) {
        self.observer.begins(about, done, of);
    }

    /// What the rows to come are found on.
    ///
    /// # Errors
    /// [`Trouble::Stopped`] if someone asked to stop.
    pub fn case(&mut self, case: impl Into<String>) -> Result<(), Trouble> {
        self.case = case.into();
        self.resume()
    }

    /// # Errors
    /// [`Trouble::Stopped`] if someone asked to stop.
    pub fn resume(&mut self) -> Result<(), Trouble> {
        if self.observer.stop() {
            Err(Trouble::Stopped)
        } else {
            Ok(())
        }
    }

    /// A row of the case.
    pub fn row(
        &mut self,
        quantity: impl Into<String>,
        computed: f64,
        (reference, source): (f64, &str),
        tolerance: Tolerance,
    ) {
        let row = Row {
            case: self.case.clone(),
            quantity: quantity.into(),
            computed,
            reference,
            source: source.into(),
            tolerance,
            trouble: None,
        };
        self.observer.found(&row);
        self.rows.push(row);
    }

    /// A row within so much of its reference.
    pub fn within(
        &mut self,
        tolerance: f64,
        quantity: impl Into<String>,
        computed: f64,
        reference: (f64, &str),
    ) {
        self.row(
            quantity,
            computed,
            reference,
            Tolerance::Relative(tolerance),
        );
    }

    /// A row that should be zero, and is not above so much.
    pub fn nothing(
        &mut self,
        tolerance: f64,
        quantity: impl Into<String>,
        computed: f64,
        source: &str,
    ) {
        self.row(
            quantity,
            computed,
            (0.0, source),
            Tolerance::Absolute(tolerance),
        );
    }

    /// A row of a check that ended early.
    pub(super) fn failed(&mut self, trouble: &Trouble) {
        let row = Row {
            case: self.case.clone(),
            quantity: "the check itself".into(),
            computed: f64::NAN,
            reference: f64::NAN,
            source: "–".into(),
            tolerance: Tolerance::Absolute(0.0),
            trouble: Some(trouble.to_string()),
        };
        self.observer.found(&row);
        self.rows.push(row);
    }

    /// A picture, and what it shows.
    pub fn picture(&mut self, name: &str, caption: &str, chart: Chart) {
        self.charts.push((name.into(), caption.into(), chart));
    }
}

/// What a verification found.
#[derive(Clone, Debug)]
pub struct Verification {
    /// Whether it was the full one.
    pub full: bool,
    /// All rows.
    pub rows: Vec<Row>,
    /// File name, caption and what is drawn.
    pub charts: Vec<(String, String, Chart)>,
}

/// The first line of a page.
pub const TITLE: &str = "# Verification, row by row";

/// Pixels across a picture.
const WIDTH: usize = 1000;

impl Verification {
    /// Rows that are not near enough.
    pub fn failed(&self) -> usize {
        self.rows.iter().filter(|row| !row.passes()).count()
    }

    /// The table for a terminal, and the verdict.
    pub fn text(&self) -> String {
        format!("{}\n{}\n", in_columns(&self.rows), self.verdict())
    }

    fn verdict(&self) -> String {
        let (all, failed) = (self.rows.len(), self.failed());
        if failed == 0 {
            format!("all {all} rows within their tolerances")
        } else {
            format!("{failed} of {all} rows FAILED")
        }
    }

    /// A page of Markdown with the table and the pictures.
    pub fn page(&self) -> String {
        let (flag, how) = match self.full {
            true => (" --full", "the full one"),
            false => ("", "the quick one"),
        };
        let mut page = format!(
            "{TITLE}\n\n\
             Written by `plica verify{flag}`, {how}, version {}; {}. An error is over the reference, or\n\
             where the tolerance says ± in the unit of the quantity. Lengths are in D, stresses in E, energies in E·D³ (per length\n\
             E·D²). docs/verification.md tells how each row is found. Unless a row says otherwise a ring has H = 0.06 and\n\
             ν = 0.495; A and B are the wall's radii at rest, a and b those under load, θη and θζ what it has grown around and along, n waves around\n\
             and m half waves along.\n\n{}",
            env!("CARGO_PKG_VERSION"),
            self.verdict(),
            in_markdown(&self.rows)
        );
        for (name, caption, _) in &self.charts {
            page += &format!("\n![{caption}]({name})\n\n*{caption}*\n");
        }
        page
    }

    /// The pictures as PNG files: name and bytes.
    ///
    /// # Errors
    /// [`DrawError`] if one cannot be drawn.
    pub fn pictures(&self) -> Result<Vec<(String, Vec<u8>)>, DrawError> {
        let picture =
            |(name, _, chart): &(String, String, Chart)| Ok((name.clone(), chart.png(WIDTH)?));
        self.charts.iter().map(picture).collect()
    }
}
