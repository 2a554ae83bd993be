//! Points of a cylindrical surface of the wall, and its tangents there.

use super::SplineTube;
use super::kinematics::{Vector, to_element_frame};
use super::tables::CircumferentialPoint;
use rayon::prelude::*;

/// A point of a deformed surface of constant reference radius; vectors are (z, x, y).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Current position, in D.
    pub position: [f64; 3],
    /// Its derivative over the axial position at rest.
    pub along: [f64; 3],
    /// Its derivative over s, which rises by one around an element.
    pub around: [f64; 3],
}

impl SplineTube {
    /// Returns the points of a surface at axial positions `z` at rest, one list for each. A list holds the points at the
    /// positions `s` (0 to 1) of the first element of the sector, then those of the next elements.
    pub fn surface_points(
        &self,
        u: &[f64],
        radius: f64,
        z: &[f64],
        s: &[f64],
    ) -> Vec<Vec<SurfacePoint>> {
        let around = |&s: &f64| CircumferentialPoint::at(&self.sector, &self.circle, s, 1.0);
        let around: Vec<CircumferentialPoint> = s.iter().map(around).collect();
        let ring = |&z: &f64| {
            let rings = self.displaced_rings(u, radius, z);
            let elements = 0..self.sector.rings;
            let points = elements.flat_map(|element| {
                let (rings, place) = (&rings, [z, radius]);
                let point = move |point| self.surface_point(rings, element, place, point);
                around.iter().map(point)
            });
            points.collect()
        };
        z.par_iter().map(ring).collect()
    }

    /// Returns the displacement of each ring of the sector at a reference radius, and its slope along.
    fn displaced_rings(&self, u: &[f64], radius: f64, z: f64) -> Vec<[Vector<f64>; 2]> {
        let (axial, wall) = (self.axial.evaluate(z), self.wall.evaluate(radius));
        let (m, k) = (self.row_size(), self.sector.rings);
        let mut rings = vec![[[0.0; 3]; 2]; k];
        for (a, (n, slope)) in axial.value.iter().zip(&axial.slope).enumerate() {
            for (c, w) in wall.value.iter().enumerate() {
                let first = (axial.first + a) * m + (wall.first + c) * 3 * k;
                for (j, ring) in rings.iter_mut().enumerate() {
                    for i in 0..3 {
                        let u = u[first + i * k + j];
                        ring[0][i] += n * w * u;
                        ring[1][i] += slope * w * u;
                    }
                }
            }
        }
        rings
    }

    fn surface_point(
        &self,
        rings: &[[Vector<f64>; 2]],
        element: usize,
        [z, radius]: [f64; 2],
        point: &CircumferentialPoint,
    ) -> SurfacePoint {
        let across = |(re, im): (f64, f64)| [0.0, radius * re, radius * im];
        let mut position = across(point.circle);
        position[0] = z;
        let mut along = [1.0, 0.0, 0.0];
        let mut around = across(point.circle_slope);
        for (r, ring) in point.ring_values.iter().enumerate() {
            let [value, slope] = rings[self.sector.ring(element, r)];
            position = to_element_frame(ring, 0, value, position);
            along = to_element_frame(ring, 0, slope, along);
            around = to_element_frame(ring, 1, value, around);
        }
        // From the element's frame to the laboratory.
        let (sin, cos) = (element as f64 * self.sector.angle()).sin_cos();
        let rotated = |[z, x, y]: [f64; 3]| [z, x * cos - y * sin, x * sin + y * cos];
        SurfacePoint {
            position: rotated(position),
            along: rotated(along),
            around: rotated(around),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Point;
    use super::super::tests::{TubeAndLoad, tube_and_load, wavy};

    #[test]
    fn points_of_a_surface_are_those_of_the_samples_and_have_their_slopes() {
        for rings in [1, 2, 6] {
            let TubeAndLoad { tube, load } = tube_and_load(3, [5, 2, 6], rings);
            let u = wavy(&tube);
            let (z, s, h) = (0.7, 0.3, 1e-5);
            let points = tube.surface_points(&u, 0.4, &[z - h, z, z + h], &[s - h, s, s + h]);
            for element in 0..rings {
                let at = 3 * element + 1;
                let angle = (element as f64 + s - 0.5) * tube.sector.angle();
                let place = Point {
                    z,
                    radius: 0.4,
                    angle,
                };
                let sample = tube.sample(&load, &u, place);
                let point = points[1][at];
                for i in 0..3 {
                    assert!((point.position[i] - sample.position[i]).abs() < 1e-12);
                    let along = (points[2][at].position[i] - points[0][at].position[i]) / (2.0 * h);
                    let around =
                        (points[1][at + 1].position[i] - points[1][at - 1].position[i]) / (2.0 * h);
                    assert!((point.along[i] - along).abs() < 1e-6);
                    assert!((point.around[i] - around).abs() < 1e-6);
                }
            }
        }
    }
}
