//! A run as it goes on: a line per accepted state, and a bar under them on a terminal.

use crate::console;
use crate::interrupt::Interrupt;
use indicatif::{ProgressBar, ProgressStyle};
use plica::study::{Observer, Plan, Row};
use std::time::{Duration, Instant};

/// Ticks of a full bar.
const FULL: u64 = 1000;
/// Without a bar, a sign of life is given this often.
const QUIET: Duration = Duration::from_secs(30);

/// Shows a run, and stops it when someone asks.
pub struct Progress {
    bar: Option<ProgressBar>,
    interrupt: Interrupt,
    stopping: bool,
    stage_width: usize,
    begun: bool,
    last_sign: Instant,
}

impl Progress {
    /// Before the first state.
    pub fn new(plan: &Plan, interrupt: Interrupt) -> Self {
        let names = plan.stages.iter().map(|stage| stage.name.chars().count());
        Self {
            bar: console::is_watched().then(bar),
            interrupt,
            stopping: false,
            stage_width: names.max().unwrap_or(0).clamp(5, 24),
            begun: false,
            last_sign: Instant::now(),
        }
    }

    /// After the last state: the bar goes, the lines stay.
    pub fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }

    fn line(&mut self, line: &str) {
        match &self.bar {
            Some(bar) => bar.println(line),
            None => console::tell(line),
        }
        self.last_sign = Instant::now();
    }
}

impl Observer for Progress {
    fn accepted(&mut self, row: &Row) {
        let width = self.stage_width;
        if !self.begun {
            self.begun = true;
            self.line(&format!(
                "{:>5}  {:<width$}  {:>7} {:>7} {:>11}  {:<11} {:>6}  {:<11} {:>5} {:>8}",
                "state",
                "stage",
                "Lmax/L",
                "Dmin/D",
                "W",
                "found by",
                "angle",
                "shape",
                "iter",
                "seconds"
            ));
        }
        self.line(&format!(
            "{:>5}  {:<width$}  {:>7.4} {:>7.4} {:>11.4e}  {:<11} {:>5.1}°  {:<11} {:>5} {:>8.1}",
            row.step,
            row.stage,
            row.length_ratio,
            row.diameter_ratio,
            row.energy,
            row.method,
            row.max_wall_angle_deg,
            row.shape,
            row.iterations,
            row.seconds
        ));
    }

    fn working(&mut self, what: &str, fraction: f64) {
        match &self.bar {
            Some(bar) => {
                bar.set_position((fraction.clamp(0.0, 1.0) * FULL as f64) as u64);
                bar.set_message(what.to_owned());
            }
            None if self.last_sign.elapsed() > QUIET => {
                self.line(&format!("{:>4.0} %  {what}", 100.0 * fraction));
            }
            None => {}
        }
    }

    fn stop(&mut self) -> bool {
        if self.interrupt.asked() && !self.stopping {
            self.stopping = true;
            self.line("stopping; once more ends it at once");
        }
        self.stopping
    }
}

fn bar() -> ProgressBar {
    let bar = ProgressBar::new(FULL);
    let style = ProgressStyle::with_template("{bar:30} {percent:>3} %  {elapsed}  {wide_msg}");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar.enable_steady_tick(Duration::from_millis(500));
    bar
}
