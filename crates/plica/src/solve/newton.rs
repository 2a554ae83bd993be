//! Newton's method with the energy as judge.

use super::forcing::Forcing;
use super::{Balance, Equilibrium, Failure, Found, Method, Settings, Solver, Tangent, Watch};

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
    watch: &mut dyn Watch,
) -> Result<Found, Failure<P::Broken>> {
    let given = problem.given();
    let mut forces = problem.forces(load, &u).map_err(Failure::Broken)?;
    let mut imbalance = forces.imbalance(given);
    let mut forcing = Forcing::new(settings.tolerance);
    let (mut iterations, mut unsolved) = (0, 0);
    while imbalance > settings.tolerance || imbalance.is_nan() {
        if iterations == settings.newton_iterations {
            return Err(Failure::NotConverged {
                iterations,
                imbalance,
                worst: forces.worst(given),
            });
        }
        let solver = problem.tangent(load, &u).into_shifted(0.0)?;
        iterations += 1;
        if solver.negative_pivots() > 0 {
            return Err(Failure::Indefinite {
                negative_pivots: solver.negative_pivots(),
            });
        }
        let mut step = free_part(&forces.residual, given, -1.0);
        match solver.solve(&mut step, forcing.accuracy(imbalance), watch) {
            Ok(solved) => {
                watch.iterated(solved.iterations);
                let enough = solved.reached || imbalance <= EQUILIBRIUM;
                unsolved = if enough { 0 } else { unsolved + 1 };
                if unsolved == UNSOLVED {
                    if !watch.solved(Method::Newton, imbalance) {
                        return Err(Failure::Stopped);
                    }
                    return Err(Failure::Unsolved {
                        iterations,
                        imbalance,
                        worst: forces.worst(given),
                    });
                }
            }
            Err(down) => {
                watch.iterated(down.iterations);
                return Err(Failure::Indefinite { negative_pivots: 1 });
            }
        }
        let (length, next, next_forces) = match descend(problem, load, &u, &step, &forces) {
            Ok(found) => found,
            // Rounding: the energy no longer tells the states apart.
            Err(Descent::None) if imbalance <= EQUILIBRIUM => break,
            Err(Descent::Broken(broken)) => return Err(Failure::Broken(broken)),
            Err(Descent::None) => {
                return Err(Failure::NoDescent {
                    iterations,
                    imbalance,
                    worst: forces.worst(given),
                });
            }
        };
        let before = imbalance;
        imbalance = next_forces.imbalance(given);
        if !watch.solved(Method::Newton, imbalance) {
            return Err(Failure::Stopped);
        }
        if before <= EQUILIBRIUM && length == 1.0 && imbalance > 0.5 * before {
            // Rounding keeps the residual where it is; the better of the two stays.
            if imbalance < before {
                (u, forces) = (next, next_forces);
            }
            break;
        }
        (u, forces) = (next, next_forces);
    }
    Ok(Found {
        u,
        forces,
        drag_work: 0.0,
        iterations,
    })
}

/// `factor` times the free entries of a vector; zero where a support gives the unknown.
pub fn free_part(vector: &[f64], given: &[bool], factor: f64) -> Vec<f64> {
    vector
        .iter()
        .zip(given)
        .map(|(x, &given)| if given { 0.0 } else { factor * x })
        .collect()
}

enum Descent<B> {
    Broken(B),
    None,
}

/// Goes along a step as far as the energy falls: all of it, or after halvings a part.
fn descend<P: Equilibrium>(
    problem: &P,
    load: &P::Load,
    u: &[f64],
    step: &[f64],
    forces: &Balance,
) -> Result<(f64, Vec<f64>, Balance), Descent<P::Broken>> {
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
    Err(broken.map_or(Descent::None, Descent::Broken))
}
