//! Lowest eigenvalues of the tangents of three-dimensional states.

use crate::saved_state::SavedState;
use crate::tube::Load;

/// Lowest eigenvalues of the tangent of a saved state.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// Name of its stage.
    pub stage: String,
    /// Number of the state.
    pub row: usize,
    /// Completed fraction of the stage, 0 to 1.
    pub along: f64,
    /// Load of the state.
    pub load: Load,
    /// Lowest eigenvalues in ascending order.
    pub lowest: Vec<Eigenvalue>,
    /// Iterations of the eigenvalue solver.
    pub iterations: usize,
}

/// One of the lowest eigenvalues, with the composition of its mode.
#[derive(Clone, Debug, PartialEq)]
pub struct Eigenvalue {
    /// Eigenvalue ν of K x = ν C x with the mass C of unit density, in E/D².
    pub value: f64,
    /// Relative residual, as defined by [`crate::solve::Lowest::residuals`].
    pub residual: f64,
    /// True if the residual is within the tolerance.
    pub found: bool,
    /// Share of each circumferential mode from 0 on in x · C x.
    pub shares: Vec<f64>,
}

/// Lowest eigenvalues of the states of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectra {
    /// States in the order of the path.
    pub states: Vec<Spectrum>,
    /// First unstable state, or else the last one, with the shapes of its modes.
    pub shown: Option<StateWithModes>,
    /// Files of the modes, relative to the run directory.
    pub modes: Vec<String>,
    /// True if the run has friction, which the eigenvalues leave out.
    pub leaves_out_friction: bool,
}

/// A state with its modes.
#[derive(Clone, Debug, PartialEq)]
pub struct StateWithModes {
    /// Index among the states.
    pub index: usize,
    /// The state.
    pub state: SavedState,
    /// Eigenvectors, numbered as the unknowns of the state; the largest entry is one.
    pub shapes: Vec<Vec<f64>>,
}

impl Spectrum {
    /// Returns the number of negative eigenvalues, and whether it is complete: the last eigenvalue has converged and
    /// is not negative.
    pub fn negative(&self) -> (usize, bool) {
        let count = self.lowest.iter().filter(|e| e.value < 0.0).count();
        let bounded = self
            .lowest
            .last()
            .is_some_and(|e| e.found && e.value >= 0.0);
        (count, bounded)
    }
}

impl Eigenvalue {
    /// Returns the circumferential mode with the largest share.
    pub fn harmonic(&self) -> usize {
        let shares = self.shares.iter().enumerate();
        let largest = shares.max_by(|a, b| a.1.total_cmp(b.1).then(b.0.cmp(&a.0)));
        largest.map_or(0, |(n, _)| n)
    }

    /// Returns circumferential modes with a share of at least 1 %, with the shares in descending order.
    pub fn parts(&self) -> Vec<(usize, f64)> {
        let shares = self.shares.iter().copied().enumerate();
        let mut parts: Vec<_> = shares.filter(|(_, share)| *share >= 0.01).collect();
        parts.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        parts
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::fixture;

    fn eigenvalue(value: f64, found: bool) -> Eigenvalue {
        Eigenvalue {
            value,
            residual: 0.0,
            found,
            shares: vec![0.0099, 0.4, 0.01, 0.4, 0.1801],
        }
    }

    #[test]
    fn negative_eigenvalues_are_all_known_if_the_last_one_is_found_and_not_negative() {
        let negative = |values: &[(f64, bool)]| {
            let lowest = values
                .iter()
                .map(|&(value, found)| eigenvalue(value, found));
            let spectrum = Spectrum {
                stage: String::new(),
                row: 1,
                along: 0.5,
                load: fixture::short().rest(),
                lowest: lowest.collect(),
                iterations: 1,
            };
            spectrum.negative()
        };
        assert_eq!(
            negative(&[(-2.0, true), (-1.0, true), (3.0, true)]),
            (2, true)
        );
        assert_eq!(negative(&[(-2.0, true), (0.0, true)]), (1, true));
        assert_eq!(negative(&[(-2.0, true), (3.0, false)]), (1, false));
        assert_eq!(negative(&[(-2.0, true)]), (1, false));
        assert_eq!(negative(&[]), (0, false));
    }

    #[test]
    fn parts_have_at_least_a_hundredth_and_the_largest_comes_first() {
        let eigenvalue = eigenvalue(1.0, true);
        assert_eq!(
            eigenvalue.parts(),
            [(1, 0.4), (3, 0.4), (4, 0.1801), (2, 0.01)]
        );
        assert_eq!(eigenvalue.harmonic(), 1);
    }
}
