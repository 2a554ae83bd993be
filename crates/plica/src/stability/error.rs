//! Errors of the stability test.

use crate::matrix::NoEigenpairs;
use crate::run_directory::RunError;
use crate::saved_state::SavedStateError;
use std::path::PathBuf;

/// Errors of the stability test of a run.
#[derive(Debug, thiserror::Error)]
pub enum StabilityError {
    /// The run is not axisymmetric.
    #[error(
        "the run is not axisymmetric, so its states do not decouple into circumferential modes: compute the \
         lowest modes of its tangent, or run the case with symmetry = \"axisymmetric\""
    )]
    Symmetry,
    /// The run is axisymmetric.
    #[error(
        "the run is axisymmetric, so its states are tested by circumferential mode; for the lowest modes of \
         single states run the case with symmetry = \"none\""
    )]
    OneRing,
    /// A selected state was not saved.
    #[error(
        "{} has no saved state {row}: see its folder states; output.states_every = 1 saves all",
        directory.display()
    )]
    NoSuchState {
        /// Number of the state.
        row: usize,
        /// Run directory.
        directory: PathBuf,
    },
    /// The preconditioner of a tangent cannot be factorised.
    #[error("{}: its tangent cannot be preconditioned; run the case again", path.display())]
    NoTangent {
        /// File of the state.
        path: PathBuf,
    },
    /// A state is twisted.
    #[error(
        "state {row} is twisted, so its tangent does not decouple into circumferential modes: run the case \
         without twist_degrees, or with symmetry = \"none\" and see the column unstable_modes of history.csv"
    )]
    Twisted {
        /// Number of the state.
        row: usize,
    },
    /// There are fewer than two saved states.
    #[error(
        "{} has {found} saved state(s) and at least two are needed: run the case again with \
         output.states_every = 1",
        directory.display()
    )]
    NoStates {
        /// Run directory.
        directory: PathBuf,
        /// Number of saved states.
        found: usize,
    },
    /// A saved state cannot be used.
    #[error("{}: {source}", path.display())]
    State {
        /// File of the state.
        path: PathBuf,
        /// Cause.
        source: SavedStateError,
    },
    /// A saved state is not in equilibrium.
    #[error(
        "{} is not in equilibrium (relative residual {relative_residual:.1e}): if the case has \
         solver.pseudo_time.equilibrate = false, run it again with true",
        path.display()
    )]
    OutOfEquilibrium {
        /// File of the state.
        path: PathBuf,
        /// Relative residual; infinite if an element is inverted.
        relative_residual: f64,
    },
    /// A lowest eigenvalue was not found.
    #[error("{}: {source}", path.display())]
    Eigenvalues {
        /// File of the state.
        path: PathBuf,
        /// Cause.
        source: NoEigenpairs,
    },
    /// The run directory cannot be read or written.
    #[error(transparent)]
    Directory(#[from] RunError),
    /// The monitor cancelled the computation.
    #[error("cancelled")]
    Cancelled,
}

impl StabilityError {
    /// Returns whether the request does not fit the run, rather than a file being unusable.
    pub fn is_misuse(&self) -> bool {
        matches!(
            self,
            Self::Symmetry
                | Self::OneRing
                | Self::Twisted { .. }
                | Self::NoStates { .. }
                | Self::NoSuchState { .. }
        )
    }
}
