//! Potential of pressure against a volume from triangles, and its first and second derivatives.

use super::super::tests::{
    TubeAndLoad, direction, dot, largest, linearised, moved, tube_and_load, wavy,
};
use super::super::{Forces, Point, SplineTube};
use crate::tube::{Load, Pressure, Tube};
use std::f64::consts::{PI, TAU};

fn pressed(tube: &SplineTube, [inner, outer]: [Pressure; 2]) -> Load {
    Load {
        pressures: [inner, outer],
        ..tube.tube.rest()
    }
}

fn follower(follower: f64) -> Pressure {
    Pressure {
        follower,
        dead: 0.0,
    }
}

/// Returns potential and residual of the pressures alone.
fn alone(tube: &SplineTube, load: &Load, u: &[f64]) -> Forces {
    let mut forces = Forces {
        residual: vec![0.0; u.len()],
        ..Forces::default()
    };
    tube.add_walls(load, u, &mut forces);
    forces
}

/// Changes a displacement so that its ends stay in planes z = const.
fn between_plates(tube: &SplineTube, mut u: Vec<f64>) -> Vec<f64> {
    let (m, k) = (tube.row_size(), tube.sector.rings);
    let last = u.len() - m;
    for row in [0, last] {
        for point in u[row..row + m].chunks_exact_mut(3 * k) {
            point[..k].fill(if row == 0 { 0.0 } else { 0.07 });
        }
    }
    u
}

/// Returns the volume that a wall encloses between its ends, from triangles on a grid of points.
fn volume_by_triangles(tube: &SplineTube, u: &[f64], radius: f64, n: usize) -> f64 {
    let rest = tube.tube.rest();
    let point = |i: usize, j: usize| {
        let z = tube.tube.length * i as f64 / n as f64;
        let angle = TAU * (j % (2 * n)) as f64 / (2 * n) as f64;
        tube.sample(&rest, u, Point { z, radius, angle }).position
    };
    // The middle of each end closes the surface.
    let ends = [[0.0; 3], [point(n, 0)[0], 0.0, 0.0]];
    let six = |a: [f64; 3], b: [f64; 3], c: [f64; 3]| {
        a[0] * (b[1] * c[2] - b[2] * c[1])
            + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    let mut volume = 0.0;
    for j in 0..2 * n {
        for i in 0..n {
            let [a, b, c, d] = [
                point(i, j),
                point(i + 1, j),
                point(i + 1, j + 1),
                point(i, j + 1),
            ];
            volume -= six(a, b, c) + six(a, c, d);
        }
        volume -= six(ends[0], point(0, j), point(0, j + 1));
        volume -= six(ends[1], point(n, j + 1), point(n, j));
    }
    volume / 6.0
}

#[test]
fn follower_pressure_potential_equals_enclosed_volume() {
    let TubeAndLoad { tube, .. } = tube_and_load(3, [5, 2, 6], 6);
    let u = between_plates(&tube, wavy(&tube));
    let zero = vec![0.0; u.len()];
    for (radius, pressures) in [
        (tube.tube.inner_radius(), [follower(-1.0), follower(0.0)]),
        (Tube::OUTER_RADIUS, [follower(0.0), follower(1.0)]),
    ] {
        let change = alone(&tube, &pressed(&tube, pressures), &u).potential;
        let of = |n| {
            volume_by_triangles(&tube, &u, radius, n) - volume_by_triangles(&tube, &zero, radius, n)
        };
        // The error of the triangles is quadratic in their size.
        let expected = (4.0 * of(48) - of(24)) / 3.0;
        assert!(
            (change - expected).abs() < 1e-4 * expected.abs(),
            "{change}, {expected}"
        );
    }
}

#[test]
fn uniform_expansion_has_the_exact_pressure_potential() {
    // 60 uniform cubic splines represent a circle of the exact area to 1e-12.
    let TubeAndLoad { tube, .. } = tube_and_load(3, [5, 2, 60], 1);
    let greville = tube.wall.greville();
    let mut u = vec![];
    for z in tube.axial.greville() {
        for r in &greville {
            u.extend([0.2 * z, 0.1 * r * tube.circle.control_radius, 0.0]);
        }
    }
    let load = pressed(&tube, [follower(0.3), follower(0.5)]);
    let potential = alone(&tube, &load, &u).potential;
    let (inner, length) = (tube.tube.inner_radius(), tube.tube.length);
    let shell = |radius: f64| PI * radius * radius * length * (1.1 * 1.1 * 1.2 - 1.0);
    let expected = 0.5 * shell(0.5) - 0.3 * shell(inner);
    assert!(
        (potential / expected - 1.0).abs() < 1e-11,
        "{potential}, {expected}"
    );
}

/// Degrees, elements and rings: whole tubes, sectors of several rings, and one ring.
const TUBES: [(usize, [usize; 3], usize); 5] = [
    (3, [9, 2, 6], 6),
    (3, [9, 2, 6], 3),
    (3, [9, 2, 6], 1),
    (2, [4, 1, 7], 7),
    (1, [3, 2, 8], 4),
];

/// Returns a load with follower pressure and dead load on both walls.
fn all(tube: &SplineTube) -> Load {
    let pressure = |follower, dead| Pressure { follower, dead };
    pressed(tube, [pressure(0.3, -0.2), pressure(0.7, 0.4)])
}

#[test]
fn pressure_forces_are_the_derivative_of_the_potential() {
    for (degree, elements, rings) in TUBES {
        let TubeAndLoad { tube, .. } = tube_and_load(degree, elements, rings);
        let (load, u, v) = (all(&tube), wavy(&tube), direction(&tube));
        let exact = dot(&alone(&tube, &load, &u).residual, &v) * tube.sector.repeats();
        let potential = |h: f64| alone(&tube, &load, &moved(&u, &v, h)).potential;
        let slope = |h: f64| (potential(h) - potential(-h)) / (2.0 * h);
        // The potential is cubic: two central differences give the exact derivative.
        let found = (4.0 * slope(0.1) - slope(0.2)) / 3.0;
        assert!(
            (found - exact).abs() < 1e-12 * exact.abs().max(1.0),
            "{found}, {exact}"
        );
    }
}

#[test]
fn pressure_tangent_is_the_derivative_of_the_forces() {
    for (degree, elements, rings) in TUBES {
        let TubeAndLoad { tube, .. } = tube_and_load(degree, elements, rings);
        let (load, u, v) = (all(&tube), wavy(&tube), direction(&tube));
        // The forces are quadratic.
        let [ahead, behind] = [0.5, -0.5].map(|h| alone(&tube, &load, &moved(&u, &v, h)).residual);
        let slope: Vec<f64> = ahead.iter().zip(&behind).map(|(a, b)| a - b).collect();

        let mut product = vec![0.0; u.len()];
        let at = tube.wall_tangent(&load, &u).unwrap();
        tube.add_wall_product(&at, 1.0, &v, &mut product);
        let mut assembled = vec![0.0; u.len()];
        tube.tangent(&load, &u)
            .multiply_add(1.0, &v, &mut assembled);
        let free = tube.tangent(&tube.tube.rest(), &u);
        free.multiply_add(-1.0, &v, &mut assembled);
        let size = largest(&slope);
        for i in 0..u.len() {
            assert!(
                (product[i] - slope[i]).abs() < 1e-13 * size,
                "{i}: {} {}",
                product[i],
                slope[i]
            );
            // A difference of two tangents.
            assert!(
                (assembled[i] - slope[i]).abs() < 1e-11 * size,
                "{i}: {} {}",
                assembled[i],
                slope[i]
            );
        }
    }
}

#[test]
fn pressure_average_and_harmonic_block_agree_with_the_product() {
    let (degree, elements) = (3, [5, 2, 10]);
    let TubeAndLoad { tube, .. } = tube_and_load(degree, elements, 10);
    let one = tube.axisymmetric();
    let ring = unknowns_without_twist(&one);
    let u: Vec<f64> = ring.iter().flat_map(|x| [*x; 10]).collect();
    let load = all(&tube);
    let at = tube.wall_tangent(&load, &u).unwrap();
    let mut average = linearised(&tube, &tube.tube.rest(), &u).average;
    let free = average.clone();
    tube.add_average_walls(&at, &mut average);
    let x = direction(&one);
    for n in 0..=4 {
        let mut wave = vec![0.0; u.len()];
        for (i, x) in x.iter().enumerate() {
            for j in 0..10 {
                let (sin, cos) = (n as f64 * tube.sector.ring_angle(j)).sin_cos();
                wave[10 * i + j] = match (n, i % 3) {
                    (0, _) => *x,
                    (_, 2) => -sin * x,
                    _ => cos * x,
                };
            }
        }
        let mut product = vec![0.0; u.len()];
        tube.add_wall_product(&at, 1.0, &wave, &mut product);
        let whole = dot(&product, &wave) * if n == 0 { 0.1 } else { 0.2 };
        let form = |matrix: &crate::matrix::BlockBanded| {
            let mut y = vec![0.0; x.len()];
            matrix.multiply_add(1.0, &x, &mut y);
            dot(&y, &x)
        };
        let averaged = form(&average.harmonic(n)) - form(&free.harmonic(n));
        let block = |load: &Load| match n {
            0 => form(&one.tangent(load, &ring)),
            n => form(&one.tangent_in_harmonic(load, &ring, n)),
        };
        let block = block(&load) - block(&one.tube.rest());
        // Differences of tangents of the wall, which are 1e3 times as large.
        assert!(
            (averaged - whole).abs() < 1e-9 * whole.abs(),
            "{n}: {averaged}, {whole}"
        );
        assert!(
            (block - whole).abs() < 1e-9 * whole.abs(),
            "{n}: {block}, {whole}"
        );
    }
}

fn unknowns_without_twist(tube: &SplineTube) -> Vec<f64> {
    let mut u = wavy(tube);
    u.iter_mut().skip(2).step_by(3).for_each(|x| *x = 0.0);
    u
}

#[test]
fn pressure_between_plates_does_no_work_on_rigid_motions() {
    // A sideways shift and a rotation about the axis sweep no volume, so the forces do no work.
    let TubeAndLoad { tube, .. } = tube_and_load(3, [5, 2, 12], 12);
    let u = between_plates(&tube, wavy(&tube));
    let load = pressed(&tube, [follower(0.3), follower(0.7)]);
    let at = tube.wall_tangent(&load, &u).unwrap();
    let k = tube.sector.rings;
    let (mut shift, mut turn) = (vec![0.0; u.len()], vec![0.0; u.len()]);
    let radii = tube.wall.greville();
    for point in 0..u.len() / (3 * k) {
        let radius = radii[point % radii.len()] * tube.circle.control_radius;
        for j in 0..k {
            let at = |i: usize| (3 * point + i) * k + j;
            let (sin, cos) = tube.sector.ring_angle(j).sin_cos();
            (shift[at(1)], shift[at(2)]) = (cos, -sin);
            (turn[at(1)], turn[at(2)]) = (-u[at(2)], radius + u[at(1)]);
        }
    }
    let forces = alone(&tube, &load, &u).residual;
    for motion in [&shift, &turn] {
        assert!(
            dot(&forces, motion).abs() < 1e-13,
            "{}",
            dot(&forces, motion)
        );
    }
    // A shift changes no force.
    let mut product = vec![0.0; u.len()];
    tube.add_wall_product(&at, 1.0, &shift, &mut product);
    let m = tube.row_size();
    let axial = |i: usize| (i / k).is_multiple_of(3) && (i < m || i >= u.len() - m);
    for (i, x) in product.iter().enumerate().filter(|(i, _)| !axial(*i)) {
        assert!(x.abs() < 1e-14, "{i}: {x}");
    }
}

#[test]
fn pressure_forces_do_not_depend_on_the_number_of_threads() {
    let TubeAndLoad { tube, .. } = tube_and_load(3, [29, 2, 6], 6);
    let (load, u) = (all(&tube), wavy(&tube));
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| alone(&tube, &load, &u))
    };
    let (one, three) = (with(1), with(3));
    assert_eq!(one.residual, three.residual);
    assert_eq!(
        (one.potential, one.residual_scale),
        (three.potential, three.residual_scale)
    );
}
