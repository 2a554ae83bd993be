//! Illumination and colour of surface points.

use super::colour::{ColourMap, MISSING, to_linear, to_srgb};
use super::vec3::{dot, unit};

/// A light source above the left shoulder of the viewer.
pub(super) struct Lamp {
    direction: [f64; 3],
    /// Direction halfway between the lamp and the viewer, for the specular part.
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
    /// Returns the diffuse and the specular intensity of a surface with a unit normal in page axes: Lambert's law with an
    /// ambient part, and a weak specular reflection.
    pub fn intensity(&self, normal: [f64; 3]) -> [f32; 2] {
        let diffuse = dot(normal, self.direction).max(0.0);
        let specular = dot(normal, self.halfway).max(0.0).powi(40);
        [(0.5 + 0.58 * diffuse) as f32, (0.05 * specular) as f32]
    }
}

/// Colours of a field in linear light.
pub(super) struct Shader {
    low: f64,
    per_value: f64,
    /// The colour map in linear light.
    map: Vec<[f32; 3]>,
    missing: [f32; 3],
    /// sRGB bytes of linear light from 0 to 1, in equal steps.
    bytes: Vec<u8>,
}

impl Shader {
    const SHADES: usize = 1024;
    const BYTES: usize = 4096;

    pub fn new((low, high): (f64, f64), map: ColourMap) -> Self {
        let linear = |c: [u8; 3]| c.map(|byte| to_linear(byte) as f32);
        let map = (0..=Self::SHADES)
            .map(|i| linear(map.colour(i as f64 / Self::SHADES as f64)))
            .collect();
        Self {
            low,
            per_value: Self::SHADES as f64 / (high - low),
            map,
            missing: linear(MISSING),
            bytes: (0..Self::BYTES)
                .map(|i| to_srgb(i as f64 / (Self::BYTES - 1) as f64))
                .collect(),
        }
    }

    /// Returns the shade of a value: an index into the map, or NaN for a missing value.
    pub fn shade(&self, value: f64) -> f32 {
        ((value - self.low) * self.per_value) as f32
    }

    /// Returns the light reflected by a point with a shade and the two intensities of [`Lamp::intensity`].
    #[inline(always)]
    pub fn light(&self, shade: f32, diffuse: f32, specular: f32) -> [f32; 3] {
        let [r, g, b] = if shade.is_nan() {
            self.missing
        } else {
            self.map[(shade.max(0.0) as usize).min(Self::SHADES)]
        };
        [
            r * diffuse + specular,
            g * diffuse + specular,
            b * diffuse + specular,
        ]
    }

    /// Converts light to an sRGB pixel.
    #[inline(always)]
    pub fn pixel(&self, [r, g, b]: [f32; 3]) -> [u8; 3] {
        let byte =
            |light: f32| self.bytes[(light.clamp(0.0, 1.0) * (Self::BYTES - 1) as f32) as usize];
        [byte(r), byte(g), byte(b)]
    }
}
