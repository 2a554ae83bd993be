//! Conjugate gradients with a preconditioner, for matrices that are near positive definite and may
//! turn out not to be (Hestenes and Stiefel 1952; the truncation is Steihaug's, 1983).

use super::operator::{Operator, add, dot, hold};
use super::{Monitor, NegativeCurvature, Solved};

/// What a step adds to the fall of the energy, relative to all before, where rounding takes over.
const IDLE: f64 = f64::EPSILON * f64::EPSILON;
/// Steps in a row that add no more, after which the iteration has stagnated.
const IDLE_STEPS: usize = 10;

/// Solves A x = b in place for the free unknowns; the other entries of `b` stay as they are.
/// Each iteration applies A and M⁻¹ once.
///
/// It stops when the Euclidean norm of the residual is at most `accuracy` times that of b. That is
/// the norm in which a state is accepted: to first order, the residual of A Δu = −R is what is left
/// of R after the step. Short of that it stops after `iterations`, where the watch says so, where
/// rounding hides all progress, and where a number is no longer one. What it then leaves in `b` is
/// still of use: each iterate x is the minimum of ½ x · A x − b · x over all directions so far,
/// hence b · x > 0, and along x the energy falls.
///
/// β is that of Polak and Ribière, z · (r − r₋)/(z₋ · r₋), which forgives an M that is not quite
/// the same each time, and rounding (Golub and Ye 1999); r − r₋ is a multiple of A p, at hand.
///
/// # Errors
///
/// At the first direction p with p · A p ≤ 0. The iterate so far is left in `b`.
pub fn conjugate_gradients<O: Operator>(
    operator: &O,
    b: &mut [f64],
    accuracy: f64,
    iterations: usize,
    monitor: &mut dyn Monitor,
) -> Result<Solved, NegativeCurvature> {
    let prescribed = operator.prescribed();
    let mut r = b.to_vec();
    hold(operator, &mut r);
    let mut x = vec![0.0; b.len()];
    let outcome = iterate(operator, &mut r, &mut x, accuracy, iterations, monitor);
    for i in 0..b.len() {
        if !prescribed[i] {
            b[i] = x[i];
        }
    }
    outcome
}

/// From x = 0 and r = b.
fn iterate<O: Operator>(
    operator: &O,
    r: &mut [f64],
    x: &mut [f64],
    accuracy: f64,
    iterations: usize,
    monitor: &mut dyn Monitor,
) -> Result<Solved, NegativeCurvature> {
    let size = dot(r, r).sqrt();
    let target = accuracy * size;
    let ended = |iterations, reached| {
        Ok(Solved {
            iterations,
            reached,
        })
    };
    if size == 0.0 {
        return ended(0, true);
    }
    let [mut z, mut Ap] = [vec![0.0; r.len()], vec![0.0; r.len()]];
    operator.precondition(r, &mut z);
    hold(operator, &mut z);
    let mut p = z.clone();
    let mut rho = dot(r, &z);
    let (mut fall, mut idle_steps) = (0.0, 0);
    for done in 0..iterations {
        // Not a number is not positive.
        if rho.is_nan() || rho <= 0.0 || idle_steps >= IDLE_STEPS {
            return ended(done, false);
        }
        operator.apply(&p, &mut Ap);
        hold(operator, &mut Ap);
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
        let reached = dot(r, r).sqrt() <= target;
        if reached || !monitor.iterating() {
            return ended(done + 1, reached);
        }
        // Twice what ½ x · A x − b · x falls by.
        let step_fall = length * rho;
        fall += step_fall;
        idle_steps = if step_fall <= IDLE * fall {
            idle_steps + 1
        } else {
            0
        };
        operator.precondition(r, &mut z);
        hold(operator, &mut z);
        let beta = (-length * dot(&z, &Ap) / rho).max(0.0);
        rho = dot(r, &z);
        for (p, z) in p.iter_mut().zip(&z) {
            *p = z + beta * *p;
        }
    }
    ended(iterations, false)
}

#[cfg(test)]
mod tests {
    use super::super::{Method, reflected::Reflected};
    use super::*;

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
    fn a_positive_definite_system_is_solved_to_the_accuracy_asked_for() {
        let spectrum: Vec<f64> = (0..120)
            .map(|i| 10_f64.powf(i as f64 / 20.0 - 3.0))
            .collect();
        let operator = Reflected::new(&spectrum, 3.0);
        let mut before = 0;
        for accuracy in [1e-1, 1e-4, 1e-8] {
            let b = waves(120);
            let mut x = b.clone();
            let taken = conjugate_gradients(&operator, &mut x, accuracy, 1000, &mut ()).unwrap();
            let left = residual(&operator, &x, &b);
            assert!(left <= 1.01 * accuracy, "{accuracy}: {left}");
            // No more than asked for, and quickly: M is within a factor 3 of A.
            let Solved {
                iterations,
                reached,
            } = taken;
            assert!(reached && iterations > before, "{accuracy}: {taken:?}");
            assert!(iterations < 60, "{accuracy}: {taken:?}");
            before = iterations;
        }
    }

    #[test]
    fn as_many_iterations_as_there_are_different_eigenvalues_are_enough() {
        let spectrum: Vec<f64> = (0..50).map(|i| [0.1, 2.0, 30.0][i % 3]).collect();
        let operator = Reflected::with_preconditioner(&spectrum, vec![1.0; 50]);
        let mut x = waves(50);
        let taken = conjugate_gradients(&operator, &mut x, 1e-10, 1000, &mut ()).unwrap();
        let expected = Solved {
            iterations: 3,
            reached: true,
        };
        assert_eq!(taken, expected);
    }

    #[test]
    fn a_truncated_solution_leads_down() {
        let spectrum: Vec<f64> = (0..80).map(|i| 1e-2 * 1.15_f64.powi(i)).collect();
        let operator = Reflected::new(&spectrum, 10.0);
        let b = waves(80);
        let mut energies = vec![0.0];
        for iterations in 1..6 {
            let mut x = b.clone();
            let taken = conjugate_gradients(&operator, &mut x, 1e-12, iterations, &mut ()).unwrap();
            let cut_off = Solved {
                iterations,
                reached: false,
            };
            assert_eq!(taken, cut_off);
            assert!(dot(&b, &x) > 0.0);
            let mut Ax = vec![0.0; 80];
            operator.apply(&x, &mut Ax);
            energies.push(0.5 * dot(&x, &Ax) - dot(&b, &x));
        }
        assert!(energies.windows(2).all(|e| e[1] < e[0]), "{energies:?}");
    }

    /// Someone who wants no more than so many iterations.
    struct Stops(usize);

    impl Monitor for Stops {
        fn solved(&mut self, _: Method, _: f64) -> bool {
            self.0 > 0
        }
        fn iterating(&mut self) -> bool {
            self.0 -= 1;
            self.0 > 0
        }
    }

    #[test]
    fn a_long_solve_is_cut_off_when_the_watch_says_so() {
        let spectrum: Vec<f64> = (0..80).map(|i| 1e-2 * 1.15_f64.powi(i)).collect();
        let operator = Reflected::new(&spectrum, 10.0);
        let solved = |iterations: usize, monitor: &mut dyn Monitor| {
            let mut x = waves(80);
            let taken = conjugate_gradients(&operator, &mut x, 1e-12, iterations, monitor);
            (taken.unwrap(), x)
        };
        assert!(solved(1000, &mut ()).0.iterations > 30);
        assert_eq!(solved(1000, &mut Stops(3)), solved(3, &mut ()));
    }

    #[test]
    fn negative_curvature_is_met_and_measured_in_the_metric() {
        let mut spectrum: Vec<f64> = (0..100).map(|i| 0.1 + i as f64).collect();
        spectrum[40] = -0.5;
        let operator = Reflected::new(&spectrum, 2.0);
        let b = waves(100);
        let mut x = b.clone();
        let down = conjugate_gradients(&operator, &mut x, 1e-8, 1000, &mut ()).unwrap_err();
        let [mut Ad, mut Cd] = [vec![0.0; 100], vec![0.0; 100]];
        let d = &down.direction;
        operator.apply(d, &mut Ad);
        operator.metric(d, &mut Cd);
        assert_eq!(down.curvature, dot(d, &Ad) / dot(d, &Cd));
        // No Rayleigh quotient is below the lowest eigenvalue.
        assert!((-0.5..=0.0).contains(&down.curvature), "{}", down.curvature);
        // The energy falls along d, too.
        assert!(dot(d, &b) > 0.0);
        assert!(dot(&x, &b) >= 0.0);
    }

    #[test]
    fn a_singular_system_that_has_a_solution_is_solved() {
        let mut spectrum: Vec<f64> = (0..100).map(|i| 1.0 + i as f64).collect();
        spectrum[3] = 0.0;
        let operator = Reflected::new(&spectrum, 2.0);
        let mut b = vec![0.0; 100];
        operator.apply(&waves(100), &mut b);
        let mut x = b.clone();
        conjugate_gradients(&operator, &mut x, 1e-9, 1000, &mut ()).unwrap();
        assert!(residual(&operator, &x, &b) < 1.01e-9);
    }

    #[test]
    fn given_unknowns_take_no_part() {
        let spectrum: Vec<f64> = (0..30).map(|i| 1.0 + i as f64).collect();
        let mut operator = Reflected::new(&spectrum, 2.0);
        for i in [0, 7, 29] {
            operator.prescribed[i] = true;
        }
        let b = waves(30);
        let mut x = b.clone();
        conjugate_gradients(&operator, &mut x, 1e-12, 1000, &mut ()).unwrap();
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
    fn what_is_pinned_takes_no_part() {
        let spectrum: Vec<f64> = (0..30).map(|i| 1.0 + i as f64).collect();
        let mut operator = Reflected::new(&spectrum, 2.0);
        operator.prescribed[7] = true;
        let wave = |i| if i == 7 { 0.0 } else { 1.0 / 29.0_f64.sqrt() };
        let pinned: Vec<f64> = (0..30).map(wave).collect();
        operator.pinned = Some(pinned.clone());
        let b = waves(30);
        let mut x = b.clone();
        conjugate_gradients(&operator, &mut x, 1e-12, 1000, &mut ()).unwrap();
        assert_eq!(x[7], b[7]);
        x[7] = 0.0;
        assert!(dot(&x, &pinned).abs() < 1e-13);
        // What is left is what the pin carries.
        let mut r = vec![0.0; 30];
        operator.apply(&x, &mut r);
        add(-1.0, &b, &mut r);
        assert!(dot(&r, &pinned).abs() > 0.1);
        hold(&operator, &mut r);
        assert!(r.iter().all(|r| r.abs() < 1e-10));
    }

    #[test]
    fn it_ends_where_there_is_nothing_to_gain() {
        let operator = Reflected::new(&[1.0, 2.0, 3.0, 400.0, 1e-3], 2.0);
        // Nothing to solve.
        let mut x = vec![0.0; 5];
        assert_eq!(
            conjugate_gradients(&operator, &mut x, 1e-3, 1000, &mut ()),
            Ok(Solved {
                iterations: 0,
                reached: true
            })
        );
        // More asked for than rounding allows.
        let mut x = waves(5);
        let taken = conjugate_gradients(&operator, &mut x, 0.0, 1000, &mut ()).unwrap();
        assert!(taken.iterations < 100 && !taken.reached, "{taken:?}");
        let left = residual(&operator, &x, &waves(5));
        assert!(left < 1e-9, "{taken:?}: {left:e}");
        // Not a number.
        let mut x = vec![1.0, f64::NAN, 0.0, 0.0, 0.0];
        assert_eq!(
            conjugate_gradients(&operator, &mut x, 1e-3, 1000, &mut ()),
            Ok(Solved {
                iterations: 0,
                reached: false
            })
        );
        assert_eq!(x, [0.0; 5]);
    }
}
