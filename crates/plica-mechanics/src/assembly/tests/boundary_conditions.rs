//! Boundary conditions and rigid-body constraints.

use super::{TubeAndLoad, mesh, tube_and_load};
use crate::assembly::{Point, SplineTube};
use crate::tube::{EndMotion, Support, Tube};

#[test]
fn as_many_rigid_body_constraints_as_permitted_rigid_motions() {
    use Support::{Fixed, Free, Sliding};
    // Along z and about z; for the whole circumference also two shifts and two tilts.
    for (ends, one_ring, whole) in [
        ([Fixed, Fixed], 0, 0),
        ([Fixed, Sliding], 0, 0),
        ([Fixed, Free], 0, 0),
        ([Sliding, Fixed], 0, 0),
        ([Sliding, Sliding], 1, 3),
        ([Sliding, Free], 1, 3),
        ([Free, Fixed], 0, 0),
        ([Free, Sliding], 1, 3),
        ([Free, Free], 2, 6),
    ] {
        for (rings, rigid_body_constraints) in [(1, one_ring), (3, one_ring), (6, whole)] {
            let TubeAndLoad { tube, .. } = tube_and_load(2, [4, 1, 6], rings);
            let tube = Tube { ends, ..tube.tube };
            let spline = SplineTube::new(&tube, &mesh(2, [4, 1, 6]), rings);
            assert_eq!(
                spline.boundary_conditions.rigid_body_constraints(),
                rigid_body_constraints,
                "{ends:?}, {rings} rings"
            );

            // The constrained stiffness at rest has no eigenvalue near zero.
            let zero = vec![0.0; spline.unknowns()];
            let mut K = spline.tangent(&tube.rest(), &zero);
            K.constrain(spline.prescribed());
            let n = spline.unknowns();
            let mut held = faer::Mat::zeros(n, n);
            for j in 0..n {
                let mut unit = vec![0.0; n];
                unit[j] = 1.0;
                let mut free = unit.clone();
                spline.project_out_constraints(&mut free);
                let mut product = vec![0.0; n];
                K.multiply_add(1.0, &free, &mut product);
                spline.project_out_constraints(&mut product);
                for i in 0..n {
                    held[(i, j)] = product[i] + (unit[i] - free[i]);
                }
            }
            let eigenvalues = held.self_adjoint_eigenvalues(faer::Side::Lower).unwrap();
            assert!(eigenvalues[0] > 1e-5, "{ends:?}: {}", eigenvalues[0]);
        }
    }
}

#[test]
fn ends_follow_displacement_and_twist_of_the_load() {
    for rings in [1, 6] {
        let TubeAndLoad { tube, .. } = tube_and_load(3, [5, 2, 6], rings);
        let mut load = tube.tube.rest();
        load.ends = [
            EndMotion {
                displacement: -0.2,
                ..EndMotion::default()
            },
            EndMotion {
                displacement: 0.1,
                twist: 0.9,
                ..EndMotion::default()
            },
        ];
        let mut u = vec![0.0; tube.unknowns()];
        tube.apply_prescribed(&load, &mut u);
        for angle in [0.0, 0.3, 2.0] {
            for radius in [0.35, 0.42, 0.5] {
                for (z, motion) in [(0.0, load.ends[0]), (1.5, load.ends[1])] {
                    let sample = tube.sample(&load, &u, Point { z, radius, angle });
                    let ([_, X, Y], [along, x, y]) = (sample.reference, sample.position);
                    let (sin, cos) = motion.twist.sin_cos();
                    assert!((along - z - motion.displacement).abs() < 1e-14);
                    assert!((x - (X * cos - Y * sin)).abs() < 1e-14);
                    assert!((y - (X * sin + Y * cos)).abs() < 1e-14);
                }
            }
        }
    }
}

#[test]
fn ends_follow_a_shift_and_a_tilt_after_a_twist() {
    let TubeAndLoad { tube, .. } = tube_and_load(3, [5, 2, 6], 6);
    let mut load = tube.tube.rest();
    load.ends = [
        EndMotion {
            displacement: -0.2,
            twist: 0.4,
            shift: [0.3, -0.1],
            tilt: [0.0; 2],
        },
        EndMotion {
            displacement: 0.1,
            twist: 0.9,
            shift: [-0.2, 0.5],
            tilt: [1.2, -0.5],
        },
    ];
    let mut u = vec![0.0; tube.unknowns()];
    tube.apply_prescribed(&load, &mut u);
    // Right-handed rotation of (x, y, z) about an axis of unit length.
    let rotated = |x: [f64; 3], axis: [f64; 3], angle: f64| {
        let (sin, cos) = angle.sin_cos();
        let dot: f64 = (0..3).map(|i| axis[i] * x[i]).sum();
        let cross = |i: usize, j: usize| axis[i] * x[j] - axis[j] * x[i];
        let cross = [cross(1, 2), cross(2, 0), cross(0, 1)];
        [0, 1, 2].map(|i| x[i] * cos + cross[i] * sin + axis[i] * dot * (1.0 - cos))
    };
    for angle in [0.0, 0.3, 2.0] {
        for radius in [0.35, 0.42, 0.5] {
            for (z, motion) in [(0.0, load.ends[0]), (1.5, load.ends[1])] {
                let sample = tube.sample(&load, &u, Point { z, radius, angle });
                let ([_, X, Y], position) = (sample.reference, sample.position);
                let [a, b] = motion.tilt;
                let size = a.hypot(b).max(1e-300);
                let x = rotated([X, Y, 0.0], [0.0, 0.0, 1.0], motion.twist);
                let x = rotated(x, [a / size, b / size, 0.0], a.hypot(b));
                let expected = [
                    z + motion.displacement + x[2],
                    x[0] + motion.shift[0],
                    x[1] + motion.shift[1],
                ];
                for (found, expected) in position.iter().zip(expected) {
                    assert!(
                        (found - expected).abs() < 1e-14,
                        "{position:?} {expected:?}"
                    );
                }
            }
        }
    }
}
