//! Critical loads of an axisymmetric run.

use super::bisection::{Bisection, Bracket, Point};
use super::{
    Harmonics, Mode, ModeStability, PathStability, Quantity, StabilityChange, StabilityError,
    TestedState, Transition,
};
use crate::equilibrium::TubeProblem;
use crate::matrix::NoEigenpairs;
use crate::monitor::{Monitor, Part};
use crate::run_directory::RunDirectory;
use crate::saved_state::SavedState;
use crate::solve::{ContinuationState, Path, Scheme, Segment, Settings};
use crate::study::Plan;
use std::path::{self, PathBuf};

/// Circumferential displacement, in D, above which a state counts as twisted.
const TWISTED: f64 = 1e-9;

/// Stability test of the saved states of an axisymmetric run, state by state.
///
/// Where the stability to a mode changes between two states, the path is computed again from the earlier one, by the
/// static scheme with the settings of the run; equilibria do not depend on the scheme.
pub struct CriticalLoads<'a> {
    plan: &'a Plan,
    problem: TubeProblem,
    harmonics: Harmonics,
    settings: Settings,
    files: Vec<PathBuf>,
    /// Number of files already tested.
    done: usize,
    previous: Option<SavedState>,
    result: PathStability,
}

impl<'a> CriticalLoads<'a> {
    /// Prepares the test of every saved state for circumferential modes 0 to `highest`.
    ///
    /// `tolerance` is the width to which critical values are bracketed, in the driven quantity (Lmax/L, Dmin/D, or a
    /// displacement in D), or as a fraction of a pressure.
    ///
    /// # Errors
    /// [`StabilityError`] if the run is not axisymmetric or has fewer than two saved states.
    pub fn new(
        plan: &'a Plan,
        directory: &RunDirectory,
        highest: usize,
        tolerance: f64,
    ) -> Result<Self, StabilityError> {
        if plan.mesh.rings(plan.symmetry) != 1 {
            return Err(StabilityError::Symmetry);
        }
        let files = directory.states()?;
        if files.len() < 2 {
            return Err(StabilityError::NoStates {
                directory: directory.path().to_owned(),
                found: files.len(),
            });
        }
        let problem = plan.problem();
        let harmonics = Harmonics::new(&problem, highest);
        Ok(Self {
            plan,
            settings: Settings {
                scheme: Scheme::Static,
                ..plan.solver.clone()
            },
            files,
            done: 0,
            previous: None,
            result: PathStability {
                highest: harmonics.count() - 1,
                tolerance,
                states: vec![],
                changes: vec![],
                leaves_out_friction: plan.has_friction(),
            },
            problem,
            harmonics,
        })
    }

    /// Tests the next saved state and brackets the changes since the previous one; none after the last state.
    ///
    /// # Errors
    /// [`StabilityError`] if a file is unusable, an eigenvalue is not found, or the monitor cancels.
    pub fn next_state(
        &mut self,
        monitor: &mut dyn Monitor,
    ) -> Result<Option<&TestedState>, StabilityError> {
        let Some(file) = self.files.get(self.done).cloned() else {
            return Ok(None);
        };
        let fraction = self.done as f64 / self.files.len() as f64;
        let state = self.read(&file)?;
        monitor.working(&format_args!("testing state {}", state.row), fraction);
        let modes = self.harmonics.test(&state.load, &state.u);
        let modes = modes.map_err(no_eigenpairs(&file))?;
        if let Some(previous) = self.previous.take() {
            let activity = format!("between states {} and {}", previous.row, state.row);
            let mut part = Part::new(monitor, activity, fraction, 0.0);
            self.bracket_changes(&file, &previous, &state, &modes, &mut part)?;
        }
        if monitor.is_cancelled() {
            return Err(StabilityError::Cancelled);
        }
        self.result.states.push(TestedState {
            stage: state.stage.clone(),
            row: Some(state.row),
            along: state.along,
            load: state.load.clone(),
            modes,
        });
        self.previous = Some(state);
        self.done += 1;
        Ok(self.result.states.last())
    }

    /// Returns the stability of the states tested so far.
    pub fn finish(self) -> PathStability {
        self.result
    }

    /// Reads a saved state and checks that it is an equilibrium of this case without twist.
    fn read(&self, file: &path::Path) -> Result<SavedState, StabilityError> {
        let error = |source| StabilityError::State {
            path: file.to_owned(),
            source,
        };
        let state = SavedState::read(file).map_err(error)?;
        self.plan.accepts(&state).map_err(error)?;
        let twist = state.u.iter().skip(2).step_by(3);
        if twist.into_iter().any(|u| u.abs() > TWISTED) {
            return Err(StabilityError::Twisted { row: state.row });
        }
        let (load, u) = (state.load.clone(), state.u.clone());
        let history = state.history().to_vec();
        let path = Path::resume(
            self.problem.clone(),
            Segment::between(load.clone(), load.clone()),
            load,
            u,
            ContinuationState::at_start(vec![0.0; state.u.len()], history),
            self.settings.clone(),
        );
        let relative_residual = match path {
            Ok(path) if path.state().in_equilibrium() || state.row == 0 => return Ok(state),
            Ok(path) => path.state().relative_residual,
            Err(_) => f64::INFINITY,
        };
        Err(StabilityError::OutOfEquilibrium {
            path: file.to_owned(),
            relative_residual,
        })
    }

    /// Brackets and records the changes of stability between two saved states.
    fn bracket_changes(
        &mut self,
        file: &path::Path,
        previous: &SavedState,
        state: &SavedState,
        modes: &[ModeStability],
        monitor: &mut dyn Monitor,
    ) -> Result<(), StabilityError> {
        // A stage begins at the end of the previous one.
        let begin = if previous.stage == state.stage {
            previous.along
        } else {
            0.0
        };
        let point = |state: &SavedState, along, modes: &[ModeStability]| Point {
            along,
            load: state.load.clone(),
            u: state.u.clone(),
            history: state.history().to_vec(),
            negative: modes.iter().map(|mode| mode.negative).collect(),
        };
        let Some(last) = self.result.states.last() else {
            return Ok(());
        };
        let (a, b) = (
            point(previous, begin, &last.modes),
            point(state, state.along, modes),
        );
        let quantity = Quantity::between(&self.plan.tube, &a.load, &b.load);
        let bisection = Bisection {
            problem: &self.problem,
            harmonics: &self.harmonics,
            settings: &self.settings,
            quantity,
            tolerance: self.result.tolerance,
        };
        for bracket in bisection.brackets(&a, &b, monitor)? {
            self.record(&bracket, quantity, previous, state)
                .map_err(no_eigenpairs(file))?;
        }
        Ok(())
    }

    /// Records a change for every mode whose stability differs between the ends of a bracket, and the ends as tested
    /// states.
    fn record(
        &mut self,
        bracket: &Bracket,
        quantity: Quantity,
        previous: &SavedState,
        state: &SavedState,
    ) -> Result<(), NoEigenpairs> {
        let tube = &self.plan.tube;
        let smooth = bracket.transition == Transition::Smooth;
        let between = [0, 1].map(|i| quantity.of(tube, &bracket.ends[i].load));
        for harmonic in 0..self.harmonics.count() {
            let negative = [0, 1].map(|i| bracket.ends[i].negative[harmonic]);
            if negative[0] == negative[1] {
                continue;
            }
            let mut change = StabilityChange {
                stage: state.stage.clone(),
                harmonic,
                quantity,
                between,
                critical: 0.5 * (between[0] + between[1]),
                negative,
                transition: bracket.transition,
                mode: None,
            };
            if smooth {
                self.locate(&mut change, bracket, previous, state)?;
            }
            self.result.changes.push(change);
        }
        // Unless the transition is smooth, the ends may be saved states, which are recorded already.
        for end in bracket.ends.iter().filter(|_| smooth) {
            let modes = self.harmonics.test(&end.load, &end.u)?;
            self.result.states.push(TestedState {
                stage: state.stage.clone(),
                row: None,
                along: end.along,
                load: end.load.clone(),
                modes,
            });
        }
        Ok(())
    }

    /// Interpolates the zero of the eigenvalue that changes its sign; adds its mode if stability is lost.
    fn locate(
        &self,
        change: &mut StabilityChange,
        bracket: &Bracket,
        previous: &SavedState,
        state: &SavedState,
    ) -> Result<(), NoEigenpairs> {
        let (n, [from, to]) = (change.harmonic, change.between);
        // The first one, if several eigenvalues change their signs together.
        let index = change.negative[0].min(change.negative[1]);
        let pair = |point: &Point| {
            let mut pairs = self.harmonics.lowest(n, &point.load, &point.u, index + 1)?;
            pairs.pop().ok_or(NoEigenpairs { count: index + 1 })
        };
        let [a, b] = [pair(&bracket.ends[0])?, pair(&bracket.ends[1])?];
        if a.value * b.value < 0.0 {
            change.critical = from + (to - from) * a.value / (a.value - b.value);
        }
        if change.is_loss() {
            let largest = b
                .vector
                .iter()
                .copied()
                .max_by(|x, y| x.abs().total_cmp(&y.abs()));
            let largest = largest.unwrap_or(1.0);
            let end = &bracket.ends[1];
            change.mode = Some(Mode {
                harmonic: n,
                eigenvalue: b.value,
                state: SavedState {
                    row: previous.row,
                    along: end.along,
                    load: end.load.clone(),
                    u: end.u.clone(),
                    ..state.clone()
                },
                shape: b.vector.iter().map(|x| x / largest).collect(),
            });
        }
        Ok(())
    }
}

fn no_eigenpairs(file: &path::Path) -> impl Fn(NoEigenpairs) -> StabilityError {
    |source| StabilityError::Eigenvalues {
        path: file.to_owned(),
        source,
    }
}
