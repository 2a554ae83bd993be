//! The light of samples.

use super::light::Shader;
use super::scene::{Scene, double_area};

/// A quantity that changes evenly over a triangle: at its first corner, and what it grows by a sample to the right and down.
type Plane = [f32; 3];

/// The light of triangles, each worked out once as long as samples stay on it.
pub(super) struct Lit<'a> {
    scene: &'a Scene,
    /// First row of the strip.
    top: usize,
    /// The triangle at hand, by its name.
    name: u32,
    /// Where the first corner lies: close to it, differences have all digits.
    at: [f64; 2],
    shade: Plane,
    body: Plane,
    gloss: Plane,
}

impl<'a> Lit<'a> {
    pub fn new(scene: &'a Scene, top: usize) -> Self {
        let none = [0.0; 3];
        Self {
            scene,
            top,
            name: 0,
            at: [0.0; 2],
            shade: none,
            body: none,
            gloss: none,
        }
    }

    /// The light of a sample that shows the triangle of a name, or the paper for none; rows are counted in the strip.
    #[inline(always)]
    pub fn at(&mut self, name: u32, x: usize, y: usize, shader: &Shader) -> [f32; 3] {
        if name == 0 {
            return [1.0; 3];
        }
        if name != self.name {
            self.turn_to(name);
        }
        let (x, y) = (
            (x as f64 + 0.5 - self.at[0]) as f32,
            ((y + self.top) as f64 + 0.5 - self.at[1]) as f32,
        );
        let on = |plane: &Plane| plane[0] + x * plane[1] + y * plane[2];
        shader.light(on(&self.shade), on(&self.body), on(&self.gloss))
    }

    #[inline(always)]
    fn turn_to(&mut self, name: u32) {
        self.name = name;
        let corners = self.scene.corners(name);
        let places = corners.map(|corner| corner.place);
        let double_area = double_area(places);
        let per_area = 1.0 / double_area;
        // Corners go around the normal; on the page, whose rows run down, that is against the clock where it points to the viewer.
        let side = usize::from(double_area > 0.0);
        let [a, b, c] = places;
        let [bx, by] = [b[0] - a[0], b[1] - a[1]];
        let [cx, cy] = [c[0] - a[0], c[1] - a[1]];
        let plane = |[at_a, at_b, at_c]: [f32; 3]| {
            let [to_b, to_c] = [f64::from(at_b - at_a), f64::from(at_c - at_a)];
            [
                at_a,
                ((to_b * cy - to_c * by) * per_area) as f32,
                ((to_c * bx - to_b * cx) * per_area) as f32,
            ]
        };
        self.at = [a[0], a[1]];
        self.shade = plane(corners.map(|corner| corner.shade));
        self.body = plane(corners.map(|corner| corner.lit[side][0]));
        self.gloss = plane(corners.map(|corner| corner.lit[side][1]));
    }
}
