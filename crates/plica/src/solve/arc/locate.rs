//! Points of a branch at which a function is zero.

use super::curve::{Curve, Failure, Point};
use super::error::ArcFailure;
use super::family::Family;
use crate::monitor::Monitor;

/// Largest number of points that are computed.
const POINTS: usize = 60;

/// The accuracy of a location.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// Length of a bracket that is short enough.
    pub width: f64,
    /// Value of the function that counts as zero, relative to the larger one at the ends.
    pub zero: f64,
}

impl<F: Family> Curve<'_, F> {
    /// Solves for points between two others, where a function has different signs, until they bracket a zero of the function
    /// within a length, or the function is zero at one of them. Returns the last bracket, with the values of the function; a
    /// wider one if no further point between is found. The method is that of Illinois (Dowell and Jarratt 1971) with a
    /// bisection after every second step.
    ///
    /// # Errors
    /// The error of the function, or [`super::ArcFailure::Cancelled`].
    pub fn locate<E: From<Failure<F>>>(
        &self,
        [a, b]: [&Point; 2],
        [at_a, at_b]: [f64; 2],
        accuracy: Accuracy,
        mut function: impl FnMut(&Point) -> Result<f64, E>,
        monitor: &mut dyn Monitor,
    ) -> Result<[(Point, f64); 2], E> {
        let (mut low, mut high) = ((a.clone(), at_a), (b.clone(), at_b));
        // Values with which the next secant is drawn.
        let [mut f, mut g] = [at_a, at_b];
        let zero = accuracy.zero * at_a.abs().max(at_b.abs());
        let mut side = 0;
        for number in 0..POINTS {
            let length = high.0.s - low.0.s;
            if length <= accuracy.width || low.1.abs() <= zero || high.1.abs() <= zero {
                break;
            }
            // Every third point halves the bracket.
            let fraction = match number % 3 {
                2 => 0.5,
                _ => (f / (f - g)).clamp(0.01, 0.99),
            };
            let point = match self.between([&low.0, &high.0], fraction, monitor) {
                Ok(point) => point,
                Err(ArcFailure::Cancelled) => return Err(ArcFailure::Cancelled.into()),
                Err(_) => break,
            };
            let value = function(&point)?;
            if value * low.1 > 0.0 {
                (low, f) = ((point, value), value);
                g = if side == -1 { 0.5 * g } else { high.1 };
                side = -1;
            } else {
                (high, g) = ((point, value), value);
                f = if side == 1 { 0.5 * f } else { low.1 };
                side = 1;
            }
        }
        Ok([low, high])
    }
}
