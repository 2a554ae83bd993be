//! Reactions of the supports.
//!
//! The residual at a prescribed unknown is the force of the support on it. The virtual work of these forces in a rigid
//! motion of an end gives their resultants: a rigid motion of the face is the same motion of its control points, so sums
//! over control points are exact. The potential of a follower pressure is that of the volume between flat ends
//! ([`crate::assembly`]), so the axial force includes the force of the pressures on flat lids.

use super::dimensions::cross;
use crate::assembly::SplineTube;
use crate::tube::Load;

/// Force and moment of the support of an end on the whole tube, in E·D² and E·D³.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reaction {
    /// Force (z, x, y).
    pub force: [f64; 3],
    /// Moment (z, x, y) about the centre of the end where it is prescribed to be.
    pub moment: [f64; 3],
    /// Axial component of the outward normal of the end: −1 at z = 0, 1 at z = L.
    pub outwards: f64,
}

impl Reaction {
    /// Returns the reactions at both ends, from the residual of a state.
    pub fn of(tube: &SplineTube, load: &Load, u: &[f64], residual: &[f64]) -> [Self; 2] {
        let (k, repeats) = (tube.sector.rings, tube.sector.repeats());
        let (z, at_ends) = (tube.axial.greville(), tube.prescribed_at_ends());
        let radii = tube.wall.greville();
        let end = |(end, row): (usize, usize)| {
            let (mut force, mut moment) = ([0.0; 3], [0.0; 3]);
            for (c, radius) in radii.iter().enumerate() {
                let unknown = |i: usize| (row * radii.len() + c) * 3 + i;
                for ring in 0..k {
                    let (sin, cos) = tube.sector.ring_angle(ring).sin_cos();
                    let in_space = |[z, r, t]: [f64; 3]| [z, r * cos - t * sin, r * sin + t * cos];
                    let f = in_space([0, 1, 2].map(|i| match at_ends[unknown(i)] {
                        true => residual[unknown(i) * k + ring],
                        false => 0.0,
                    }));
                    let mut x = [0, 1, 2].map(|i| u[unknown(i) * k + ring]);
                    // From the centre of the end.
                    x[0] -= load.ends[end].displacement;
                    x[1] += radius * tube.circle.control_radius;
                    let mut x = in_space(x);
                    for (k, shift) in load.ends[end].shift.iter().enumerate() {
                        x[k + 1] -= shift;
                    }
                    let m = cross(x, f);
                    for i in 0..3 {
                        force[i] += f[i];
                        moment[i] += m[i];
                    }
                }
            }
            // The sectors cancel each other across the axis.
            let whole = |sum: [f64; 3]| match repeats {
                1.0 => sum,
                repeats => [repeats * sum[0], 0.0, 0.0],
            };
            Self {
                force: whole(force),
                moment: whole(moment),
                outwards: [-1.0, 1.0][end],
            }
        };
        [(0, 0), (1, z.len() - 1)].map(end)
    }

    /// Returns the axial force, positive if it pulls the end outwards.
    pub fn axial_force(&self) -> f64 {
        self.outwards * self.force[0]
    }

    /// Returns the magnitude of the force across the axis.
    pub fn shear_force(&self) -> f64 {
        self.force[1].hypot(self.force[2])
    }

    /// Returns the moment about the axis, positive if it turns the end counterclockwise as seen from outside.
    pub fn torque(&self) -> f64 {
        self.outwards * self.moment[0]
    }

    /// Returns the magnitude of the moment about axes across the tube's.
    pub fn bending_moment(&self) -> f64 {
        self.moment[1].hypot(self.moment[2])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::Point;
    use crate::material::{Material, NeoHookean};
    use crate::measure::Dimensions;
    use crate::study::fixture::plan;
    use crate::study::{Stage, Study};
    use crate::tube::{EndMotion, Pressure, Support, Symmetry};
    use std::f64::consts::{PI, TAU};

    fn tube(rings: usize, ends: Support) -> SplineTube {
        let mut plan = plan(Symmetry::Axisymmetric);
        plan.tube.ends = [ends; 2];
        SplineTube::new(&plan.tube, &plan.mesh, rings)
    }

    fn reactions(tube: &SplineTube, load: &Load, u: &[f64]) -> [Reaction; 2] {
        let forces = tube.forces(load, u).unwrap();
        Reaction::of(tube, load, u, &forces.residual)
    }

    /// Returns μ and λ of the fixture's law.
    fn lame(tube: &SplineTube) -> [f64; 2] {
        let Material::NeoHookean(NeoHookean { mu, lambda, .. }) = tube.tube.layers[0].material
        else {
            panic!("the law is not neo-Hookean")
        };
        [mu, lambda]
    }

    #[test]
    fn a_uniform_bar_is_pulled_with_the_same_force_at_both_ends() {
        let tube = tube(1, Support::Sliding);
        let ([mu, lambda], along) = (lame(&tube), 1.3_f64);
        // No stress across the axis: μ (b² − 1) + λ ln(a b²) = 0.
        let mut b = 1.0_f64;
        for _ in 0..30 {
            let f = mu * (b * b - 1.0) + lambda * (along * b * b).ln();
            b -= f / (2.0 * mu * b + 2.0 * lambda / b);
        }
        let length = tube.tube.length;
        let u = tube.control_values_from(|z, r, _| {
            let r = r * tube.circle.control_radius;
            [(along - 1.0) * (z - 0.5 * length), (b - 1.0) * r, 0.0]
        });
        let mut load = tube.tube.rest();
        load.ends = [-1.0, 1.0].map(|side| EndMotion {
            displacement: side * 0.5 * (along - 1.0) * length,
            ..EndMotion::default()
        });
        let stress = mu * (along - 1.0 / along) + lambda * (along * b * b).ln() / along;
        let area = PI * (0.25 - tube.tube.inner_radius().powi(2));
        for end in reactions(&tube, &load, &u) {
            let error = end.axial_force() / (stress * area) - 1.0;
            assert!(error.abs() < 1e-3, "{error}");
            assert_eq!((end.shear_force(), end.bending_moment()), (0.0, 0.0));
            assert!(end.torque().abs() < 1e-12);
        }
    }

    #[test]
    fn a_twisted_tube_has_the_torque_of_a_bar_at_both_ends() {
        let tube = tube(1, Support::Fixed);
        let (twist, length) = (1e-4, tube.tube.length);
        let u = tube.control_values_from(|z, r, _| {
            let r = r * tube.circle.control_radius;
            [0.0, 0.0, r * twist * z / length]
        });
        let polar = 0.5 * PI * (0.5_f64.powi(4) - tube.tube.inner_radius().powi(4));
        let expected = lame(&tube)[0] * polar * twist / length;
        let mut load = tube.tube.rest();
        load.ends[1].twist = twist;
        for end in reactions(&tube, &load, &u) {
            let error = end.torque() / expected - 1.0;
            assert!(error.abs() < 2e-3, "{error}");
        }
    }

    #[test]
    fn reactions_are_the_derivatives_of_the_energy_by_rigid_motions_of_an_end() {
        let whole = plan(Symmetry::Axisymmetric).mesh.around;
        let tube = tube(whole, Support::Fixed);
        let mut load = tube.tube.rest();
        load.ends[1].displacement = 0.1;
        load.pressures[0].follower = 0.02;
        let bent = tube.control_values_from(|z, r, ring| {
            let angle = TAU * ring as f64 / whole as f64;
            let (sin, cos) = angle.sin_cos();
            [
                0.1 * z * z + 0.1 * z * r * cos,
                0.1 * z * cos,
                0.1 * z * (r - sin),
            ]
        });
        let row = tube.row_size();
        let radii = tube.wall.greville();
        let ends = reactions(&tube, &load, &bent);
        for (end, reaction) in ends.iter().enumerate() {
            let first = [0, bent.len() - row][end];
            let centre = load.ends[end].displacement;
            // The energy with an end moved by t + w × x to first order.
            let energy = |t: [f64; 3], w: [f64; 3]| {
                let mut u = bent.clone();
                for (c, radius) in radii.iter().enumerate() {
                    for ring in 0..whole {
                        let at = |i: usize| first + (c * 3 + i) * whole + ring;
                        let (sin, cos) = tube.sector.ring_angle(ring).sin_cos();
                        let r = radius * tube.circle.control_radius + bent[at(1)];
                        let x = [
                            bent[at(0)] - centre,
                            r * cos - bent[at(2)] * sin,
                            r * sin + bent[at(2)] * cos,
                        ];
                        let turned = cross(w, x);
                        let move_by = [0, 1, 2].map(|i| t[i] + turned[i]);
                        u[at(0)] += move_by[0];
                        u[at(1)] += move_by[1] * cos + move_by[2] * sin;
                        u[at(2)] += move_by[2] * cos - move_by[1] * sin;
                    }
                }
                tube.forces(&load, &u).unwrap().potential
            };
            let h = 1e-5;
            for i in 0..3 {
                let step = |h: f64| [0, 1, 2].map(|j| if i == j { h } else { 0.0 });
                let nil = [0.0; 3];
                let force = (energy(step(h), nil) - energy(step(-h), nil)) / (2.0 * h);
                let moment = (energy(nil, step(h)) - energy(nil, step(-h))) / (2.0 * h);
                let scale = 1e-6 * (1.0 + force.abs() + moment.abs());
                assert!((reaction.force[i] - force).abs() < scale, "{i}: {force}");
                assert!((reaction.moment[i] - moment).abs() < scale, "{i}: {moment}");
            }
            assert!(reaction.shear_force() > 1e-3 && reaction.bending_moment() > 1e-3);
        }
    }

    #[test]
    fn the_ends_of_a_tube_under_pressure_balance_the_section_and_the_fluid() {
        let mut plan = plan(Symmetry::Axisymmetric);
        (plan.mesh.axial, plan.mesh.around) = (15, 36);
        plan.tube.ends = [Support::Fixed; 2];
        plan.output.stability_modes = 0;
        let pressure = 0.03;
        let mut load = plan.tube.rest();
        load.pressures[0] = Pressure {
            follower: pressure,
            dead: 0.0,
        };
        load.ends[1].displacement = 0.05;
        let name = "inflate".into();
        plan.stages = vec![Stage::new(name, load, 2)];
        let mut study = Study::new(&plan).unwrap();
        let state = study.by_ref().last().unwrap().unwrap();
        let [first, second] = state.reactions.map(|end| end.axial_force());
        assert!(
            (first - second).abs() < 1e-8 * first.abs(),
            "{first} {second}"
        );
        // ∫ P_zz dA₀ over the middle section, less the pressure on the section of the lumen.
        let tube = study.tube();
        let (inner, thickness) = (tube.tube.inner_radius(), tube.tube.thickness);
        let mut section = 0.0;
        for (x, w) in crate::spline::gauss_legendre(5) {
            let radius = inner + x * thickness;
            let place = Point {
                z: 0.5,
                radius,
                angle: 0.0,
            };
            let sample = tube.sample(&state.load, &state.unknowns, place);
            let column = |j: usize| [0, 1, 2].map(|i| sample.elastic.0[i][j]);
            let area = cross(column(1), column(2));
            let traction: f64 = (0..3).map(|j| sample.stress.0[0][j] * area[j]).sum();
            section += w * thickness * TAU * radius * traction;
        }
        let ring = tube.surface_points(&state.unknowns, inner, &[0.5], &[0.5]);
        let [_, x, y] = ring[0][0].position;
        let fluid = pressure * PI * (x * x + y * y);
        let error = (section - fluid - first) / fluid;
        assert!(error.abs() < 5e-3, "{section} − {fluid} is not {first}");
        assert!(state.dimensions.outer_radius_max > 0.51);
        let volume = Dimensions::of(tube, &vec![0.0; tube.unknowns()]).lumen_volume;
        assert!(state.dimensions.lumen_volume > 1.05 * volume);
    }
}
