//! Relaxation: down the energy, in a drag that shrinks.

use super::forcing::Forcing;
use super::newton::{EQUILIBRIUM, free_part};
use super::operator::dot;
use super::{
    Equilibrium, Failure, Method, Monitor, ResidualEvaluation, Settings, Solution, Solver, Tangent,
};

/// Drag after a step along which the energy did not fall, over the drag before.
const STIFFER: f64 = 8.0;
/// Drag after a step along which the energy fell as predicted, over the drag before, at most and at
/// least.
const SOFTER: (f64, f64) = (0.5, 0.05);
/// The energy's fall over the one that the tangent predicts: from the first on the drag may shrink,
/// below the second it grows.
const TRUSTED: (f64, f64) = (0.6, 0.25);
/// Where a solver did not come as far as it was to, the drag stays above this many times what it was,
/// and half as much after every so many solves that do.
const UNSOLVED: (f64, usize) = (2.0, 5);
/// How often a step is shortened before it is given up, and the most and the least that is left of
/// it each time.
const SHORTENINGS: usize = 4;
const SHORTER: (f64, f64) = (0.5, 0.1);
/// The largest displacement of the first step along a direction of negative curvature, if the solver
/// had not come further, in D.
const LEAP: f64 = 1e-3;
/// The largest displacement of a step, in D, a diameter's tenth: what a nearly singular tangent gives
/// is as long as it likes, and beyond a larger one may lie another equilibrium than the next.
const LONGEST: f64 = 0.1;
/// Drag, in E/D², above which a step no longer moves anything: forces are below E D², so no step is
/// longer than 1e-12 D.
const LARGEST_DRAG: f64 = 1e12;

/// From `u`, which satisfies the supports: (K + α C) Δu = −R, backward Euler in pseudo-time. A step
/// is taken if the matrix is positive definite, no element inverts and the energy falls; if need be
/// after it was shortened, which costs an evaluation of the energy and not another solve. Where the
/// energy falls nearly as the tangent says, the drag then shrinks with the residual (switched
/// evolution relaxation); where it falls much less, or a step was shortened, the drag grows; where it
/// does not fall at all, it grows eightfold, and the step is solved for again. It grows eightfold, too,
/// where a solver that iterates did not come as far as it was to, and does not soon shrink back to where
/// that was. This follows the tube down to the next equilibrium, whatever lies between. It is stable
/// unless a symmetry of the start kept the tube on a saddle; the caller looks at the tangent there.
///
/// Where a solver that iterates meets a direction of negative curvature, the step is what it had by
/// then and that direction, along both of which the energy falls, made longer twofold as long as it
/// does; the drag grows by twice what the direction lacks. If that failed, a damped step from there
/// that itself leads along negative curvature is made longer likewise. So a tube leaves a saddle along
/// its own motion, and its symmetry only by what rounding adds.
pub fn relaxation<P: Equilibrium>(
    problem: &P,
    load: &P::Load,
    mut u: Vec<f64>,
    settings: &Settings,
    monitor: &mut dyn Monitor,
) -> Result<Solution, Failure<P::EvaluationError>> {
    let prescribed = problem.prescribed();
    let mut forces = problem.forces(load, &u).map_err(Failure::Evaluation)?;
    let mut relative_residual = forces.relative_residual(prescribed);
    let mut forcing = Forcing::new(settings.tolerance);
    let mut accuracy = forcing.accuracy(relative_residual);
    let mut alpha = settings.relaxation_damping;
    // Drag with which solves come as far as they are to, and how many in a row have.
    let (mut solvable, mut in_a_row) = (0.0, 0);
    let (mut iterations, mut damping_work) = (0, 0.0);
    let mut tangent = None;
    let (mut refused, mut rejected) = (None, 0);
    // Whether it was met at u.
    let mut negative_curvature = false;
    while relative_residual > settings.tolerance || relative_residual.is_nan() {
        if alpha > LARGEST_DRAG {
            return Err(refused.unwrap_or(Failure::NoDescent {
                iterations,
                relative_residual,
                worst: forces.worst(prescribed),
            }));
        }
        if iterations == settings.relaxation_steps {
            return Err(Failure::NotConverged {
                iterations,
                relative_residual,
                worst: forces.worst(prescribed),
            });
        }
        let K = tangent.take().unwrap_or_else(|| {
            negative_curvature = false;
            problem.tangent(load, &u)
        });
        let solver = K.shifted(alpha);
        iterations += 1;
        if !monitor.solved(Method::Relaxation, relative_residual) {
            return Err(Failure::Stopped);
        }
        let positive = solver.ok().filter(|solver| solver.negative_pivots() == 0);
        let Some(solver) = positive else {
            (alpha, tangent) = (alpha * STIFFER, Some(K));
            continue;
        };
        let mut step = free_part(&forces.residual, prescribed, -1.0);
        let reached = match solver.solve(&mut step, accuracy, monitor) {
            Ok(solved) => {
                monitor.iterated(solved.iterations);
                solved.reached || relative_residual <= EQUILIBRIUM
            }
            Err(down) => {
                monitor.iterated(down.iterations);
                negative_curvature = true;
                // Here the energy falls both where the solver came and along what it met.
                let leapt =
                    negative_curvature_step(problem, load, &u, &step, &down.direction, &forces);
                alpha += 2.0 * down.curvature.abs();
                if let Some((length, next, f)) = leapt {
                    damping_work += forces.energy - f.energy;
                    (u, forces) = (next, f);
                    relative_residual = forces.relative_residual(prescribed);
                    accuracy = forcing.accuracy(relative_residual);
                    if length < 1.0 {
                        alpha *= stiffer(length);
                    }
                    (refused, rejected) = (None, 0);
                } else {
                    (alpha, tangent) = (alpha * STIFFER, Some(K));
                }
                continue;
            }
        };
        drop(solver);
        if !reached {
            (solvable, in_a_row) = (UNSOLVED.0 * alpha, 0);
        } else {
            in_a_row += 1;
            if in_a_row % UNSOLVED.1 == 0 {
                solvable *= 0.5;
            }
        }
        let mut damping = vec![0.0; u.len()];
        problem.damping(alpha, &step, &mut damping);
        // α s · C s, and s · K s = −R · s − α s · C s.
        let (slope, work) = (dot(&forces.residual, &step), dot(&damping, &step));
        let predicted = 0.5 * (slope - work);
        match backtrack(problem, load, &u, &step, &forces, slope) {
            Ok((length, next, f)) => {
                // As far as rounding lets it be seen, and the step was not too long.
                let trust = if length < 1.0 {
                    0.0
                } else if -predicted <= forces.rounding {
                    1.0
                } else {
                    (f.energy - forces.energy) / predicted
                };
                let curved_down = negative_curvature && length == 1.0 && -slope < work;
                let (next, f) = if curved_down {
                    expand(problem, load, &u, step, (next, f))
                } else {
                    (next, f)
                };
                // The load stays: what the energy falls by is spent on drag.
                damping_work += forces.energy - f.energy;
                (u, forces) = (next, f);
                let before = relative_residual;
                relative_residual = forces.relative_residual(prescribed);
                accuracy = forcing.accuracy(relative_residual);
                alpha *= if !reached {
                    STIFFER
                } else if trust >= TRUSTED.0 {
                    // Not below what is solvable, unless it is already.
                    let floor = (solvable / alpha).clamp(SOFTER.1, 1.0);
                    (relative_residual / before)
                        .clamp(SOFTER.1, SOFTER.0)
                        .max(floor)
                } else if trust < TRUSTED.1 {
                    stiffer(length)
                } else {
                    1.0
                };
                (refused, rejected) = (None, 0);
            }
            // Rounding keeps the residual where it is, with whatever drag.
            Err(None) if relative_residual <= EQUILIBRIUM && rejected >= 3 => break,
            Err(None) => {
                rejected += 1;
                (alpha, tangent) = (alpha * STIFFER, Some(K));
            }
            Err(Some(broken)) => {
                refused = Some(Failure::Evaluation(broken));
                (alpha, tangent) = (alpha * STIFFER, Some(K));
            }
        }
    }
    Ok(Solution {
        u,
        forces,
        damping_work,
        iterations,
    })
}

/// Goes as far as an iterative solver came and on along the direction of negative curvature that it
/// met, in which the energy falls too: at first as far again, or [`LEAP`], then twofold each time as
/// long as the energy falls. The part of it that was left, and where that leads; none if the energy
/// does not fall at all.
fn negative_curvature_step<P: Equilibrium>(
    problem: &P,
    load: &P::Load,
    u: &[f64],
    step: &[f64],
    direction: &[f64],
    forces: &ResidualEvaluation,
) -> Option<(f64, Vec<f64>, ResidualEvaluation)> {
    let tau = largest(step).max(LEAP) / largest(direction);
    let step: Vec<f64> = step
        .iter()
        .zip(direction)
        .map(|(s, d)| s + tau * d)
        .collect();
    let slope = dot(&forces.residual, &step);
    let (length, next, balance) = backtrack(problem, load, u, &step, forces, slope).ok()?;
    let (next, balance) = if length < 1.0 {
        (next, balance)
    } else {
        expand(problem, load, u, step, (next, balance))
    };
    Some((length, next, balance))
}

/// What the drag grows by after a step that had to be shortened to this part of it, or that was too
/// long as it was.
fn stiffer(length: f64) -> f64 {
    (0.5 / length).clamp(2.0, STIFFER)
}

/// Goes along a step as far as the energy falls, from its whole length down: how far, where that is,
/// and the forces there. Where the energy rises, the parabola with its slope at the start and its
/// value at the end says what to try next.
///
/// # Errors
///
/// How the shortest step that was tried is broken, if it is.
fn backtrack<P: Equilibrium>(
    problem: &P,
    load: &P::Load,
    u: &[f64],
    step: &[f64],
    forces: &ResidualEvaluation,
    slope: f64,
) -> Result<(f64, Vec<f64>, ResidualEvaluation), Option<P::EvaluationError>> {
    let prescribed = problem.prescribed();
    let (mut length, mut broken) = ((LONGEST / largest(step)).min(1.0), None);
    for _ in 0..=SHORTENINGS {
        let next: Vec<f64> = u.iter().zip(step).map(|(u, s)| u + length * s).collect();
        let left = match problem.forces(load, &next) {
            Ok(f) if falls(forces, &f, prescribed) => return Ok((length, next, f)),
            Ok(f) => {
                broken = None;
                let rise = f.energy - forces.energy - length * slope;
                -0.5 * slope * length / rise
            }
            Err(b) => {
                broken = Some(b);
                SHORTER.0
            }
        };
        // Not a number is neither.
        length *= left.min(SHORTER.0).max(SHORTER.1);
    }
    Err(broken)
}

fn largest(step: &[f64]) -> f64 {
    step.iter().fold(0.0, |most, x| most.max(x.abs()))
}

/// Doubles a step from `u` as long as that lowers the energy beyond rounding and is not longer than
/// [`LONGEST`]; where it leads, at first and then.
fn expand<P: Equilibrium>(
    problem: &P,
    load: &P::Load,
    u: &[f64],
    mut step: Vec<f64>,
    (mut next, mut balance): (Vec<f64>, ResidualEvaluation),
) -> (Vec<f64>, ResidualEvaluation) {
    while 2.0 * largest(&step) <= LONGEST {
        step.iter_mut().for_each(|s| *s *= 2.0);
        let further: Vec<f64> = u.iter().zip(&step).map(|(u, s)| u + s).collect();
        match problem.forces(load, &further) {
            Ok(b) if b.energy < balance.energy - balance.rounding => {
                (next, balance) = (further, b);
            }
            _ => break,
        }
    }
    (next, balance)
}

/// Whether the energy falls, or, where rounding hides that, the residual.
fn falls(from: &ResidualEvaluation, to: &ResidualEvaluation, prescribed: &[bool]) -> bool {
    to.energy < from.energy - from.rounding
        || (to.energy <= from.energy + from.rounding
            && to.relative_residual(prescribed) < from.relative_residual(prescribed))
}
