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
    /// [`DrawError::Grid`] for a surface whose lists do not fill its grid, [`DrawError::Triangles`] for more than can be told apart.
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
        let mut triangles = 0usize;
        for surface in surfaces {
            surface.check()?;
            triangles = triangles.saturating_add(surface.points.len().saturating_mul(2));
        }
        if triangles >> scene.bits != 0 {
            return Err(DrawError::Triangles { triangles });
        }
        let scale = view.scale * samples as f64;
        let lamp = Lamp::default();
        for (number, surface) in surfaces.iter().enumerate() {
            if surface.columns < 2 || surface.rows < 2 {
                continue;
            }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::Map;

    #[test]
    fn names_tell_triangles_and_surfaces_apart() {
        let square = Surface {
            columns: 2,
            rows: 2,
            points: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]],
            values: vec![0.5; 4],
            sides: Sides::Both,
        };
        let view = View {
            right: [1.0, 0.0, 0.0],
            up: [0.0, 1.0, 0.0],
            toward: [0.0, 0.0, 1.0],
            corner: (0.0, 1.0),
            scale: 1.0,
            size: (16, 16),
        };
        let shader = Shader::new((0.0, 1.0), Map::Viridis);
        for count in [0, 1, 3, 6, 7, 8, 12] {
            let scene = Scene::of(&vec![square.clone(); count], &view, 2, &shader).unwrap();
            assert_eq!(scene.triangles.len(), 2 * count);
            assert_eq!(scene.surface(0), 0);
            for number in 0..2 * count as u32 {
                let name = scene.name(number);
                assert_eq!(scene.surface(name), number / 2 + 1);
                let places = scene.corners(name).map(|corner| corner.place);
                let own = scene.triangles[number as usize].corners;
                assert_eq!(places, scene.places(own));
            }
        }
        let nothing = Surface {
            rows: usize::MAX,
            ..Surface::default()
        };
        let scene = Scene::of(&[nothing], &view, 2, &shader).unwrap();
        assert!(scene.triangles.is_empty());
    }
}
