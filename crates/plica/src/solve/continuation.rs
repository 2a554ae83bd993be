//! The state of a path beside its accepted state.

/// The state before the current one, with the tangent du/dt of the path there.
#[derive(Clone, Debug, PartialEq)]
pub struct PreviousPoint {
    /// Position on the segment.
    pub t: f64,
    /// Unknowns.
    pub u: Vec<f64>,
    /// du/dt.
    pub tangent: Vec<f64>,
}

impl PreviousPoint {
    /// Extrapolates the cubic through this point and `u` at `t`, with the tangents of both, to `to`
    /// (Hermite).
    pub(super) fn extrapolate(&self, t: f64, u: &[f64], tangent: &[f64], to: f64) -> Vec<f64> {
        let (back, ahead) = (t - self.t, to - t);
        let s = 1.0 + ahead / back;
        let [a, b, c, d] = [
            (2.0 * s - 3.0) * s * s + 1.0,
            ((s - 2.0) * s + 1.0) * s * back,
            (3.0 - 2.0 * s) * s * s,
            (s - 1.0) * s * s * back,
        ];
        (0..u.len())
            .map(|i| a * self.u[i] + b * self.tangent[i] + c * u[i] + d * tangent[i])
            .collect()
    }
}

/// Everything that a path needs beside its accepted state to continue as if it had never stopped.
#[derive(Clone, Debug, PartialEq)]
pub struct ContinuationState {
    /// Position of the state on its segment.
    pub reached: f64,
    /// Number of halvings with which the next step begins.
    pub halving_level: usize,
    /// The state before on this segment, unless a snap lies between.
    pub previous: Option<PreviousPoint>,
    /// Velocity u̇ of pseudo-time.
    pub velocity: Vec<f64>,
    /// History of the accepted state: [`Equilibrium::history`](super::Equilibrium::history).
    pub history: Vec<f64>,
}

impl ContinuationState {
    /// Returns the continuation state at the start of a segment.
    pub fn at_start(velocity: Vec<f64>, history: Vec<f64>) -> Self {
        Self {
            reached: 0.0,
            halving_level: 0,
            previous: None,
            velocity,
            history,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_is_extrapolated_exactly() {
        let u = |t: f64| vec![((t - 2.0) * t + 0.5) * t - 3.0];
        let tangent = |t: f64| vec![(3.0 * t - 4.0) * t + 0.5];
        let previous = PreviousPoint {
            t: 0.25,
            u: u(0.25),
            tangent: tangent(0.25),
        };
        for to in [0.5, 0.75, 2.0] {
            let found = previous.extrapolate(0.5, &u(0.5), &tangent(0.5), to);
            assert!((found[0] - u(to)[0]).abs() < 1e-13, "{found:?}");
        }
    }
}
