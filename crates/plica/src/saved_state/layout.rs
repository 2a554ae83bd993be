//! The layout of the unknowns of a state.

use crate::tube::{Mesh, MeshLayer, Tube};

/// The layout of the unknowns of a state: size of the tube, mesh, and rings of the cyclic sector.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// Length of the tube, in D.
    pub length: f64,
    /// Thickness of its wall, in D.
    pub thickness: f64,
    /// The mesh.
    pub mesh: Mesh,
    /// Rings of the cyclic sector; the number of rings around the tube is a multiple.
    pub rings: usize,
}

impl Layout {
    /// Returns the shape of the unknowns: rows along the tube, points through the wall, components (axial, radial,
    /// circumferential), rings; the last index is fastest.
    pub fn shape(&self) -> [usize; 4] {
        [self.mesh.axial, self.mesh.thickness, 3, self.rings]
    }

    /// Returns the number of unknowns; `usize::MAX` if it overflows.
    pub fn unknowns(&self) -> usize {
        self.shape().iter().fold(1, |n, &m| n.saturating_mul(m))
    }

    /// Returns a reason why no tube can have this layout; none if one can.
    pub fn fault(&self) -> Option<&'static str> {
        let Mesh {
            axial,
            around,
            thickness,
            degree,
            ref refinements,
            grading,
            contact_range,
            volumetric: _,
            ref layers,
        } = self.mesh;
        let sound = |from: f64, to: f64, factor: f64| {
            from < to && from.is_finite() && to.is_finite() && (1.0..=1e6).contains(&factor)
        };
        if !(self.length > 0.0 && self.length.is_finite()) {
            Some("its tube has no length")
        } else if !(self.thickness > 0.0 && self.thickness < Tube::OUTER_RADIUS) {
            Some("its wall has no thickness, or fills the tube")
        } else if !(1..=5).contains(&degree) {
            Some("the degree of its splines is not from 1 to 5")
        } else if axial <= degree || thickness <= degree || around < 2 * degree + 2 {
            Some("its mesh has too few control points for the degree")
        } else if self.rings == 0 || !around.is_multiple_of(self.rings) {
            Some("its rings do not divide the rings around the tube")
        } else if !refinements.iter().all(|r| sound(r.from, r.to, r.factor)) {
            Some("a zone of refinement of its mesh is invalid")
        } else if !(1e-6..=1e6).contains(&grading) {
            Some("the grading of its mesh through the wall is invalid")
        } else if !(1e-6..=1e6).contains(&contact_range) {
            Some("the range of contact of its mesh is invalid")
        } else if !layers.is_empty() && !self.has_valid_layers() {
            Some("the layers of its wall do not fit together")
        } else {
            None
        }
    }

    /// Returns true if the layers of the mesh are those of a wall with its control points.
    fn has_valid_layers(&self) -> bool {
        let Mesh {
            degree,
            thickness,
            ref layers,
            ..
        } = self.mesh;
        let sound = |layer: &MeshLayer| layer.share > 0.0 && (1..=4096).contains(&layer.elements);
        let shares: f64 = layers.iter().map(|layer| layer.share).sum();
        layers.len() <= 4096
            && layers.iter().all(sound)
            && (shares - 1.0).abs() < 1e-9
            && Mesh::points_through(degree, layers) == thickness
    }
}
