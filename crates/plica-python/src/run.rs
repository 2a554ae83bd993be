//! Run directories.

use super::case::read_checked;
use super::monitor::compute;
use super::state::{State, Tube, bytes};
use plica::case::{self, Input, InputFile};
use plica::monitor::Monitor;
use plica::run_directory::{self, RunDirectory, RunError};
use plica::saved_state::SavedState;
use plica::study::{Findings, Plan, Row, Scale, forbidden_changes};
use pyo3::exceptions::{PyFileExistsError, PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Runs a case in a directory, or resumes a run there. Returns the verdict and the closing table.
#[pyfunction]
#[pyo3(signature = (text, name, folder, out, overwrite=false, resume=false, threads=None, report=None))]
#[expect(clippy::too_many_arguments, reason = "keywords in Python")]
pub fn run(
    py: Python<'_>,
    text: &str,
    name: &str,
    folder: PathBuf,
    out: PathBuf,
    overwrite: bool,
    resume: bool,
    threads: Option<usize>,
    report: Option<Py<PyAny>>,
) -> PyResult<(String, String)> {
    let plan = read_checked(text, name, &folder)?;
    compute(py, threads, report.as_ref(), |monitor| {
        follow(&plan, text, &out, [overwrite, resume], monitor)
    })?
}

/// Follows a run to its end.
fn follow(
    plan: &Plan,
    text: &str,
    out: &Path,
    [overwrite, resume]: [bool; 2],
    monitor: &mut dyn Monitor,
) -> PyResult<(String, String)> {
    let resumes = resume && RunDirectory::exists(out);
    let mut directory = match resumes {
        true => to_resume(plan, text, out)?,
        false => RunDirectory::create(out, text, &plan.title, overwrite).map_err(error_of)?,
    };
    if resumes && directory.is_complete() && directory.stopped_at().is_none() {
        return Ok((directory.verdict().to_string(), String::new()));
    }
    let mut run = match resumes {
        true => run_directory::Run::resume(plan, &mut directory, monitor).map_err(error_of)?,
        false => run_directory::Run::begin(plan, &mut directory).map_err(error_of)?,
    };
    while run.next_row(monitor).map_err(error_of)?.is_some() {}
    let table = run.finish().map_err(error_of)?.to_string();
    Ok((directory.verdict().to_string(), table))
}

/// Opens a run to resume it with a case that may differ in what is still ahead.
fn to_resume(plan: &Plan, text: &str, out: &Path) -> PyResult<RunDirectory> {
    let mut directory = RunDirectory::open(out).map_err(error_of)?;
    directory.lock().map_err(error_of)?;
    if !directory.has_hardly_begun() {
        let old = plan_of(&directory)?;
        let checkpoint = directory.checkpoint(&old).map_err(error_of)?.checkpoint;
        let reached = checkpoint.path.reached;
        let changes = forbidden_changes(&old, plan, checkpoint.stage.map(|stage| (stage, reached)));
        if !changes.is_empty() {
            return Err(PyValueError::new_err(format!(
                "{}: the run was begun with another case; this one must not change {}",
                out.display(),
                changes.join(", ")
            )));
        }
    }
    let before = directory.read("case.toml").unwrap_or_default();
    if before != text.as_bytes() {
        directory.write_case(text, &plan.title).map_err(error_of)?;
    }
    Ok(directory)
}

/// Returns the plan of a run directory, with the start state and the modes that it keeps.
fn plan_of(directory: &RunDirectory) -> PyResult<Plan> {
    let text = directory.read("case.toml").unwrap_or_default();
    let text = String::from_utf8_lossy(&text);
    let manifest = directory.manifest();
    let title = manifest["title"].as_str().unwrap_or("case");
    let open = |wanted: InputFile<'_>| {
        let path = match wanted {
            // Older run directories have only their first state.
            InputFile::State(_) if !directory.start().exists() => {
                directory.path().join(RunDirectory::name_of_state(0))
            }
            InputFile::State(_) => directory.start(),
            InputFile::Mode(number, _) => directory.imperfection(number),
            InputFile::Materials(number, _) => directory.materials(number),
        };
        Input::read(wanted, &path)
    };
    case::read_with(&text, title, &open).map_err(|error| PyValueError::new_err(error.to_string()))
}

/// Returns the exception for an error of a run.
fn error_of(error: RunError) -> PyErr {
    let text = error.to_string();
    match error {
        RunError::Occupied(_) => PyFileExistsError::new_err(text),
        _ if error.is_about_files() => PyOSError::new_err(text),
        _ => PyRuntimeError::new_err(text),
    }
}

/// An existing run.
#[pyclass(frozen, module = "plica._native")]
pub struct Run {
    directory: RunDirectory,
    tube: Arc<Tube>,
    rows: Vec<Row>,
    faults: Vec<String>,
}

#[pymethods]
impl Run {
    #[new]
    fn open(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        py.detach(|| {
            let directory = RunDirectory::open(&path).map_err(error_of)?;
            let plan = plan_of(&directory)?;
            let history = directory.checked_history().map_err(error_of)?;
            let faults = history.faults.iter().map(ToString::to_string);
            let faults = faults.chain(history.unreadable.clone()).collect();
            Ok(Self {
                tube: Arc::new(Tube::of(plan)),
                rows: history.rows,
                directory,
                faults,
            })
        })
    }

    /// The title.
    #[getter]
    fn title(&self) -> &str {
        &self.tube.plan.title
    }

    /// The verdict.
    #[getter]
    fn verdict(&self) -> String {
        self.directory.verdict().to_string()
    }

    /// The damages of its files, in words.
    #[getter]
    fn faults(&self) -> Vec<String> {
        self.faults.clone()
    }

    /// The text of the case.
    #[getter]
    fn case_text(&self) -> String {
        let text = self.directory.read("case.toml").unwrap_or_default();
        String::from_utf8_lossy(&text).into_owned()
    }

    /// The numbers of the saved states.
    #[getter]
    fn state_numbers(&self) -> PyResult<Vec<usize>> {
        self.directory.state_numbers().map_err(error_of)
    }

    /// The columns of the history: name, unit, and texts or bytes of float64.
    fn columns<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let columns = PyDict::new(py);
        let tables: Vec<_> = self.rows.iter().map(Row::cells).collect();
        for (i, cell) in tables.first().into_iter().flatten().enumerate() {
            let cells = tables.iter().filter_map(|cells| cells.get(i));
            let unit = self.tube.scale.unit(cell.quantity);
            let numbers: Option<Vec<f64>> = cells.clone().map(|cell| cell.number()).collect();
            match numbers {
                Some(numbers) => {
                    columns.set_item(&cell.name, (unit, bytes(py, &numbers)))?;
                }
                None => {
                    let texts: Vec<&str> = cells.map(|cell| cell.text.as_str()).collect();
                    columns.set_item(&cell.name, (unit, texts))?;
                }
            }
        }
        Ok(columns)
    }

    /// The findings, as JSON, and the lines of the table.
    fn findings(&self) -> (String, Vec<(String, String)>) {
        let scale = Scale::of(self.tube.plan.units.as_ref());
        let findings = Findings::of(&self.rows, &scale, self.tube.plan.symmetry);
        let lines = findings.lines().into_iter();
        let lines = lines.map(|(name, value)| (name.to_string(), value.to_string()));
        let json = serde_json::to_string(&findings).unwrap_or_default();
        (json, lines.collect())
    }

    /// Reads a saved state.
    fn state(&self, number: usize) -> PyResult<State> {
        let path = self
            .directory
            .path()
            .join(RunDirectory::name_of_state(number));
        let failed = |why: String| PyOSError::new_err(format!("{}: {why}", path.display()));
        let state = SavedState::read(&path).map_err(|error| failed(error.to_string()))?;
        let accepted = self.tube.plan.accepts(&state);
        accepted.map_err(|error| failed(error.to_string()))?;
        let row = self.rows.iter().find(|row| row.step == number);
        let row = row.ok_or_else(|| failed("history.csv has no such state".into()))?;
        Ok(State::new(&self.tube, state.load, state.u, row))
    }

    /// The bytes of a file of the run; none if there is none.
    fn file<'py>(&self, py: Python<'py>, name: &str) -> Option<Bound<'py, PyBytes>> {
        Some(PyBytes::new(py, &self.directory.read(name)?))
    }
}
