//! Newton's method with a line search.

use super::equilibrium::Equilibrium;
use super::failure::{Cause, Failure};
use super::forcing::Forcing;
use super::iterate::{Iterate, LinearStep};
use super::line_search::LineSearch;
use super::settings::Settings;
use super::state::{Effort, Method, Solution, report};
use super::tangent::Tangent;
use crate::monitor::Monitor;

/// Successive inaccurate linear solves after which Newton gives up. Truncated steps lower the energy,
/// but slowly; damping makes the systems easier to solve.
const INACCURATE_SOLVES: usize = 2;

/// Solves R(u) = 0 by K Δu = −R (Okino et al. 2025, Eq. (14)), from a `u` with the prescribed values.
///
/// Every step must lower the energy, and the tangent must be positive definite, as far as the solver
/// finds out, at every iterate from which a step is taken. The tangent at the solution itself is not
/// tested; [`Path`](super::Path) does that. The required accuracy of an iterative linear solver
/// follows the residual.
///
/// # Errors
///
/// A [`Failure`] if the tangent is indefinite or singular, the energy does not decrease, the linear
/// solver misses its accuracy twice in a row, or `settings.newton_iterations` do not suffice.
pub fn newton<P: Equilibrium>(
    problem: &P,
    load: &P::Load,
    u: Vec<f64>,
    settings: &Settings,
    effort: &mut Effort,
    monitor: &mut dyn Monitor,
) -> Result<Solution, Failure<P::EvaluationError>> {
    let mut now = Iterate::new(problem, load, u).map_err(Failure::Evaluation)?;
    let mut forcing = Forcing::new(settings.tolerance);
    let (mut solves, mut inaccurate) = (0, 0);
    while !now.converged(settings.tolerance) {
        if solves == settings.newton_iterations {
            return Err(now.failure(Cause::SolveLimit, solves));
        }
        let solver = now.tangent().into_shifted(0.0)?;
        let accuracy = forcing.accuracy(now.relative_residual);
        solves += 1;
        let (step, accurate) = match now.solve(solver, accuracy, effort, monitor) {
            LinearStep::Descent { step, accurate } => (step, accurate),
            LinearStep::Indefinite { negative_pivots } => {
                return Err(Failure::Indefinite { negative_pivots });
            }
            LinearStep::NegativeCurvature { .. } => {
                return Err(Failure::Indefinite { negative_pivots: 1 });
            }
        };
        inaccurate = if accurate { 0 } else { inaccurate + 1 };
        if inaccurate == INACCURATE_SOLVES {
            report(monitor, Method::Newton, solves, now.relative_residual)?;
            return Err(now.failure(Cause::InaccurateSolves, solves));
        }
        let (length, next) = match now.search(&step, LineSearch::Armijo) {
            Ok(found) => found,
            Err(None) if now.in_equilibrium() => break, // Rounding hides the decrease.
            Err(None) => return Err(now.failure(Cause::NoDescent, solves)),
            Err(Some(error)) => return Err(Failure::Evaluation(error)),
        };
        report(monitor, Method::Newton, solves, next.relative_residual)?;
        let [before, after] = [now.relative_residual, next.relative_residual];
        let stagnates = now.in_equilibrium() && length == 1.0 && after > 0.5 * before;
        if !stagnates || after < before {
            now = next;
        }
        if stagnates {
            break;
        }
    }
    effort.linear_solves += solves;
    Ok(now.into_solution(0.0))
}
