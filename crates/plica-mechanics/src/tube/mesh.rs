//! The spline mesh of a tube.

use crate::spline::{Refinement, geometric_breakpoints, graded_breakpoints};

/// Control points, degree and grading.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Control points along the tube.
    pub axial: usize,
    /// Control points around the whole circumference (N_C), for any symmetry.
    pub around: usize,
    /// Control points through the wall.
    pub thickness: usize,
    /// Degree p of the splines, in every direction.
    pub degree: usize,
    /// Zones along the tube with smaller elements.
    pub refinements: Vec<Refinement>,
    /// Thickness of the innermost element of the wall over that of the outermost. The elements in between form a geometric
    /// sequence.
    pub grading: f64,
    /// Range of the law of contact, in smallest axial elements at rest.
    pub contact_range: f64,
    /// Integration of the volumetric part of the law.
    pub volumetric: Integration,
}

/// A quadrature of the elements.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Integration {
    /// p + 1 Gauss points per element and direction.
    #[default]
    Full,
    /// About one point per element through the wall, and p + 1 along and around. Avoids locking of
    /// nearly incompressible walls with few elements through the thickness. For degrees 3 and 5.
    Reduced,
}

/// Symmetry of the solution around the circumference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symmetry {
    /// Every cross-section stays circular; twist is possible.
    Axisymmetric,
    /// The tube consists of `m` equal sectors.
    Fold(usize),
    /// No symmetry.
    None,
}

impl Mesh {
    /// Returns the numbers of elements along, around and through the wall.
    pub fn elements(&self) -> [usize; 3] {
        [
            self.axial - self.degree,
            self.around,
            self.thickness - self.degree,
        ]
    }

    /// Returns the edges of the elements along a tube, from 0 to its length.
    pub fn breakpoints_along(&self, length: f64) -> Vec<f64> {
        graded_breakpoints(length, self.axial - self.degree, &self.refinements)
    }

    /// Returns the edges of the elements through a wall, from 0 at the inner surface to its thickness.
    pub fn breakpoints_through(&self, thickness: f64) -> Vec<f64> {
        geometric_breakpoints(thickness, self.thickness - self.degree, self.grading)
    }

    /// Returns the number of rings of a sector: 1 if axisymmetric, N_C/m if m-fold, else N_C.
    pub fn rings(&self, symmetry: Symmetry) -> usize {
        match symmetry {
            Symmetry::Axisymmetric => 1,
            Symmetry::Fold(m) => self.around / m,
            Symmetry::None => self.around,
        }
    }
}
