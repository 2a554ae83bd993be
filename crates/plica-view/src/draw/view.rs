//! Parallel projections of space onto a page.

use super::vec3::{cross, minus, unit};

/// A parallel projection: unit axes of the page in space, and the part of the page that an image shows.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    /// Direction in space that points to the right on the page.
    pub right: [f64; 3],
    /// Direction that points up the page.
    pub up: [f64; 3],
    /// Direction towards the viewer.
    pub toward: [f64; 3],
    /// Page coordinates of the top left corner of the image, in units of D.
    pub corner: (f64, f64),
    /// Pixels per unit of D.
    pub scale: f64,
    /// Width and height of the image in pixels.
    pub size: (usize, usize),
}

impl View {
    /// Returns the axes (right, up, toward) for a viewer in the direction `toward`; the z axis of the tube is horizontal on the page.
    #[must_use]
    pub fn axes(toward: [f64; 3]) -> [[f64; 3]; 3] {
        let toward = unit(toward);
        let right = unit(minus([0.0, 0.0, 1.0], toward.map(|c| c * toward[2])));
        [right, cross(toward, right), toward]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::vec3::dot;

    #[test]
    fn the_tube_axis_is_horizontal() {
        let [right, up, toward] = View::axes([0.4, 0.8, -0.3]);
        assert!(dot([0.0, 0.0, 1.0], up).abs() < 1e-12 && right[2] > 0.0);
        assert!(dot(cross(right, up), toward) > 0.999_999);
    }
}
