//! The light that leaves a point of a surface, and the little vector algebra that needs.

use super::colour::{MISSING, Map, to_byte, to_light};

/// The light that leaves a point of the surface.
pub(super) struct Shader {
    low: f64,
    per_value: f64,
    /// The colour map as light.
    map: Vec<[f32; 3]>,
    missing: [f32; 3],
    /// Bytes of light from 0 to 1, in even steps.
    bytes: Vec<u8>,
    lamp: [f64; 3],
    halfway: [f64; 3],
}

impl Shader {
    const SHADES: usize = 1024;
    const BYTES: usize = 4096;

    pub fn new((low, high): (f64, f64), map: Map) -> Self {
        let light = |c: [u8; 3]| c.map(|byte| to_light(byte) as f32);
        let map = (0..=Self::SHADES)
            .map(|i| light(map.colour(i as f64 / Self::SHADES as f64)))
            .collect();
        let lamp = unit([-0.3, 0.45, 1.0]);
        let halfway = unit([lamp[0], lamp[1], lamp[2] + 1.0]);
        let per_value = Self::SHADES as f64 / (high - low);
        Self {
            low,
            per_value,
            map,
            missing: light(MISSING),
            bytes: (0..Self::BYTES)
                .map(|i| to_byte(i as f64 / (Self::BYTES - 1) as f64))
                .collect(),
            lamp,
            halfway,
        }
    }

    /// Lambert's law with an ambient part, and a weak gloss; the side towards the viewer is the one that is lit.
    #[inline]
    pub fn light(&self, normal: [f64; 3], value: f64) -> [f32; 3] {
        let normal = unit(normal);
        let normal = if normal[2] < 0.0 {
            normal.map(|c| -c)
        } else {
            normal
        };
        let diffuse = dot(normal, self.lamp).max(0.0);
        let gloss = dot(normal, self.halfway).max(0.0).powi(40);
        let (body, shine) = ((0.5 + 0.58 * diffuse) as f32, (0.05 * gloss) as f32);
        let place = (value - self.low) * self.per_value;
        let shade = if place.is_nan() {
            self.missing
        } else {
            self.map[(place.max(0.0) as usize).min(Self::SHADES)]
        };
        shade.map(|c| c * body + shine)
    }

    /// The sRGB byte of light.
    #[inline]
    pub fn byte(&self, light: f32) -> u8 {
        self.bytes[(light.clamp(0.0, 1.0) * (Self::BYTES - 1) as f32) as usize]
    }
}

pub(super) fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

#[inline]
pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline]
pub(super) fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = dot(a, a).sqrt();
    if length > 0.0 {
        a.map(|c| c / length)
    } else {
        a
    }
}
