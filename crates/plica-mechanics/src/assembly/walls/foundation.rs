//! Elastic foundations of the outer wall.
//!
//! Springs add ½ ∫ k(z, φ) |d|² dA₀ to the energy, with d the displacement from the stress-free shape, or its part along
//! the normal of the wall at rest, and dA₀ the area at rest. Where the diameter or the thickness varies along the tube, both
//! are those of that shape; small imperfections of the shape do not change them. See [`Foundation`](crate::tube::Foundation).

use super::super::SplineTube;
use super::super::kinematics::{Vector, to_element_frame};
use super::obstacles::PointContact;
use super::volume::Surface;
use super::{Along, CircumferentialPoint, LoadedWall, WallPoint};
use crate::tube::SpringDirection;

impl SplineTube {
    /// Returns the energy of the foundations per area at rest, and its derivatives, at a point that has moved by `u` in the
    /// frame of its element; none where there are none.
    pub(super) fn foundation_at(
        &self,
        wall: &LoadedWall,
        u: Vector<f64>,
        point: &WallPoint<'_>,
    ) -> Option<PointContact> {
        if !wall.has_foundations {
            return None;
        }
        let phi = self.angle_at(point.element, point.around);
        let mut found: Option<PointContact> = None;
        let d: Vector<f64> = std::array::from_fn(|i| u[i] - point.shape[2][i]);
        let area = wall.area_at_rest(point);
        let size = match wall.is_outlined {
            true => wall.foundation_area(point),
            false => area[1].hypot(area[2]),
        };
        let normal = area.map(|x| x / size);
        let along: f64 = (0..3).map(|i| normal[i] * d[i]).sum();
        for foundation in &self.tube.foundations {
            let k = foundation.stiffness * foundation.region.value(point.z, phi);
            if k == 0.0 {
                continue;
            }
            let at = found.get_or_insert_default();
            if foundation.direction == SpringDirection::All {
                at.energy += 0.5 * k * d.iter().map(|x| x * x).sum::<f64>();
                for i in 0..3 {
                    at.slope[i] += k * d[i];
                    at.curvature[i][i] += k;
                }
            } else if along < 0.0 || foundation.direction == SpringDirection::Normal {
                at.energy += 0.5 * k * along * along;
                for i in 0..3 {
                    at.slope[i] += k * along * normal[i];
                    for j in 0..3 {
                        at.curvature[i][j] += k * normal[i] * normal[j];
                    }
                }
            }
        }
        found
    }

    /// Returns the force of the foundations on the outer wall per area at rest, at a point of an element at the axial position
    /// z that has moved by `u` from the cylinder, given the displacement of the stress-free shape and its slopes.
    pub(in crate::assembly) fn foundation_force(
        &self,
        (element, around): (usize, &CircumferentialPoint),
        z: f64,
        u: Vector<f64>,
        shape: Option<Surface>,
    ) -> Vector<f64> {
        let wall = LoadedWall {
            has_foundations: true,
            ..self.bare_wall(1)
        };
        let point = WallPoint {
            element,
            number: 0,
            z,
            around,
            shape: shape.unwrap_or_default(),
        };
        let found = self.foundation_at(&wall, u, &point);
        found.map_or([0.0; 3], |at| at.slope.map(|slope| -slope))
    }

    /// Returns a quadrature point of a wall. Its number has a meaning only for the quadrature of the tube itself.
    pub(super) fn wall_point<'a>(
        &self,
        wall: &LoadedWall,
        along: Along<'_>,
        qz: usize,
        [element, number]: [usize; 2],
        around: &'a CircumferentialPoint,
    ) -> WallPoint<'a> {
        let (batch, lane) = along;
        let mut point = WallPoint {
            element,
            number: self.point_number(along, qz, [element, number]),
            z: batch.z[qz].0[lane],
            around,
            shape: [[0.0; 3]; 3],
        };
        let matters = wall.has_foundations || (wall.is_outlined && wall.dead != 0.0);
        let Some(shape) = self.stress_free_shape.as_ref().filter(|_| matters) else {
            return point;
        };
        let (m, k) = (self.row_size(), self.sector.rings);
        for (r, ring) in around.ring_values.iter().enumerate() {
            let (mut value, mut slope) = ([0.0; 3], [0.0; 3]);
            for a in 0..=self.degree() {
                let (n, dn) = self.along(along, qz, a);
                let row = (batch.first + lane + a) * m + wall.point * 3 * k;
                for i in 0..3 {
                    let u = shape.displacement[row + i * k + self.sector.ring(element, r)];
                    value[i] += n * u;
                    slope[i] += dn * u;
                }
            }
            let [along, around, at] = &mut point.shape;
            *along = to_element_frame(ring, 0, slope, *along);
            *around = to_element_frame(ring, 1, value, *around);
            *at = to_element_frame(ring, 0, value, *at);
        }
        point
    }
}
