//! Fields at a point of the wall.

use super::SplineTube;
use super::kinematics::{GradientMap, Vector, to_element_frame};
use super::spline_tube::PartKind;
use super::stress_free::ImperfectionMap;
use super::tables::CircumferentialPoint;
use crate::material::Law;
use crate::spline::Values;
use crate::tensor::{Tensor2, with_vectors};
use crate::tube::{Load, Tube};

/// Distance from the outer wall, in D, within which a point is on it.
const ON_FACE: f64 = 1e-9;

/// A material point, by its reference position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Position along the tube, in D.
    pub z: f64,
    /// Radius, in D.
    pub radius: f64,
    /// Angle around the tube, in radians.
    pub angle: f64,
}

/// Fields at a material point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Reference position (z, x, y), in the perfect tube.
    pub reference: [f64; 3],
    /// Current position (z, x, y).
    pub position: [f64; 3],
    /// Elastic deformation gradient: rows (z, outwards, around) at the middle of the point's
    /// element, columns (along, outwards, around) at the point.
    pub elastic: Tensor2,
    /// det Fe; at the nearest volumetric point, if the volumetric part of the law has points of its
    /// own.
    pub jacobian: f64,
    /// Strain energy density w(Fe), per grown volume and with that of active stresses, in E.
    pub energy_density: f64,
    /// Cauchy stress, in E: rows and columns (z, outwards, around) at the middle of the point's element.
    pub stress: Tensor2,
    /// Growth stretches θζ along and θη around: of the muscles, times the residual stretches.
    pub grown: [f64; 2],
    /// Growth stretch θξ through the wall, of patches.
    pub grown_through: f64,
    /// Sum of the tensions of muscles with active stress, in E.
    pub tension: f64,
    /// Factor of patches on the energy of the law.
    pub stiffness: f64,
    /// Force of the foundations per area at rest, in E, (z, outwards, around) at the middle of the point's element; zero
    /// inside the outer wall.
    pub foundation: [f64; 3],
    /// Angle of the middle of the point's element, in radians.
    pub element_angle: f64,
}

impl Sample {
    /// Returns true if det Fe is not positive here or at the nearest volumetric point, as may
    /// happen between quadrature points: neither energy nor stress exists.
    pub fn is_inverted(&self) -> bool {
        self.elastic.determinant().min(self.jacobian) <= 0.0
    }

    /// Returns the principal stretches of Fe, largest first, and their directions in the deformed
    /// wall, (z, outwards, around) at the middle of the point's element.
    pub fn stretches(&self) -> [(f64, [f64; 3]); 3] {
        let left = self.elastic.times(self.elastic.transpose()); // b = Fe Feᵀ
        left.eigenpairs()
            .map(|(square, direction)| (square.max(0.0).sqrt(), direction))
    }

    /// Returns the normal components of the Cauchy stress in the directions of the deformed wall, in E: along its meridian
    /// (the line that runs along the tube at rest), through the wall (normal to that line and to the circle), and along its
    /// circle. Without stress-free shape imperfections these lines are the columns of Fe.
    pub fn wall_stresses(&self) -> [f64; 3] {
        let column = |j: usize| [0, 1, 2].map(|i| self.elastic.0[i][j]);
        let (along, around) = (column(0), column(2));
        let across = |i: usize, j: usize| around[i] * along[j] - around[j] * along[i];
        let through = [across(1, 2), across(2, 0), across(0, 1)];
        let s = self.stress.0;
        [along, through, around].map(|a| {
            let (mut normal, mut square) = (0.0, 0.0);
            for i in 0..3 {
                square += a[i] * a[i];
                (0..3).for_each(|j| normal += a[i] * s[i][j] * a[j]);
            }
            normal / square
        })
    }

    /// Returns the von Mises stress √(3/2 s : s), s the deviator of σ, in E.
    pub fn von_mises(&self) -> f64 {
        let mut s = self.stress;
        let mean = (s.0[0][0] + s.0[1][1] + s.0[2][2]) / 3.0;
        (0..3).for_each(|i| s.0[i][i] -= mean);
        (1.5 * s.dot(s)).sqrt()
    }
}

impl SplineTube {
    /// Evaluates the fields at a point under a load; at an interface of layers, in the outer one.
    /// Outside the wall, it extrapolates the splines of the nearest element. If the volumetric part of the law has quadrature points of its own,
    /// its energy and stress are those of the nearest of them through the wall, since the volume is
    /// not controlled between them.
    pub fn sample(&self, load: &Load, u: &[f64], at: Point) -> Sample {
        // With fused multiply-add enabled this takes a third of the time.
        with_vectors!(simd => self.sample_at(load, u, at))
    }

    #[inline(always)]
    fn sample_at(&self, load: &Load, u: &[f64], at: Point) -> Sample {
        let element = self.wall.find(at.radius);
        let holds = |part: &&Self| part.layers.iter().any(|layer| layer.element == element);
        let parts = || self.all_parts().filter(holds);
        let own = parts().find(|part| !part.is_volumetric()).unwrap_or(self);
        let mut sample = own.sample_here(load, u, at);
        if !self.tube.foundations.is_empty() && (at.radius - Tube::OUTER_RADIUS).abs() < ON_FACE {
            sample.foundation = self.foundation_here(u, at);
        }
        for part in parts() {
            if matches!(part.kind, PartKind::Muscle(_)) && !part.is_idle(load) {
                let active = part.sample_here(load, u, at);
                sample.tension += part.energy_factor(at.z, at.angle, load);
                sample.energy_density += active.energy_density;
                sample.stress = sum(sample.stress, active.stress);
            }
        }
        let Some(volume) = parts().find(|part| part.is_volumetric()) else {
            return sample;
        };
        let points = volume.layers.iter().flat_map(|layer| {
            let points = layer.radius.iter().zip(&layer.weight);
            points.filter(|(_, weight)| **weight > 0.0).map(|(r, _)| *r)
        });
        let far = |r: &f64| (r - at.radius).abs();
        let nearest = points.min_by(|a, b| far(a).total_cmp(&far(b)));
        let radius = nearest.unwrap_or(at.radius);
        let there = volume.sample_here(load, u, Point { radius, ..at });
        Sample {
            energy_density: sample.energy_density + there.energy_density,
            stress: sum(sample.stress, there.stress),
            jacobian: there.jacobian,
            ..sample
        }
    }

    /// Evaluates the fields for `self.law` alone.
    #[inline(always)]
    fn sample_here(&self, load: &Load, u: &[f64], at: Point) -> Sample {
        let near = self.near(at);
        let (point, element) = (&near.point, near.element);
        let alpha = self.sector.angle();
        let (value, gradients) = self.displaced(u, &near);
        let (theta_z, theta_t) = self
            .tube
            .stretches_at(self.wall_layer, at.z, at.angle, load);
        let residual = self.tube.residual_stretch(self.wall_layer, at.radius);
        let (theta_z, theta_t) = (theta_z * residual[0], theta_t * residual[1]);
        let (inverse_along, inverse_around) = (1.0 / theta_z, 1.0 / theta_t);
        let imperfection_map = self.stress_free_shape.as_ref().map(|imperfect| {
            let gradient_map = GradientMap::new(point, at.radius, [1.0; 2], [1.0; 2]);
            let (_, gradients) = self.displaced(&imperfect.displacement, &near);
            let A = gradient_map.elastic_gradient(point, at.radius, gradients);
            ImperfectionMap::from_gradient(A, inverse_along, inverse_around)
        });
        let (imperfection_map, [through, stiffness]) = self.with_patch(imperfection_map, load, at);
        let gradient_map =
            GradientMap::new(point, at.radius, [inverse_along, inverse_around], [1.0; 2]);
        let gradient_map = gradient_map.with_imperfection(imperfection_map);
        let Fe = gradient_map.elastic_gradient(point, at.radius, gradients);
        let reference = [at.z, at.radius * point.circle.0, at.radius * point.circle.1];
        let position = [0, 1, 2].map(|i| reference[i] + value[i]);
        // From the element's frame to the laboratory.
        let (sin, cos) = (element * alpha).sin_cos();
        let rotated = |x: [f64; 3]| [x[0], x[1] * cos - x[2] * sin, x[1] * sin + x[2] * cos];
        let energy_density = stiffness * self.law.energy(&Fe);
        let P = self.law.stress(&Fe).scaled(stiffness);
        let jacobian = Fe.determinant();
        Sample {
            reference: rotated(reference),
            position: rotated(position),
            jacobian,
            energy_density,
            stress: P.times(Fe.transpose()).scaled(1.0 / jacobian), // σ = P Feᵀ / det Fe
            grown: [theta_z, theta_t],
            grown_through: through,
            tension: 0.0,
            stiffness,
            foundation: [0.0; 3],
            element_angle: element * alpha,
            elastic: Fe,
        }
    }
}

impl SplineTube {
    /// Adds patches to the map from F Fp⁻¹ to Fe at a point, and returns their growth through the wall and their factor on
    /// the energy.
    #[inline(always)]
    fn with_patch(
        &self,
        map: Option<ImperfectionMap<f64>>,
        load: &Load,
        at: Point,
    ) -> (Option<ImperfectionMap<f64>>, [f64; 2]) {
        let (tube, layer) = (&self.tube, self.wall_layer);
        if !self.has_factors(load) {
            return (map, [1.0; 2]);
        }
        let through = tube.growth_through(layer, at.z, at.angle, load);
        let stiffness = self.energy_factor(at.z, at.angle, load);
        let map = map.unwrap_or(ImperfectionMap::identity(1.0));
        let map = map.with_patch([1.0, 1.0 / through, 1.0], stiffness);
        (Some(map), [through, stiffness])
    }
}

/// Basis functions at a point.
struct Near {
    axial: Values,
    wall: Values,
    point: CircumferentialPoint,
    /// Number of the element around, in the whole tube.
    element: f64,
    /// First ring of the element around.
    first_ring: usize,
}

impl SplineTube {
    /// Returns the basis functions at a point.
    #[inline(always)]
    fn near(&self, at: Point) -> Near {
        // Element 0 is centred on angle zero.
        let rotations = at.angle / self.sector.angle() + 0.5;
        let (element, s) = (rotations.floor(), rotations - rotations.floor());
        Near {
            axial: self.axial.evaluate(at.z),
            wall: self.wall.evaluate(at.radius),
            point: CircumferentialPoint::at(&self.sector, &self.circle, s, 1.0),
            element,
            first_ring: (element as i64).rem_euclid(self.sector.rings as i64) as usize,
        }
    }

    /// Returns the force of the foundations per area at rest at a point of the outer wall, in the element's frame.
    fn foundation_here(&self, u: &[f64], at: Point) -> Vector<f64> {
        let near = self.near(at);
        let shape = self.stress_free_shape.as_ref().map(|imperfect| {
            let (value, [along, around, _]) = self.displaced(&imperfect.displacement, &near);
            [along, around, value]
        });
        let (moved, _) = self.displaced(u, &near);
        self.foundation_force((near.first_ring, &near.point), at.z, moved, shape)
    }

    /// Returns a displacement and its gradients over ζ, s and R, in the element's frame.
    #[inline(always)]
    fn displaced(&self, u: &[f64], near: &Near) -> (Vector<f64>, [Vector<f64>; 3]) {
        let Near { axial, wall, .. } = near;
        let rings = self.sector.rings;
        let (mut value, mut g) = ([0.0; 3], [[0.0; 3]; 3]);
        for (a, (n, dn)) in axial.value.iter().zip(&axial.slope).enumerate() {
            for (c, (m, dm)) in wall.value.iter().zip(&wall.slope).enumerate() {
                for (r, ring) in near.point.ring_values.iter().enumerate() {
                    let row = axial.first + a;
                    let index = |i: usize| {
                        row * self.row_size()
                            + ((wall.first + c) * 3 + i) * rings
                            + (near.first_ring + r) % rings
                    };
                    let u = [0, 1, 2].map(|i| u[index(i)]);
                    value = to_element_frame(ring, 0, u.map(|x| n * m * x), value);
                    g[0] = to_element_frame(ring, 0, u.map(|x| dn * m * x), g[0]);
                    g[1] = to_element_frame(ring, 1, u.map(|x| n * m * x), g[1]);
                    g[2] = to_element_frame(ring, 0, u.map(|x| n * dm * x), g[2]);
                }
            }
        }
        (value, g)
    }
}

fn sum(a: Tensor2, b: Tensor2) -> Tensor2 {
    Tensor2([0, 1, 2].map(|i| [0, 1, 2].map(|j| a.0[i][j] + b.0[i][j])))
}
