//! What a test of stability finds.

use super::{Quantity, Tested};
use crate::saved_state::SavedState;
use crate::tube::Load;

/// A place along the path that was tested: a saved state, or one end of a bracket.
#[derive(Clone, Debug, PartialEq)]
pub struct Station {
    /// Name of its stage.
    pub stage: String,
    /// Number of the saved state; none between two.
    pub row: Option<usize>,
    /// How far along its stage it is, 0 to 1.
    pub along: f64,
    /// The load it is under.
    pub load: Load,
    /// Harmonics 0, 1, 2, ….
    pub tested: Vec<Tested>,
}

/// How a change came about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum How {
    /// An eigenvalue passes through zero on a path that goes on.
    Smooth,
    /// The tube snaps to another branch there.
    Snap,
    /// The path could not be followed any closer.
    Unfollowed,
}

/// A harmonic that gains or loses negative eigenvalues between two places along the path.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// Name of the stage.
    pub stage: String,
    /// n.
    pub harmonic: usize,
    /// What is driven there.
    pub quantity: Quantity,
    /// The bracket: its value at the last place before and the first after.
    pub between: [f64; 2],
    /// Where the eigenvalue is zero on the straight line through its values at both; in the middle,
    /// if the tube snaps.
    pub critical: f64,
    /// Negative eigenvalues before and after.
    pub negative: [usize; 2],
    /// How it came about.
    pub how: How,
    /// The mode that was lost; none where a harmonic is regained or the tube snaps.
    pub mode: Option<Mode>,
}

impl Change {
    /// Whether stability was lost, not regained.
    pub fn is_loss(&self) -> bool {
        self.negative[1] > self.negative[0]
    }
}

/// The shape in which a tube leaves its path, just after it can.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// n.
    pub harmonic: usize,
    /// λ in E/D²: negative, and near zero.
    pub eigenvalue: f64,
    /// The state it belongs to; its row is that of the saved state before.
    pub state: SavedState,
    /// Amplitudes (z, r, θ) of every control point, numbered as the state's unknowns, of the
    /// displacement (z cos nφ, r cos nφ, −θ sin nφ); for n = 0 (z, r, θ). The largest is one.
    pub shape: Vec<f64>,
}

/// Everything that was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Stability {
    /// Harmonics that were looked at: 0 to this.
    pub highest: usize,
    /// Width of a bracket at most.
    pub tolerance: f64,
    /// Places in the order of the path.
    pub stations: Vec<Station>,
    /// Changes in the order of the path.
    pub changes: Vec<Change>,
}

impl Stability {
    /// The first harmonic that is lost.
    pub fn first_loss(&self) -> Option<&Change> {
        self.changes.iter().find(|change| change.is_loss())
    }

    /// The modes that were lost, with the number of their change, from 1.
    pub fn modes(&self) -> impl Iterator<Item = (usize, &Mode)> {
        let numbered = (1..).zip(&self.changes);
        numbered.filter_map(|(number, change)| Some((number, change.mode.as_ref()?)))
    }
}
