//! Computations without the interpreter, which report to Python and end at Ctrl-C.

use plica::monitor::Monitor;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use std::fmt::Display;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
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

/// Variable that limits threads; joblib, Dask and batch systems set it in their workers.
const THREADS: &str = "OMP_NUM_THREADS";

/// Returns the number of threads to use: as many as asked for, or else as [`THREADS`] says, but at most one per processor that
/// this process may use.
fn threads(wanted: Option<usize>) -> usize {
    let available = std::thread::available_parallelism().map_or(1, usize::from);
    let limit = || std::env::var(THREADS).ok()?.parse().ok();
    wanted
        .or_else(limit)
        .unwrap_or(available)
        .clamp(1, available)
}

/// Computes on a number of threads without the interpreter, and cancels at a signal. The threads end with the computation, so
/// that a process may fork afterwards.
///
/// # Errors
/// The error of a signal handler, such as KeyboardInterrupt, or of the function that receives reports; if threads cannot be
/// started.
pub fn compute<T: Send>(
    py: Python<'_>,
    wanted: Option<usize>,
    report: Option<&Py<PyAny>>,
    computation: impl FnOnce(&mut (dyn Monitor + Send)) -> T + Send,
) -> PyResult<T> {
    let failed = |why: &dyn Display| PyRuntimeError::new_err(format!("cannot compute: {why}"));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads(wanted));
    let pool = &pool.build().map_err(|error| failed(&error))?;
    let is_cancelled = &AtomicBool::new(false);
    let (sender, mut receiver) = mpsc::channel();
    let (found, signalled) = std::thread::scope(|scope| {
        scope.spawn(move || {
            let mut monitor = PythonMonitor {
                report,
                last_report: Instant::now(),
                is_cancelled,
                error: None,
            };
            // After a panic nothing is sent.
            let found = catch_unwind(AssertUnwindSafe(|| {
                pool.install(|| computation(&mut monitor))
            }));
            if let Ok(found) = found {
                // The receiver waits.
                let _ = sender.send((found, monitor.error));
            }
        });
        // Python handles signals in the thread that called.
        let mut signalled = None;
        loop {
            let received;
            (receiver, received) = py.detach(move || {
                let received = receiver.recv_timeout(INTERVAL);
                (receiver, received)
            });
            match received {
                Ok(found) => return (Some(found), signalled),
                Err(RecvTimeoutError::Disconnected) => return (None, signalled),
                Err(RecvTimeoutError::Timeout) => {}
            }
            if let Err(error) = py.check_signals() {
                is_cancelled.store(true, Ordering::Relaxed);
                signalled.get_or_insert(error);
            }
        }
    });
    match (signalled, found) {
        (Some(error), _) | (None, Some((_, Some(error)))) => Err(error),
        (None, Some((found, None))) => Ok(found),
        (None, None) => Err(failed(&"an internal error, please report it")),
    }
}
