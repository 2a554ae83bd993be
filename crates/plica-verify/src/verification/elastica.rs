//! An inextensible ring under outer pressure whose opposite walls touch at one point (Flaherty, Keller and Rubinow 1972).
//!
//! A quarter of the ring, from the place of contact (s = 0) to the tip (s = π/2), in units of its radius R and bending
//! stiffness EI. With the tangent at the angle θ to the line of contact, the curvature κ, the tension T and the shear force V,
//!
//! x′ = cos θ, y′ = sin θ, θ′ = κ, κ′ = −V, V′ = −κ T − p, T′ = κ V.
//!
//! The place of contact is at x = y = θ = 0, the tip at θ = π/2, y = 0 (half the height is that of the place of contact),
//! V = 0.

use super::VerificationError;
use std::f64::consts::FRAC_PI_2;

/// Steps of the method of Runge and Kutta along the quarter.
const STEPS: usize = 2000;

/// y, θ, κ, T and V.
type State = [f64; 5];

fn slope([_, theta, kappa, T, V]: State, p: f64) -> State {
    [theta.sin(), kappa, -V, kappa * V, -kappa * T - p]
}

/// Returns the state at the tip of a ring with these values at the place of contact.
fn at_tip(kappa: f64, T: f64, V: f64, p: f64) -> State {
    let h = FRAC_PI_2 / STEPS as f64;
    let moved = |a: State, factor: f64, b: State| -> State {
        std::array::from_fn(|i| a[i] + factor * b[i])
    };
    let mut state = [0.0, 0.0, kappa, T, V];
    for _ in 0..STEPS {
        let a = slope(state, p);
        let b = slope(moved(state, 0.5 * h, a), p);
        let c = slope(moved(state, 0.5 * h, b), p);
        let d = slope(moved(state, h, c), p);
        state =
            std::array::from_fn(|i| state[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
    }
    state
}

/// Solves the conditions at the tip for three unknowns by Newton's method with differences.
fn solve(mut z: [f64; 3], tip: impl Fn([f64; 3]) -> State) -> Result<[f64; 3], VerificationError> {
    let residual = |z: [f64; 3]| {
        let [y, theta, _, _, V] = tip(z);
        [theta - FRAC_PI_2, V, y]
    };
    for _ in 0..50 {
        let r = residual(z);
        let column = |j: usize| {
            let [low, high] = [-1e-6, 1e-6].map(|h| {
                let mut moved = z;
                moved[j] += h;
                residual(moved)
            });
            [0, 1, 2].map(|i| (high[i] - low[i]) / 2e-6)
        };
        let columns = [0, 1, 2].map(column);
        // Cramer's rule.
        let determinant = |c: [[f64; 3]; 3]| {
            c[0][0] * (c[1][1] * c[2][2] - c[1][2] * c[2][1])
                - c[0][1] * (c[1][0] * c[2][2] - c[1][2] * c[2][0])
                + c[0][2] * (c[1][0] * c[2][1] - c[1][1] * c[2][0])
        };
        let all = determinant(columns);
        let change = [0, 1, 2].map(|j| {
            let mut with = columns;
            with[j] = r.map(|x| -x);
            determinant(with) / all
        });
        let largest = change.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let damping = (0.5 / largest).min(1.0);
        z = [0, 1, 2].map(|i| z[i] + damping * change[i]);
        if largest < 1e-10 {
            return Ok(z);
        }
    }
    Err(VerificationError::Solve(
        "the elastica has no solution".into(),
    ))
}

/// Returns p R³/EI at which opposite walls touch.
pub fn touching_load() -> Result<f64, VerificationError> {
    let [_, _, p] = solve([-0.96, -0.13, 5.1], |[kappa, T, p]| {
        at_tip(kappa, T, 0.0, p)
    })?;
    Ok(p)
}

/// Returns p R³/EI at which the curvature is zero where opposite walls touch; beyond it they touch along a line.
pub fn flat_load() -> Result<f64, VerificationError> {
    let [_, _, p] = solve([0.0, 3.9, 10.2], |[T, V, p]| at_tip(0.0, T, V, p))?;
    Ok(p)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_is_in_equilibrium() {
        let [y, theta, kappa, T, V] = at_tip(1.0, -3.0, 0.0, 3.0);
        assert!((y - 1.0).abs() < 1e-12 && (theta - FRAC_PI_2).abs() < 1e-12);
        assert!((kappa - 1.0).abs() < 1e-12 && (T + 3.0).abs() < 1e-12 && V.abs() < 1e-12);
    }

    #[test]
    fn walls_touch_at_the_published_pressure() {
        // Flaherty, Keller and Rubinow (1972), 5.247 and, for a line of contact, 10.34.
        assert!((touching_load().unwrap() - 5.24689).abs() < 1e-5);
        assert!((flat_load().unwrap() - 10.33603).abs() < 1e-5);
    }
}
