//! Results of the stability test of an axisymmetric path.

use super::{ModeStability, Quantity};
use crate::saved_state::SavedState;
use crate::tube::Load;

/// A tested state of the path: a saved one, or one end of a bracket.
#[derive(Clone, Debug, PartialEq)]
pub struct TestedState {
    /// Name of its stage.
    pub stage: String,
    /// Number of the saved state; none for a state between two.
    pub row: Option<usize>,
    /// Completed fraction of the stage, 0 to 1.
    pub along: f64,
    /// Load of the state.
    pub load: Load,
    /// Stability to circumferential modes 0, 1, 2, ….
    pub modes: Vec<ModeStability>,
}

/// Character of the path where stability changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Transition {
    /// An eigenvalue passes through zero on a continuous path.
    Smooth,
    /// The path snaps to another branch.
    Snap,
    /// The path between the ends could not be computed.
    Unfollowed,
}

/// A change in the number of negative eigenvalues of one circumferential mode.
#[derive(Clone, Debug, PartialEq)]
pub struct StabilityChange {
    /// Name of the stage.
    pub stage: String,
    /// Circumferential mode n.
    pub harmonic: usize,
    /// Driven quantity.
    pub quantity: Quantity,
    /// Bracket: values of the quantity at the last state before the change and the first after it.
    pub between: [f64; 2],
    /// Value of the quantity at which the linearly interpolated eigenvalue is zero; the midpoint of the bracket unless
    /// the path is smooth.
    pub critical: f64,
    /// Numbers of negative eigenvalues before and after.
    pub negative: [usize; 2],
    /// Character of the path there.
    pub transition: Transition,
    /// Buckling mode; none where stability is regained or the path snaps.
    pub mode: Option<Mode>,
}

impl StabilityChange {
    /// Returns whether stability is lost rather than regained.
    pub fn is_loss(&self) -> bool {
        self.negative[1] > self.negative[0]
    }
}

/// Buckling mode just after the loss of stability.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// Circumferential mode n.
    pub harmonic: usize,
    /// Eigenvalue λ in E/D²: negative and near zero.
    pub eigenvalue: f64,
    /// State of the mode; its number is that of the previous saved state.
    pub state: SavedState,
    /// Amplitudes (z, r, θ) per control point of the displacement (z cos nφ, r cos nφ, −θ sin nφ), or (z, r, θ) for
    /// n = 0, numbered as the unknowns of the state. The largest is one.
    pub shape: Vec<f64>,
}

/// Stability along a path.
#[derive(Clone, Debug, PartialEq)]
pub struct PathStability {
    /// Highest circumferential mode tested.
    pub highest: usize,
    /// Largest accepted width of a bracket.
    pub tolerance: f64,
    /// Tested states in the order of the path.
    pub states: Vec<TestedState>,
    /// Changes in the order of the path.
    pub changes: Vec<StabilityChange>,
    /// True if the run has friction, which the verdicts leave out.
    pub leaves_out_friction: bool,
}

impl PathStability {
    /// Returns the first loss of stability.
    pub fn first_loss(&self) -> Option<&StabilityChange> {
        self.changes.iter().find(|change| change.is_loss())
    }

    /// Returns the buckling modes with the numbers of their changes, from 1.
    pub fn modes(&self) -> impl Iterator<Item = (usize, &Mode)> {
        let numbered = (1..).zip(&self.changes);
        numbered.filter_map(|(number, change)| Some((number, change.mode.as_ref()?)))
    }
}
