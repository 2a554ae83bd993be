//! Relaxation: down the energy, in a drag that shrinks.

use super::forcing::Forcing;
use super::newton::{EQUILIBRIUM, free_part};
use super::operator::dot;
use super::{Balance, Equilibrium, Failure, Found, Method, Settings, Solver, Tangent, Watch};

/// Drag after a rejected step, over the drag before.
const STIFFER: f64 = 8.0;
/// Drag after an accepted step, over the drag before, at most and at least.
const SOFTER: (f64, f64) = (0.5, 0.05);
/// Drag above which a step no longer moves anything.
const LARGEST_DRAG: f64 = 1e12;

/// From `u`, which satisfies the supports: (K + α C) Δu = −R, backward Euler in pseudo-time. A step
/// is taken if the matrix is positive definite, no element inverts and the energy falls; then the
/// drag shrinks with the residual (switched evolution relaxation). Otherwise it grows: eightfold, or
/// by twice what a direction of negative curvature lacks. This follows the tube down to the next
/// equilibrium, whatever lies between. It is stable unless a symmetry of the start kept the tube
/// on a saddle; the caller looks at the tangent there.
///
/// Away from a saddle a damped step is short. Where negative curvature was met and the step itself
/// leads along such a direction, it is made longer, twofold each time, as long as the energy falls.
/// So a tube leaves a saddle along its own motion, and never leaves its symmetry.
pub fn relaxation<P: Equilibrium>(
    problem: &P,
    load: &P::Load,
    mut u: Vec<f64>,
    settings: &Settings,
    watch: &mut dyn Watch,
) -> Result<Found, Failure<P::Broken>> {
    let given = problem.given();
    let mut forces = problem.forces(load, &u).map_err(Failure::Broken)?;
    let mut imbalance = forces.imbalance(given);
    let mut forcing = Forcing::new(settings.tolerance);
    let mut accuracy = forcing.accuracy(imbalance);
    let mut alpha = settings.relaxation_drag;
    let (mut iterations, mut drag_work) = (0, 0.0);
    let mut tangent = None;
    let (mut refused, mut rejected) = (None, 0);
    // Whether it was met at u.
    let mut negative_curvature = false;
    while imbalance > settings.tolerance || imbalance.is_nan() {
        if alpha > LARGEST_DRAG {
            return Err(refused.unwrap_or(Failure::NoDescent {
                iterations,
                imbalance,
            }));
        }
        if iterations == settings.relaxation_steps {
            return Err(Failure::NotConverged {
                iterations,
                imbalance,
            });
        }
        let K = tangent.take().unwrap_or_else(|| {
            negative_curvature = false;
            problem.tangent(load, &u)
        });
        let solver = K.shifted(alpha);
        iterations += 1;
        if !watch.solved(Method::Relaxation, imbalance) {
            return Err(Failure::Stopped);
        }
        let positive = solver.ok().filter(|solver| solver.negative_pivots() == 0);
        let Some(solver) = positive else {
            (alpha, tangent) = (alpha * STIFFER, Some(K));
            continue;
        };
        let mut step = free_part(&forces.residual, given, -1.0);
        match solver.solve(&mut step, accuracy) {
            Ok(inner) => watch.iterated(inner),
            Err(down) => {
                watch.iterated(down.iterations);
                negative_curvature = true;
                alpha = (2.0 * alpha).max(alpha + 2.0 * down.curvature.abs());
                tangent = Some(K);
                continue;
            }
        }
        let next: Vec<f64> = u.iter().zip(&step).map(|(u, s)| u + s).collect();
        match problem.forces(load, &next) {
            Ok(f) if falls(&forces, &f, given) => {
                let mut drag = vec![0.0; u.len()];
                problem.drag(alpha, &step, &mut drag);
                let work = dot(&drag, &step);
                drag_work += work;
                // s · K s = −R · s − α s · C s
                let curved_down = negative_curvature && -dot(&forces.residual, &step) < work;
                (u, forces) = if curved_down {
                    let (next, longer) = lengthen(problem, load, &u, step, (next, f.clone()));
                    drag_work += f.energy - longer.energy;
                    (next, longer)
                } else {
                    (next, f)
                };
                let before = imbalance;
                imbalance = forces.imbalance(given);
                accuracy = forcing.accuracy(imbalance);
                alpha *= (imbalance / before).clamp(SOFTER.1, SOFTER.0);
                (refused, rejected) = (None, 0);
            }
            // Rounding keeps the residual where it is, with whatever drag.
            Ok(_) if imbalance <= EQUILIBRIUM && rejected >= 3 => break,
            Ok(_) => {
                rejected += 1;
                (alpha, tangent) = (alpha * STIFFER, Some(K));
            }
            Err(broken) => {
                refused = Some(Failure::Broken(broken));
                (alpha, tangent) = (alpha * STIFFER, Some(K));
            }
        }
    }
    Ok(Found {
        u,
        forces,
        drag_work,
        iterations,
    })
}

/// Doubles a step from `u` as long as that lowers the energy beyond rounding; where it leads, at
/// first and then.
fn lengthen<P: Equilibrium>(
    problem: &P,
    load: &P::Load,
    u: &[f64],
    mut step: Vec<f64>,
    (mut next, mut balance): (Vec<f64>, Balance),
) -> (Vec<f64>, Balance) {
    loop {
        step.iter_mut().for_each(|s| *s *= 2.0);
        let further: Vec<f64> = u.iter().zip(&step).map(|(u, s)| u + s).collect();
        match problem.forces(load, &further) {
            Ok(b) if b.energy < balance.energy - balance.rounding => {
                (next, balance) = (further, b);
            }
            _ => return (next, balance),
        }
    }
}

/// Whether the energy falls, or, where rounding hides that, the residual.
fn falls(from: &Balance, to: &Balance, given: &[bool]) -> bool {
    to.energy < from.energy - from.rounding
        || (to.energy <= from.energy + from.rounding && to.imbalance(given) < from.imbalance(given))
}
