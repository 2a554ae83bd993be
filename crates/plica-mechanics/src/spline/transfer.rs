//! Transfer of splines from one basis to another.

use super::Basis;

/// Returns the control values on `to` of the spline with `values` on `from`, `width` numbers per
/// function. Both bases are open and of the same interval.
///
/// The new spline interpolates the old one at its Greville abscissae. It is the same curve if the new
/// basis contains it, as when knots are inserted. Equal bases keep the values to the bit.
pub fn transfer(from: &Basis, to: &Basis, values: &[f64], width: usize) -> Vec<f64> {
    assert_eq!(values.len(), from.functions() * width);
    if from == to {
        return values.to_vec();
    }
    let mut curve = vec![0.0; to.functions() * width];
    for (sum, &x) in curve.chunks_exact_mut(width).zip(&to.greville()) {
        let old = from.evaluate(x);
        for (b, value) in old.value.iter().enumerate() {
            let from = &values[(old.first + b) * width..][..width];
            for (sum, x) in sum.iter_mut().zip(from) {
                *sum += value * x;
            }
        }
    }
    interpolate(to, curve, width)
}

/// Returns the control values of the spline that interpolates `values` at the Greville abscissae of its
/// basis, `width` numbers per function.
pub fn interpolate(basis: &Basis, mut values: Vec<f64>, width: usize) -> Vec<f64> {
    let p = basis.degree();
    // Collocation: row i holds N_j at Greville abscissa i, for j = i − p to i + p.
    let mut matrix = vec![vec![0.0; 2 * p + 1]; basis.functions()];
    for (i, (row, &x)) in matrix.iter_mut().zip(&basis.greville()).enumerate() {
        let at = basis.evaluate(x);
        for (b, value) in at.value.iter().enumerate() {
            // Functions beyond the band are zero there.
            let place = (at.first + b + p).checked_sub(i);
            if let Some(entry) = place.and_then(|place| row.get_mut(place)) {
                *entry = *value;
            }
        }
    }
    solve(&mut matrix, &mut values, p, width);
    values
}

/// Solves a banded system in place by elimination without pivoting: a collocation matrix of splines
/// is totally positive (de Boor and Pinkus 1977).
pub(super) fn solve(matrix: &mut [Vec<f64>], right: &mut [f64], p: usize, width: usize) {
    let n = matrix.len();
    for i in 0..n {
        let (head, tail) = matrix.split_at_mut(i + 1);
        let (solved, below) = right.split_at_mut((i + 1) * width);
        let (pivot, solved) = (&head[i], &solved[i * width..]);
        for (d, row) in (1..=p).zip(tail) {
            let factor = row[p - d] / pivot[p];
            for c in 0..=p {
                row[p - d + c] -= factor * pivot[p + c];
            }
            for (x, y) in below[(d - 1) * width..].iter_mut().zip(solved) {
                *x -= factor * y;
            }
        }
    }
    for i in (0..n).rev() {
        let (head, tail) = right.split_at_mut((i + 1) * width);
        let row = &mut head[i * width..];
        for d in (1..=p).filter(|d| i + d < n) {
            for (x, y) in row.iter_mut().zip(&tail[(d - 1) * width..]) {
                *x -= matrix[i][p + d] * y;
            }
        }
        for x in row {
            *x /= matrix[i][p];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BREAKS: [f64; 5] = [0.0, 0.3, 0.5, 1.4, 3.0];

    fn curve(basis: &Basis, values: &[f64], width: usize, x: f64) -> Vec<f64> {
        let at = basis.evaluate(x);
        let sum = |w: usize| {
            let terms = at.value.iter().enumerate();
            terms
                .map(|(b, n)| n * values[(at.first + b) * width + w])
                .sum()
        };
        (0..width).map(sum).collect()
    }

    #[test]
    fn knot_insertion_keeps_the_curve() {
        for p in 1..=5 {
            let from = Basis::open(p, &BREAKS);
            // A basis with a kink contains the one without.
            let kinked = Basis::with_multiplicities(p, &BREAKS, &[1, p, 1]);
            let values: Vec<f64> = (0..from.functions()).map(|i| (i as f64).cos()).collect();
            let with_kink = transfer(&from, &kinked, &values, 1);
            for i in 0..=60 {
                let x = 0.05 * f64::from(i);
                let (a, b) = (
                    curve(&from, &values, 1, x),
                    curve(&kinked, &with_kink, 1, x),
                );
                assert!((a[0] - b[0]).abs() < 1e-13, "{p}, {x}");
            }
            let mut finer = BREAKS.to_vec();
            finer.extend([0.1, 0.4, 0.45, 0.9, 2.0, 2.9]);
            finer.sort_by(f64::total_cmp);
            let to = Basis::open(p, &finer);
            let values: Vec<f64> = (0..2 * from.functions())
                .map(|i| (i as f64).sin())
                .collect();
            let fine = transfer(&from, &to, &values, 2);
            for i in 0..=60 {
                let x = 0.05 * f64::from(i);
                let (a, b) = (curve(&from, &values, 2, x), curve(&to, &fine, 2, x));
                assert!(
                    a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-13),
                    "{p}, {x}"
                );
            }
            let back = transfer(&to, &from, &fine, 2);
            let error = back.iter().zip(&values).map(|(a, b)| (a - b).abs());
            assert!(error.fold(0.0, f64::max) < 1e-12, "degree {p}");
        }
    }

    #[test]
    fn the_error_of_interpolation_has_the_order_of_the_degree() {
        for p in 1..=5 {
            let error = |n: usize| {
                let even: Vec<f64> = (0..=n).map(|i| 3.0 * i as f64 / n as f64).collect();
                let basis = Basis::open(p, &even);
                let sine = basis.greville().iter().map(|x| x.sin()).collect();
                let values = interpolate(&basis, sine, 1);
                (0..=500)
                    .map(|i| 0.006 * f64::from(i))
                    .map(|x| (curve(&basis, &values, 1, x)[0] - x.sin()).abs())
                    .fold(0.0, f64::max)
            };
            let order = (error(12) / error(24)).log2();
            assert!(order > p as f64 + 0.7, "degree {p}: order {order}");
        }
    }

    #[test]
    fn equal_bases_keep_values_to_the_bit() {
        let basis = Basis::open(3, &BREAKS);
        let values: Vec<f64> = (0..basis.functions())
            .map(|i| (i as f64).sin() / 3.0)
            .collect();
        assert_eq!(transfer(&basis, &basis.clone(), &values, 1), values);
    }
}
