//! Volume and narrowest cross-section of the lumen, and radii of the outer wall.
//!
//! With x the position on a face, s around it and z along it at rest, and with the outward element of area
//! x_s × x_z ds dz, the divergence theorem gives the volume of the lumen
//!
//! V = ⅓ ∫∫ x · (x_s × x_z) ds dz + ⅓ c₁ · A(L) − ⅓ c₀ · A(0),    A(z) = ½ ∮ x × x_s ds.
//!
//! A(z) is the vector area of the material ring at z, and c₀ and c₁ are the centres of the rings at the ends: each end is
//! closed by straight lines from its edge to its centre, which is a flat lid if the edge is plane. The integrands are
//! polynomials on each element, and Gauss points integrate them exactly.
//!
//! A region that the wall winds around several times, as it crosses itself, counts as often, with the sign of the winding.

use super::POINTS_PER_ELEMENT;
use crate::assembly::{SplineTube, SurfacePoint};
use crate::spline::gauss_legendre;
use crate::tube::Tube;

/// Sizes of one state, of the whole tube; lengths in D.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Dimensions {
    /// Volume of the lumen between flat ends.
    pub lumen_volume: f64,
    /// Smallest cross-section of the lumen: the smallest |A| of a material ring of the inner face.
    pub lumen_area_min: f64,
    /// Largest distance of a point of the outer face from the centre of its material ring.
    pub outer_radius_max: f64,
    /// Distance of the outer wall from the axis at the middle of the length at rest, as the mean over the circumference.
    pub outer_radius_mid: f64,
}

impl Dimensions {
    /// Measures a state.
    pub fn of(tube: &SplineTube, u: &[f64]) -> Self {
        let z = tube
            .axial
            .positions(tube.axial.elements() * POINTS_PER_ELEMENT + 1);
        // The middles of the elements around, where the spline circle has the same radius.
        let rings = tube.surface_points(u, Tube::OUTER_RADIUS, &z, &[0.5]);
        let largest = rings.iter().flat_map(|ring| radii(tube, ring));
        let middle = [0.5 * tube.tube.length];
        let middle = tube.surface_points(u, Tube::OUTER_RADIUS, &middle, &[0.5]);
        let (inner, rule) = (tube.tube.inner_radius(), rule(tube));
        let s: Vec<f64> = rule.iter().map(|(s, _)| *s).collect();
        let inner = tube.surface_points(u, inner, &z, &s);
        let areas = inner.iter().map(|ring| norm(vector_area(tube, ring)));
        Self {
            lumen_volume: enclosed_volume(tube, u, tube.tube.inner_radius()),
            lumen_area_min: areas.fold(f64::INFINITY, f64::min),
            outer_radius_max: largest.fold(0.0, f64::max),
            outer_radius_mid: {
                let radii = radii(tube, &middle[0]);
                radii.iter().sum::<f64>() / radii.len() as f64
            },
        }
    }
}

/// Returns the volume that a surface of constant reference radius encloses between its flat ends.
pub(crate) fn enclosed_volume(tube: &SplineTube, u: &[f64], radius: f64) -> f64 {
    let rule = rule(tube);
    let s: Vec<f64> = rule.iter().map(|(s, _)| *s).collect();
    let along = (0..tube.axial.elements()).flat_map(|e| {
        let (from, to) = tube.axial.element(e);
        let length = to - from;
        let points = rule.iter();
        points.map(move |(x, w)| (from + length * x, length * w))
    });
    let (z, weights): (Vec<f64>, Vec<f64>) = along.unzip();
    let mut flux = 0.0;
    for (ring, weight) in tube.surface_points(u, radius, &z, &s).iter().zip(weights) {
        for (point, (_, w)) in ring.iter().zip(rule.iter().cycle()) {
            flux += weight * w * dot(point.position, cross(point.around, point.along));
        }
    }
    let edges = tube.surface_points(u, radius, &[0.0, tube.tube.length], &s);
    let lid = |ring| dot(centre(tube, ring), vector_area(tube, ring));
    (tube.sector.repeats() * flux + lid(&edges[1]) - lid(&edges[0])) / 3.0
}

/// Returns the Gauss points that integrate polynomials of degree 3p − 1.
fn rule(tube: &SplineTube) -> Vec<(f64, f64)> {
    gauss_legendre((3 * tube.degree()).div_ceil(2))
}

/// Returns ½ ∮ x × x_s ds of the whole ring, from its points at [`rule`].
fn vector_area(tube: &SplineTube, ring: &[SurfacePoint]) -> [f64; 3] {
    let mut area = [0.0; 3];
    for (point, (_, w)) in ring.iter().zip(rule(tube).iter().cycle()) {
        let x = cross(point.position, point.around);
        (0..3).for_each(|i| area[i] += 0.5 * w * x[i]);
    }
    match tube.sector.repeats() {
        1.0 => area,
        repeats => [repeats * area[0], 0.0, 0.0],
    }
}

/// Returns the mean of the points of a ring of the whole tube.
fn centre(tube: &SplineTube, ring: &[SurfacePoint]) -> [f64; 3] {
    let mean = |i: usize| ring.iter().map(|p| p.position[i]).sum::<f64>() / ring.len() as f64;
    match tube.sector.repeats() {
        1.0 => [0, 1, 2].map(mean),
        _ => [mean(0), 0.0, 0.0],
    }
}

/// Returns the distances, across the axis, of points from the centre of their ring.
fn radii(tube: &SplineTube, ring: &[SurfacePoint]) -> Vec<f64> {
    let [_, x, y] = centre(tube, ring);
    let points = ring.iter().map(|p| p.position);
    points.map(|[_, a, b]| (a - x).hypot(b - y)).collect()
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn norm(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

/// Returns a × b; (z, x, y) is as right-handed as (x, y, z).
pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::fixture::plan;
    use crate::tube::Symmetry;
    use std::f64::consts::{PI, TAU};

    fn tube(rings: usize) -> SplineTube {
        let plan = plan(Symmetry::Axisymmetric);
        SplineTube::new(&plan.tube, &plan.mesh, rings)
    }

    /// Returns the displacement x ↦ A x + b of all control points; vectors are (z, x, y).
    fn affine(tube: &SplineTube, a: [[f64; 3]; 3], b: [f64; 3]) -> Vec<f64> {
        tube.control_values_from(|z, r, ring| {
            let (sin, cos) = tube.sector.ring_angle(ring).sin_cos();
            let r = r * tube.circle.control_radius;
            let x = [z, r * cos, r * sin];
            let u = [0, 1, 2].map(|i| dot(a[i], x) + b[i] - x[i]);
            [u[0], u[1] * cos + u[2] * sin, u[2] * cos - u[1] * sin]
        })
    }

    #[test]
    fn an_affine_map_scales_the_volume_by_its_determinant() {
        let whole = plan(Symmetry::Axisymmetric).mesh.around;
        let tube = tube(whole);
        let rest = Dimensions::of(&tube, &vec![0.0; tube.unknowns()]);
        let a = [[1.1, 0.2, -0.1], [0.3, 0.8, 0.25], [-0.2, 0.1, 1.3]];
        let moved = Dimensions::of(&tube, &affine(&tube, a, [0.4, -2.0, 3.0]));
        let determinant = dot(a[0], cross(a[1], a[2]));
        let expected = determinant * rest.lumen_volume;
        assert!((moved.lumen_volume / expected - 1.0).abs() < 1e-12);
        // The vector area e_z A₀ becomes A₀ cof(A) e_z.
        let columns = [0, 1, 2].map(|j| [0, 1, 2].map(|i| a[i][j]));
        let area = rest.lumen_area_min * norm(cross(columns[1], columns[2]));
        assert!((moved.lumen_area_min / area - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_tube_at_rest_has_the_sizes_of_a_cylinder() {
        for rings in [1, plan(Symmetry::Axisymmetric).mesh.around] {
            let tube = tube(rings);
            let size = Dimensions::of(&tube, &vec![0.0; tube.unknowns()]);
            let area = PI * tube.tube.inner_radius().powi(2);
            // The spline circle is not quite a circle.
            assert!((size.lumen_area_min / area - 1.0).abs() < 1e-3);
            let volume = size.lumen_area_min * tube.tube.length;
            assert!((size.lumen_volume / volume - 1.0).abs() < 1e-12);
            assert!((size.outer_radius_max - 0.5).abs() < 1e-3);
            assert!((size.outer_radius_mid - size.outer_radius_max).abs() < 1e-12);
        }
    }

    #[test]
    fn a_waist_is_the_smallest_cross_section_in_every_symmetry() {
        let whole = plan(Symmetry::Axisymmetric).mesh.around;
        let sizes = [1, whole].map(|rings| {
            let tube = tube(rings);
            let (length, inner) = (tube.tube.length, tube.tube.inner_radius());
            let u = tube.control_values_from(|z, _, _| [0.0, -0.2 * (PI * z / length).sin(), 0.0]);
            let size = Dimensions::of(&tube, &u);
            // The wall moves inwards by as much inside as outside.
            let narrow = PI * (inner - (0.5 - size.outer_radius_mid)).powi(2);
            assert!((size.lumen_area_min / narrow - 1.0).abs() < 2e-3);
            assert!((size.outer_radius_max - 0.5).abs() < 1e-3 && size.outer_radius_mid < 0.4);
            size
        });
        assert!((sizes[0].lumen_volume / sizes[1].lumen_volume - 1.0).abs() < 1e-12);
        assert!((sizes[0].lumen_area_min / sizes[1].lumen_area_min - 1.0).abs() < 1e-12);
        // A shift with the angle does not widen the ring: mode 1 moves its centre.
        let tube = tube(whole);
        let u = tube.control_values_from(|_, _, ring| {
            let angle = TAU * ring as f64 / whole as f64;
            [0.0, 0.1 * angle.cos(), -0.1 * angle.sin()]
        });
        let size = Dimensions::of(&tube, &u);
        assert!((size.outer_radius_max - size.outer_radius_mid).abs() < 1e-12);
    }
}
