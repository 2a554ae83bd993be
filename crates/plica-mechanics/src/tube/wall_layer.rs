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
    /// The open sector that the layer is a part of when it is free of stress; multiplies `around`.
    pub opening: Option<Opening>,
}

/// Open sector to which a tube springs when it is cut along its length. Thickness is conserved, so that a point at radius r of
/// the tube is at r + s of the sector, and its stress-free length over that at rest is q (r + s)/r around the tube.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Opening {
    /// Fraction q of a full circle that the sector covers.
    pub fraction: f64,
    /// Radius in the sector less that in the tube, s, in D.
    pub shift: f64,
}

impl Default for ResidualStretch {
    fn default() -> Self {
        Self {
            along: [1.0; 2],
            around: [1.0; 2],
            opening: None,
        }
    }
}

impl ResidualStretch {
    /// Returns the stretches along and around at a depth in the layer, 0 at its inner face and 1 at its outer face, and at
    /// that radius.
    pub fn at(&self, depth: f64, radius: f64) -> [f64; 2] {
        let [along, around] =
            [self.along, self.around].map(|[inner, outer]| inner + depth * (outer - inner));
        match &self.opening {
            Some(Opening { fraction, shift }) => {
                [along, around * fraction * (radius + shift) / radius]
            }
            None => [along, around],
        }
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
