//! Progress on standard error: lines, a progress bar below them on a terminal, and a check for Ctrl-C.

use crate::console;
use crate::interrupt::Interrupt;
use indicatif::{ProgressBar, ProgressStyle};
use plica::monitor::Monitor;
use std::cell::Cell;
use std::fmt::Display;
use std::time::{Duration, Instant};

/// Ticks of a full bar.
const FULL: u64 = 1000;
/// Longest time without output where there is no bar.
const QUIET: Duration = Duration::from_secs(30);

/// Shows progress and checks for interruption.
pub struct Ticker {
    bar: Option<ProgressBar>,
    interrupt: Interrupt,
    stopping: Cell<bool>,
    last_output: Cell<Instant>,
}

impl Ticker {
    /// Starts the progress bar, if standard error is a terminal.
    pub fn new(interrupt: Interrupt) -> Self {
        Self {
            bar: console::is_terminal().then(bar),
            interrupt,
            stopping: Cell::new(false),
            last_output: Cell::new(Instant::now()),
        }
    }

    /// Removes the bar; the lines stay.
    pub fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }

    /// Prints a line above the bar.
    pub fn line(&self, line: &str) {
        match &self.bar {
            Some(bar) => bar.println(line),
            None => console::message(line),
        }
        self.last_output.set(Instant::now());
    }

    /// Shows the current task and the completed fraction (0 to 1) of the whole work.
    pub fn working(&self, what: &str, fraction: f64) {
        match &self.bar {
            Some(bar) => {
                bar.set_position((fraction.clamp(0.0, 1.0) * FULL as f64) as u64);
                bar.set_message(what.to_owned());
            }
            None if self.last_output.get().elapsed() > QUIET => {
                self.line(&format!("{:>4.0} %  {what}", 100.0 * fraction));
            }
            None => {}
        }
    }

    /// Returns whether the user has asked to stop.
    pub fn stop(&self) -> bool {
        if self.interrupt.is_requested() && !self.stopping.replace(true) {
            self.line("stopping; press Ctrl-C again to stop at once");
        }
        self.stopping.get()
    }
}

impl Monitor for Ticker {
    fn working(&mut self, activity: &dyn Display, fraction: f64) {
        Self::working(self, &activity.to_string(), fraction);
    }

    fn notice(&mut self, message: &str) {
        self.line(message);
    }

    fn is_cancelled(&self) -> bool {
        self.stop()
    }
}

fn bar() -> ProgressBar {
    let bar = ProgressBar::new(FULL);
    let style = ProgressStyle::with_template("{bar:30} {percent:>3} %  {elapsed}  {wide_msg}");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar.enable_steady_tick(Duration::from_millis(500));
    bar
}
