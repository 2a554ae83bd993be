//! Preconditioned conjugate gradients for matrices that may turn out to be indefinite (Hestenes and
//! Stiefel 1952, truncated as in Steihaug 1983).

use super::operator::{Operator, add, dot, project};
use super::tangent::{NegativeCurvature, Solved};
use crate::monitor::Monitor;

/// Decrease of the energy in one iteration, relative to that in all before, at which rounding takes
/// over.
const IDLE: f64 = f64::EPSILON * f64::EPSILON;
/// Successive iterations without a larger decrease after which the method has stagnated.
const IDLE_ITERATIONS: usize = 10;

/// Solves A x = b in place for the free unknowns; the other entries of `b` stay as they are. Each
/// iteration applies A and M⁻¹ once.
///
/// The iteration stops when the Euclidean norm of the residual is at most `accuracy` times that of b.
/// To first order, the residual of A Δu = −R is the R that is left after the step. It also stops after
/// `iterations`, when the monitor cancels, when rounding hides all progress, and at NaN. Each iterate x
/// is the minimum of ½ x · A x − b · x over all directions so far; hence b · x > 0, and the energy
/// decreases along x.
///
/// β is that of Polak and Ribière, z · (r − r₋)/(z₋ · r₋), which tolerates rounding and an M that varies
/// slightly (Golub and Ye 1999); r − r₋ is a multiple of A p.
///
/// # Errors
///
/// At the first direction p with p · A p ≤ 0; `b` then holds the iterate so far.
pub fn conjugate_gradients<O: Operator>(
    operator: &O,
    b: &mut [f64],
    accuracy: f64,
    iterations: usize,
    monitor: &dyn Monitor,
) -> Result<Solved, NegativeCurvature> {
    let mut r = b.to_vec();
    project(operator, &mut r);
    let mut x = vec![0.0; b.len()];
    let outcome = iterate(operator, &mut r, &mut x, accuracy, iterations, monitor);
    for ((b, x), &prescribed) in b.iter_mut().zip(x).zip(operator.prescribed()) {
        if !prescribed {
            *b = x;
        }
    }
    outcome
}

/// Iterates from x = 0 and r = b.
fn iterate<O: Operator>(
    operator: &O,
    r: &mut [f64],
    x: &mut [f64],
    accuracy: f64,
    limit: usize,
    monitor: &dyn Monitor,
) -> Result<Solved, NegativeCurvature> {
    let size = dot(r, r).sqrt();
    let target = accuracy * size;
    let ended = |iterations, converged| {
        Ok(Solved {
            iterations,
            converged,
        })
    };
    if size == 0.0 {
        return ended(0, true);
    }
    let [mut z, mut Ap] = [vec![0.0; r.len()], vec![0.0; r.len()]];
    operator.precondition(r, &mut z);
    project(operator, &mut z);
    let mut p = z.clone();
    let mut rho = dot(r, &z);
    let (mut decrease, mut idle) = (0.0, 0);
    for done in 0..limit {
        if rho.is_nan() || rho <= 0.0 || idle >= IDLE_ITERATIONS {
            return ended(done, false);
        }
        operator.apply(&p, &mut Ap);
        project(operator, &mut Ap);
        let pAp = dot(&p, &Ap);
        if pAp <= 0.0 {
            operator.metric(&p, &mut z);
            return Err(NegativeCurvature {
                curvature: pAp / dot(&p, &z),
                direction: p,
                iterations: done + 1,
            });
        }
        let length = rho / pAp;
        if !length.is_finite() {
            return ended(done + 1, false);
        }
        add(length, &p, x);
        add(-length, &Ap, r);
        let converged = dot(r, r).sqrt() <= target;
        if converged || monitor.is_cancelled() {
            return ended(done + 1, converged);
        }
        // Twice the decrease of ½ x · A x − b · x in this iteration.
        let latest = length * rho;
        decrease += latest;
        idle = if latest <= IDLE * decrease {
            idle + 1
        } else {
            0
        };
        operator.precondition(r, &mut z);
        project(operator, &mut z);
        let beta = (-length * dot(&z, &Ap) / rho).max(0.0);
        rho = dot(r, &z);
        for (p, z) in p.iter_mut().zip(&z) {
            *p = z + beta * *p;
        }
    }
    ended(limit, false)
}

#[cfg(test)]
mod tests {
    use super::super::reflected::Reflected;
    use super::*;
    use std::cell::Cell;

    fn residual(operator: &Reflected, x: &[f64], b: &[f64]) -> f64 {
        let mut r = vec![0.0; b.len()];
        operator.apply(x, &mut r);
        add(-1.0, b, &mut r);
        (dot(&r, &r) / dot(b, b)).sqrt()
    }

    fn waves(n: usize) -> Vec<f64> {
        (0..n).map(|i| (0.7 * i as f64 * i as f64).sin()).collect()
    }

    #[test]
    fn a_positive_definite_system_is_solved_to_the_required_accuracy() {
        let spectrum: Vec<f64> = (0..120)
            .map(|i| 10_f64.powf(i as f64 / 20.0 - 3.0))
            .collect();
        let operator = Reflected::new(&spectrum, 3.0);
        let mut before = 0;
        for accuracy in [1e-1, 1e-4, 1e-8] {
            let b = waves(120);
            let mut x = b.clone();
            let taken = conjugate_gradients(&operator, &mut x, accuracy, 1000, &()).unwrap();
            let left = residual(&operator, &x, &b);
            assert!(left <= 1.01 * accuracy, "{accuracy}: {left}");
            // M is within a factor 3 of A.
            let Solved {
                iterations,
                converged,
            } = taken;
            assert!(converged && iterations > before, "{accuracy}: {taken:?}");
            assert!(iterations < 60, "{accuracy}: {taken:?}");
            before = iterations;
        }
    }

    #[test]
    fn iterations_do_not_exceed_the_number_of_distinct_eigenvalues() {
        let spectrum: Vec<f64> = (0..50).map(|i| [0.1, 2.0, 30.0][i % 3]).collect();
        let operator = Reflected::with_preconditioner(&spectrum, vec![1.0; 50]);
        let mut x = waves(50);
        let taken = conjugate_gradients(&operator, &mut x, 1e-10, 1000, &()).unwrap();
        let expected = Solved {
            iterations: 3,
            converged: true,
        };
        assert_eq!(taken, expected);
    }

    #[test]
    fn the_energy_decreases_along_truncated_solutions() {
        let spectrum: Vec<f64> = (0..80).map(|i| 1e-2 * 1.15_f64.powi(i)).collect();
        let operator = Reflected::new(&spectrum, 10.0);
        let b = waves(80);
        let mut energies = vec![0.0];
        for iterations in 1..6 {
            let mut x = b.clone();
            let taken = conjugate_gradients(&operator, &mut x, 1e-12, iterations, &()).unwrap();
            let cut_off = Solved {
                iterations,
                converged: false,
            };
            assert_eq!(taken, cut_off);
            assert!(dot(&b, &x) > 0.0);
            let mut Ax = vec![0.0; 80];
            operator.apply(&x, &mut Ax);
            energies.push(0.5 * dot(&x, &Ax) - dot(&b, &x));
        }
        assert!(energies.windows(2).all(|e| e[1] < e[0]), "{energies:?}");
    }

    /// Cancels after a number of iterations.
    struct CancelAfter(Cell<usize>);

    impl Monitor for CancelAfter {
        fn is_cancelled(&self) -> bool {
            self.0.set(self.0.get() - 1);
            self.0.get() == 0
        }
    }

    #[test]
    fn a_solve_stops_when_the_monitor_cancels() {
        let spectrum: Vec<f64> = (0..80).map(|i| 1e-2 * 1.15_f64.powi(i)).collect();
        let operator = Reflected::new(&spectrum, 10.0);
        let solved = |iterations: usize, monitor: &dyn Monitor| {
            let mut x = waves(80);
            let taken = conjugate_gradients(&operator, &mut x, 1e-12, iterations, monitor);
            (taken.unwrap(), x)
        };
        assert!(solved(1000, &()).0.iterations > 30);
        assert_eq!(solved(1000, &CancelAfter(Cell::new(3))), solved(3, &()));
    }

    #[test]
    fn negative_curvature_is_found_and_measured_in_the_metric() {
        let mut spectrum: Vec<f64> = (0..100).map(|i| 0.1 + i as f64).collect();
        spectrum[40] = -0.5;
        let operator = Reflected::new(&spectrum, 2.0);
        let b = waves(100);
        let mut x = b.clone();
        let met = conjugate_gradients(&operator, &mut x, 1e-8, 1000, &()).unwrap_err();
        let [mut Ad, mut Cd] = [vec![0.0; 100], vec![0.0; 100]];
        let d = &met.direction;
        operator.apply(d, &mut Ad);
        operator.metric(d, &mut Cd);
        assert_eq!(met.curvature, dot(d, &Ad) / dot(d, &Cd));
        // No Rayleigh quotient is below the lowest eigenvalue.
        assert!((-0.5..=0.0).contains(&met.curvature), "{}", met.curvature);
        // The energy decreases along d, too.
        assert!(dot(d, &b) > 0.0);
        assert!(dot(&x, &b) >= 0.0);
    }

    #[test]
    fn a_consistent_singular_system_is_solved() {
        let mut spectrum: Vec<f64> = (0..100).map(|i| 1.0 + i as f64).collect();
        spectrum[3] = 0.0;
        let operator = Reflected::new(&spectrum, 2.0);
        let mut b = vec![0.0; 100];
        operator.apply(&waves(100), &mut b);
        let mut x = b.clone();
        conjugate_gradients(&operator, &mut x, 1e-9, 1000, &()).unwrap();
        assert!(residual(&operator, &x, &b) < 1.01e-9);
    }

    #[test]
    fn prescribed_unknowns_stay_as_they_are() {
        let spectrum: Vec<f64> = (0..30).map(|i| 1.0 + i as f64).collect();
        let mut operator = Reflected::new(&spectrum, 2.0);
        for i in [0, 7, 29] {
            operator.prescribed[i] = true;
        }
        let b = waves(30);
        let mut x = b.clone();
        conjugate_gradients(&operator, &mut x, 1e-12, 1000, &()).unwrap();
        for i in [0, 7, 29] {
            assert_eq!(x[i], b[i]);
            x[i] = 0.0;
        }
        let mut r = vec![0.0; 30];
        operator.apply(&x, &mut r);
        for i in 0..30 {
            assert!(operator.prescribed[i] || (r[i] - b[i]).abs() < 1e-10);
        }
    }

    #[test]
    fn the_solution_is_orthogonal_to_constrained_combinations() {
        let spectrum: Vec<f64> = (0..30).map(|i| 1.0 + i as f64).collect();
        let mut operator = Reflected::new(&spectrum, 2.0);
        operator.prescribed[7] = true;
        let wave = |i| if i == 7 { 0.0 } else { 1.0 / 29.0_f64.sqrt() };
        let pinned: Vec<f64> = (0..30).map(wave).collect();
        operator.pinned = Some(pinned.clone());
        let b = waves(30);
        let mut x = b.clone();
        conjugate_gradients(&operator, &mut x, 1e-12, 1000, &()).unwrap();
        assert_eq!(x[7], b[7]);
        x[7] = 0.0;
        assert!(dot(&x, &pinned).abs() < 1e-13);
        // The residual is the force of the constraint.
        let mut r = vec![0.0; 30];
        operator.apply(&x, &mut r);
        add(-1.0, &b, &mut r);
        assert!(dot(&r, &pinned).abs() > 0.1);
        project(&operator, &mut r);
        assert!(r.iter().all(|r| r.abs() < 1e-10));
    }

    #[test]
    fn the_iteration_ends_at_zero_at_rounding_and_at_nan() {
        let operator = Reflected::new(&[1.0, 2.0, 3.0, 400.0, 1e-3], 2.0);
        // Zero.
        let mut x = vec![0.0; 5];
        assert_eq!(
            conjugate_gradients(&operator, &mut x, 1e-3, 1000, &()),
            Ok(Solved {
                iterations: 0,
                converged: true
            })
        );
        // A higher accuracy than rounding permits.
        let mut x = waves(5);
        let taken = conjugate_gradients(&operator, &mut x, 0.0, 1000, &()).unwrap();
        assert!(taken.iterations < 100 && !taken.converged, "{taken:?}");
        let left = residual(&operator, &x, &waves(5));
        assert!(left < 1e-9, "{taken:?}: {left:e}");
        // NaN.
        let mut x = vec![1.0, f64::NAN, 0.0, 0.0, 0.0];
        assert_eq!(
            conjugate_gradients(&operator, &mut x, 1e-3, 1000, &()),
            Ok(Solved {
                iterations: 0,
                converged: false
            })
        );
        assert_eq!(x, [0.0; 5]);
    }
}
