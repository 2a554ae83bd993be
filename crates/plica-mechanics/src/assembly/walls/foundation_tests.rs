//! Foundations: derivatives in every symmetry, averages, closed forms and rigid motions.

use super::super::tests::{
    TubeAndLoad, direction, dot, largest, linearised, mesh, moved, tube_and_load, unknowns, wavy,
};
use super::super::{Forces, Point, SplineTube};
use crate::activation::AngularSector;
use crate::tube::{
    Axial, Foundation, Imperfection, Outline, Part, Region, Shape, SpringDirection, Support, Tube,
    Wave,
};
use std::f64::consts::{PI, TAU};

const DIRECTIONS: [SpringDirection; 3] = [
    SpringDirection::All,
    SpringDirection::Normal,
    SpringDirection::Inward,
];

fn foundation(direction: SpringDirection, sector: Option<AngularSector>) -> Foundation {
    Foundation {
        region: Region {
            zone: [0.2, 1.3],
            edge: 0.2,
            sector,
        },
        stiffness: 0.7,
        direction,
    }
}

fn sector(repeats: usize) -> AngularSector {
    AngularSector {
        centre: 0.4,
        width: 3.0 / repeats as f64,
        edge: 1.0 / repeats as f64,
        repeats,
    }
}

fn founded(elements: [usize; 3], rings: usize, change: impl Fn(&mut Tube)) -> SplineTube {
    let TubeAndLoad { tube, .. } = tube_and_load(3, elements, 1);
    let mut tube = tube.tube;
    change(&mut tube);
    SplineTube::new(&tube, &mesh(3, elements), rings)
}

/// Returns the forces of the walls alone.
fn alone(tube: &SplineTube, u: &[f64]) -> Forces {
    let mut forces = Forces {
        residual: vec![0.0; u.len()],
        ..Forces::default()
    };
    tube.add_walls(&tube.tube.rest(), u, &mut forces);
    assert_eq!(forces.foundation, forces.potential);
    forces
}

#[test]
fn forces_and_tangent_of_foundations_are_derivatives() {
    for (rings, repeats) in [(1, 0), (3, 2), (6, 1)] {
        for direction_of_springs in DIRECTIONS {
            for shape in ["plain", "imperfect", "cone"] {
                let tube = founded([4, 1, 6], rings, |tube| {
                    let sector = (repeats > 0).then(|| sector(repeats));
                    tube.foundations = vec![foundation(direction_of_springs, sector)];
                    let imperfection = |amplitude, shape| Imperfection {
                        of: Part::Geometry,
                        amplitude,
                        shape,
                    };
                    if shape == "imperfect" {
                        let wave = Wave::new(0, 0.0, Axial::Uniform);
                        tube.imperfections = vec![imperfection(0.02, Shape::Wave(wave))];
                    }
                    if shape == "cone" {
                        let outline = Outline {
                            diameter: vec![[0.0, 1.1], [1.5, 0.8]],
                            thickness: vec![],
                        };
                        tube.imperfections = vec![imperfection(1.0, Shape::Outline(outline))];
                    }
                });
                let mut u = wavy(&tube);
                if let (Some(rest), "cone") = (tube.geometric_imperfection(), shape) {
                    u = moved(&u, rest, 1.0);
                }
                // Stretched springs stay so.
                if direction_of_springs == SpringDirection::Inward {
                    u = unknowns(&tube, |z, r, s| {
                        [0.1 * z, -0.2 + 0.02 * (TAU * s).sin() * r, 0.05 * z * r]
                    });
                }
                let v = direction(&tube);
                let exact = dot(&alone(&tube, &u).residual, &v) * tube.sector.repeats();
                let energy = |h: f64| alone(&tube, &moved(&u, &v, h)).foundation;
                // The energy is quadratic.
                let slope = (energy(0.01) - energy(-0.01)) / 0.02;
                assert!(
                    (slope / exact - 1.0).abs() < 1e-11,
                    "{rings}: {slope} {exact}"
                );
                let [ahead, behind] =
                    [0.01, -0.01].map(|h| alone(&tube, &moved(&u, &v, h)).residual);
                let slope: Vec<f64> = ahead
                    .iter()
                    .zip(&behind)
                    .map(|(a, b)| (a - b) / 0.02)
                    .collect();
                let mut product = vec![0.0; u.len()];
                let at = tube.wall_tangent(&tube.tube.rest(), &u).unwrap();
                tube.add_wall_product(&at, 1.0, &v, &mut product);
                let off = moved(&product, &slope, -1.0);
                assert!(largest(&off) < 1e-11 * largest(&slope));
                let mut assembled = vec![0.0; u.len()];
                tube.tangent(&tube.tube.rest(), &u)
                    .multiply_add(1.0, &v, &mut assembled);
                let bare = founded([4, 1, 6], rings, |bare| {
                    bare.imperfections = tube.tube.imperfections.clone();
                });
                bare.tangent(&tube.tube.rest(), &u)
                    .multiply_add(-1.0, &v, &mut assembled);
                let off = moved(&assembled, &slope, -1.0);
                assert!(largest(&off) < 1e-10 * largest(&slope));
            }
        }
    }
}

#[test]
fn springs_pull_where_the_wall_has_moved_inwards() {
    let [all, normal, inward] = DIRECTIONS.map(|direction| {
        let tube = founded([5, 2, 12], 12, |tube| {
            tube.foundations = vec![foundation(direction, None)];
        });
        move |motion: [f64; 2]| {
            let radial = |s: f64| motion[1] * (TAU * s).cos();
            let u = unknowns(&tube, |_, _, s| {
                // A sideways shift by `motion[1]` and a change of all radii.
                let s = s + tube.sector.ring_angle(0) / TAU;
                let around = -motion[1] * (TAU * s).sin();
                [
                    0.0,
                    motion[0] * tube.circle.control_radius + radial(s),
                    around,
                ]
            });
            alone(&tube, &u).foundation
        }
    });
    // ∫ p dz = 0.9, circumference π.
    let size = 0.5 * 0.7 * 0.9 * PI;
    let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 2e-3, "{a} {b}");
    close(all([0.01, 0.0]), size * 1e-4);
    close(normal([-0.01, 0.0]), size * 1e-4);
    close(inward([-0.01, 0.0]), size * 1e-4);
    assert_eq!(inward([0.01, 0.0]), 0.0);
    close(all([0.0, 0.02]), size * 4e-4);
    close(normal([0.0, 0.02]), 0.5 * size * 4e-4);
    close(inward([0.0, 0.02]), 0.25 * size * 4e-4);
}

#[test]
fn average_and_harmonic_block_of_a_foundation_agree_with_the_product() {
    for direction_of_springs in DIRECTIONS {
        let tube = founded([5, 2, 10], 10, |tube| {
            tube.foundations = vec![foundation(direction_of_springs, None)];
        });
        let one = tube.axisymmetric();
        let ring = unknowns(&one, |z, _, _| {
            [0.1 * z, -0.05 - 0.02 * (3.0 * z).sin(), 0.0]
        });
        let u: Vec<f64> = ring.iter().flat_map(|x| [*x; 10]).collect();
        let load = tube.tube.rest();
        let at = tube.wall_tangent(&load, &u).unwrap();
        let free = founded([5, 2, 10], 10, |_| {});
        let free_average = linearised(&free, &load, &u).average;
        let average = linearised(&tube, &load, &u).average;
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
            let averaged = form(&average.harmonic(n)) - form(&free_average.harmonic(n));
            let block = |tube: &SplineTube| match n {
                0 => form(&tube.tangent(&load, &ring)),
                n => form(&tube.tangent_in_harmonic(&load, &ring, n)),
            };
            let block = block(&one) - block(&free.axisymmetric());
            assert!((averaged - whole).abs() < 1e-9 * whole.abs(), "{n}");
            assert!((block - whole).abs() < 1e-9 * whole.abs(), "{n}");
        }
    }
}

#[test]
fn a_foundation_holds_a_free_tube() {
    // Constraints of one ring and of the whole circumference: normal springs leave motions along and about the axis.
    for (direction, one, whole) in [
        (SpringDirection::All, 0, 0),
        (SpringDirection::Normal, 2, 2),
        (SpringDirection::Inward, 2, 6),
    ] {
        for (rings, expected) in [(1, one), (6, whole)] {
            let tube = founded([5, 2, 6], rings, |tube| {
                tube.ends = [Support::Free; 2];
                let sector = (rings > 1).then(|| sector(1));
                tube.foundations = vec![foundation(direction, sector)];
            });
            let constraints = tube.boundary_conditions.rigid_body_constraints();
            assert_eq!(constraints, expected, "{direction:?}, {rings} rings");
            if rings == 1 {
                let u = vec![0.0; tube.unknowns()];
                let motions = [0, 1].map(|n| tube.rigid_motions_in_harmonic(&u, n).len());
                // Each motion of harmonic 1 stands for two of the whole tube.
                let free = [one, (whole - one) / 2];
                assert_eq!(motions, free, "{direction:?}");
            }
        }
    }
}

#[test]
fn sampled_forces_are_those_of_the_residual() {
    // Their work on a displacement, summed over points of the outer wall, is that of the residual.
    for (rings, repeats) in [(1, 0), (3, 2), (6, 1)] {
        for direction_of_springs in DIRECTIONS {
            let tube = founded([8, 1, 6], rings, |tube| {
                let sector = (repeats > 0).then(|| sector(repeats));
                tube.foundations = vec![foundation(direction_of_springs, sector)];
            });
            let u = unknowns(&tube, |z, r, s| {
                [0.1 * z, -0.1 + 0.02 * (TAU * s).sin() * r, 0.05 * z * r]
            });
            let residual = alone(&tube, &u).residual;
            // A shift along the axis, and one of all rings outwards.
            for component in [0, 1] {
                let v = unknowns(&tube, |_, _, _| match component {
                    0 => [1.0, 0.0, 0.0],
                    _ => [0.0, tube.circle.control_radius, 0.0],
                });
                let exact = -dot(&residual, &v) * tube.sector.repeats();
                let [along, around] = [300, 48];
                let mut sum = 0.0;
                for i in 0..along {
                    for j in 0..around {
                        let angle = TAU * (f64::from(j) + 0.5) / f64::from(around);
                        let at = Point {
                            z: 1.5 * (f64::from(i) + 0.5) / f64::from(along),
                            radius: 0.5,
                            angle,
                        };
                        let sample = tube.sample(&tube.tube.rest(), &u, at);
                        let [z, x, y] = sample.foundation;
                        let own = angle - sample.element_angle;
                        sum += match component {
                            0 => z,
                            _ => x * own.cos() + y * own.sin(),
                        };
                    }
                }
                let area = PI * 1.5 / f64::from(along * around);
                let found = area * sum;
                let scale = largest(&residual);
                assert!(
                    (found - exact).abs() < 5e-3 * exact.abs().max(scale),
                    "{rings} {component}: {found} {exact}"
                );
            }
            let inside = Point {
                z: 0.7,
                radius: 0.49,
                angle: 0.4,
            };
            assert_eq!(
                tube.sample(&tube.tube.rest(), &u, inside).foundation,
                [0.0; 3]
            );
        }
    }
}
