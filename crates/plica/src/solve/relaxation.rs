//! Relaxation: down the energy, in a drag that shrinks.

use super::newton::{EQUILIBRIUM, free_part};
use super::{Equilibrium, Failure, Forces, Found, Method, Settings, Watch};

/// Drag after a rejected step, over the drag before.
const STIFFER: f64 = 8.0;
/// Drag after an accepted step, over the drag before, at most and at least.
const SOFTER: (f64, f64) = (0.5, 0.05);
/// Drag above which a step no longer moves anything.
const LARGEST_DRAG: f64 = 1e12;

/// From `u`, which satisfies the supports: (K + α C) Δu = −R, backward Euler in pseudo-time. A step
/// is taken if the matrix is positive definite, no element inverts and the energy falls; then the
/// drag shrinks with the residual (switched evolution relaxation). Otherwise it grows. This
/// follows the tube down to the next equilibrium, whatever lies between. It is stable unless a
/// symmetry of the start kept the tube on a saddle; the caller looks at the tangent there.
pub fn relaxation<P: Equilibrium>(
    problem: &P,
    load: &P::Load,
    mut u: Vec<f64>,
    settings: &Settings,
    watch: &mut dyn Watch,
) -> Result<Found, Failure<P::Broken>> {
    let (given, C) = (problem.given(), problem.drag());
    let mut forces = problem.forces(load, &u).map_err(Failure::Broken)?;
    let mut imbalance = forces.imbalance(given);
    let mut alpha = settings.relaxation_drag;
    let (mut iterations, mut drag_work) = (0, 0.0);
    let mut tangent = None;
    let (mut refused, mut rejected) = (None, 0);
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
        let K = tangent.take().unwrap_or_else(|| problem.tangent(load, &u));
        let mut A = K.clone();
        A.add_scaled(alpha, C);
        A.constrain(given);
        let factor = A.factor();
        iterations += 1;
        if !watch.solved(Method::Relaxation, imbalance) {
            return Err(Failure::Stopped);
        }
        let positive = factor.ok().filter(|factor| factor.negative_pivots() == 0);
        let Some(factor) = positive else {
            (alpha, tangent) = (alpha * STIFFER, Some(K));
            continue;
        };
        let mut step = free_part(&forces.residual, given, -1.0);
        factor.solve(&mut step);
        let next: Vec<f64> = u.iter().zip(&step).map(|(u, s)| u + s).collect();
        match problem.forces(load, &next) {
            Ok(f) if falls(&forces, &f, given) => {
                let mut drag = vec![0.0; u.len()];
                C.multiply_add(alpha, &step, &mut drag);
                drag_work += drag.iter().zip(&step).map(|(d, s)| d * s).sum::<f64>();
                (u, forces) = (next, f);
                let before = imbalance;
                imbalance = forces.imbalance(given);
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

/// Whether the energy falls, or, where rounding hides that, the residual.
fn falls(from: &Forces, to: &Forces, given: &[bool]) -> bool {
    to.energy < from.energy - from.rounding
        || (to.energy <= from.energy + from.rounding && to.imbalance(given) < from.imbalance(given))
}
