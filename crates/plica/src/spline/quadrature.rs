//! Quadrature: Gauss's rule, and one with about a point to an element.

use super::Basis;
use super::transfer::solve;

/// Points and weights of the n-point Gauss–Legendre rule on [0, 1], rising; exact for polynomials
/// of degree 2n − 1. The rule is symmetric about ½ to the last bit.
pub fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    let mut rule = vec![(0.5, 0.0); n];
    for i in 0..n.div_ceil(2) {
        // Newton on the Legendre polynomial P_n from Chebyshev's guess.
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

/// About one point to an element, as many as splines of degree p − 1 have functions: at no more places can
/// something be asked of a slope of splines of degree p without asking too much. Element by element, on
/// [0, 1] of it; none if p is even, or where no such rule with positive weights was found.
///
/// The rule integrates splines of degree p exactly that are one derivative less smooth than they could be:
/// slopes of such times R, so that an even stress meets its forces (in the middle of a uniform mesh the
/// middles of elements do, if p is odd). Points and weights are the nearest to Greville's for degree p − 1
/// that do: Newton's steps of the smallest size. (Hughes et al. 2010 look for such rules with as few points
/// as exactness allows; here there are more, as many as a slope through the wall may be asked at.)
pub fn reduced_rule(basis: &Basis) -> Option<Vec<Vec<(f64, f64)>>> {
    let (p, elements) = (basis.degree(), basis.elements());
    if p % 2 == 0 {
        return None;
    }
    if p == 1 {
        return Some(vec![vec![(0.5, 1.0)]; elements]);
    }
    let mut breakpoints: Vec<f64> = (0..elements).map(|e| basis.element(e).0).collect();
    breakpoints.push(basis.element(elements - 1).1);
    let lower = Basis::open(p - 1, &breakpoints);
    let target = Basis::less_smooth(p, 2, &breakpoints);
    let integrals = target.integrals();
    let (mut points, mut weights) = (lower.greville(), lower.integrals());
    for _ in 0..RULE_STEPS {
        // r_j = Σ_i w_i B_j(x_i) − ∫ B_j, and J Jᵀ over steps of x_i and w_i in lengths of elements.
        let mut left: Vec<f64> = integrals.iter().map(|integral| -integral).collect();
        let mut matrix = vec![vec![0.0; 2 * p + 1]; left.len()];
        let at: Vec<_> = points.iter().map(|&x| target.evaluate(x)).collect();
        let scales: Vec<f64> = points
            .iter()
            .map(|&x| {
                let (start, end) = lower.element(lower.find(x));
                end - start
            })
            .collect();
        for (i, at) in at.iter().enumerate() {
            for (a, (value, slope)) in at.value.iter().zip(&at.slope).enumerate() {
                left[at.element + a] += weights[i] * value;
                for (b, (other, other_slope)) in at.value.iter().zip(&at.slope).enumerate() {
                    let moved = weights[i] * weights[i] * slope * other_slope;
                    matrix[at.element + a][p + b - a] +=
                        scales[i] * scales[i] * (value * other + moved);
                }
            }
        }
        let largest = integrals.iter().fold(0.0_f64, |most, x| most.max(*x));
        let off = left.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        if off < 1e-15 * largest.max(1e-300) * 10.0 {
            break;
        }
        solve(&mut matrix, &mut left, p, 1);
        let (first, last) = (breakpoints[0], breakpoints[elements]);
        for (i, at) in at.iter().enumerate() {
            let scale = scales[i] * scales[i];
            let sum = |of: &[f64]| -> f64 {
                let values = of.iter().zip(&left[at.element..]);
                values.map(|(b, y)| b * y).sum()
            };
            let moved = scale * weights[i] * sum(&at.slope);
            weights[i] -= scale * sum(&at.value);
            points[i] = (points[i] - moved).clamp(first, last);
        }
    }
    let mut off: Vec<f64> = integrals.iter().map(|integral| -integral).collect();
    for (&x, w) in points.iter().zip(&weights) {
        let at = target.evaluate(x);
        for (a, value) in at.value.iter().enumerate() {
            off[at.element + a] += w * value;
        }
    }
    let exact = off
        .iter()
        .zip(&integrals)
        .all(|(off, integral)| off.abs() < 1e-12 * integral);
    let mut rule = vec![vec![]; elements];
    for (&x, &w) in points.iter().zip(&weights) {
        let e = lower.find(x);
        let (start, end) = lower.element(e);
        rule[e].push(((x - start) / (end - start), w / (end - start)));
    }
    let sound = weights.iter().all(|w| *w > 0.0) && rule.iter().all(|rule| rule.len() <= p + 1);
    (exact && sound).then_some(rule)
}

/// Newton's steps towards a rule, of which five are many.
const RULE_STEPS: usize = 30;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reduced_rule_integrates_polynomials_of_its_degree() {
        let breakpoints = [0.0, 0.1, 0.25, 0.5, 0.8, 1.0];
        for p in [1, 3, 5] {
            let basis = Basis::open(p, &breakpoints);
            let rule = reduced_rule(&basis).unwrap();
            let points: Vec<(f64, f64)> = rule
                .iter()
                .enumerate()
                .flat_map(|(e, rule)| {
                    let (start, end) = basis.element(e);
                    let place =
                        move |&(x, w): &(f64, f64)| (start + (end - start) * x, (end - start) * w);
                    rule.iter().map(place)
                })
                .collect();
            assert_eq!(points.len(), basis.functions() - 1);
            assert!(rule.iter().all(|rule| rule.len() <= p + 1));
            assert!(points.iter().all(|(_, w)| *w > 0.0), "{points:?}");
            for power in 0..=p {
                let sum: f64 = points.iter().map(|(x, w)| w * x.powi(power as i32)).sum();
                assert!(
                    (sum - 1.0 / (power as f64 + 1.0)).abs() < 1e-13,
                    "{p} {power}"
                );
            }
        }
    }

    #[test]
    fn polynomials_are_integrated_exactly() {
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
