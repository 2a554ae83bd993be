//! From saved state to saved state.

use super::bisection::{Bisection, Bracket, Point};
use super::observer::Relay;
use super::{
    Change, Harmonics, How, Mode, Observer, Quantity, Stability, StabilityError, Station, Tested,
};
use crate::assembly::SplineTube;
use crate::equilibrium::TubeProblem;
use crate::matrix::NoEigenpairs;
use crate::monitor::Part;
use crate::run_directory::RunDirectory;
use crate::saved_state::SavedState;
use crate::solve::{Path, Scheme, Settings};
use crate::study::Plan;
use std::path;

/// Circumferential displacement, in D, from which a tube counts as twisted.
const TWISTED: f64 = 1e-9;

/// What is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Request {
    /// Harmonics 0 to this.
    pub harmonics: usize,
    /// How close critical values are bracketed, in what is driven: Lmax/L, Dmin/D, or displacement
    /// in D; of a pressure, as a fraction of it.
    pub tolerance: f64,
}

/// Tests every saved state of a run of one ring, and finds where between two of them a harmonic
/// changes. The path is followed anew there from the earlier state, by the static scheme with the
/// settings of the run; equilibria do not depend on the scheme.
///
/// # Errors
/// [`StabilityError`]; nothing is written in any case.
pub fn follow(
    plan: &Plan,
    directory: &RunDirectory,
    request: &Request,
    observer: &mut dyn Observer,
) -> Result<Stability, StabilityError> {
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
    let problem = TubeProblem::new(SplineTube::new(&plan.tube, &plan.mesh, 1));
    let harmonics = Harmonics::new(&problem.tube, request.harmonics);
    let mut follower = Follower {
        plan,
        problem: &problem,
        harmonics: &harmonics,
        settings: Settings {
            scheme: Scheme::Static,
            ..plan.solver.clone()
        },
        tolerance: request.tolerance,
        observer,
        found: Stability {
            highest: harmonics.count() - 1,
            tolerance: request.tolerance,
            stations: vec![],
            changes: vec![],
        },
        fraction: 0.0,
    };
    let mut before: Option<SavedState> = None;
    for (done, file) in files.iter().enumerate() {
        follower.fraction = done as f64 / files.len() as f64;
        let state = follower.read(file)?;
        let tested = follower.test(file, &state)?;
        if let Some(before) = &before {
            follower.between(file, before, &state, &tested)?;
        }
        let station = station(&state, Some(state.row), state.along, tested);
        follower.observer.tested(&plan.tube, &station);
        follower.found.stations.push(station);
        before = Some(state);
        if follower.observer.stop() {
            return Err(StabilityError::Stopped);
        }
    }
    Ok(follower.found)
}

struct Follower<'a> {
    plan: &'a Plan,
    problem: &'a TubeProblem,
    harmonics: &'a Harmonics<'a>,
    settings: Settings,
    tolerance: f64,
    observer: &'a mut dyn Observer,
    found: Stability,
    fraction: f64,
}

impl Follower<'_> {
    /// A saved state, if it is an equilibrium of this case without twist.
    fn read(&self, file: &path::Path) -> Result<SavedState, StabilityError> {
        let trouble = |source| StabilityError::State {
            path: file.to_owned(),
            source,
        };
        let state = SavedState::read(file).map_err(trouble)?;
        self.plan.accepts(&state).map_err(trouble)?;
        let twist = state.u.iter().skip(2).step_by(3);
        if twist.into_iter().any(|u| u.abs() > TWISTED) {
            return Err(StabilityError::Twisted { row: state.row });
        }
        let (load, u) = (state.load.clone(), state.u.clone());
        let relative_residual = match Path::begin(self.problem, load, u, self.settings.clone()) {
            Ok(path) if path.state().in_equilibrium() || state.row == 0 => return Ok(state),
            Ok(path) => path.state().relative_residual,
            Err(_) => f64::INFINITY,
        };
        Err(StabilityError::OutOfEquilibrium {
            path: file.to_owned(),
            relative_residual,
        })
    }

    fn test(
        &mut self,
        file: &path::Path,
        state: &SavedState,
    ) -> Result<Vec<Tested>, StabilityError> {
        let what = format!("testing state {}", state.row);
        self.observer.working(&what, self.fraction);
        let tested = self.harmonics.test(&state.load, &state.u);
        tested.map_err(no_eigenpairs(file))
    }

    /// What changes between two saved states.
    fn between(
        &mut self,
        file: &path::Path,
        before: &SavedState,
        state: &SavedState,
        tested: &[Tested],
    ) -> Result<(), StabilityError> {
        let tube = &self.plan.tube;
        // A stage begins where the one before ends.
        let begin = if before.stage == state.stage {
            before.along
        } else {
            0.0
        };
        let point = |state: &SavedState, along, tested: &[Tested]| Point {
            along,
            load: state.load.clone(),
            u: state.u.clone(),
            negative: tested.iter().map(|tested| tested.negative).collect(),
        };
        let Some(last) = self.found.stations.last() else {
            return Ok(());
        };
        let (a, b) = (
            point(before, begin, &last.tested),
            point(state, state.along, tested),
        );
        let quantity = Quantity::between(tube, &a.load, &b.load);
        let bisection = Bisection {
            problem: self.problem,
            harmonics: self.harmonics,
            settings: &self.settings,
            quantity,
            tolerance: self.tolerance,
        };
        let mut relay = Relay::new(self.observer);
        let activity = format!("between states {} and {}", before.row, state.row);
        let mut monitor = Part::new(&mut relay, activity, self.fraction, 0.0);
        for bracket in bisection.brackets(&a, &b, &mut monitor)? {
            self.note(&bracket, quantity, before, state)
                .map_err(no_eigenpairs(file))?;
        }
        Ok(())
    }

    /// Writes down what a bracket holds: a change for every harmonic that differs, and both ends.
    fn note(
        &mut self,
        bracket: &Bracket,
        quantity: Quantity,
        before: &SavedState,
        state: &SavedState,
    ) -> Result<(), NoEigenpairs> {
        let tube = &self.plan.tube;
        let smooth = bracket.how == How::Smooth;
        let between = [0, 1].map(|i| quantity.of(tube, &bracket.ends[i].load));
        for harmonic in 0..self.harmonics.count() {
            let negative = [0, 1].map(|i| bracket.ends[i].negative[harmonic]);
            if negative[0] == negative[1] {
                continue;
            }
            let mut change = Change {
                stage: state.stage.clone(),
                harmonic,
                quantity,
                between,
                critical: 0.5 * (between[0] + between[1]),
                negative,
                how: bracket.how,
                mode: None,
            };
            if smooth {
                self.locate(&mut change, bracket, before, state)?;
            }
            self.found.changes.push(change);
        }
        // Where the ends are saved states, they are stations already.
        for end in bracket.ends.iter().filter(|_| smooth) {
            let tested = self.harmonics.test(&end.load, &end.u)?;
            self.found.stations.push(Station {
                stage: state.stage.clone(),
                row: None,
                along: end.along,
                load: end.load.clone(),
                tested,
            });
        }
        Ok(())
    }

    /// Where the eigenvalue that changes its sign is zero, and its mode if it is lost.
    fn locate(
        &self,
        change: &mut Change,
        bracket: &Bracket,
        before: &SavedState,
        state: &SavedState,
    ) -> Result<(), NoEigenpairs> {
        let (n, [from, to]) = (change.harmonic, change.between);
        // Of those that change together, the first.
        let which = change.negative[0].min(change.negative[1]);
        let pair = |point: &Point| {
            let mut pairs = self.harmonics.lowest(n, &point.load, &point.u, which + 1)?;
            pairs.pop().ok_or(NoEigenpairs { count: which + 1 })
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
                    row: before.row,
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

fn station(state: &SavedState, row: Option<usize>, along: f64, tested: Vec<Tested>) -> Station {
    Station {
        stage: state.stage.clone(),
        row,
        along,
        load: state.load.clone(),
        tested,
    }
}

fn no_eigenpairs(file: &path::Path) -> impl Fn(NoEigenpairs) -> StabilityError {
    |source| StabilityError::Eigenvalues {
        path: file.to_owned(),
        source,
    }
}
