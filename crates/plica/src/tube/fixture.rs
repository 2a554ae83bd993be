//! A small tube for tests.

use super::{Mesh, Support, Tube};
use crate::material::{Material, NeoHookean};

/// Returns a tube as long as it is wide, with free ends and without muscles.
pub fn short() -> Tube {
    Tube {
        length: 1.0,
        thickness: 0.1,
        material: Material::NeoHookean(NeoHookean::new(1.0, 0.3)),
        muscles: vec![],
        ends: [Support::Free; 2],
        imperfections: vec![],
    }
}

/// Returns a coarse cubic mesh: 6 control points along, 12 around, 4 through the wall.
pub fn coarse() -> Mesh {
    Mesh {
        axial: 6,
        around: 12,
        thickness: 4,
        degree: 3,
        refinements: vec![],
        volumetric: Default::default(),
    }
}
