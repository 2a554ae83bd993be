//! The circle that a uniform periodic spline draws.

use super::{Basis, gauss_legendre};
use std::f64::consts::TAU;

/// A circle of unit radius projected on the uniform periodic splines of `rings` functions.
///
/// By symmetry its control points lie on a circle too, of a radius slightly larger than one. A
/// spline cannot be round exactly; the L2 projection chosen here is right on average, and off by
/// at most [`Circle::error`] (3.1e-7 from crest to trough for 60 cubic functions).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// Radius of the control points of the unit circle.
    pub control_radius: f64,
    /// Largest deviation of the drawn radius from one.
    pub error: f64,
}

impl Circle {
    /// Projects the unit circle on `rings` functions of a degree.
    pub fn new(degree: usize, rings: usize) -> Self {
        let (basis, alpha) = (Basis::uniform_element(degree), TAU / rings as f64);
        // c(s) = Σ N_b(s) exp(i φ_b), φ_b the angle of ring b from the middle of the element.
        let drawn = |s: f64| {
            let v = basis.evaluate_in(0, s);
            v.value
                .iter()
                .enumerate()
                .fold((0.0, 0.0), |(x, y), (b, n)| {
                    let phi = (b as f64 - 0.5 * degree as f64) * alpha;
                    (x + n * phi.cos(), y + n * phi.sin())
                })
        };
        // Least squares: ∫ c · e / ∫ c · c, with e the unit vector at the same angle.
        let (mut ce, mut cc) = (0.0, 0.0);
        for (s, w) in gauss_legendre(degree + 3) {
            let (x, y) = drawn(s);
            let phi = (s - 0.5) * alpha;
            ce += w * (x * phi.cos() + y * phi.sin());
            cc += w * (x * x + y * y);
        }
        let control_radius = ce / cc;
        let error = (0..=40)
            .map(|i| {
                let (x, y) = drawn(f64::from(i) / 40.0);
                (control_radius * x.hypot(y) - 1.0).abs()
            })
            .fold(0.0, f64::max);
        Self {
            control_radius,
            error,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sixty_cubic_functions_are_round_to_3e_7() {
        let circle = Circle::new(3, 60);
        assert!(circle.error < 3.1e-7, "{}", circle.error);
        assert!(circle.control_radius > 1.0);
    }

    #[test]
    fn the_error_falls_with_the_power_of_the_degree() {
        // Radial error O(h⁴) for cubics, O(h²) for polygons.
        for (degree, order) in [(1, 2.0), (3, 4.0)] {
            let ratio = Circle::new(degree, 30).error / Circle::new(degree, 60).error;
            assert!(
                (ratio.log2() - order).abs() < 0.05,
                "degree {degree}: {ratio}"
            );
        }
    }
}
