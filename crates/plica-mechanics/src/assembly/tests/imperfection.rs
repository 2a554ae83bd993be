//! Displacements of imperfections.

use super::{TubeAndLoad, mesh, tube_and_load};
use crate::assembly::{Point, SplineTube};
use crate::spline::{Basis, gauss_legendre};
use crate::tube::{
    Axial, End, EndDirection, EndMotion, Imperfection, Part, Shape, Support, Tube, Wave,
};

/// Returns the tube of the other tests with twelve rings and an imperfection.
fn imperfect(ends: [Support; 2], of: Part, amplitude: f64, wave: Wave) -> SplineTube {
    let TubeAndLoad { tube, .. } = tube_and_load(3, [9, 2, 12], 1);
    let imperfection = Imperfection {
        of,
        amplitude,
        shape: Shape::Wave(wave),
    };
    let tube = Tube {
        ends,
        imperfections: vec![imperfection],
        ..tube.tube
    };
    SplineTube::new(&tube, &mesh(3, [9, 2, 12]), 12)
}

const COLON: Part = Part::End(End::Colon, EndDirection::Across);

/// Returns the displacement (z, x, y) of a point of a tube at rest with unknowns `u`.
pub(super) fn displacement(
    tube: &SplineTube,
    u: &[f64],
    z: f64,
    radius: f64,
    angle: f64,
) -> [f64; 3] {
    let at = tube.sample(&tube.tube.rest(), u, Point { z, radius, angle });
    [0, 1, 2].map(|i| at.position[i] - at.reference[i])
}

#[test]
fn end_imperfection_of_harmonic_1_shifts_the_face_sideways() {
    let phase = 0.4;
    let wave = Wave::new(1, phase, Axial::Uniform);
    let tube = imperfect([Support::Fixed; 2], COLON, 0.03, wave);
    let mut u = vec![0.0; tube.unknowns()];
    tube.apply_prescribed(&tube.tube.rest(), &mut u);
    for i in 0..50 {
        let angle = 0.13 * f64::from(i);
        let moved = displacement(&tube, &u, 0.0, 0.45, angle);
        let shift = [0.0, 0.03 * phase.cos(), 0.03 * phase.sin()];
        for (x, expected) in moved.into_iter().zip(shift) {
            assert!((x - expected).abs() < 1e-16, "{moved:?}");
        }
        assert!(displacement(&tube, &u, 1.5, 0.45, angle)[1].abs() < 1e-16);
    }
}

#[test]
fn axial_end_imperfection_of_harmonic_1_tilts_the_face() {
    let wave = Wave::new(1, 0.0, Axial::Uniform);
    let of = Part::End(End::Ileum, EndDirection::Axial);
    let tube = imperfect([Support::Fixed, Support::Sliding], of, 0.03, wave);
    let mut u = vec![0.0; tube.unknowns()];
    tube.apply_prescribed(&tube.tube.rest(), &mut u);
    for i in 0..50 {
        let (angle, radius) = (0.13 * f64::from(i), 0.35 + 0.003 * f64::from(i));
        let at = tube.sample(
            &tube.tube.rest(),
            &u,
            Point {
                z: 1.5,
                radius,
                angle,
            },
        );
        let [z, x, y] = [0, 1, 2].map(|i| at.position[i] - at.reference[i]);
        // A plane: proportional to x, and equal to the amplitude at x = D/2.
        let expected = 0.03 * at.reference[1] / 0.5;
        assert!((z - expected).abs() < 1e-15, "{z} is not {expected}");
        assert!(x.abs().max(y.abs()) < 1e-16);
    }
}

#[test]
fn end_imperfection_of_harmonic_2_is_an_inextensible_oval() {
    let wave = Wave::new(2, 0.0, Axial::Uniform);
    let tube = imperfect([Support::Fixed; 2], COLON, 0.01, wave);
    let mut u = vec![0.0; tube.unknowns()];
    tube.apply_prescribed(&tube.tube.rest(), &mut u);
    let rotated = |angle: f64| {
        let [_, x, y] = displacement(&tube, &u, 0.0, 0.45, angle);
        let (sin, cos) = angle.sin_cos();
        [x * cos + y * sin, y * cos - x * sin]
    };
    for i in 0..50 {
        let angle = 0.13 * f64::from(i);
        let [radial, around] = rotated(angle);
        // Twelve splines represent three periods to 2 %.
        assert!(
            (radial - 0.01 * (2.0 * angle).cos()).abs() < 1e-4,
            "{radial}"
        );
        assert!(
            (around + 0.005 * (2.0 * angle).sin()).abs() < 1e-4,
            "{around}"
        );
    }
}

#[test]
fn end_imperfection_rotates_with_the_end() {
    let wave = Wave::new(1, 0.0, Axial::Uniform);
    let tube = imperfect([Support::Fixed; 2], COLON, 0.03, wave);
    let mut load = tube.tube.rest();
    load.ends[0] = EndMotion {
        displacement: 0.02,
        twist: 0.5,
        ..EndMotion::default()
    };
    let mut u = vec![0.0; tube.unknowns()];
    tube.apply_prescribed(&load, &mut u);
    for i in 0..20 {
        let angle = 0.3 * f64::from(i);
        let point = Point {
            z: 0.0,
            radius: 0.45,
            angle,
        };
        let at = tube.sample(&load, &u, point);
        let (sin, cos) = 0.5_f64.sin_cos();
        let [_, x, y] = at.reference;
        let expected = [0.02, (x + 0.03) * cos - y * sin, (x + 0.03) * sin + y * cos];
        for (x, expected) in at.position.into_iter().zip(expected) {
            assert!((x - expected).abs() < 1e-15, "{:?}", at.position);
        }
    }
}

#[test]
fn geometric_imperfection_vanishes_at_fixed_ends_and_has_its_amplitude_between() {
    for (axial, middle) in [
        (Axial::HalfWaves(1), 1.0),
        (Axial::Uniform, 1.0),
        (Axial::Zone([0.5, 1.0]), 0.7),
    ] {
        for harmonic in 0..=3 {
            let wave = Wave::new(harmonic, 0.0, axial);
            let tube = imperfect([Support::Fixed; 2], Part::Geometry, 0.01, wave);
            let u = tube.geometric_imperfection().unwrap();
            for z in [0.0, 1.5] {
                for x in displacement(&tube, u, z, 0.45, 0.3) {
                    assert!(x.abs() < 1e-17, "{wave:?} at {z}: {x}");
                }
            }
            // Control values flatten a crest; one over three elements by a quarter.
            let x = displacement(&tube, u, 0.75, 0.45, 0.0)[1];
            assert!(x > 0.95 * middle * 0.01 && x < 0.0103, "{wave:?}: {x}");
        }
    }
}

#[test]
fn perfect_tube_has_a_zero_initial_guess() {
    let TubeAndLoad { tube, load } = tube_and_load(3, [9, 2, 6], 6);
    assert_eq!(tube.geometric_imperfection(), None);
    assert!(tube.initial_guess().iter().all(|x| x.to_bits() == 0));
    for z in [0.1, 0.3, 0.75, 1.2] {
        assert_eq!(
            tube.tube.stretches_at(0, z, 2.0, &load),
            tube.tube.stretches(0, z, &load)
        );
    }
}

#[test]
fn initial_guess_satisfies_the_boundary_conditions() {
    let wave = Wave::new(2, 0.3, Axial::Uniform);
    let tube = imperfect([Support::Fixed; 2], COLON, 0.01, wave);
    let u = tube.initial_guess();
    let mut imposed = u.clone();
    tube.apply_prescribed(&tube.tube.rest(), &mut imposed);
    assert_eq!(u, imposed);
    assert!(tube.forces(&tube.tube.rest(), &u).is_ok());
}

#[test]
fn sampled_fields_integrate_to_the_energy_of_an_imperfect_tube() {
    let wave = Wave::new(2, 0.4, Axial::Uniform);
    for (of, amplitude) in [
        (Part::Muscle(0), 0.4),
        (Part::Geometry, 0.02),
        (COLON, 0.02),
    ] {
        let tube = imperfect([Support::Fixed; 2], of, amplitude, wave);
        let mut load = tube_and_load(3, [9, 2, 12], 1).load;
        load.ends = tube.tube.rest().ends;
        let mut u = tube.initial_guess();
        tube.apply_prescribed(&load, &mut u);
        let rule = gauss_legendre(4);
        let spans = |basis: &Basis| -> Vec<(f64, f64)> {
            let spans = (0..basis.elements()).map(|e| basis.element(e));
            let points = |(from, to): (f64, f64)| {
                let size = to - from;
                rule.iter().map(move |(x, w)| (from + size * x, size * w))
            };
            spans.flat_map(points).collect()
        };
        let size = tube.sector.angle();
        let angles: Vec<(f64, f64)> = (0..12)
            .flat_map(|e| {
                rule.iter()
                    .map(move |(x, w)| (size * (f64::from(e) - 0.5 + x), size * w))
            })
            .collect();
        let mut energy = 0.0;
        for &(z, wz) in &spans(&tube.axial) {
            for &(angle, wa) in &angles {
                for &(radius, wr) in &spans(&tube.wall) {
                    let at = tube.sample(&load, &u, Point { z, radius, angle });
                    // The parameter of the spline circle is nearly proportional to the angle.
                    let volume = wz * wa * wr * radius;
                    energy += at.energy_density * at.grown[0] * at.grown[1] * volume;
                }
            }
        }
        let expected = tube.forces(&load, &u).unwrap().energy;
        let off = energy / expected - 1.0;
        assert!(off.abs() < 2e-3, "{of:?}: {energy} {expected}");
    }
}
