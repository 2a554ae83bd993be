//! The stability analysis of a run.

use super::monitor::compute;
use super::run::{error_of, plan_of};
use plica::monitor::Monitor;
use plica::run_directory::RunDirectory;
use plica::stability::{CriticalLoads, LowestModes, StabilityError};
use plica_view::report::{mode_pictures, stability_pictures};
use pyo3::exceptions::{PyKeyboardInterrupt, PyOSError, PyValueError};
use pyo3::prelude::*;
use std::path::{Path, PathBuf};

/// Tests the stability of the saved states of a run as `plica stability` does, and writes its files. Returns the table that the
/// program prints, and the names of the files of modes.
///
/// An axisymmetric run is tested against circumferential modes 0 to `highest`; of a three-dimensional one the lowest `modes` modes
/// of `states`, or of all, are computed.
#[pyfunction]
#[pyo3(signature = (path, highest, tolerance, modes, states, threads=None, report=None))]
#[expect(clippy::too_many_arguments, reason = "keywords in Python")]
pub fn stability(
    py: Python<'_>,
    path: PathBuf,
    highest: Option<usize>,
    tolerance: Option<f64>,
    modes: Option<usize>,
    states: Vec<usize>,
    threads: Option<usize>,
    report: Option<Py<PyAny>>,
) -> PyResult<(String, Vec<String>)> {
    compute(py, threads, report.as_ref(), |monitor| {
        analyse(&path, (highest, tolerance), (modes, &states), monitor)
    })?
}

/// Default width of the brackets of critical values.
const TOLERANCE: f64 = 1e-4;
/// Default number of lowest modes of a state.
const MODES: usize = 3;

fn analyse(
    path: &Path,
    (highest, tolerance): (Option<usize>, Option<f64>),
    (modes, states): (Option<usize>, &[usize]),
    monitor: &mut dyn Monitor,
) -> PyResult<(String, Vec<String>)> {
    let mut directory = RunDirectory::open(path).map_err(error_of)?;
    directory.lock().map_err(error_of)?;
    let plan = plan_of(&directory)?;
    let (table, names, pictures) = if plan.mesh.rings(plan.symmetry) == 1 {
        if modes.is_some() || !states.is_empty() {
            return Err(PyValueError::new_err(
                "modes and states are of three-dimensional runs; this one is axisymmetric and has highest and tolerance",
            ));
        }
        let highest = highest.unwrap_or(plan.output.stability_modes);
        let tolerance = tolerance.unwrap_or(TOLERANCE);
        let test = CriticalLoads::new(&plan, &directory, highest, tolerance);
        let mut test = test.map_err(failure)?;
        while test.next_state(monitor).map_err(failure)?.is_some() {}
        let found = test.finish();
        let names = found.write(&plan.tube, &directory).map_err(error_of)?;
        let pictures = stability_pictures(&plan, &found);
        (found.table(&plan.tube), names, pictures)
    } else {
        if highest.is_some() || tolerance.is_some() {
            return Err(PyValueError::new_err(
                "highest and tolerance are of axisymmetric runs; this one is three-dimensional and has modes and states",
            ));
        }
        let modes = modes.unwrap_or(MODES);
        let search = LowestModes::new(&plan, &directory, states, modes);
        let mut search = search.map_err(failure)?;
        while search.next_state(monitor).map_err(failure)?.is_some() {}
        let found = search.finish();
        found.write(&plan.tube, &directory).map_err(error_of)?;
        let names = found.modes.clone();
        let pictures = mode_pictures(&plan, &found);
        (found.table(&plan.tube), names, pictures)
    };
    // A picture that cannot be drawn is no failure.
    for (name, png) in pictures.unwrap_or_default() {
        directory.write(&name, &png).map_err(error_of)?;
    }
    let is_mode = |name: &String| name.starts_with("modes/");
    Ok((table, names.into_iter().filter(is_mode).collect()))
}

/// Returns the exception for an error of the analysis.
fn failure(error: StabilityError) -> PyErr {
    match error {
        StabilityError::Cancelled => PyKeyboardInterrupt::new_err(()),
        error if error.is_misuse() => PyValueError::new_err(error.to_string()),
        error => PyOSError::new_err(error.to_string()),
    }
}
