//! Elastic foundations: springs between the outer wall and its surroundings, such as a mesentery.

use super::Region;

/// Springs on the outer wall in a part of the tube, free of force where the wall is at rest. Their energy is
/// ½ ∫ k p |u|² dA₀ with the function p of the region, u the displacement and A₀ the area at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foundation {
    /// Its place.
    pub region: Region,
    /// k, in E/D.
    pub stiffness: f64,
    /// The displacements that it resists.
    pub direction: SpringDirection,
}

/// The displacements that springs resist.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpringDirection {
    /// All.
    All,
    /// Those along the normal N of the wall at rest: |u|² is (N·u)².
    Normal,
    /// Those inwards along the normal: |u|² is (N·u)² where N·u < 0, else 0.
    Inward,
}

impl Foundation {
    /// Returns true if it holds a tube that is free otherwise against the rigid motions of circumferential harmonic n, 0
    /// (along and about the axis) or 1 (sideways and tilting).
    pub(super) fn holds(&self, n: usize) -> bool {
        match self.direction {
            SpringDirection::All => true,
            SpringDirection::Normal => n == 1,
            SpringDirection::Inward => false,
        }
    }
}
