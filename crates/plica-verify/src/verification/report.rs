//! Rows and charts of a verification: how checks record them, and the table and page made of them.

use super::VerificationError;
use super::row::{Row, Tolerance, in_columns, in_markdown};
use plica::monitor::Monitor;
use plica_view::draw::{Chart, DrawError};

/// Collects the rows and charts of running checks.
pub struct Recorder<'a> {
    /// True if the full verification runs, with finer meshes.
    pub full: bool,
    monitor: &'a mut dyn Monitor,
    fraction: f64,
    case: String,
    rows: Vec<Row>,
    charts: Vec<(String, String, Chart)>,
}

impl<'a> Recorder<'a> {
    pub(super) fn new(full: bool, monitor: &'a mut dyn Monitor) -> Self {
        Self {
            full,
            monitor,
            fraction: 0.0,
            case: String::new(),
            rows: vec![],
            charts: vec![],
        }
    }

    /// Begins a check after `done` of `all`; its description is the case until the check names another.
    pub(super) fn begin(&mut self, description: &str, done: usize, all: usize) {
        self.fraction = done as f64 / all as f64;
        self.case = description.into();
        self.monitor.working(
            &format_args!("{} of {all}: {description}", done + 1),
            self.fraction,
        );
    }

    /// Sets the case of the rows that follow.
    ///
    /// # Errors
    /// [`VerificationError::Cancelled`] if the monitor cancels.
    pub fn case(&mut self, case: impl Into<String>) -> Result<(), VerificationError> {
        self.case = case.into();
        self.check_cancelled()
    }

    /// Reports the case to the monitor.
    ///
    /// # Errors
    /// [`VerificationError::Cancelled`] if the monitor cancels.
    pub fn check_cancelled(&mut self) -> Result<(), VerificationError> {
        self.monitor.working(&self.case, self.fraction);
        if self.monitor.is_cancelled() {
            Err(VerificationError::Cancelled)
        } else {
            Ok(())
        }
    }

    /// Records a quantity of the case with its reference value and the source of that.
    pub fn row(
        &mut self,
        quantity: impl Into<String>,
        computed: f64,
        (reference, source): (f64, &str),
        tolerance: Tolerance,
    ) {
        self.push(Row {
            case: self.case.clone(),
            quantity: quantity.into(),
            computed,
            reference,
            source: source.into(),
            tolerance,
            failure: None,
        });
    }

    /// Records a row with a relative tolerance.
    pub fn relative(
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

    /// Records a row whose reference is zero.
    pub fn zero(
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

    /// Records that a check ended with an error.
    pub(super) fn failed(&mut self, error: &VerificationError) {
        self.push(Row {
            case: self.case.clone(),
            quantity: "the check itself".into(),
            computed: f64::NAN,
            reference: f64::NAN,
            source: "–".into(),
            tolerance: Tolerance::Absolute(0.0),
            failure: Some(error.to_string()),
        });
    }

    fn push(&mut self, row: Row) {
        if !row.passes() {
            self.monitor.notice(&format!(
                "FAILED: {}, {}: {:.6e} instead of {:.6e}",
                row.case, row.quantity, row.computed, row.reference
            ));
        }
        self.rows.push(row);
    }

    /// Records a chart with its file name and caption.
    pub fn chart(&mut self, name: &str, caption: &str, chart: Chart) {
        self.charts.push((name.into(), caption.into(), chart));
    }

    pub(super) fn finish(self) -> Verification {
        Verification {
            full: self.full,
            rows: self.rows,
            charts: self.charts,
        }
    }
}

/// Results of a verification.
#[derive(Clone, Debug)]
pub struct Verification {
    /// True if slow checks and finer meshes are included.
    pub full: bool,
    /// All rows.
    pub rows: Vec<Row>,
    /// File names, captions and charts.
    pub charts: Vec<(String, String, Chart)>,
}

/// First line of a page.
pub const TITLE: &str = "# Verification, row by row";

/// Width of a picture, in pixels.
const WIDTH: usize = 1000;

impl Verification {
    /// Returns the number of rows outside their tolerances.
    pub fn failed(&self) -> usize {
        self.rows.iter().filter(|row| !row.passes()).count()
    }

    /// Returns the table in aligned columns, and the number of failed rows.
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

    /// Returns a page of Markdown with the table and the pictures.
    pub fn page(&self) -> String {
        let flag = if self.full { " --full" } else { "" };
        let mut page = format!(
            "{TITLE}\n\n\
             Written by `plica verify{flag}`, version {}: {}. Errors are relative to the reference, or absolute where\n\
             the tolerance has a ±. Lengths are in D, stresses in E, energies in E·D³ (per length E·D²).\n\
             docs/verification.md describes the references. Unless a row says otherwise a ring has H = 0.06 and\n\
             ν = 0.495. A and B are the radii of the wall at rest, a and b those under load, θη and θζ the growth\n\
             stretches around and along, n the circumferential mode and m the number of axial half waves.\n\n{}",
            env!("CARGO_PKG_VERSION"),
            self.verdict(),
            in_markdown(&self.rows)
        );
        for (name, caption, _) in &self.charts {
            page += &format!("\n![{caption}]({name})\n\n*{caption}*\n");
        }
        page
    }

    /// Returns the file names and bytes of the pictures as PNG.
    ///
    /// # Errors
    /// [`DrawError`] if a chart cannot be drawn.
    pub fn pictures(&self) -> Result<Vec<(String, Vec<u8>)>, DrawError> {
        let picture =
            |(name, _, chart): &(String, String, Chart)| Ok((name.clone(), chart.png(WIDTH)?));
        self.charts.iter().map(picture).collect()
    }
}
