//! What the unknowns of a state belong to.

use super::Plan;
use crate::tube::{Mesh, Tube};

/// The size of a tube, its mesh, and the rings that are solved for: all that it takes to know
/// what the numbers of a state mean.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// Length of the tube, in D.
    pub length: f64,
    /// Thickness of its wall, in D.
    pub thickness: f64,
    /// The mesh.
    pub mesh: Mesh,
    /// Rings of the sector; the mesh's rings around the tube are a multiple.
    pub rings: usize,
}

impl Layout {
    /// The layout of a plan.
    pub fn of(plan: &Plan) -> Self {
        Self {
            length: plan.tube.length,
            thickness: plan.tube.thickness,
            mesh: plan.mesh.clone(),
            rings: plan.mesh.rings(plan.symmetry),
        }
    }

    /// Rows of control points, points through the wall, components and rings: the shape of `u`,
    /// the last index fastest. The largest number if it overflows.
    pub fn shape(&self) -> [usize; 4] {
        [self.mesh.axial, self.mesh.thickness, 3, self.rings]
    }

    /// Unknowns of the sector.
    pub fn unknowns(&self) -> usize {
        self.shape().iter().fold(1, |n, &m| n.saturating_mul(m))
    }

    /// Whether splines can be laid over a tube like this; if not, what is wrong.
    pub fn fault(&self) -> Option<&'static str> {
        let Mesh {
            axial,
            around,
            thickness,
            degree,
            ref refinements,
            volumetric: _,
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
            Some("its rings do not repeat around the tube")
        } else if !refinements.iter().all(|r| sound(r.from, r.to, r.factor)) {
            Some("its mesh is refined where nothing can be")
        } else {
            None
        }
    }
}
