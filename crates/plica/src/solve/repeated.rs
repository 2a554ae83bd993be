//! Repetition of a step whose energy depends on its solution.

use super::equilibrium::{EQUILIBRIUM, Equilibrium};
use super::failure::Failure;
use super::settings::Settings;
use super::state::Solution;

/// Largest number of solutions of a step after the first.
const REPETITIONS: usize = 20;

/// Tolerance of the solutions but the first, relative to the residual with the energy of the solution before.
const INEXACT: f64 = 0.02;

/// Repetition from which each must reduce the residual, and factor by which.
const REDUCTION: (usize, f64) = (4, 0.8);

/// Updates the energy of a step to that of a solution, and solves again by `again`, until the residual with the energy of
/// the solution itself is within the [`repetition_tolerance`](Equilibrium::repetition_tolerance), or the energy does not
/// change. Returns the last solution.
///
/// # Errors
///
/// The error of `again`; [`Failure::Friction`] after 20 repetitions, or if they do not reduce the residual.
pub(super) fn repeated<P: Equilibrium>(
    problem: &mut P,
    load: &P::Load,
    mut found: Solution,
    settings: &Settings,
    mut again: impl FnMut(&P, Vec<f64>, &Settings) -> Result<Solution, Failure<P::EvaluationError>>,
) -> Result<Solution, Failure<P::EvaluationError>> {
    let tolerance = problem.repetition_tolerance(load, settings.tolerance);
    let mut before = f64::INFINITY;
    for repetition in 0.. {
        if !problem.update(load, &found.u) {
            break;
        }
        found.forces = problem
            .forces(load, &found.u)
            .map_err(Failure::Evaluation)?;
        let relative_residual = found.forces.relative_residual(problem.prescribed());
        if relative_residual <= tolerance {
            break;
        }
        let stagnates = repetition >= REDUCTION.0 && relative_residual > REDUCTION.1 * before;
        if stagnates && relative_residual <= EQUILIBRIUM {
            break;
        }
        before = relative_residual;
        if repetition == REPETITIONS || stagnates {
            return Err(Failure::Friction {
                relative_residual,
                worst_unknown: found.forces.worst_unknown(problem.prescribed()),
            });
        }
        let settings = Settings {
            tolerance: settings.tolerance.max(INEXACT * relative_residual),
            ..settings.clone()
        };
        let next = again(problem, found.u, &settings)?;
        found = Solution {
            damping_work: found.damping_work + next.damping_work,
            ..next
        };
    }
    Ok(found)
}
