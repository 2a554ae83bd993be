//! The spline mesh of a tube.

use crate::spline::{Refinement, geometric_breakpoints, graded_breakpoints};
use std::ops::Range;

/// Control points, degree and grading.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Control points along the tube.
    pub axial: usize,
    /// Control points around the whole circumference (N_C), for any symmetry.
    pub around: usize,
    /// Control points through the wall; see [`Mesh::points_through`] for several layers.
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
    /// Layers of the wall from the inside out. Displacements have kinks at their interfaces, as strains jump there.
    /// Empty for a wall of one layer.
    pub layers: Vec<MeshLayer>,
}

/// The elements of a layer of the wall, all of the same thickness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshLayer {
    /// Thickness of the layer over that of the wall.
    pub share: f64,
    /// Elements through the layer.
    pub elements: usize,
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
        let through = match &self.layers[..] {
            [] => self.thickness - self.degree,
            layers => layers.iter().map(|layer| layer.elements).sum(),
        };
        [self.axial - self.degree, self.around, through]
    }

    /// Returns the number of control points through a wall of several layers.
    pub fn points_through(degree: usize, layers: &[MeshLayer]) -> usize {
        let elements: usize = layers.iter().map(|layer| layer.elements).sum();
        elements + degree + (layers.len() - 1) * (degree - 1)
    }

    /// Returns the elements through the wall that each layer consists of.
    pub fn elements_of_layers(&self) -> Vec<Range<usize>> {
        let mut first = 0;
        let range = |layer: &MeshLayer| {
            let from = first;
            first += layer.elements;
            from..first
        };
        match &self.layers[..] {
            [] => std::iter::once(0..self.elements()[2]).collect(),
            layers => layers.iter().map(range).collect(),
        }
    }

    /// Returns the edges of the elements along a tube, from 0 to its length.
    pub fn breakpoints_along(&self, length: f64) -> Vec<f64> {
        graded_breakpoints(length, self.axial - self.degree, &self.refinements)
    }

    /// Returns the edges of the elements through a wall, from 0 at the inner surface to its thickness.
    pub fn breakpoints_through(&self, thickness: f64) -> Vec<f64> {
        if self.layers.is_empty() {
            return geometric_breakpoints(thickness, self.thickness - self.degree, self.grading);
        }
        let (mut breakpoints, mut below) = (vec![0.0], 0.0);
        for (l, layer) in self.layers.iter().enumerate() {
            let (n, above) = (layer.elements, below + layer.share);
            let part = |i: usize| thickness * (below + layer.share * i as f64 / n as f64);
            breakpoints.extend((1..n).map(part));
            breakpoints.push(match l + 1 == self.layers.len() {
                true => thickness,
                false => thickness * above,
            });
            below = above;
        }
        breakpoints
    }

    /// Returns how often the knot of each inner edge of the elements through the wall is repeated.
    pub fn multiplicities_through(&self) -> Vec<usize> {
        let mut multiplicities = vec![1; self.elements()[2] - 1];
        for range in self.elements_of_layers() {
            if let Some(interface) = multiplicities.get_mut(range.end - 1) {
                *interface = self.degree;
            }
        }
        multiplicities
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
