//! Relaxation: descent in energy with damping that decreases.

use super::damping_controller::{AcceptedStep, DampingController};
use super::equilibrium::Equilibrium;
use super::failure::{Cause, Failure};
use super::forcing::Forcing;
use super::iterate::{Iterate, LinearStep};
use super::line_search::LineSearch;
use super::operator::dot;
use super::settings::Settings;
use super::state::{Effort, Method, Solution, report};
use super::tangent::Tangent;
use crate::monitor::Monitor;

/// Rejected steps after which a state that is in equilibrium is returned although its residual is not
/// within the tolerance: rounding keeps it from decreasing, whatever the damping.
const REJECTIONS: usize = 3;

/// Descends from a `u` with the prescribed values to an equilibrium by (K + α C) Δu = −R, which is
/// backward Euler in pseudo-time.
///
/// A step is taken if K + α C is positive definite, no element inverts and the energy decreases; if
/// need be after it was shortened, which costs an evaluation of the energy but no linear solve. The
/// damping α follows the residual and the agreement of the energy with the tangent
/// (`DampingController`). The equilibrium is stable unless a symmetry of the start keeps the iterates
/// on a saddle.
///
/// Where an iterative solver meets a direction of negative curvature, the step is the one found so far
/// plus that direction; both lower the energy, and the step is doubled as long as that goes on. If
/// the energy does not decrease there, a later damped step from the same iterate is doubled likewise,
/// if it is itself a direction of negative curvature. In this way an iterate leaves a saddle in few
/// solves, and breaks a symmetry only by rounding.
///
/// # Errors
///
/// A [`Failure`] if no damping gives a step that may be taken, or `settings.relaxation_steps` linear
/// solves do not suffice.
pub fn relaxation<P: Equilibrium>(
    problem: &P,
    load: &P::Load,
    u: Vec<f64>,
    settings: &Settings,
    effort: &mut Effort,
    monitor: &mut dyn Monitor,
) -> Result<Solution, Failure<P::EvaluationError>> {
    let mut now = Iterate::new(problem, load, u).map_err(Failure::Evaluation)?;
    let mut forcing = Forcing::new(settings.tolerance);
    let mut accuracy = forcing.accuracy(now.relative_residual);
    let mut damping = DampingController::new(settings.relaxation_damping);
    let (mut solves, mut damping_work) = (0, 0.0);
    // What is known of the iterate: its tangent, and the outcome of rejected steps.
    let (mut tangent, mut negative_curvature) = (None, false);
    let (mut rejections, mut undefined) = (0, None);
    while !now.converged(settings.tolerance) {
        if damping.is_exhausted() {
            return Err(
                undefined.map_or(now.failure(Cause::NoDescent, solves), Failure::Evaluation)
            );
        }
        if solves == settings.relaxation_steps {
            return Err(now.failure(Cause::SolveLimit, solves));
        }
        let K = tangent.take().unwrap_or_else(|| now.tangent());
        solves += 1;
        let step = K
            .shifted(damping.alpha())
            .map(|solver| now.solve(solver, accuracy, effort, monitor));
        let next = match step {
            Ok(LinearStep::Descent { step, accurate }) => {
                damping.solved(accurate);
                match descend(&now, step, accurate, negative_curvature, &mut damping) {
                    Ok(next) => Some(next),
                    Err(None) if now.in_equilibrium() && rejections >= REJECTIONS => break,
                    Err(error) => {
                        rejections += usize::from(error.is_none());
                        undefined = error.or(undefined);
                        None
                    }
                }
            }
            Ok(LinearStep::NegativeCurvature {
                step,
                direction,
                curvature,
            }) => {
                negative_curvature = true;
                damping.compensate(curvature);
                now.follow_negative_curvature(&step, &direction)
                    .map(|(length, next)| {
                        damping.shortened(length);
                        next
                    })
            }
            Ok(LinearStep::Indefinite { .. }) | Err(_) => None,
        };
        if let Some(next) = next {
            // At a constant load the decrease of the energy is the work of the damping.
            damping_work += now.forces.energy - next.forces.energy;
            now = next;
            accuracy = forcing.accuracy(now.relative_residual);
            negative_curvature = false;
            (rejections, undefined) = (0, None);
        } else {
            damping.reject();
            tangent = Some(K);
        }
        report(monitor, Method::Relaxation, solves, now.relative_residual)?;
    }
    effort.linear_solves += solves;
    Ok(now.into_solution(damping_work))
}

/// Takes a damped step as far as the energy decreases, and adapts the damping to it. A step along
/// which the energy is curved downwards is doubled if negative curvature was met here before.
fn descend<'a, P: Equilibrium>(
    now: &Iterate<'a, P>,
    step: Vec<f64>,
    accurate: bool,
    negative_curvature: bool,
    damping: &mut DampingController,
) -> Result<Iterate<'a, P>, Option<P::EvaluationError>> {
    // Δu · α C Δu, and Δu · K Δu = −R · Δu − Δu · α C Δu.
    let slope = dot(&now.forces.residual, &step);
    let work = dot(&now.damping_force(damping.alpha(), &step), &step);
    let predicted = 0.5 * (slope - work);
    let (length, mut next) = now.search(&step, LineSearch::Decrease)?;
    let trust = if length < 1.0 {
        0.0
    } else if -predicted <= now.forces.rounding {
        1.0
    } else {
        (next.forces.energy - now.forces.energy) / predicted
    };
    if negative_curvature && length == 1.0 && -slope < work {
        next = now.expand(step, next);
    }
    damping.accept(AcceptedStep {
        accurate,
        length,
        trust,
        residual_ratio: next.relative_residual / now.relative_residual,
    });
    Ok(next)
}
