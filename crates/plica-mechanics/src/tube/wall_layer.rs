//! Layers of the wall.

use crate::material::Material;

/// A layer of the wall.
#[derive(Clone, Debug, PartialEq)]
pub struct WallLayer {
    /// Its name in the case file.
    pub name: String,
    /// Its thickness over that of the wall.
    pub share: f64,
    /// Its law, with stresses in E. Directions (along, outwards, around) are columns of Fe.
    pub material: Material,
    /// Its residual stretches.
    pub residual: ResidualStretch,
    /// Muscles of the tube, by their numbers, that do not act in it.
    pub idle_muscles: Vec<usize>,
}

/// Stress-free length over the length at rest at the inner and the outer face of a layer, linear in between. It acts like
/// growth that is always there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResidualStretch {
    /// Along the tube.
    pub along: [f64; 2],
    /// Around it.
    pub around: [f64; 2],
}

impl Default for ResidualStretch {
    fn default() -> Self {
        Self {
            along: [1.0; 2],
            around: [1.0; 2],
        }
    }
}

impl ResidualStretch {
    /// Returns the stretches along and around at a depth in the layer: 0 at its inner face, 1 at its outer face.
    pub fn at(&self, depth: f64) -> [f64; 2] {
        [self.along, self.around].map(|[inner, outer]| inner + depth * (outer - inner))
    }

    /// Returns true if there is none.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }
}

impl WallLayer {
    /// Returns the only layer of a wall.
    pub fn of(material: Material) -> Self {
        Self {
            name: "wall".into(),
            share: 1.0,
            material,
            residual: ResidualStretch::default(),
            idle_muscles: vec![],
        }
    }
}
