//! A study in memory.

use super::case::read_checked;
use super::monitor::compute;
use super::state::{State, Tube};
use plica::study::{self, Row, StudyError};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::Arc;

/// A tube that is followed through the stages of a case.
#[pyclass(module = "plica._native")]
pub struct Study {
    study: study::Study,
    tube: Arc<Tube>,
    threads: Option<usize>,
    report: Option<Py<PyAny>>,
    last_row: Option<Row>,
}

#[pymethods]
impl Study {
    #[new]
    #[pyo3(signature = (text, name, folder, threads=None, report=None))]
    fn new(
        py: Python<'_>,
        text: &str,
        name: &str,
        folder: PathBuf,
        threads: Option<usize>,
        report: Option<Py<PyAny>>,
    ) -> PyResult<Self> {
        let plan = read_checked(text, name, &folder)?;
        let study = compute(py, threads, None, |_| study::Study::new(&plan))?;
        Ok(Self {
            study: study.map_err(|error| PyRuntimeError::new_err(error.to_string()))?,
            tube: Arc::new(Tube::of(plan)),
            threads,
            report,
            last_row: None,
        })
    }

    /// Follows the tube through other stages from its last state on: those of a case with the same tube.
    fn extend(&mut self, py: Python<'_>, text: &str, name: &str, folder: PathBuf) -> PyResult<()> {
        let plan = read_checked(text, name, &folder)?;
        let ended = || PyRuntimeError::new_err("the study has ended early");
        let from = self.study.continuation().ok_or_else(ended)?;
        let resumed = compute(py, self.threads, None, |_| {
            study::Study::resume(&plan, from)
        })?;
        self.study = resumed.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        self.tube = Arc::new(Tube::of(plan));
        Ok(())
    }

    fn __iter__(slf: PyRef<'_, Self>) -> PyRef<'_, Self> {
        slf
    }

    /// Computes the next state; none after the last.
    fn __next__(&mut self, py: Python<'_>) -> PyResult<Option<State>> {
        let (study, report) = (&mut self.study, self.report.as_ref());
        let found = compute(py, self.threads, report, |monitor| {
            study.next_state(monitor)
        })?;
        let state = match found {
            None => return Ok(None),
            Some(Err(StudyError::Lost(lost))) => {
                return Err(PyRuntimeError::new_err(lost.to_string()));
            }
            Some(Err(error)) => return Err(PyRuntimeError::new_err(error.to_string())),
            Some(Ok(state)) => state,
        };
        let scale = &self.tube.scale;
        let has_pressures = self.tube.plan.has_pressures();
        let row = Row::new(&state, scale, has_pressures, self.last_row.as_ref());
        let state = State::new(&self.tube, state.load.clone(), state.unknowns, &row);
        self.last_row = Some(row);
        Ok(Some(state))
    }
}
