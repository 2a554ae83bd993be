//! Computations without the interpreter, which report to Python and end at Ctrl-C.

use plica::monitor::Monitor;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use std::fmt::Display;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Time between two looks at Python's signals, and between two reports.
const INTERVAL: Duration = Duration::from_millis(100);

/// Reports to a function of (activity, fraction), and is cancelled by a flag.
struct PythonMonitor<'a> {
    report: Option<&'a Py<PyAny>>,
    last_report: Instant,
    is_cancelled: &'a AtomicBool,
    error: Option<PyErr>,
}

impl Monitor for PythonMonitor<'_> {
    fn working(&mut self, activity: &dyn Display, fraction: f64) {
        let Some(report) = self.report else { return };
        if self.last_report.elapsed() < INTERVAL || self.is_cancelled() {
            return;
        }
        self.last_report = Instant::now();
        let text = activity.to_string();
        if let Err(error) = Python::attach(|py| report.call1(py, (text, fraction))) {
            self.is_cancelled.store(true, Ordering::Relaxed);
            self.error.get_or_insert(error);
        }
    }

    fn is_cancelled(&self) -> bool {
        self.is_cancelled.load(Ordering::Relaxed)
    }
}

/// Computes on a number of threads without the interpreter, and cancels at a signal. A pool of its own stays usable after a
/// fork.
///
/// # Errors
/// The error of a signal handler, such as KeyboardInterrupt, or of the function that receives reports; if threads cannot be
/// started.
pub fn compute<T: Send>(
    py: Python<'_>,
    threads: Option<usize>,
    report: Option<&Py<PyAny>>,
    computation: impl FnOnce(&mut dyn Monitor) -> T + Send,
) -> PyResult<T> {
    let available = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = threads.unwrap_or(available).clamp(1, available);
    let failed = |why: &dyn Display| PyRuntimeError::new_err(format!("cannot compute: {why}"));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|error| failed(&error))?;
    let is_cancelled = AtomicBool::new(false);
    let caller = std::thread::current();
    let (found, reported, signalled) = std::thread::scope(|scope| {
        let worker = scope.spawn(|| {
            let mut monitor = PythonMonitor {
                report,
                last_report: Instant::now(),
                is_cancelled: &is_cancelled,
                error: None,
            };
            let found = pool.install(|| computation(&mut monitor));
            caller.unpark();
            (found, monitor.error)
        });
        // Python handles signals in the thread that called.
        let mut signalled = None;
        while !worker.is_finished() {
            py.detach(|| std::thread::park_timeout(INTERVAL));
            if let Err(error) = py.check_signals() {
                is_cancelled.store(true, Ordering::Relaxed);
                signalled.get_or_insert(error);
            }
        }
        match worker.join() {
            Ok((found, reported)) => (Some(found), reported, signalled),
            Err(_) => (None, None, signalled),
        }
    });
    match (signalled.or(reported), found) {
        (Some(error), _) => Err(error),
        (None, Some(found)) => Ok(found),
        (None, None) => Err(failed(&"an internal error, please report it")),
    }
}
