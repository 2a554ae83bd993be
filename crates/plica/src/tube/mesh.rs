//! The mesh that is laid over a tube.

use crate::spline::Refinement;

/// Control points, degree and grading.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Control points along the tube.
    pub axial: usize,
    /// Control points around it (N_C), for the whole circumference whatever the symmetry.
    pub around: usize,
    /// Control points through the wall.
    pub thickness: usize,
    /// Degree p of the splines, in every direction.
    pub degree: usize,
    /// Where elements along the tube are denser.
    pub refinements: Vec<Refinement>,
    /// How the wall's resistance to a change of volume is integrated.
    pub volumetric: Integration,
}

/// At how many points something is integrated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Integration {
    /// p + 1 Gauss points to an element each way.
    #[default]
    Full,
    /// About one point to an element through the wall, and p + 1 along and around, so that a nearly
    /// incompressible wall does not lock where few elements are that thick. For degrees 3 and 5.
    Reduced,
}

/// What repeats around the circumference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symmetry {
    /// Every cross-section stays a circle; it may twist.
    Axisymmetric,
    /// The tube repeats `m` times around.
    Fold(usize),
    /// Nothing repeats.
    None,
}

impl Mesh {
    /// Elements along, around and through the wall.
    pub fn elements(&self) -> [usize; 3] {
        [
            self.axial - self.degree,
            self.around,
            self.thickness - self.degree,
        ]
    }

    /// Rings k in the sector that repeats: 1 if axisymmetric, N_C/m if m-fold, N_C if nothing
    /// repeats.
    pub fn rings(&self, symmetry: Symmetry) -> usize {
        match symmetry {
            Symmetry::Axisymmetric => 1,
            Symmetry::Fold(m) => self.around / m,
            Symmetry::None => self.around,
        }
    }
}
