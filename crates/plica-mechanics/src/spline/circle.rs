//! Approximation of a circle, and of waves around it, by uniform periodic splines.

use super::{Basis, gauss_legendre};
use std::f64::consts::TAU;

/// L2 projection of the unit circle on uniform periodic splines.
///
/// By symmetry its control points lie on a circle too, of a radius slightly larger than one. The
/// radius of the spline deviates by at most [`Circle::error`] (3.1e-7 for 60 cubic functions).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// Radius of the control points of the unit circle.
    pub control_radius: f64,
    /// Largest deviation of the radius of the spline from one.
    pub error: f64,
}

impl Circle {
    /// Projects the unit circle on `rings` functions.
    pub fn new(degree: usize, rings: usize) -> Self {
        let basis = Basis::uniform_element(degree);
        let control_radius = control_wave(degree, rings, 1);
        let error = (0..=40)
            .map(|i| {
                let (x, y) = spline_wave(&basis, rings, 1, f64::from(i) / 40.0);
                (control_radius * x.hypot(y) - 1.0).abs()
            })
            .fold(0.0, f64::max);
        Self {
            control_radius,
            error,
        }
    }
}

/// Returns the amplitude of the control points of the L2 projection of a wave exp(inφ) on `rings`
/// functions. It is one for n = 0, and the control radius of [`Circle`] for n = 1.
pub fn control_wave(degree: usize, rings: usize, n: usize) -> f64 {
    let basis = Basis::uniform_element(degree);
    // Least squares: ∫ c · e / ∫ c · c, with c the spline and e the exact wave.
    let (mut ce, mut cc) = (0.0, 0.0);
    for (s, w) in gauss_legendre(degree + 3) {
        let (x, y) = spline_wave(&basis, rings, n, s);
        let phi = n as f64 * (s - 0.5) * (TAU / rings as f64);
        ce += w * (x * phi.cos() + y * phi.sin());
        cc += w * (x * x + y * y);
    }
    ce / cc
}

/// Returns c(s) = Σ N_b(s) exp(i n φ_b), φ_b the angle of ring b from the middle of the element.
fn spline_wave(basis: &Basis, rings: usize, n: usize, s: f64) -> (f64, f64) {
    let alpha = TAU / rings as f64;
    let v = basis.evaluate_in(0, s);
    let values = v.value.iter().enumerate();
    values.fold((0.0, 0.0), |(x, y), (b, value)| {
        let phi = n as f64 * ((b as f64 - 0.5 * basis.degree() as f64) * alpha);
        (x + value * phi.cos(), y + value * phi.sin())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sixty_cubic_functions_approximate_a_circle_to_3e_7() {
        let circle = Circle::new(3, 60);
        assert!(circle.error < 3.1e-7, "{}", circle.error);
        assert!(circle.control_radius > 1.0);
    }

    #[test]
    fn the_error_of_waves_is_of_fourth_order() {
        for n in 0..=15 {
            let (height, basis) = (control_wave(3, 60, n), Basis::uniform_element(3));
            let worst = (0..=20).fold(0.0_f64, |worst, i| {
                let s = f64::from(i) / 20.0;
                let (x, y) = spline_wave(&basis, 60, n, s);
                let phi = n as f64 * (s - 0.5) * TAU / 60.0;
                worst.max((height * x - phi.cos()).hypot(height * y - phi.sin()))
            });
            // (n α)⁴ / 720 is the first term of the deviation of cubics.
            let angle = n as f64 * TAU / 60.0;
            assert!(worst < 1e-14 + 2.0 * angle.powi(4) / 720.0, "{n}: {worst}");
        }
        assert_eq!(control_wave(3, 60, 1), Circle::new(3, 60).control_radius);
    }

    #[test]
    fn the_error_of_a_circle_has_the_order_of_the_degree() {
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
