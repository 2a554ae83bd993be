//! A run as it goes on: a line per accepted state.

use crate::interrupt::Interrupt;
use crate::ticker::Ticker;
use plica::study::{Observer, Plan, Row};

/// Shows a run, and stops it when someone asks.
pub struct Progress {
    ticker: Ticker,
    stage_width: usize,
    round: bool,
    pressed: bool,
    begun: bool,
}

impl Progress {
    /// Before the first state.
    pub fn new(plan: &Plan, interrupt: Interrupt) -> Self {
        let names = plan.stages.iter().map(|stage| stage.name.chars().count());
        Self {
            ticker: Ticker::new(interrupt),
            stage_width: names.max().unwrap_or(0).clamp(5, 24),
            round: plan.mesh.rings(plan.symmetry) == 1,
            pressed: plan.is_pressed(),
            begun: false,
        }
    }

    /// After the last state: the bar goes, the lines stay.
    pub fn finish(&self) {
        self.ticker.finish();
    }
}

impl Observer for Progress {
    fn accepted(&mut self, row: &Row) {
        let width = self.stage_width;
        // What only a tube that may leave axisymmetry has to tell.
        let departs = |what: String| if self.round { String::new() } else { what };
        let pressed = |what: String| if self.pressed { what } else { String::new() };
        if !self.begun {
            self.begun = true;
            self.ticker.line(&format!(
                "{:>5}  {:<width$}  {:>7} {:>7}{} {:>11}  {:<11} {:>6}  {:<11}{} {:>5} {:>8}",
                "state",
                "stage",
                "Lmax/L",
                "Dmin/D",
                pressed(format!(" {:>10}", "pressure")),
                "W",
                "found by",
                "angle",
                "shape",
                departs(format!(" {:>12}", "departs")),
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
            pressed(format!(" {:>10.2e}", pressure(row))),
            row.energy,
            row.method,
            row.max_wall_angle_deg,
            row.shape,
            departs(format!(" {:>12}", asymmetry(row))),
            row.iterations,
            row.seconds
        ));
    }

    fn noticed(&mut self, what: &str) {
        self.ticker.line(what);
    }

    fn working(&mut self, what: &str, fraction: f64) {
        self.ticker.working(what, fraction);
    }

    fn stop(&mut self) -> bool {
        self.ticker.stop()
    }
}

/// The first of the pressures that a state is under, if there is any.
fn pressure(row: &Row) -> f64 {
    let pressures = [
        row.outer_pressure,
        row.inner_pressure,
        row.outer_dead_load,
        row.inner_dead_load,
    ];
    let under = |p: &f64| *p != 0.0;
    pressures.into_iter().flatten().find(under).unwrap_or(0.0)
}

/// How far a state is from axisymmetric, and in which harmonic.
fn asymmetry(row: &Row) -> String {
    match row.asymmetry_mode {
        0 => "0".into(),
        n => format!("{:.1e} n={n}", row.asymmetry),
    }
}
