//! Diameter and wall thickness that vary along the tube.
//!
//! The stress-free shape of such a tube is that of a circular cylinder of thickness H, displaced: the point at radius R is
//! below the outer face at D(z)/2 by the depth (D/2 − R) h(z)/H, along the normal of the face. So a line through the wall
//! stays normal to it, and the map from the cylinder is a rotation and stretches along, through and around the wall. At a
//! corner the direction turns within twice the thickness on both sides, and toward the ends to that of the radius, so that
//! the end faces are plane.

use super::Tube;

/// Outer diameter and wall thickness along the tube, in D: points (z, value), linear between them and constant beyond
/// them. No points stand for the diameter or the thickness of the tube itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outline {
    /// Outer diameter.
    pub diameter: Vec<[f64; 2]>,
    /// Wall thickness.
    pub thickness: Vec<[f64; 2]>,
}

impl Outline {
    /// Returns the outer diameter at z.
    pub fn diameter_at(&self, z: f64) -> f64 {
        value_at(&self.diameter, z).unwrap_or(2.0 * Tube::OUTER_RADIUS)
    }

    /// Returns the wall thickness at z of a tube of thickness H.
    pub fn thickness_at(&self, z: f64, thickness: f64) -> f64 {
        value_at(&self.thickness, z).unwrap_or(thickness)
    }

    /// Returns the displacement along and outwards of the point at (z, R) of a cylinder of length L and thickness H.
    pub fn displacement(&self, z: f64, radius: f64, [length, thickness]: [f64; 2]) -> [f64; 2] {
        let h = self.thickness_at(z, thickness);
        let depth = (Tube::OUTER_RADIUS - radius) / thickness * h;
        let from_end = z.min(length - z).max(0.0);
        // Where the slope changed within less than the thickness, the inner face would fold over.
        let angle = self.mean_slope(z, 2.0 * h).atan() * (from_end / (2.0 * h)).min(1.0);
        let (sin, cos) = angle.sin_cos();
        [
            depth * sin,
            0.5 * self.diameter_at(z) - depth * cos - radius,
        ]
    }

    /// Returns the mean slope of the outer radius within a distance of z.
    fn mean_slope(&self, z: f64, distance: f64) -> f64 {
        let [before, after] = [z - distance, z + distance].map(|z| self.diameter_at(z));
        (after - before) / (4.0 * distance)
    }

    /// Returns the positions of all points.
    pub fn positions(&self) -> impl Iterator<Item = f64> {
        self.diameter.iter().chain(&self.thickness).map(|[z, _]| *z)
    }
}

/// Returns the value of a table at z; none without points.
fn value_at(points: &[[f64; 2]], z: f64) -> Option<f64> {
    let after = points.partition_point(|[at, _]| *at <= z);
    let [before, next] = [after.checked_sub(1), Some(after)].map(|i| points.get(i?));
    match (before, next) {
        (Some([a, from]), Some([b, to])) => Some(from + (to - from) * (z - a) / (b - a)),
        (one, other) => one.or(other).map(|[_, value]| *value),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_linear_between_its_points_and_constant_beyond() {
        let outline = Outline {
            diameter: vec![[0.5, 1.0], [1.5, 0.6], [2.0, 0.8]],
            thickness: vec![],
        };
        for (z, expected) in [(0.0, 1.0), (0.5, 1.0), (1.0, 0.8), (1.75, 0.7), (3.0, 0.8)] {
            assert!((outline.diameter_at(z) - expected).abs() < 1e-15, "{z}");
            assert_eq!(outline.thickness_at(z, 0.06), 0.06);
        }
        assert_eq!(Outline::default().diameter_at(1.0), 1.0);
    }

    #[test]
    fn the_inner_face_is_one_thickness_from_the_outer_one() {
        // Slope −0.75, so that the normal is (0.6, 0.8).
        let outline = Outline {
            diameter: vec![[1.0, 5.0], [3.0, 2.0]],
            thickness: vec![[0.0, 0.1]],
        };
        let at = |z: f64, radius: f64| {
            let [along, outwards] = outline.displacement(z, radius, [4.0, 0.06]);
            [z + along, radius + outwards]
        };
        for (z, radius, expected) in [
            (2.0, 0.5, [2.0, 1.75]),
            (2.0, 0.44, [2.0 - 0.06, 1.75 - 0.08]),
            (2.0, 0.47, [2.0 - 0.03, 1.75 - 0.04]),
            (0.0, 0.44, [0.0, 2.4]),
            (4.0, 0.44, [4.0, 0.9]),
        ] {
            for (found, expected) in at(z, radius).into_iter().zip(expected) {
                assert!((found - expected).abs() < 1e-14, "{z} {radius}: {found}");
            }
        }
        assert!((outline.mean_slope(1.0, 0.2) + 0.375).abs() < 1e-14);
    }
}
