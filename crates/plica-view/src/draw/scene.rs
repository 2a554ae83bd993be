//! Projection of surfaces onto the page: triangles and the illumination of their corners.

use super::light::{Lamp, Shader};
use super::vec3::dot;
use super::view::View;
use super::{DrawError, Sides, Surface};

/// All triangles of a picture.
#[derive(Default)]
pub(super) struct Scene {
    pub corners: Vec<Corner>,
    pub triangles: Vec<Triangle>,
    /// Number of low bits of an identifier that hold the index of the triangle.
    index_bits: u32,
}

/// A triangle.
#[derive(Clone, Copy)]
pub(super) struct Triangle {
    pub corners: [u32; 3],
    /// Number of the surface, starting from one.
    surface: u32,
}

/// A corner of a triangle.
#[derive(Clone, Copy)]
pub(super) struct Corner {
    /// Position on the page and depth towards the viewer, in samples.
    pub position: [f64; 3],
    /// Shade of the field value.
    pub shade: f32,
    /// Diffuse and specular intensity of the front side and of the back side.
    pub intensity: [[f32; 2]; 2],
}

impl Scene {
    /// Projects surfaces onto the page; `samples` is the number of samples along each side of a pixel.
    ///
    /// # Errors
    /// [`DrawError::Grid`] for lists that do not match the grid, [`DrawError::Triangles`] for more triangles than identifiers.
    pub fn new(
        surfaces: &[Surface],
        view: &View,
        samples: usize,
        shader: &Shader,
    ) -> Result<Self, DrawError> {
        let mut scene = Self {
            index_bits: u32::BITS - (surfaces.len() + 1).ilog2() - 1,
            ..Self::default()
        };
        let mut triangles = 0usize;
        for surface in surfaces {
            surface.check()?;
            triangles = triangles.saturating_add(surface.points.len().saturating_mul(2));
        }
        if triangles >> scene.index_bits != 0 {
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
                    position: [across, down, dot(p, view.toward) * scale],
                    shade: shader.shade(value),
                    intensity: [lamp.intensity(normal), lamp.intensity(normal.map(|c| -c))],
                }
            });
            scene.corners.extend(corners);
            for row in 1..surface.rows {
                for column in 1..surface.columns {
                    let d = first + row * surface.columns + column;
                    let (a, b, c) = (d - surface.columns - 1, d - surface.columns, d - 1);
                    for corners in [[a, b, d], [a, d, c]] {
                        let corners = corners.map(|corner| corner as u32);
                        let area = double_area(scene.positions(corners));
                        let is_hidden = match surface.sides {
                            Sides::Both => false,
                            // Seen against the normal, the corners are in counter-clockwise order; the rows of the page run downwards.
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

    /// Returns the identifier of a triangle, which contains its index and its surface. It is never 0.
    #[inline(always)]
    pub fn id(&self, index: u32) -> u32 {
        self.triangles[index as usize].surface << self.index_bits | index
    }

    /// Returns the number of the surface of a triangle, starting from one; 0 for id 0.
    #[inline(always)]
    pub fn surface(&self, id: u32) -> u32 {
        id >> self.index_bits
    }

    /// Returns the corners of a triangle.
    #[inline(always)]
    pub fn corners(&self, id: u32) -> [&Corner; 3] {
        let index = id & ((1 << self.index_bits) - 1);
        let Triangle { corners, .. } = self.triangles[index as usize];
        corners.map(|corner| &self.corners[corner as usize])
    }

    /// Returns the positions of corners.
    pub fn positions(&self, corners: [u32; 3]) -> [[f64; 3]; 3] {
        corners.map(|corner| self.corners[corner as usize].position)
    }
}

/// Returns twice the area of a triangle on the page, positive if the viewer sees its corners in clockwise order.
#[inline]
pub(super) fn double_area([a, b, c]: [[f64; 3]; 3]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::ColourMap;

    #[test]
    fn identifiers_contain_triangle_and_surface() {
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
        let shader = Shader::new((0.0, 1.0), ColourMap::Viridis);
        for count in [0, 1, 3, 6, 7, 8, 12] {
            let scene = Scene::new(&vec![square.clone(); count], &view, 2, &shader).unwrap();
            assert_eq!(scene.triangles.len(), 2 * count);
            assert_eq!(scene.surface(0), 0);
            for number in 0..2 * count as u32 {
                let id = scene.id(number);
                assert_eq!(scene.surface(id), number / 2 + 1);
                let positions = scene.corners(id).map(|corner| corner.position);
                let own = scene.triangles[number as usize].corners;
                assert_eq!(positions, scene.positions(own));
            }
        }
        let empty = Surface {
            rows: usize::MAX,
            ..Surface::default()
        };
        let scene = Scene::new(&[empty], &view, 2, &shader).unwrap();
        assert!(scene.triangles.is_empty());
    }
}
