//! What is found of the lowest eigenpairs of a run's own tangent.

use crate::saved_state::SavedState;
use crate::tube::Load;

/// A saved state and the lowest eigenvalues of its tangent.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// Name of its stage.
    pub stage: String,
    /// Number of the state.
    pub row: usize,
    /// How far along its stage it is, 0 to 1.
    pub along: f64,
    /// The load it is under.
    pub load: Load,
    /// The lowest eigenvalues, rising.
    pub lowest: Vec<Eigenvalue>,
    /// Iterations it took to find them.
    pub iterations: usize,
}

/// One of the lowest eigenvalues, and what its mode is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct Eigenvalue {
    /// ν in E/D², of K x = ν C x with the mass C of unit density.
    pub value: f64,
    /// Its relative residual, as [`crate::solve::Lowest::residuals`] says.
    pub residual: f64,
    /// Whether that is as small as it was to be.
    pub found: bool,
    /// Share of each circumferential harmonic in x · C x, from 0; those that do not repeat with the
    /// run are zero.
    pub shares: Vec<f64>,
}

/// The lowest eigenvalues along a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectra {
    /// State by state, in the order of the path.
    pub states: Vec<Spectrum>,
    /// The first state that is unstable, or else the last, with the shapes of its modes.
    pub shown: Option<Shown>,
    /// The files of the modes, as they are called in the run directory.
    pub modes: Vec<String>,
    /// Whether someone asked to stop before all states were done.
    pub stopped: bool,
}

/// A state with its modes.
#[derive(Clone, Debug, PartialEq)]
pub struct Shown {
    /// Its place among the states.
    pub which: usize,
    /// The state.
    pub state: SavedState,
    /// x of each of its lowest eigenvalues, numbered as the state's unknowns; the largest entry is one.
    pub shapes: Vec<Vec<f64>>,
}

impl Spectrum {
    /// How many of the lowest eigenvalues are negative, and whether that is all there are: the last
    /// is not, and was found.
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
    /// The harmonic that has the largest share.
    pub fn harmonic(&self) -> usize {
        let shares = self.shares.iter().enumerate();
        let largest = shares.max_by(|a, b| a.1.total_cmp(b.1).then(b.0.cmp(&a.0)));
        largest.map_or(0, |(n, _)| n)
    }

    /// The shares of a hundredth and more, the largest first: harmonic and share.
    pub fn parts(&self) -> Vec<(usize, f64)> {
        let shares = self.shares.iter().copied().enumerate();
        let mut parts: Vec<_> = shares.filter(|(_, share)| *share >= 0.01).collect();
        parts.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        parts
    }
}
