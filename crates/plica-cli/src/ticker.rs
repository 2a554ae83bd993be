//! Signs of life: lines, a bar under them on a terminal, and an ear for Ctrl-C.

use crate::console;
use crate::interrupt::Interrupt;
use indicatif::{ProgressBar, ProgressStyle};
use plica::monitor::Monitor;
use std::cell::Cell;
use std::fmt::Display;
use std::time::{Duration, Instant};

/// Ticks of a full bar.
const FULL: u64 = 1000;
/// Without a bar, a sign of life is given this often.
const QUIET: Duration = Duration::from_secs(30);

/// Shows what goes on, and hears when someone asks to stop.
pub struct Ticker {
    bar: Option<ProgressBar>,
    interrupt: Interrupt,
    stopping: Cell<bool>,
    last_sign: Instant,
}

impl Ticker {
    /// At the beginning.
    pub fn new(interrupt: Interrupt) -> Self {
        Self {
            bar: console::is_watched().then(bar),
            interrupt,
            stopping: Cell::new(false),
            last_sign: Instant::now(),
        }
    }

    /// In the end: the bar goes, the lines stay.
    pub fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }

    /// A line that stays.
    pub fn line(&mut self, line: &str) {
        self.print(line);
        self.last_sign = Instant::now();
    }

    /// What takes time, and how far it all is (0 to 1).
    pub fn working(&mut self, what: &str, fraction: f64) {
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

    /// Whether someone asked to stop.
    pub fn stop(&self) -> bool {
        if self.interrupt.asked() && !self.stopping.replace(true) {
            self.print("stopping; once more ends it at once");
        }
        self.stopping.get()
    }

    fn print(&self, line: &str) {
        match &self.bar {
            Some(bar) => bar.println(line),
            None => console::tell(line),
        }
    }
}

impl Monitor for Ticker {
    fn working(&mut self, activity: &dyn Display, fraction: f64) {
        self.working(&activity.to_string(), fraction);
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
