//! Lowest eigenpairs of the saved states of a three-dimensional run.

use super::{Eigenvalue, Spectra, Spectrum, StabilityError, StateWithModes};
use crate::assembly::SplineTube;
use crate::equilibrium::TubeProblem;
use crate::monitor::{Monitor, Part};
use crate::rings::Transform;
use crate::run_directory::RunDirectory;
use crate::saved_state::{Array, SavedState};
use crate::solve::{EQUILIBRIUM, Equilibrium, Lowest, Search};
use crate::study::Plan;
use std::path::{Path, PathBuf};

/// Relative residual of converged eigenpairs; the relative error of an eigenvalue is about its square.
const ACCURACY: f64 = 1e-4;
/// Maximum number of iterations.
const ITERATIONS: usize = 300;
/// Additional vectors of the search block, beside half as many again as requested.
const GUARDS: usize = 3;

/// Computation of the lowest eigenpairs of the tangent of saved states of a three-dimensional run, state by state.
pub struct LowestModes<'a> {
    plan: &'a Plan,
    directory: &'a RunDirectory,
    problem: TubeProblem,
    files: Vec<PathBuf>,
    /// Number of eigenpairs of each state.
    modes: usize,
    result: Spectra,
}

impl<'a> LowestModes<'a> {
    /// Prepares the computation of the lowest `modes` eigenpairs of the states with the numbers `states`, or of all if
    /// there are none. Removes the results of a previous stability test from the run directory.
    ///
    /// # Errors
    /// [`StabilityError`] if the run is axisymmetric or a state was not saved.
    pub fn new(
        plan: &'a Plan,
        directory: &'a RunDirectory,
        states: &[usize],
        modes: usize,
    ) -> Result<Self, StabilityError> {
        let files = selected(directory, states)?;
        let rings = plan.mesh.rings(plan.symmetry);
        if rings == 1 {
            return Err(StabilityError::OneRing);
        }
        let problem = TubeProblem::new(SplineTube::new(&plan.tube, &plan.mesh, rings));
        directory.clear_stability()?;
        Ok(Self {
            plan,
            directory,
            problem,
            files,
            modes,
            result: Spectra {
                states: vec![],
                shown: None,
                modes: vec![],
            },
        })
    }

    /// Computes the eigenpairs of the next state and writes its modes into the run directory; none after the last
    /// state.
    ///
    /// # Errors
    /// [`StabilityError`] if a file is unusable or the monitor cancels; the modes of the states before stay written.
    pub fn next_state(
        &mut self,
        monitor: &mut dyn Monitor,
    ) -> Result<Option<&Spectrum>, StabilityError> {
        let done = self.result.states.len();
        let Some(file) = self.files.get(done) else {
            return Ok(None);
        };
        let state = read(self.plan, &self.problem, file)?;
        let activity = format!("state {}", state.row);
        let fraction = done as f64 / self.files.len() as f64;
        let mut part = Part::new(monitor, activity, fraction, 0.0);
        let found = search(&self.problem, &state, self.modes, &mut part);
        let found = found.ok_or_else(|| StabilityError::NoTangent {
            path: file.to_owned(),
        })?;
        if monitor.is_cancelled() {
            return Err(StabilityError::Cancelled);
        }
        let (spectrum, shapes) = spectrum(&self.problem, &state, found);
        for (number, (shape, eigenvalue)) in shapes.iter().zip(&spectrum.lowest).enumerate() {
            let name = format!("mode-state-{:04}-{}", state.row, number + 1);
            let mode = saved(&state, shape, eigenvalue);
            let name = self.directory.write_mode(&name, &mode)?;
            self.result.modes.push(name);
        }
        let shown = self.result.shown.as_ref();
        let shows_unstable =
            shown.is_some_and(|shown| self.result.states[shown.index].negative().0 > 0);
        if !shows_unstable {
            self.result.shown = Some(StateWithModes {
                index: done,
                state,
                shapes,
            });
        }
        self.result.states.push(spectrum);
        Ok(self.result.states.last())
    }

    /// Returns the eigenvalues of the states computed so far.
    pub fn finish(self) -> Spectra {
        self.result
    }
}

/// Returns the files of the selected states.
fn selected(directory: &RunDirectory, rows: &[usize]) -> Result<Vec<PathBuf>, StabilityError> {
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

/// Reads a saved state and checks that it is an equilibrium of this case.
fn read(plan: &Plan, problem: &TubeProblem, file: &Path) -> Result<SavedState, StabilityError> {
    let error = |source| StabilityError::State {
        path: file.to_owned(),
        source,
    };
    let state = SavedState::read(file).map_err(error)?;
    plan.accepts(&state).map_err(error)?;
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

/// Returns the lowest eigenpairs of the tangent of a state; none if it has no preconditioner.
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

/// Returns the spectrum with the shares of circumferential modes, and the modes with their largest entry one.
fn spectrum(problem: &TubeProblem, state: &SavedState, found: Lowest) -> (Spectrum, Vec<Vec<f64>>) {
    let sector = &problem.tube.sector;
    let (transform, repeats) = (Transform::new(sector.rings), sector.around / sector.rings);
    let (mut lowest, mut shapes) = (vec![], vec![]);
    for (j, mut x) in found
        .vectors
        .into_iter()
        .take(found.values.len())
        .enumerate()
    {
        let mut mass_times_x = vec![0.0; x.len()];
        problem.damping(1.0, &x, &mut mass_times_x);
        let products = transform.dot_by_harmonic(&x, &mass_times_x);
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

/// Returns the contents of the file of a mode: the state with additional arrays.
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
