//! Light of samples, interpolated linearly over triangles.

use super::light::Shader;
use super::scene::{Scene, double_area};

/// A linear function on a triangle: its value at the first corner, and its increments per sample to the right and down.
type Linear = [f32; 3];

/// Interpolates light on triangles; the coefficients of the last triangle are cached.
pub(super) struct Interpolator<'a> {
    scene: &'a Scene,
    /// First row of samples of the strip.
    top: usize,
    /// Identifier of the cached triangle.
    id: u32,
    /// Position of the first corner, the origin of the linear functions.
    origin: [f64; 2],
    shade: Linear,
    diffuse: Linear,
    specular: Linear,
}

impl<'a> Interpolator<'a> {
    pub fn new(scene: &'a Scene, top: usize) -> Self {
        let none = [0.0; 3];
        Self {
            scene,
            top,
            id: 0,
            origin: [0.0; 2],
            shade: none,
            diffuse: none,
            specular: none,
        }
    }

    /// Returns the light of sample (x, y) of the strip, which shows the triangle `id`; id 0 is white paper.
    #[inline(always)]
    pub fn sample(&mut self, id: u32, x: usize, y: usize, shader: &Shader) -> [f32; 3] {
        if id == 0 {
            return [1.0; 3];
        }
        if id != self.id {
            self.load(id);
        }
        let (x, y) = (
            (x as f64 + 0.5 - self.origin[0]) as f32,
            ((y + self.top) as f64 + 0.5 - self.origin[1]) as f32,
        );
        let on = |f: &Linear| f[0] + x * f[1] + y * f[2];
        shader.light(on(&self.shade), on(&self.diffuse), on(&self.specular))
    }

    #[inline(always)]
    fn load(&mut self, id: u32) {
        self.id = id;
        let corners = self.scene.corners(id);
        let positions = corners.map(|corner| corner.position);
        let double_area = double_area(positions);
        let per_area = 1.0 / double_area;
        // Seen against the normal, the corners are in counter-clockwise order; the rows of the page run downwards.
        let side = usize::from(double_area > 0.0);
        let [a, b, c] = positions;
        let [bx, by] = [b[0] - a[0], b[1] - a[1]];
        let [cx, cy] = [c[0] - a[0], c[1] - a[1]];
        let linear = |[at_a, at_b, at_c]: [f32; 3]| {
            let [to_b, to_c] = [f64::from(at_b - at_a), f64::from(at_c - at_a)];
            [
                at_a,
                ((to_b * cy - to_c * by) * per_area) as f32,
                ((to_c * bx - to_b * cx) * per_area) as f32,
            ]
        };
        self.origin = [a[0], a[1]];
        self.shade = linear(corners.map(|corner| corner.shade));
        self.diffuse = linear(corners.map(|corner| corner.intensity[side][0]));
        self.specular = linear(corners.map(|corner| corner.intensity[side][1]));
    }
}
