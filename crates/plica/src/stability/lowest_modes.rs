//! Lowest eigenpairs of the saved states of a three-dimensional run.

use super::spectra_table::PAIRS;
use super::{Eigenvalue, Spectra, Spectrum, StabilityError, StateWithModes};
use crate::equilibrium::TubeProblem;
use crate::monitor::{Monitor, Part};
use crate::rings::Transform;
use crate::run_directory::RunDirectory;
use crate::saved_state::{Array, SavedState};
use crate::solve::{EQUILIBRIUM, Equilibrium, Lowest, Search};
use crate::study::Plan;
use std::collections::BTreeMap;
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
    /// Number of states done.
    done: usize,
    /// Results by the number of the state, those of earlier analyses included.
    found: BTreeMap<usize, Analysed>,
}

/// Eigenvalues of a state and the files of its modes, relative to the run directory.
struct Analysed {
    spectrum: Spectrum,
    files: Vec<String>,
}

impl<'a> LowestModes<'a> {
    /// Prepares the computation of the lowest `modes` eigenpairs of the states with the numbers `states`, or of all if
    /// there are none. Results of earlier analyses of other states are kept.
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
        let problem = plan.problem();
        Ok(Self {
            plan,
            directory,
            problem,
            files,
            modes,
            done: 0,
            found: earlier(plan, directory),
        })
    }

    /// Computes the eigenpairs of the next state and writes them and its modes into the run directory; none after the last
    /// state.
    ///
    /// # Errors
    /// [`StabilityError`] if a file is unusable or the monitor cancels; the results of the states before stay written.
    pub fn next_state(
        &mut self,
        monitor: &mut dyn Monitor,
    ) -> Result<Option<&Spectrum>, StabilityError> {
        let done = self.done;
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
        let mut files = vec![];
        for (number, (shape, eigenvalue)) in (1..).zip(shapes.iter().zip(&spectrum.lowest)) {
            let mode = saved(&state, shape, eigenvalue);
            files.push(self.directory.write_mode(&name(state.row, number), &mode)?);
        }
        self.done += 1;
        self.found.insert(state.row, Analysed { spectrum, files });
        self.results().write(&self.plan.tube, self.directory)?;
        Ok(self.found.get(&state.row).map(|found| &found.spectrum))
    }

    /// Returns the eigenvalues of all states that were analysed, now or earlier.
    pub fn finish(self) -> Spectra {
        let mut results = self.results();
        let is_unstable = |state: &Spectrum| state.negative().0 > 0;
        let last = results.states.len().checked_sub(1);
        let index = results.states.iter().position(is_unstable).or(last);
        results.shown = index.and_then(|index| {
            let row = results.states[index].row;
            let modes = &self.found.get(&row)?.files;
            let mut shapes = vec![];
            let mut state = None;
            for name in modes {
                let mut mode = SavedState::read(&self.directory.path().join(name)).ok()?;
                shapes.push(mode.arrays.remove(MODE)?.values);
                mode.arrays.clear();
                state = Some(mode);
            }
            let state = state?;
            Some(StateWithModes {
                index,
                state,
                shapes,
            })
        });
        results
    }

    /// Returns all results, without the shapes of modes.
    fn results(&self) -> Spectra {
        let found = self.found.values();
        Spectra {
            states: found.clone().map(|one| one.spectrum.clone()).collect(),
            shown: None,
            modes: found.flat_map(|one| one.files.clone()).collect(),
            leaves_out_friction: self.plan.has_friction(),
        }
    }
}

/// Name of the array with the shape of a mode.
const MODE: &str = "mode";

/// Returns the name of the file of a mode, without folder and extension; modes are counted from 1.
fn name(row: usize, number: usize) -> String {
    format!("mode-state-{row:04}-{number}")
}

/// Reads the results of earlier analyses, except for states whose modes are missing or damaged.
fn earlier(plan: &Plan, directory: &RunDirectory) -> BTreeMap<usize, Analysed> {
    let table = directory.records(PAIRS).unwrap_or_default();
    let Some((header, lines)) = table.split_first() else {
        return BTreeMap::new();
    };
    let column = |name: &str| header.iter().position(|head| head == name);
    let (Some(state), Some(iterations)) = (column("state"), column("iterations")) else {
        return BTreeMap::new();
    };
    let numbers = lines.iter().filter_map(|line| {
        let number = |column: usize| line.get(column)?.parse::<usize>().ok();
        Some((number(state)?, number(iterations)?))
    });
    let mut counted: BTreeMap<usize, (usize, usize)> = BTreeMap::new();
    for (row, iterations) in numbers {
        let (count, _) = counted.get(&row).copied().unwrap_or_default();
        counted.insert(row, (count + 1, iterations));
    }
    let read = |(row, (count, iterations)): (usize, (usize, usize))| {
        let mut found: Option<Analysed> = None;
        for number in 1..=count {
            let file = RunDirectory::name_of_mode(&name(row, number));
            let mode = SavedState::read(&directory.path().join(&file)).ok()?;
            plan.accepts(&mode).ok()?;
            let scalar = |name: &str| mode.arrays.get(name)?.values.first().copied();
            let residual = scalar("residual")?;
            let eigenvalue = Eigenvalue {
                value: scalar("eigenvalue")?,
                residual,
                found: residual <= ACCURACY,
                shares: mode.arrays.get("shares")?.values.clone(),
            };
            let own = found.get_or_insert_with(|| Analysed {
                spectrum: Spectrum {
                    stage: mode.stage.clone(),
                    row,
                    along: mode.along,
                    load: mode.load.clone(),
                    lowest: vec![],
                    iterations,
                },
                files: vec![],
            });
            own.spectrum.lowest.push(eigenvalue);
            own.files.push(file);
        }
        Some((row, found?))
    };
    counted.into_iter().filter_map(read).collect()
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
    let path = |row: usize| directory.path().join(RunDirectory::name_of_state(row));
    if let Some(&row) = rows.iter().find(|row| !files.contains(&path(**row))) {
        return Err(StabilityError::NoSuchState {
            row,
            directory: directory.path().to_owned(),
        });
    }
    let wanted = |file: &PathBuf| rows.is_empty() || rows.iter().any(|&row| *file == path(row));
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
    let mut step = problem.clone();
    step.begin_step(&state.load, &state.u, state.history());
    let forces = step.forces(&state.load, &state.u);
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
        (MODE, array(&state.layout.shape(), shape)),
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
