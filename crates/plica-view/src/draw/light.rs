//! The light that leaves a point of a surface, and the little vector algebra that needs.

use super::colour::{MISSING, Map, to_byte, to_light};

/// A lamp above the viewer's left shoulder.
pub(super) struct Lamp {
    direction: [f64; 3],
    /// Between it and the viewer: what gloss is seen by.
    halfway: [f64; 3],
}

impl Default for Lamp {
    fn default() -> Self {
        let direction = unit([-0.3, 0.45, 1.0]);
        let halfway = unit([direction[0], direction[1], direction[2] + 1.0]);
        Self { direction, halfway }
    }
}

impl Lamp {
    /// How much of its colour, and of white, a surface throws back that has this unit normal in page axes: Lambert's law with an
    /// ambient part, and a weak gloss.
    pub fn on(&self, normal: [f64; 3]) -> [f32; 2] {
        let diffuse = dot(normal, self.direction).max(0.0);
        let gloss = dot(normal, self.halfway).max(0.0).powi(40);
        [(0.5 + 0.58 * diffuse) as f32, (0.05 * gloss) as f32]
    }
}

/// Colours of a field as light.
pub(super) struct Shader {
    low: f64,
    per_value: f64,
    /// The colour map as light.
    map: Vec<[f32; 3]>,
    missing: [f32; 3],
    /// Bytes of light from 0 to 1, in even steps.
    bytes: Vec<u8>,
}

impl Shader {
    const SHADES: usize = 1024;
    const BYTES: usize = 4096;

    pub fn new((low, high): (f64, f64), map: Map) -> Self {
        let light = |c: [u8; 3]| c.map(|byte| to_light(byte) as f32);
        let map = (0..=Self::SHADES)
            .map(|i| light(map.colour(i as f64 / Self::SHADES as f64)))
            .collect();
        Self {
            low,
            per_value: Self::SHADES as f64 / (high - low),
            map,
            missing: light(MISSING),
            bytes: (0..Self::BYTES)
                .map(|i| to_byte(i as f64 / (Self::BYTES - 1) as f64))
                .collect(),
        }
    }

    /// Which shade a value has: a place along the map, NaN for none.
    pub fn shade(&self, value: f64) -> f32 {
        ((value - self.low) * self.per_value) as f32
    }

    /// The light that leaves a point of such a shade that throws back so much of its colour and of white.
    #[inline(always)]
    pub fn light(&self, shade: f32, body: f32, gloss: f32) -> [f32; 3] {
        let [r, g, b] = if shade.is_nan() {
            self.missing
        } else {
            self.map[(shade.max(0.0) as usize).min(Self::SHADES)]
        };
        [r * body + gloss, g * body + gloss, b * body + gloss]
    }

    /// Light as an sRGB pixel.
    #[inline(always)]
    pub fn pixel(&self, [r, g, b]: [f32; 3]) -> [u8; 3] {
        let byte =
            |light: f32| self.bytes[(light.clamp(0.0, 1.0) * (Self::BYTES - 1) as f32) as usize];
        [byte(r), byte(g), byte(b)]
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
