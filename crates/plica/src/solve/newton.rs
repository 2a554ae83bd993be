//! Newton's method with the energy as judge.

use super::forcing::Forcing;
use super::{
    Equilibrium, Failure, Method, Monitor, ResidualEvaluation, Settings, Solution, Solver, Tangent,
};

/// A residual this small, relative to the forces in play, is equilibrium even if rounding keeps
/// the solver from its own, finer tolerance.
pub const EQUILIBRIUM: f64 = 1e-6;

/// Armijo's condition: the fraction of the predicted fall of the energy that a step must reach.
const SUFFICIENT: f64 = 1e-4;

/// Linear systems in a row that are not solved as exactly as was asked for, after which Newton gives
/// up. Truncated steps lead down, but creep; a drag makes the systems easier.
const UNSOLVED: usize = 2;

/// Halvings of a step before it counts as leading nowhere.
const HALVINGS: usize = 7;

/// From `u`, which satisfies the supports: K Δu = −R (Okino et al. 2025, Eq. (14)) until the
/// residual is within the tolerance. The tangent must be positive definite all the way, as far as
/// the solver tells, and every step must lower the energy, so what is found is a minimum. A solver
/// that iterates is asked for no more accuracy than each step is worth; where it does not reach
/// that twice in a row, Newton gives up.
pub fn newton<P: Equilibrium>(
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
    let (mut iterations, mut unsolved) = (0, 0);
    while relative_residual > settings.tolerance || relative_residual.is_nan() {
        if iterations == settings.newton_iterations {
            return Err(Failure::NotConverged {
                iterations,
                relative_residual,
                worst: forces.worst(prescribed),
            });
        }
        let solver = problem.tangent(load, &u).into_shifted(0.0)?;
        iterations += 1;
        if solver.negative_pivots() > 0 {
            return Err(Failure::Indefinite {
                negative_pivots: solver.negative_pivots(),
            });
        }
        let mut step = free_part(&forces.residual, prescribed, -1.0);
        match solver.solve(&mut step, forcing.accuracy(relative_residual), monitor) {
            Ok(solved) => {
                monitor.iterated(solved.iterations);
                let enough = solved.reached || relative_residual <= EQUILIBRIUM;
                unsolved = if enough { 0 } else { unsolved + 1 };
                if unsolved == UNSOLVED {
                    if !monitor.solved(Method::Newton, relative_residual) {
                        return Err(Failure::Stopped);
                    }
                    return Err(Failure::Unsolved {
                        iterations,
                        relative_residual,
                        worst: forces.worst(prescribed),
                    });
                }
            }
            Err(down) => {
                monitor.iterated(down.iterations);
                return Err(Failure::Indefinite { negative_pivots: 1 });
            }
        }
        let (length, next, next_forces) = match descend(problem, load, &u, &step, &forces) {
            Ok(found) => found,
            // Rounding: the energy no longer tells the states apart.
            Err(Descent::None) if relative_residual <= EQUILIBRIUM => break,
            Err(Descent::EvaluationError(broken)) => return Err(Failure::Evaluation(broken)),
            Err(Descent::None) => {
                return Err(Failure::NoDescent {
                    iterations,
                    relative_residual,
                    worst: forces.worst(prescribed),
                });
            }
        };
        let before = relative_residual;
        relative_residual = next_forces.relative_residual(prescribed);
        if !monitor.solved(Method::Newton, relative_residual) {
            return Err(Failure::Stopped);
        }
        if before <= EQUILIBRIUM && length == 1.0 && relative_residual > 0.5 * before {
            // Rounding keeps the residual where it is; the better of the two stays.
            if relative_residual < before {
                (u, forces) = (next, next_forces);
            }
            break;
        }
        (u, forces) = (next, next_forces);
    }
    Ok(Solution {
        u,
        forces,
        damping_work: 0.0,
        iterations,
    })
}

/// `factor` times the free entries of a vector; zero where a support gives the unknown.
pub fn free_part(vector: &[f64], prescribed: &[bool], factor: f64) -> Vec<f64> {
    vector
        .iter()
        .zip(prescribed)
        .map(|(x, &prescribed)| if prescribed { 0.0 } else { factor * x })
        .collect()
}

enum Descent<B> {
    EvaluationError(B),
    None,
}

/// Goes along a step as far as the energy falls: all of it, or after halvings a part.
fn descend<P: Equilibrium>(
    problem: &P,
    load: &P::Load,
    u: &[f64],
    step: &[f64],
    forces: &ResidualEvaluation,
) -> Result<(f64, Vec<f64>, ResidualEvaluation), Descent<P::EvaluationError>> {
    let slope: f64 = forces.residual.iter().zip(step).map(|(r, s)| r * s).sum();
    let (mut length, mut broken) = (1.0, None);
    for _ in 0..=HALVINGS {
        let next: Vec<f64> = u.iter().zip(step).map(|(u, s)| u + length * s).collect();
        match problem.forces(load, &next) {
            Ok(f) if f.energy <= forces.energy + SUFFICIENT * length * slope + forces.rounding => {
                return Ok((length, next, f));
            }
            Ok(_) => broken = None,
            Err(b) => broken = Some(b),
        }
        length *= 0.5;
    }
    Err(broken.map_or(Descent::None, Descent::EvaluationError))
}
