//! A monitor that reports progress to Python and notices Ctrl-C.

use plica::monitor::Monitor;
use pyo3::prelude::*;
use std::cell::{Cell, RefCell};
use std::fmt::Display;
use std::time::{Duration, Instant};

/// Time between two looks at Python's signals, and between two reports.
const INTERVAL: Duration = Duration::from_millis(100);

/// Reports to a function of (activity, fraction), and asks Python for signals, without holding the interpreter in between.
pub struct PythonMonitor {
    report: Option<Py<PyAny>>,
    last_look: Cell<Instant>,
    last_report: Instant,
    is_cancelled: Cell<bool>,
    error: RefCell<Option<PyErr>>,
}

impl PythonMonitor {
    /// Makes a monitor that reports to a function, if there is one.
    pub fn new(report: Option<Py<PyAny>>) -> Self {
        let now = Instant::now();
        Self {
            report,
            last_look: Cell::new(now),
            last_report: now,
            is_cancelled: Cell::new(false),
            error: RefCell::new(None),
        }
    }

    /// Returns the error of a signal handler or of the function, which has cancelled the computation.
    pub fn into_error(self) -> Option<PyErr> {
        self.error.into_inner()
    }

    fn cancel(&self, error: PyErr) {
        self.is_cancelled.set(true);
        self.error.borrow_mut().get_or_insert(error);
    }
}

impl Monitor for PythonMonitor {
    fn working(&mut self, activity: &dyn Display, fraction: f64) {
        let Some(report) = &self.report else { return };
        if self.last_report.elapsed() < INTERVAL || self.is_cancelled.get() {
            return;
        }
        self.last_report = Instant::now();
        let text = activity.to_string();
        if let Err(error) = Python::attach(|py| report.call1(py, (text, fraction))) {
            self.cancel(error);
        }
    }

    fn is_cancelled(&self) -> bool {
        if !self.is_cancelled.get() && self.last_look.get().elapsed() >= INTERVAL {
            self.last_look.set(Instant::now());
            if let Err(error) = Python::attach(|py| py.check_signals()) {
                self.cancel(error);
            }
        }
        self.is_cancelled.get()
    }
}

/// Runs a computation on a number of threads without the interpreter. A pool of its own stays usable after a fork.
pub fn on_threads<T: Send>(
    py: Python<'_>,
    threads: Option<usize>,
    compute: impl FnOnce() -> T + Send,
) -> PyResult<T> {
    let available = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = threads.unwrap_or(available).clamp(1, available);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|error| {
        pyo3::exceptions::PyRuntimeError::new_err(format!("cannot start threads: {error}"))
    })?;
    Ok(py.detach(|| pool.install(compute)))
}
