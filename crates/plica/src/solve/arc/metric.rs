//! The measure of length along a branch.

use super::super::equilibrium::Equilibrium;
use super::super::operator::dot;

/// ds² = ½ (duᵀ C du / n + dλ²) of the free unknowns.
#[derive(Clone, Debug)]
pub(super) struct Metric<P: Equilibrium> {
    /// A problem of the family, for its C.
    problem: P,
    /// n.
    scale: f64,
}

impl<P: Equilibrium> Metric<P> {
    /// Returns the metric with n = 1.
    pub fn unit(problem: P) -> Self {
        Self {
            problem,
            scale: 1.0,
        }
    }

    /// Returns the metric in which the displacement `slope` = du/dλ weighs as much as λ; itself if that is zero.
    pub fn scaled(self, slope: &[f64]) -> Self {
        let square = dot(slope, &self.dual(slope));
        if square > 0.0 && square.is_finite() {
            return Self {
                scale: square,
                ..self
            };
        }
        self
    }

    /// Returns for every unknown whether a support prescribes it.
    pub fn prescribed(&self) -> &[bool] {
        self.problem.prescribed()
    }

    /// Returns C v of the free unknowns.
    pub fn dual(&self, v: &[f64]) -> Vec<f64> {
        let mut v = v.to_vec();
        self.clear_prescribed(&mut v);
        let mut y = vec![0.0; v.len()];
        self.problem.damping(1.0, &v, &mut y);
        self.clear_prescribed(&mut y);
        y
    }

    /// Sets the entries of prescribed unknowns to zero.
    pub fn clear_prescribed(&self, v: &mut [f64]) {
        for (x, prescribed) in v.iter_mut().zip(self.problem.prescribed()) {
            if *prescribed {
                *x = 0.0;
            }
        }
    }

    /// Returns the row (½ C v / n, ½ λ) of the scalar product with a direction (v, λ).
    pub fn row(&self, v: &[f64], parameter: f64) -> (Vec<f64>, f64) {
        let mut row = self.dual(v);
        row.iter_mut().for_each(|x| *x *= 0.5 / self.scale);
        (row, 0.5 * parameter)
    }

    /// Returns the length of a direction.
    pub fn length(&self, v: &[f64], parameter: f64) -> f64 {
        let (row, corner) = self.row(v, parameter);
        (dot(&row, v) + corner * parameter).sqrt()
    }
}
