//! The eigenpair of the tangent stiffness whose eigenvalue is nearest to zero.

use super::super::operator::dot;
use super::curve::{Curve, Failure, Point};
use super::family::Family;

/// Largest number of inverse iterations.
const ITERATIONS: usize = 60;
/// Relative change of the eigenvalue at which the iteration ends.
const ACCURACY: f64 = 1e-12;

/// An eigenpair of K x = ν C x.
#[derive(Clone, Debug, PartialEq)]
pub struct CriticalPair {
    /// ν.
    pub value: f64,
    /// x; its largest entry is one.
    pub vector: Vec<f64>,
}

impl<F: Family> Curve<'_, F> {
    /// Returns the eigenpair with the eigenvalue nearest to zero, by inverse iteration from smooth noise or a seed.
    ///
    /// # Errors
    /// [`super::ArcFailure`] if K cannot be factored.
    pub fn critical(&self, at: &Point, seed: Option<&[f64]>) -> Result<CriticalPair, Failure<F>> {
        let linear = self.linear(&at.u, at.parameter)?;
        let mut x = match seed {
            Some(seed) => seed.to_vec(),
            None => {
                let noise = (0..at.u.len()).map(|i| (1.0 + 0.7 * i as f64 + (i * i) as f64).sin());
                linear.solve_alone(&self.metric.dual(&noise.collect::<Vec<f64>>()))?
            }
        };
        self.metric.clear_prescribed(&mut x);
        let mut value = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let norm = dot(&x, &self.metric.dual(&x)).sqrt();
            x.iter_mut().for_each(|x| *x /= norm);
            let dual = self.metric.dual(&x);
            let next = linear.solve_alone(&dual)?;
            let before = value;
            value = 1.0 / dot(&dual, &next);
            x = next;
            if (value - before).abs() <= ACCURACY * value.abs() {
                break;
            }
        }
        let largest = x.iter().copied().max_by(|a, b| a.abs().total_cmp(&b.abs()));
        let largest = largest.unwrap_or(1.0);
        x.iter_mut().for_each(|x| *x /= largest);
        Ok(CriticalPair { value, vector: x })
    }
}
