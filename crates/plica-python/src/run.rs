//! Run directories.

use super::case::read_checked;
use super::mode::Mode;
use super::monitor::compute;
use super::state::{State, Tube, bytes};
use plica::case::{self, Input, InputFile};
use plica::monitor::Monitor;
use plica::run_directory::{self, RunDirectory, RunError};
use plica::saved_state::SavedState;
use plica::study::{Ending, Findings, Plan, Row, Scale, forbidden_changes};
use plica_view::report::{
    Appearance, Excerpt, Field, FieldScales, Shown, animate, pictures, render,
};
use pyo3::exceptions::{PyFileExistsError, PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use rayon::prelude::*;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// Runs a case in a directory, or resumes a run there. Returns the reason if the tube could not be followed to
/// the end.
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
) -> PyResult<Option<String>> {
    let plan = read_checked(text, name, &folder)?;
    compute(py, threads, report.as_ref(), |monitor| {
        follow(&plan, text, &out, [overwrite, resume], monitor)
    })?
}

/// Follows a run to its end; returns the reason if it is lost.
fn follow(
    plan: &Plan,
    text: &str,
    out: &Path,
    [overwrite, resume]: [bool; 2],
    monitor: &mut dyn Monitor,
) -> PyResult<Option<String>> {
    let resumes = resume && RunDirectory::exists(out);
    let mut directory = match resumes {
        true => to_resume(plan, text, out)?,
        false => RunDirectory::create(out, text, &plan.title, overwrite).map_err(error_of)?,
    };
    if resumes && directory.is_complete() && directory.stopped_at().is_none() {
        return Ok(None);
    }
    let mut run = match resumes {
        true => run_directory::Run::resume(plan, &mut directory, monitor).map_err(error_of)?,
        false => run_directory::Run::begin(plan, &mut directory).map_err(error_of)?,
    };
    while run.next_row(monitor).map_err(error_of)?.is_some() {}
    let summary = run.finish().map_err(error_of)?;
    // As the program does: pictures need states that closing removes, and a run without pictures is complete too.
    if plan.output.pictures
        && let Ok(pictures) = pictures(plan, &summary)
    {
        for (name, picture) in &pictures {
            directory.write(name, picture).map_err(error_of)?;
        }
    }
    match summary.ending() {
        Ending::Complete => directory.close().map_err(error_of)?,
        Ending::Stopped => {}
        Ending::Lost(lost) => return Ok(Some(lost.to_string())),
    }
    Ok(None)
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
pub fn plan_of(directory: &RunDirectory) -> PyResult<Plan> {
    let text = directory.read("case.toml").unwrap_or_default();
    let text = String::from_utf8_lossy(&text);
    let manifest = directory.manifest();
    let title = manifest["title"].as_str().unwrap_or("case");
    let open = |wanted: InputFile<'_>| Input::kept(wanted, directory);
    case::read_with(&text, title, &open).map_err(|error| PyValueError::new_err(error.to_string()))
}

/// Returns the exception for an error of a run.
pub fn error_of(error: RunError) -> PyErr {
    let text = error.to_string();
    match error {
        RunError::Occupied(_) => {
            let help = "overwrite=True replaces it, resume=True resumes it";
            PyFileExistsError::new_err(format!("{text}; {help}"))
        }
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

    /// Number of control rings of the cyclic sector; one for an axisymmetric run.
    #[getter]
    fn rings(&self) -> usize {
        self.tube.plan.layout().shape()[3]
    }

    /// Radii of the inner and the outer wall at rest, the length at rest, and the name of the unit of length.
    #[getter]
    fn size(&self) -> (f64, f64, f64, String) {
        self.tube.size()
    }

    /// True if the wall can touch itself.
    #[getter]
    fn has_contact(&self) -> bool {
        self.tube.exporter.tube().has_contact()
    }

    /// Unit of stress.
    #[getter]
    fn stress_unit(&self) -> String {
        self.tube.scale.stress_name.clone()
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
                    columns.set_item(&cell.name, (unit, bytes(py, &numbers)?))?;
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
        let (state, row) = self.shown(number)?;
        Ok(State::new(&self.tube, state.load, state.u, &row))
    }

    /// Reads a mode of the stability analysis.
    fn mode(&self, name: &str) -> PyResult<Mode> {
        Mode::read(&self.tube, &self.directory.path().join(name))
    }

    /// The part of the path that the pictures of the program show: label of the abscissa, numbers and abscissae of states, and
    /// the numbers of the states that are drawn.
    fn excerpt(&self) -> (String, Vec<(usize, f64)>, Vec<usize>) {
        let scale = &self.tube.scale;
        let findings = Findings::of(&self.rows, scale, self.tube.plan.symmetry);
        let excerpt = Excerpt::of(&self.rows, &findings, scale);
        excerpt.map_or_else(Default::default, |e| (e.label, e.states, e.chosen))
    }

    /// Names of the fields that colour pictures.
    #[getter]
    fn picture_fields(&self) -> Vec<&'static str> {
        let fields = Field::of_plan(&self.tube.plan).into_iter();
        fields.map(|field| field.name()).collect()
    }

    /// Draws states cut open, one below the other, as PNG.
    fn render<'py>(
        &self,
        py: Python<'py>,
        numbers: Vec<usize>,
        look: Look,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let look = self.appearance(&look)?;
        let states: PyResult<Vec<Shown>> = numbers.iter().map(|&n| self.shown(n)).collect();
        let (states, saved) = (states?, self.saved()?);
        let plan = &self.tube.plan;
        let drawn = compute(py, None, None, |_| {
            let path = FieldScales::of_states(plan, saved.par_iter().map(|(state, _)| state));
            render(plan, &states, &path, &look)
        })?;
        let png = drawn.map_err(|error| PyValueError::new_err(error.to_string()))?;
        Ok(PyBytes::new(py, &png))
    }

    /// Draws all saved states as an animated PNG, each shown for some seconds.
    #[pyo3(signature = (look, seconds, report=None))]
    fn animate<'py>(
        &self,
        py: Python<'py>,
        look: Look,
        seconds: f64,
        report: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let look = self.appearance(&look)?;
        let (states, plan) = (self.saved()?, &self.tube.plan);
        let drawn = compute(py, None, report.as_ref(), |monitor| {
            let path = FieldScales::of_states(plan, states.par_iter().map(|(state, _)| state));
            let monitor = Mutex::new(monitor);
            let proceed = |done: usize| {
                let mut monitor = monitor.lock().unwrap_or_else(PoisonError::into_inner);
                monitor.working(&"drawing", done as f64 / states.len() as f64);
                !monitor.is_cancelled()
            };
            animate(plan, &states, &self.rows, &path, &look, seconds, &proceed)
        })?;
        let drawn = drawn.map_err(|error| PyValueError::new_err(error.to_string()))?;
        Ok(PyBytes::new(py, &drawn.unwrap_or_default()))
    }

    /// The bytes of a file of the run; none if there is none.
    fn file<'py>(&self, py: Python<'py>, name: &str) -> Option<Bound<'py, PyBytes>> {
        Some(PyBytes::new(py, &self.directory.read(name)?))
    }
}

/// Appearance of a picture: name of the field, angle of the wall that is removed in degrees, whether that is translucent, direction
/// towards the viewer (up, to the front, along the tube), and width in pixels.
type Look = (String, f64, bool, [f64; 3], usize);

impl Run {
    /// Reads a saved state with its row.
    fn shown(&self, number: usize) -> PyResult<Shown> {
        let name = RunDirectory::name_of_state(number);
        let path = self.directory.path().join(name);
        let failed = |why: String| PyOSError::new_err(format!("{}: {why}", path.display()));
        let state = SavedState::read(&path).map_err(|error| failed(error.to_string()))?;
        let accepted = self.tube.plan.accepts(&state);
        accepted.map_err(|error| failed(error.to_string()))?;
        let row = self.rows.iter().find(|row| row.step == number);
        let row = row.ok_or_else(|| failed("history.csv has no such state".into()))?;
        Ok((state, row.clone()))
    }

    /// Reads all saved states.
    fn saved(&self) -> PyResult<Vec<Shown>> {
        let numbers = self.state_numbers()?;
        numbers
            .into_iter()
            .map(|number| self.shown(number))
            .collect()
    }

    /// Returns the appearance of a picture.
    fn appearance(
        &self,
        (name, cutaway, see_through, toward, width): &Look,
    ) -> PyResult<Appearance> {
        let fields = Field::of_plan(&self.tube.plan);
        let field = fields.iter().find(|field| field.name() == name);
        let field = field.copied().ok_or_else(|| {
            let known = self.picture_fields().join(", ");
            PyValueError::new_err(format!("there is no field {name}; there are {known}"))
        })?;
        Ok(Appearance {
            field,
            cutaway: *cutaway,
            see_through: *see_through,
            toward: *toward,
            width: *width,
            ..Appearance::default()
        })
    }
}
