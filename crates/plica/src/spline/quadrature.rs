//! Gauss–Legendre quadrature.

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

#[cfg(test)]
mod tests {
    use super::*;

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
