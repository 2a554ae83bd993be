//! Elastic foundations of the outer wall.
//!
//! Springs add ½ ∫ k(z, φ) |d|² dA₀ to the energy, with d the displacement from the stress-free shape, or its part along
//! the normal of the wall at rest, and dA₀ the area at rest. See [`Foundation`](crate::tube::Foundation).

use super::super::SplineTube;
use super::super::kinematics::{Vector, to_element_frame};
use super::obstacles::PointContact;
use super::{Along, LoadedWall, WallPoint};
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
        let d: Vector<f64> = std::array::from_fn(|i| u[i] - point.shape[i]);
        let area = wall.area_at_rest(point);
        let size = area[1].hypot(area[2]);
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

    /// Returns a quadrature point of a wall. Its number has a meaning only for the quadrature of the tube itself.
    pub(super) fn wall_point<'a>(
        &self,
        wall: &LoadedWall,
        along: Along<'_>,
        qz: usize,
        [element, number]: [usize; 2],
        around: &'a super::CircumferentialPoint,
    ) -> WallPoint<'a> {
        let (batch, lane) = along;
        let mut point = WallPoint {
            element,
            number: self.point_number(along, qz, [element, number]),
            z: batch.z[qz].0[lane],
            around,
            shape: [0.0; 3],
        };
        let Some(shape) = self
            .stress_free_shape
            .as_ref()
            .filter(|_| wall.has_foundations)
        else {
            return point;
        };
        let (m, k) = (self.row_size(), self.sector.rings);
        for (r, ring) in around.ring_values.iter().enumerate() {
            let mut value = [0.0; 3];
            for a in 0..=self.degree() {
                let (n, _) = self.along(along, qz, a);
                let row = (batch.first + lane + a) * m + wall.point * 3 * k;
                for (i, value) in value.iter_mut().enumerate() {
                    *value += n * shape.displacement[row + i * k + self.sector.ring(element, r)];
                }
            }
            point.shape = to_element_frame(ring, 0, value, point.shape);
        }
        point
    }
}
