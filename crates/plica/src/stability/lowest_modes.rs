//! The lowest eigenpairs of the saved states of a three-dimensional run.

use super::observer::Relay;
use super::{Eigenvalue, Observer, Shown, Spectra, Spectrum, StabilityError};
use crate::assembly::SplineTube;
use crate::equilibrium::TubeProblem;
use crate::monitor::{Monitor, Part};
use crate::rings::Transform;
use crate::run_directory::RunDirectory;
use crate::saved_state::{Array, SavedState};
use crate::solve::{EQUILIBRIUM, Equilibrium, Lowest, Search};
use crate::study::Plan;
use std::path::{Path, PathBuf};

/// Relative residual to which eigenpairs are found; eigenvalues then are off by about its square.
const ACCURACY: f64 = 1e-4;
/// Iterations after which what there is must do.
const ITERATIONS: usize = 300;
/// Vectors that are searched for beside those wanted, and one more for every two of them.
const GUARDS: usize = 3;

/// What is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct ModesRequest {
    /// Numbers of the states; all if there are none.
    pub states: Vec<usize>,
    /// How many of the lowest eigenpairs of each.
    pub modes: usize,
}

/// Finds the lowest eigenpairs of the tangent of saved states of a run of many rings, and writes
/// each state's modes into the run directory as soon as it is done. What a former test wrote there is
/// taken out first.
///
/// # Errors
/// [`StabilityError`]; the modes of the states before stay written.
pub fn lowest_modes(
    plan: &Plan,
    directory: &RunDirectory,
    request: &ModesRequest,
    observer: &mut dyn Observer,
) -> Result<Spectra, StabilityError> {
    let files = chosen(directory, &request.states)?;
    let rings = plan.mesh.rings(plan.symmetry);
    if rings == 1 {
        return Err(StabilityError::OneRing);
    }
    let problem = TubeProblem::new(SplineTube::new(&plan.tube, &plan.mesh, rings));
    directory.clear_stability()?;
    let mut spectra = Spectra {
        states: vec![],
        shown: None,
        modes: vec![],
        stopped: false,
    };
    for (done, file) in files.iter().enumerate() {
        let state = read(plan, &problem, file)?;
        let (done, all) = (done as f64, files.len() as f64);
        let mut relay = Relay::new(&mut *observer);
        let activity = format!("state {}", state.row);
        let mut monitor = Part::new(&mut relay, activity, done / all, 0.0);
        let found = search(&problem, &state, request.modes, &mut monitor).ok_or_else(|| {
            StabilityError::NoTangent {
                path: file.to_owned(),
            }
        })?;
        if observer.stop() {
            spectra.stopped = true;
            return Ok(spectra);
        }
        let (spectrum, shapes) = described(&problem, &state, found);
        for (number, (shape, eigenvalue)) in shapes.iter().zip(&spectrum.lowest).enumerate() {
            let name = format!("mode-state-{:04}-{}", state.row, number + 1);
            let mode = saved(&state, shape, eigenvalue);
            spectra.modes.push(directory.write_mode(&name, &mode)?);
        }
        observer.found(&plan.tube, &spectrum);
        let shown = spectra.shown.as_ref().map(|shown| shown.which);
        let settled = shown.is_some_and(|which: usize| spectra.states[which].negative().0 > 0);
        if !settled {
            spectra.shown = Some(Shown {
                which: spectra.states.len(),
                state,
                shapes,
            });
        }
        spectra.states.push(spectrum);
    }
    Ok(spectra)
}

/// The files of the states that are asked for.
fn chosen(directory: &RunDirectory, rows: &[usize]) -> Result<Vec<PathBuf>, StabilityError> {
    let files = directory.states()?;
    if rows.is_empty() && files.is_empty() {
        return Err(StabilityError::NoStates {
            directory: directory.path().to_owned(),
            found: 0,
        });
    }
    let name = |row: usize| directory.path().join(RunDirectory::name_of_state(row));
    if let Some(&row) = rows.iter().find(|row| !files.contains(&name(**row))) {
        return Err(StabilityError::NoSuchState {
            row,
            directory: directory.path().to_owned(),
        });
    }
    let wanted = |file: &PathBuf| rows.is_empty() || rows.iter().any(|&row| *file == name(row));
    Ok(files.into_iter().filter(wanted).collect())
}

/// A saved state, if it is an equilibrium of this case.
fn read(plan: &Plan, problem: &TubeProblem, file: &Path) -> Result<SavedState, StabilityError> {
    let trouble = |source| StabilityError::State {
        path: file.to_owned(),
        source,
    };
    let state = SavedState::read(file).map_err(trouble)?;
    plan.accepts(&state).map_err(trouble)?;
    let forces = problem.forces(&state.load, &state.u);
    let relative_residual =
        forces.map_or(f64::INFINITY, |f| f.relative_residual(problem.prescribed()));
    if relative_residual <= EQUILIBRIUM || (state.row == 0 && relative_residual.is_finite()) {
        return Ok(state);
    }
    Err(StabilityError::OutOfEquilibrium {
        path: file.to_owned(),
        relative_residual,
    })
}

fn search(
    problem: &TubeProblem,
    state: &SavedState,
    modes: usize,
    monitor: &mut dyn Monitor,
) -> Option<Lowest> {
    let search = Search {
        wanted: modes,
        accuracy: ACCURACY,
        iterations: ITERATIONS,
        side_of: None,
    };
    let block = modes + modes / 2 + GUARDS;
    let mut found = problem.lowest_modes(&state.load, &state.u, block, &search, monitor)?;
    found.values.truncate(modes);
    (!found.values.is_empty()).then_some(found)
}

/// A spectrum in words of the field, and the modes with their largest entry one.
fn described(
    problem: &TubeProblem,
    state: &SavedState,
    found: Lowest,
) -> (Spectrum, Vec<Vec<f64>>) {
    let sector = &problem.tube.sector;
    let (transform, repeats) = (Transform::new(sector.rings), sector.around / sector.rings);
    let (mut lowest, mut shapes) = (vec![], vec![]);
    for (j, mut x) in found
        .vectors
        .into_iter()
        .take(found.values.len())
        .enumerate()
    {
        let mut measured = vec![0.0; x.len()];
        problem.damping(1.0, &x, &mut measured);
        let products = transform.dot_by_harmonic(&x, &measured);
        let whole: f64 = products.iter().sum();
        let mut shares = vec![0.0; sector.around / 2 + 1];
        for (n, product) in products.iter().enumerate() {
            shares[n * repeats] = product / whole;
        }
        let larger = |a: f64, x: &f64| if x.abs() > a.abs() { *x } else { a };
        let largest = x.iter().fold(0.0, larger);
        x.iter_mut().for_each(|x| *x /= largest);
        shapes.push(x);
        lowest.push(Eigenvalue {
            value: found.values[j],
            residual: found.residuals[j],
            found: found.residuals[j] <= ACCURACY,
            shares,
        });
    }
    let spectrum = Spectrum {
        stage: state.stage.clone(),
        row: state.row,
        along: state.along,
        load: state.load.clone(),
        lowest,
        iterations: found.iterations,
    };
    (spectrum, shapes)
}

/// A mode with its state, as a file holds them.
fn saved(state: &SavedState, shape: &[f64], eigenvalue: &Eigenvalue) -> SavedState {
    let array = |shape: &[usize], values: &[f64]| Array {
        shape: shape.to_vec(),
        values: values.to_vec(),
    };
    let Eigenvalue {
        value,
        residual,
        ref shares,
        ..
    } = *eigenvalue;
    let arrays = [
        ("mode", array(&state.layout.shape(), shape)),
        ("harmonic", array(&[], &[eigenvalue.harmonic() as f64])),
        ("eigenvalue", array(&[], &[value])),
        ("residual", array(&[], &[residual])),
        ("shares", array(&[shares.len()], shares)),
    ];
    let arrays = arrays.map(|(name, array)| (name.to_owned(), array));
    SavedState {
        arrays: arrays.into(),
        ..state.clone()
    }
}
