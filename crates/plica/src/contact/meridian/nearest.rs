//! Local minima of the distance of a point from a Bézier curve.

use super::bezier::{Bezier, Point, dot, minus};
use crate::contact::bernstein::MAX_POINTS;

/// Most coefficients of the polynomial (y − x) · y′ of degree 2p − 1.
const MAX_COEFFICIENTS: usize = 2 * MAX_POINTS - 2;

/// Halvings of the curve after which two minima count as one.
const MAX_HALVINGS: usize = 40;

/// A polynomial in Bernstein form.
type Coefficients = [f64; MAX_COEFFICIENTS];

/// Calls `found` with ξ of every local minimum of the distance between `x` and the curve, in order:
/// every zero of (y − x) · y′ at which it passes from negative to positive. All of them are found,
/// because a polynomial has no more zeros than its Bernstein coefficients have changes of sign.
pub fn local_minima(curve: &Bezier, x: Point, found: &mut impl FnMut(f64)) {
    let (coefficients, count) = slope_of_distance(curve, x);
    isolate(&coefficients, count, [0.0, 1.0], 0, found);
}

/// Returns the Bernstein coefficients of (y − x) · y′, and their number 2p.
fn slope_of_distance(curve: &Bezier, x: Point) -> (Coefficients, usize) {
    let p = curve.degree();
    let mut coefficients = [0.0; MAX_COEFFICIENTS];
    let [outer, inner, product] = [p, p - 1, 2 * p - 1].map(binomials);
    for (i, point) in curve.points().iter().enumerate() {
        let from_x = minus(*point, x);
        for (j, difference) in curve.differences().enumerate() {
            coefficients[i + j] +=
                p as f64 * outer[i] * inner[j] / product[i + j] * dot(from_x, difference);
        }
    }
    (coefficients, 2 * p)
}

/// Returns the binomial coefficients of n.
fn binomials(n: usize) -> [f64; MAX_COEFFICIENTS] {
    let mut row = [0.0; MAX_COEFFICIENTS];
    row[0] = 1.0;
    for k in 1..=n {
        row[k] = row[k - 1] * (n + 1 - k) as f64 / k as f64;
    }
    row
}

fn isolate(
    f: &Coefficients,
    count: usize,
    [from, to]: [f64; 2],
    halvings: usize,
    found: &mut impl FnMut(f64),
) {
    let rises = |f: &[f64]| f[0] < 0.0 && f[f.len() - 1] >= 0.0;
    let used = &f[..count];
    let changes = used
        .windows(2)
        .filter(|pair| (pair[0] < 0.0) != (pair[1] < 0.0))
        .count();
    match changes {
        0 => {}
        1 if !rises(used) => {}
        1 => found(from + (to - from) * zero(used)),
        _ if halvings == MAX_HALVINGS => {
            if rises(used) {
                found(f64::midpoint(from, to));
            }
        }
        _ => {
            let (left, right) = halves(f, count);
            let middle = f64::midpoint(from, to);
            isolate(&left, count, [from, middle], halvings + 1, found);
            isolate(&right, count, [middle, to], halvings + 1, found);
        }
    }
}

fn halves(f: &Coefficients, count: usize) -> (Coefficients, Coefficients) {
    let (mut left, mut right) = (*f, *f);
    for level in (1..count).rev() {
        for i in 0..level {
            right[i] = f64::midpoint(right[i], right[i + 1]);
        }
        left[count - level] = right[0];
    }
    (left, right)
}

/// Returns the only zero of a polynomial that rises from negative to positive: Newton's method, and
/// bisection where that leaves the bracket.
fn zero(f: &[f64]) -> f64 {
    let [mut low, mut high] = [0.0, 1.0];
    let mut xi = f[0] / (f[0] - f[f.len() - 1]);
    for _ in 0..100 {
        let (value, slope) = evaluate(f, xi);
        if value < 0.0 {
            low = xi;
        } else {
            high = xi;
        }
        let mut next = xi - value / slope;
        if !(next > low && next < high) {
            next = f64::midpoint(low, high);
        }
        if (next - xi).abs() <= 1e-16 || next == low || next == high {
            return next;
        }
        xi = next;
    }
    xi
}

/// Returns value and slope of a polynomial.
fn evaluate(f: &[f64], xi: f64) -> (f64, f64) {
    let mut values = [0.0; MAX_COEFFICIENTS];
    values[..f.len()].copy_from_slice(f);
    let degree = f.len() - 1;
    for level in (2..=degree).rev() {
        for i in 0..level {
            values[i] = (1.0 - xi) * values[i] + xi * values[i + 1];
        }
    }
    let slope = degree as f64 * (values[1] - values[0]);
    ((1.0 - xi) * values[0] + xi * values[1], slope)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::meridian::bezier::length;

    fn minima(curve: &Bezier, x: Point) -> Vec<f64> {
        let mut all = vec![];
        local_minima(curve, x, &mut |xi| all.push(xi));
        all
    }

    #[test]
    fn minima_are_those_of_ten_thousand_samples() {
        let mut seed = 1_u64;
        let mut random = || {
            seed = seed
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64
        };
        let mut several = 0;
        for trial in 0..300 {
            let curve = Bezier::new((0..2 + trial % 5).map(|_| [random(), random()]));
            let x = [random(), random()];
            let distance = |i: usize| length(minus(curve.at(i as f64 / 1e4).position, x));
            let sampled: Vec<f64> = (1..10_000)
                .filter(|&i| distance(i) < distance(i - 1) && distance(i) <= distance(i + 1))
                .map(|i| i as f64 / 1e4)
                .collect();
            let found = minima(&curve, x);
            assert_eq!(found.len(), sampled.len(), "{trial}: {found:?} {sampled:?}");
            several += usize::from(found.len() > 1);
            for (found, sampled) in found.iter().zip(&sampled) {
                assert!((found - sampled).abs() < 2e-4, "{trial}: {found} {sampled}");
                let at = curve.at(*found);
                assert!(dot(minus(at.position, x), at.slope).abs() < 1e-13);
            }
        }
        assert!(several > 5, "{several}");
    }

    #[test]
    fn a_point_of_a_straight_curve_is_nearest_to_itself() {
        let line = Bezier::new([[0.0, 0.5], [0.1, 0.5], [0.2, 0.5], [0.3, 0.5]]);
        let found = minima(&line, [0.12, 0.5]);
        assert_eq!(found.len(), 1);
        assert!((found[0] - 0.4).abs() < 1e-15);
        assert!(minima(&line, [-0.1, 0.5]).is_empty());
    }
}
