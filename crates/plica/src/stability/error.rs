//! Why the stability of a run cannot be told.

use crate::matrix::NoEigenpairs;
use crate::run_directory::RunError;
use crate::saved_state::SavedStateError;
use std::path::PathBuf;

/// What can go wrong.
#[derive(Debug, thiserror::Error)]
pub enum StabilityError {
    /// The run is not axisymmetric.
    #[error(
        "the run is not axisymmetric: its states do not part into harmonics. Ask for the lowest modes \
         of its own tangent; for harmonics, run the case with symmetry = \"axisymmetric\""
    )]
    Symmetry,
    /// The run is axisymmetric.
    #[error(
        "the run is axisymmetric: its states are tested harmonic by harmonic. For the lowest modes of \
         single states, run the case with symmetry = \"none\""
    )]
    OneRing,
    /// A state that is asked for was not saved.
    #[error(
        "{} holds no state {row}; its folder states tells which there are, and \
         output.states_every = 1 saves all",
        directory.display()
    )]
    NoSuchState {
        /// Its number.
        row: usize,
        /// Of the run.
        directory: PathBuf,
    },
    /// The tangent of a state cannot be worked with.
    #[error("{}: its tangent cannot be solved with around the tube; save the state again", path.display())]
    NoTangent {
        /// The file of the state.
        path: PathBuf,
    },
    /// The run twists.
    #[error(
        "the tube is twisted in state {row}: its waves turn around it, and are no harmonics of one \
         meridian. Run the case without twist_degrees, or with symmetry = \"none\", where \
         history.csv says whether its own tangent is stable"
    )]
    Twisted {
        /// Number of the state.
        row: usize,
    },
    /// There are not two states to go between.
    #[error(
        "{} holds {found} saved state(s), and two at least are needed; run the case again with \
         output.states_every = 1",
        directory.display()
    )]
    NoStates {
        /// Of the run.
        directory: PathBuf,
        /// How many there are.
        found: usize,
    },
    /// A saved state cannot be used.
    #[error("{}: {source}", path.display())]
    State {
        /// Its file.
        path: PathBuf,
        /// What is wrong with it.
        source: SavedStateError,
    },
    /// A saved state is no equilibrium of the case.
    #[error(
        "{} is not in equilibrium in this case (residual {relative_residual:.1e} of the forces in play). \
         If the run was made with solver.pseudo_time.equilibrate = false, run it again without",
        path.display()
    )]
    OutOfEquilibrium {
        /// Its file.
        path: PathBuf,
        /// Its residual over the forces in play; infinite if an element is inverted.
        relative_residual: f64,
    },
    /// A lowest eigenvalue was not found.
    #[error("{}: {source}", path.display())]
    Eigenvalues {
        /// The file of the state.
        path: PathBuf,
        /// What was looked for.
        source: NoEigenpairs,
    },
    /// Something about the run directory.
    #[error(transparent)]
    Study(#[from] RunError),
    /// Someone asked to stop.
    #[error("stopped on request; nothing was written")]
    Stopped,
}

impl StabilityError {
    /// Whether something was asked for that is not offered, rather than files being broken.
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
