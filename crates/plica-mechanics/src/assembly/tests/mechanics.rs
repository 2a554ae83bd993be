//! Basic mechanics of a tube: state of rest, rigid motions, forces as derivatives of the energy.

use super::{TubeAndLoad, direction, dot, largest, mesh, moved, tube_and_load, unknowns, wavy};
use crate::assembly::reference::ReferenceTube;
use crate::assembly::{Point, SplineTube};
use crate::material::{Material, NeoHookean};
use crate::tube::{Load, Support, Tube, WallLayer};
use std::f64::consts::{PI, TAU};

#[test]
fn tube_at_rest_has_exact_radii_and_volume_and_no_residual() {
    let tube = Tube {
        length: 3.0,
        thickness: 0.06,
        layers: vec![WallLayer::of(Material::NeoHookean(NeoHookean::new(
            1.0, 0.495,
        )))],
        muscles: vec![],
        ends: [Support::Fixed; 2],
        imperfections: vec![],
        obstacles: vec![],
        patches: vec![],
        foundations: vec![],
    };
    let spline = SplineTube::new(&tube, &mesh(3, [10, 2, 60]), 1);
    let rest = tube.rest();
    let u = vec![0.0; spline.unknowns()];
    for radius in [0.44, 0.47, 0.5] {
        for step in 0..500 {
            let angle = f64::from(step) * 0.031 - 4.0;
            for z in [0.0, 1.234, 3.0] {
                let sample = spline.sample(&rest, &u, Point { z, radius, angle });
                let [along, x, y] = sample.position;
                // The spline circle is round to 3.1e-7.
                assert!((along - z).abs() < 1e-14);
                assert!((x.hypot(y) / radius - 1.0).abs() < 3.2e-7);
                // The angles of its points are as accurate.
                let off = (y.atan2(x) - angle).rem_euclid(TAU);
                assert!(off.min(TAU - off) < 1e-6);
                assert!(sample.energy_density.abs() < 1e-15);
            }
        }
    }

    // e_z · C e_z integrates one.
    let shift = unknowns(&spline, |_, _, _| [1.0, 0.0, 0.0]);
    let mut weighed = vec![0.0; shift.len()];
    spline.damping().multiply_add(1.0, &shift, &mut weighed);
    let volume = dot(&shift, &weighed) * spline.sector.repeats();
    let exact = PI * (0.25 - 0.44 * 0.44) * 3.0;
    // The mean radius of the projected circle is exact, so the area error is quadratic in the
    // radius error.
    assert!((volume / exact - 1.0).abs() < 1e-12, "{volume}");

    let forces = spline.forces(&rest, &u).unwrap();
    assert!(forces.energy.abs() < 1e-15, "{}", forces.energy);
    assert!(largest(&forces.residual) < 1e-15);
    assert!((forces.smallest_jacobian - 1.0).abs() < 1e-14);
}

/// Returns the unknowns of a whole tube after a displacement u and then `x → Q x + t`.
pub(super) fn carried(
    tube: &SplineTube,
    load: &Load,
    u: &[f64],
    Q: [[f64; 3]; 3],
    t: [f64; 3],
) -> Vec<f64> {
    let reference = ReferenceTube::new(tube, load);
    let mut vectors = reference.cartesian(u);
    for (node, u) in vectors.iter_mut().enumerate() {
        let X = reference.control_point(node);
        let x = [0, 1, 2].map(|i| X[i] + u[i]);
        *u = [0, 1, 2].map(|i| (0..3).map(|j| Q[i][j] * x[j]).sum::<f64>() + t[i] - X[i]);
    }
    reference.cylindrical(&vectors)
}

/// Returns a finite rotation about an axis in the cross-section, then one about z.
pub(super) fn tilted() -> [[f64; 3]; 3] {
    let ((s, c), (v, w)) = (0.8_f64.sin_cos(), 0.6_f64.sin_cos());
    [[c, -s, 0.0], [w * s, w * c, -v], [v * s, v * c, w]]
}

#[test]
fn axisymmetric_rigid_motions_store_no_energy() {
    for degree in 1..=5 {
        let TubeAndLoad { tube, .. } = tube_and_load(degree, [5, 2, 12], 1);
        let rest = tube.tube.rest();
        let control = tube.circle.control_radius;
        let (sin, cos) = 1.1_f64.sin_cos();
        let u = unknowns(&tube, |_, r, _| {
            let r = r * control;
            [0.7, r * (cos - 1.0), r * sin]
        });
        let forces = tube.forces(&rest, &u).unwrap();
        assert!(forces.energy.abs() < 1e-14, "degree {degree}");
        assert!(largest(&forces.residual) < 1e-13, "degree {degree}");
    }
}

#[test]
fn rigid_motions_of_a_whole_tube_store_no_energy() {
    for degree in 1..=5 {
        let TubeAndLoad { tube, .. } = tube_and_load(degree, [5, 2, 7], 7);
        let rest = tube.tube.rest();
        let zero = vec![0.0; tube.unknowns()];
        let u = carried(&tube, &rest, &zero, tilted(), [0.4, -0.7, 0.9]);
        let forces = tube.forces(&rest, &u).unwrap();
        assert!(forces.energy.abs() < 1e-14, "degree {degree}");
        assert!(largest(&forces.residual) < 1e-13, "degree {degree}");
    }
}

#[test]
fn rigid_motions_preserve_the_energy_of_an_active_tube() {
    for degree in 1..=5 {
        let TubeAndLoad { tube, load } = tube_and_load(degree, [5, 2, 7], 7);
        let u = wavy(&tube);
        let before = tube.forces(&load, &u).unwrap();
        let rotated = carried(&tube, &load, &u, tilted(), [0.4, -0.7, 0.9]);
        let after = tube.forces(&load, &rotated).unwrap();
        assert!(
            (after.energy / before.energy - 1.0).abs() < 1e-12,
            "degree {degree}"
        );
        // The residual rotates with the tube: its norm is unchanged.
        let size = |r: &[f64]| dot(r, r).sqrt();
        let ratio = size(&after.residual) / size(&before.residual);
        assert!((ratio - 1.0).abs() < 1e-11, "degree {degree}: {ratio}");
    }
}

/// Sectors of one ring, of fewer rings than an element has functions, and the whole tube.
const SECTORS: [usize; 4] = [1, 2, 3, 6];

#[test]
fn residual_is_the_derivative_of_the_energy() {
    for rings in SECTORS {
        let TubeAndLoad { tube, load } = tube_and_load(3, [9, 2, 6], rings);
        let (u, d) = (wavy(&tube), direction(&tube));
        let energy = |h: f64| tube.forces(&load, &moved(&u, &d, h)).unwrap().energy;
        let exact = dot(&tube.forces(&load, &u).unwrap().residual, &d) * tube.sector.repeats();
        let error = |h: f64| ((energy(h) - energy(-h)) / (2.0 * h) - exact).abs();
        for h in [4e-3, 2e-3, 1e-3] {
            let order = (error(h) / error(h / 2.0)).log2();
            assert!((order - 2.0).abs() < 0.05, "{rings} rings: order {order}");
        }
    }
}

#[test]
fn tangent_is_the_derivative_of_the_residual() {
    for rings in SECTORS {
        let TubeAndLoad { tube, load } = tube_and_load(3, [9, 2, 6], rings);
        let (u, d) = (wavy(&tube), direction(&tube));
        let residual = |h: f64| tube.forces(&load, &moved(&u, &d, h)).unwrap().residual;
        let mut exact = vec![0.0; u.len()];
        tube.tangent(&load, &u).multiply_add(1.0, &d, &mut exact);
        let error = |h: f64| {
            let slope = moved(&residual(h), &residual(-h), -1.0);
            let off = moved(&exact, &slope, -0.5 / h);
            dot(&off, &off).sqrt()
        };
        for h in [4e-3, 2e-3, 1e-3] {
            let order = (error(h) / error(h / 2.0)).log2();
            assert!((order - 2.0).abs() < 0.05, "{rings} rings: order {order}");
        }
    }
}
