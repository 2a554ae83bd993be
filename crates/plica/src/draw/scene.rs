//! Surfaces as a page shows them: triangles, and how their corners are lit.

use super::light::{Lamp, Shader, dot};
use super::raster::View;
use super::{DrawError, Sides, Surface};

/// All triangles by their corners.
#[derive(Default)]
pub(super) struct Scene {
    pub corners: Vec<Corner>,
    pub triangles: Vec<Triangle>,
    /// Of the name of a triangle, the bits that count triangles.
    bits: u32,
}

/// A triangle.
#[derive(Clone, Copy)]
pub(super) struct Triangle {
    pub corners: [u32; 3],
    /// Which surface it is of, counted from one.
    surface: u32,
}

/// A corner of a triangle.
#[derive(Clone, Copy)]
pub(super) struct Corner {
    /// Place on the page and depth towards the viewer, in samples.
    pub place: [f64; 3],
    /// Which shade it has.
    pub shade: f32,
    /// How it is lit where the viewer sees the side that its normal points to, and where the other.
    pub lit: [[f32; 2]; 2],
}

impl Scene {
    /// # Errors
    /// [`DrawError::Grid`] for a surface whose lists do not fill its grid, [`DrawError::Backend`] for more than can be told apart.
    pub fn of(
        surfaces: &[Surface],
        view: &View,
        samples: usize,
        shader: &Shader,
    ) -> Result<Self, DrawError> {
        let mut scene = Self {
            bits: u32::BITS - (surfaces.len() + 1).ilog2() - 1,
            ..Self::default()
        };
        let scale = view.scale * samples as f64;
        let lamp = Lamp::default();
        for (number, surface) in surfaces.iter().enumerate() {
            surface.check()?;
            let first = scene.corners.len();
            let points = surface.points.iter().zip(surface.normals());
            let corners = points.zip(&surface.values).map(|((&p, n), &value)| {
                let across = (dot(p, view.right) - view.corner.0) * scale;
                let down = (view.corner.1 - dot(p, view.up)) * scale;
                let normal = [view.right, view.up, view.toward].map(|axis| dot(n, axis));
                Corner {
                    place: [across, down, dot(p, view.toward) * scale],
                    shade: shader.shade(value),
                    lit: [lamp.on(normal), lamp.on(normal.map(|c| -c))],
                }
            });
            scene.corners.extend(corners);
            for row in 1..surface.rows {
                for column in 1..surface.columns {
                    let d = first + row * surface.columns + column;
                    let (a, b, c) = (d - surface.columns - 1, d - surface.columns, d - 1);
                    for corners in [[a, b, d], [a, d, c]] {
                        let corners = corners.map(|corner| corner as u32);
                        let area = double_area(scene.places(corners));
                        let is_hidden = match surface.sides {
                            Sides::Both => false,
                            // Corners go around the normal; on the page, whose rows run down, against the clock.
                            Sides::Front => area > 0.0,
                            Sides::Back => area < 0.0,
                        };
                        if !is_hidden {
                            let surface = number as u32 + 1;
                            scene.triangles.push(Triangle { corners, surface });
                        }
                    }
                }
            }
        }
        let told_apart = scene.triangles.len() as u64 <= 1 << scene.bits;
        if !told_apart || u32::try_from(scene.corners.len()).is_err() {
            return Err(DrawError::Backend("too many triangles".into()));
        }
        Ok(scene)
    }

    /// The name of a triangle by its number, from which that and its surface can be read; never 0, which is for none.
    #[inline(always)]
    pub fn name(&self, number: u32) -> u32 {
        self.triangles[number as usize].surface << self.bits | number
    }

    /// Which surface a triangle is of by its name, counted from one; 0 for none.
    #[inline(always)]
    pub fn surface(&self, name: u32) -> u32 {
        name >> self.bits
    }

    /// The corners of a triangle by its name.
    #[inline(always)]
    pub fn corners(&self, name: u32) -> [&Corner; 3] {
        let number = name & ((1 << self.bits) - 1);
        let Triangle { corners, .. } = self.triangles[number as usize];
        corners.map(|corner| &self.corners[corner as usize])
    }

    /// Where corners lie.
    pub fn places(&self, corners: [u32; 3]) -> [[f64; 3]; 3] {
        corners.map(|corner| self.corners[corner as usize].place)
    }
}

/// Twice the area of a triangle on the page, positive if its corners go around clockwise as the viewer sees it.
#[inline]
pub(super) fn double_area([a, b, c]: [[f64; 3]; 3]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
}
