//! Progress of a run: a line per accepted state.

use crate::interrupt::Interrupt;
use crate::ticker::Ticker;
use plica::monitor::Monitor;
use plica::study::{Plan, Row, Stage};
use std::fmt::Display;

/// Shows the states of a run and cancels it when the user asks.
pub struct Progress {
    ticker: Ticker,
    stage_width: usize,
    is_axisymmetric: bool,
    has_pressures: bool,
    others: Vec<Other>,
    has_heading: bool,
}

/// A driven quantity with a column of its own, besides the muscles' ratios and the pressure.
#[derive(Clone, Copy)]
enum Other {
    /// The largest tension of the muscles with active stress.
    Tension,
    /// The shift of the first muscle whose zone travels.
    Shift,
    /// The volume of the lumen.
    Volume,
}

impl Other {
    /// Returns those that the stages of a plan drive.
    fn of(plan: &Plan) -> Vec<Self> {
        let muscles = &plan.tube.muscles;
        let loads = || plan.stages.iter().map(|stage| &stage.load);
        let has_tension = muscles.iter().any(|muscle| !muscle.grows());
        let has_shift = plan.stages.iter().flat_map(Stage::loads);
        let has_shift = has_shift
            .into_iter()
            .any(|load| load.shifts.iter().any(|x| *x != 0.0));
        let has_volume = loads().any(|load| load.lumen_volume.is_some());
        [
            (Self::Tension, has_tension),
            (Self::Shift, has_shift),
            (Self::Volume, has_volume),
        ]
        .into_iter()
        .filter_map(|(other, is_driven)| is_driven.then_some(other))
        .collect()
    }

    /// Returns the heading of its column.
    fn heading(self) -> &'static str {
        match self {
            Self::Tension => "tension",
            Self::Shift => "shift",
            Self::Volume => "volume",
        }
    }

    /// Returns its value at a state.
    fn of_state(self, row: &Row) -> f64 {
        let mut muscles = row.muscles.iter();
        match self {
            Self::Tension => {
                let tensions = muscles.filter(|muscle| muscle.stretch.is_none());
                tensions.map(|muscle| muscle.target).fold(0.0, f64::max)
            }
            Self::Shift => muscles.find_map(|muscle| muscle.shift).unwrap_or(0.0),
            Self::Volume => row.lumen_volume,
        }
    }
}

impl Progress {
    /// Prepares to show a run.
    pub fn new(plan: &Plan, interrupt: Interrupt) -> Self {
        let names = plan.stages.iter().map(|stage| stage.name.chars().count());
        Self {
            ticker: Ticker::new(interrupt),
            stage_width: names.max().unwrap_or(0).clamp(5, 24),
            is_axisymmetric: plan.mesh.rings(plan.symmetry) == 1,
            has_pressures: plan.has_pressures(),
            others: Other::of(plan),
            has_heading: false,
        }
    }

    /// Removes the progress bar; the lines stay.
    pub fn finish(&self) {
        self.ticker.finish();
    }

    /// Shows the line of an accepted state.
    pub fn show(&mut self, row: &Row) {
        let width = self.stage_width;
        let asymmetry_column = |cell: String| {
            if self.is_axisymmetric {
                String::new()
            } else {
                cell
            }
        };
        let pressure_column = |cell: String| {
            if self.has_pressures {
                cell
            } else {
                String::new()
            }
        };
        if !self.has_heading {
            self.has_heading = true;
            self.ticker.line(&format!(
                "{:>5}  {:<width$}  {:>7} {:>7}{} {:>11}  {:<11} {:>6}  {:<11}{} {:>5} {:>8}",
                "state",
                "stage",
                "Lmax/L",
                "Dmin/D",
                pressure_column(format!(" {:>10}", "pressure"))
                    + &cells(&self.others, |other| format!(" {:>10}", other.heading())),
                "W",
                "found by",
                "angle",
                "shape",
                asymmetry_column(format!(" {:>12}", "asymmetry")),
                "iter",
                "seconds"
            ));
        }
        self.ticker.line(&format!(
            "{:>5}  {:<width$}  {:>7.4} {:>7.4}{} {:>11.4e}  {:<11} {:>5.1}°  {:<11}{} {:>5} {:>8.1}",
            row.step,
            row.stage,
            row.length_ratio,
            row.diameter_ratio,
            pressure_column(format!(" {:>10.2e}", pressure(row)))
                + &cells(&self.others, |other| format!(" {:>10.4}", other.of_state(row))),
            row.energy,
            row.method,
            row.max_wall_angle_deg,
            row.shape,
            asymmetry_column(format!(" {:>12}", asymmetry(row))),
            row.iterations,
            row.seconds
        ));
    }
}

impl Monitor for Progress {
    fn working(&mut self, activity: &dyn Display, fraction: f64) {
        self.ticker.working(&activity.to_string(), fraction);
    }

    fn notice(&mut self, message: &str) {
        self.ticker.line(message);
    }

    fn is_cancelled(&self) -> bool {
        self.ticker.stop()
    }
}

/// Joins the cells of further columns.
fn cells(others: &[Other], cell: impl Fn(Other) -> String) -> String {
    others.iter().map(|other| cell(*other)).collect()
}

/// Returns the first pressure of a state that is not zero; 0 if there is none.
fn pressure(row: &Row) -> f64 {
    let pressures = [
        row.outer_pressure,
        row.inner_pressure,
        row.outer_dead_load,
        row.inner_dead_load,
    ];
    let is_not_zero = |p: &f64| *p != 0.0;
    pressures
        .into_iter()
        .flatten()
        .find(is_not_zero)
        .unwrap_or(0.0)
}

/// Describes the asymmetry of a state.
fn asymmetry(row: &Row) -> String {
    match row.asymmetry_mode {
        0 => "0".into(),
        n => format!("{:.1e} n={n}", row.asymmetry),
    }
}
