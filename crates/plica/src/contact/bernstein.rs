//! Bernstein polynomials.

/// Most polynomials: those of degree 5.
pub const MAX_POINTS: usize = 6;

/// Returns the values of the Bernstein polynomials of degree p at ξ, or of the first p + 1 places.
pub fn bernstein(degree: usize, xi: f64) -> [f64; MAX_POINTS] {
    let mut values = [0.0; MAX_POINTS];
    values[0] = 1.0;
    for level in 1..=degree {
        for i in (0..=level).rev() {
            let left = if i > 0 { values[i - 1] } else { 0.0 };
            values[i] = xi * left + (1.0 - xi) * values[i];
        }
    }
    values
}

/// Returns the derivatives of the Bernstein polynomials of degree p ≥ 1 at ξ.
pub fn bernstein_slopes(degree: usize, xi: f64) -> [f64; MAX_POINTS] {
    let lower = bernstein(degree - 1, xi);
    let mut slopes = [0.0; MAX_POINTS];
    for (i, slope) in slopes.iter_mut().enumerate().take(degree + 1) {
        let left = if i > 0 { lower[i - 1] } else { 0.0 };
        let right = if i < degree { lower[i] } else { 0.0 };
        *slope = degree as f64 * (left - right);
    }
    slopes
}
