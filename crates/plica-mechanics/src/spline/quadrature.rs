//! Quadrature: Gauss–Legendre rules, and reduced rules of about one point per element.

use super::Basis;
use super::transfer::solve;

/// Returns points, rising, and weights of the n-point Gauss–Legendre rule on [0, 1]; exact for
/// polynomials of degree 2n − 1, and symmetric about ½ to the last bit.
pub fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    let mut rule = vec![(0.5, 0.0); n];
    for i in 0..n.div_ceil(2) {
        // Newton's method for the roots of the Legendre polynomial P_n.
        let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..50 {
            let (mut p0, mut p1) = (1.0, x);
            for k in 2..=n {
                let k = k as f64;
                (p0, p1) = (p1, ((2.0 * k - 1.0) * x * p1 - (k - 1.0) * p0) / k);
            }
            slope = n as f64 * (x * p1 - p0) / (x * x - 1.0);
            let step = p1 / slope;
            x -= step;
            if step.abs() < 1e-16 {
                break;
            }
        }
        if 2 * i + 1 == n {
            x = 0.0;
        }
        let weight = 1.0 / ((1.0 - x * x) * slope * slope);
        rule[i] = (0.5 - 0.5 * x, weight);
        rule[n - 1 - i] = (0.5 + 0.5 * x, weight);
    }
    rule
}

/// Returns points and weights, element by element on [0, 1], of a rule with about one point per element
/// of uniform open splines of degree p; None unless p is 3 or 5.
///
/// It has as many points as splines of degree p − 1 have functions: more constraints on a slope would
/// lock. It integrates splines of degree p with knots of multiplicity two exactly, among them slopes
/// times R, so that a uniform stress has exact forces. Points and weights are the nearest to the
/// Greville rule of degree p − 1, by Newton steps of minimal norm. (The rules of Hughes et al. 2010
/// have as few points as exactness allows.)
pub fn reduced_rule(p: usize, elements: usize) -> Option<Vec<Vec<(f64, f64)>>> {
    if ![3, 5].contains(&p) {
        return None;
    }
    // In lengths of an element, so that rounding does not depend on the position of the wall.
    let breakpoints: Vec<f64> = (0..=elements).map(|e| e as f64).collect();
    let lower = Basis::open(p - 1, &breakpoints);
    let target = Basis::with_multiplicities(p, &breakpoints, &vec![2; elements - 1]);
    let integrals = target.integrals();
    let (mut points, mut weights) = (lower.greville(), lower.integrals());
    for _ in 0..RULE_STEPS {
        let mut residual = rule_residual(&target, &integrals, &points, &weights);
        if residual.iter().all(|r| r.abs() < RULE_ERROR) {
            break;
        }
        newton_step(&target, &mut residual, &mut points, &mut weights);
    }
    let residual = rule_residual(&target, &integrals, &points, &weights);
    let exact = residual.iter().all(|r| r.abs() < RULE_ERROR);
    let mut rule = vec![vec![]; elements];
    for (&x, &w) in points.iter().zip(&weights) {
        let e = lower.find(x);
        rule[e].push((x - e as f64, w));
    }
    let valid = weights.iter().all(|w| *w > 0.0) && rule.iter().all(|rule| rule.len() <= p + 1);
    (exact && valid).then_some(rule)
}

/// Largest number of Newton steps; five suffice.
const RULE_STEPS: usize = 30;
/// Error of the integral of a function, in lengths of an element, that counts as rounding.
const RULE_ERROR: f64 = 1e-12;

/// Returns r_j = Σ_i w_i B_j(x_i) − ∫ B_j.
fn rule_residual(target: &Basis, integrals: &[f64], points: &[f64], weights: &[f64]) -> Vec<f64> {
    let mut residual: Vec<f64> = integrals.iter().map(|integral| -integral).collect();
    for (&x, w) in points.iter().zip(weights) {
        let at = target.evaluate(x);
        for (a, value) in at.value.iter().enumerate() {
            residual[at.first + a] += w * value;
        }
    }
    residual
}

/// Applies the Newton step of minimal norm in x and w, −Jᵀ (J Jᵀ)⁻¹ r. Overwrites the residual r.
fn newton_step(target: &Basis, residual: &mut [f64], points: &mut [f64], weights: &mut [f64]) {
    let p = target.degree();
    let mut matrix = vec![vec![0.0; 2 * p + 1]; residual.len()];
    let at: Vec<_> = points.iter().map(|&x| target.evaluate(x)).collect();
    for (at, w) in at.iter().zip(weights.iter()) {
        for (a, (value, slope)) in at.value.iter().zip(&at.slope).enumerate() {
            for (b, (other, other_slope)) in at.value.iter().zip(&at.slope).enumerate() {
                matrix[at.first + a][p + b - a] += value * other + w * w * slope * other_slope;
            }
        }
    }
    solve(&mut matrix, residual, p, 1);
    let end = target.element(target.elements() - 1).1;
    for (i, at) in at.iter().enumerate() {
        let sum = |of: &[f64]| -> f64 {
            let values = of.iter().zip(&residual[at.first..]);
            values.map(|(b, y)| b * y).sum()
        };
        points[i] = (points[i] - weights[i] * sum(&at.slope)).clamp(0.0, end);
        weights[i] -= sum(&at.value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reduced_rule_integrates_polynomials_of_its_degree() {
        for p in [3, 5] {
            for elements in 1..=61 {
                let rule = reduced_rule(p, elements).unwrap();
                let points: Vec<(f64, f64)> = rule
                    .iter()
                    .enumerate()
                    .flat_map(|(e, rule)| rule.iter().map(move |&(x, w)| (e as f64 + x, w)))
                    .collect();
                assert_eq!(points.len(), elements + p - 1);
                let length = elements as f64;
                for power in 0..=p as i32 {
                    let sum: f64 = points
                        .iter()
                        .map(|(x, w)| w * (x / length).powi(power))
                        .sum();
                    let exact = length / (f64::from(power) + 1.0);
                    assert!((sum / exact - 1.0).abs() < 1e-12, "{p} {power}");
                }
            }
        }
        assert!([1, 2, 4].iter().all(|&p| reduced_rule(p, 3).is_none()));
    }

    #[test]
    fn a_gauss_rule_integrates_polynomials_exactly() {
        for n in 1..=6 {
            for degree in 0..2 * n {
                let sum: f64 = gauss_legendre(n)
                    .iter()
                    .map(|(x, w)| w * x.powi(degree as i32))
                    .sum();
                assert!(
                    (sum - 1.0 / (degree as f64 + 1.0)).abs() < 1e-14,
                    "{n} points"
                );
            }
        }
    }
}
