use super::*;
use crate::contact::MeridianContact;
use crate::matrix::BlockBanded;
use crate::study::fixture::short;
use crate::tube::{Mesh, Tube};
use random::Random;
use std::f64::consts::TAU;
use vector::{cross, plus};

const RANGE: f64 = 0.04;

fn tube(rings: usize, axial: usize, around: usize) -> SplineTube {
    let mesh = Mesh {
        axial,
        around,
        thickness: 4,
        degree: 3,
        layers: vec![],
        refinements: vec![],
        grading: 1.0,
        contact_range: 0.25,
        volumetric: Default::default(),
    };
    let shape = Tube {
        length: 3.0,
        ..short()
    };
    let tube = SplineTube::new(&shape, &mesh, rings);
    let barrier = Barrier {
        range: RANGE,
        ..*tube.barrier()
    };
    tube.with_barrier(barrier)
}

/// Returns a state whose faces have a narrow hairpin, wavy around the sector by `wave`.
fn hairpin(tube: &SplineTube, wave: f64) -> Vec<f64> {
    let (length, gap) = (tube.tube.length, 0.02);
    let repeats = tube.sector.repeats();
    tube.control_values_from(|z, radius, ring| {
        let s = 3.0 * z / length;
        let way = if s < 1.0 {
            [s, 0.0]
        } else if s < 2.0 {
            [2.0 - s, -(1.0 + 0.3 * (s - 1.0)) * gap]
        } else {
            [s - 2.0, -2.3 * gap]
        };
        let phi = repeats * tube.sector.ring_angle(ring);
        let along = 0.1 * gap * (5.0 * z).sin();
        let around = wave * ((phi + z).cos() + 0.5 * (2.0 * phi - 3.0 * z).sin());
        [
            way[0] - z + wave * (phi - z).sin(),
            way[1] + along + 0.3 * (0.5 - radius) + around,
            0.5 * wave * (phi + 2.0 * z).cos(),
        ]
    })
}

/// Returns a state in which opposite sides of the lumen are a small gap apart in the middle of the tube.
fn flattened(tube: &SplineTube) -> Vec<f64> {
    let inner = tube.tube.inner_radius() * tube.circle.control_radius;
    tube.control_values_from(|z, _, ring| {
        let phi = tube.sector.ring_angle(ring);
        let w = (0.6 * (z - 1.5)).powi(4);
        // Pressed onto a plane, with rounded sides.
        let press = (-w).exp() * (1.0 - 0.008 / inner);
        let (sin, cos) = phi.sin_cos();
        let across = -(press * inner * sin);
        let slant = 0.004 * (3.0 * z).sin() * cos;
        [slant, (across + slant) * sin, (across + slant) * cos]
    })
}

fn random(count: usize, seed: u64) -> Vec<f64> {
    let mut random = Random::new(seed);
    (0..count).map(|_| random.next() - 0.5).collect()
}

fn moved(u: &[f64], v: &[f64], t: f64) -> Vec<f64> {
    u.iter().zip(v).map(|(u, v)| u + t * v).collect()
}

fn dot_of(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// States of several symmetries that touch.
fn states() -> Vec<(&'static str, SplineTube, Vec<f64>)> {
    let mut all = vec![];
    for (name, rings, wave) in [
        ("round", 8, 0.0),
        ("wavy", 8, 1e-3),
        ("fold 2", 4, 1e-3),
        ("twisted", 1, 1e-3),
    ] {
        let tube = tube(rings, 31, 8);
        let u = hairpin(&tube, wave);
        all.push((name, tube, u));
    }
    let flat = tube(8, 8, 8);
    let u = flattened(&flat);
    all.push(("flat", flat, u));
    all
}

#[test]
fn a_tube_at_rest_touches_nowhere() {
    for rings in [12, 3, 1] {
        let tube = tube(rings, 12, 12);
        let contact = SurfaceContact::new(&tube);
        let rest = vec![0.0; tube.unknowns()];
        assert!(contact.at(&rest).is_empty());
        assert_eq!(contact.crossing(&rest), None);
        let narrow = tube.control_values_from(|z, _, ring| {
            let (w, phi) = (
                z - 1.5,
                tube.sector.ring_angle(ring) * tube.sector.repeats(),
            );
            [0.0, -(0.2 + 0.05 * phi.cos()) * (-30.0 * w * w).exp(), 0.0]
        });
        assert!(contact.at(&narrow).is_empty());
        assert_eq!(contact.crossing(&narrow), None);
    }
}

#[test]
fn a_round_fold_has_the_contact_of_its_meridian() {
    let ring = tube(1, 31, 24);
    let of_ring = MeridianContact::new(&ring);
    let u = hairpin(&ring, 0.0);
    let mut residual = vec![0.0; u.len()];
    let expected = of_ring.add_forces(&of_ring.at(&u), &mut residual);
    assert!(expected.energy > 0.0);
    for rings in [1, 4] {
        let tube = tube(rings, 31, 24);
        let contact = SurfaceContact::new(&tube);
        let u = hairpin(&tube, 0.0);
        let mut forces = vec![0.0; u.len()];
        let found = contact.add_forces(&contact.at(&u), &mut forces);
        // A spline circle of 24 elements is round to 1e-5.
        assert!((found.energy / rings as f64 / expected.energy - 1.0).abs() < 1e-4);
        let size = residual.iter().fold(0.0_f64, |most, r| most.max(r.abs()));
        for (i, of_ring) in residual.iter().enumerate() {
            for ring in 0..rings {
                assert!(
                    (forces[i * rings + ring] - of_ring).abs() < 1e-4 * size,
                    "{rings}: {i}"
                );
            }
        }
    }
}

#[test]
fn forces_are_the_derivative_of_the_energy_and_balance() {
    for (name, tube, u) in states() {
        let contact = SurfaceContact::new(&tube);
        let energy = |u: &[f64]| {
            contact
                .add_forces(&contact.at(u), &mut vec![0.0; u.len()])
                .energy
        };
        let mut residual = vec![0.0; u.len()];
        contact.add_forces(&contact.at(&u), &mut residual);
        let v = random(u.len(), 1);
        let slope = dot_of(&residual, &v);
        let error = |h: f64| {
            let difference = energy(&moved(&u, &v, h)) - energy(&moved(&u, &v, -h));
            (difference / (2.0 * h) - slope).abs() / slope.abs()
        };
        let order = (error(4e-4) / error(2e-4)).log2();
        println!(
            "{name}: energy {:.3e}, errors {:.1e} {:.1e}, order {order}",
            energy(&u),
            error(2e-4),
            error(1e-5)
        );
        assert!((order - 2.0).abs() < 0.3, "{name}: order {order}");
        assert!(error(4e-5) < 1e-4, "{name}: {}", error(4e-5));
        // Forces and moments on the whole tube.
        let (mut force, mut moment, mut size) = ([0.0; 3], [0.0; 3], 0.0);
        for (net, _) in &contact.faces {
            let positions = net.positions(&u);
            let pairs = contact.at(&u);
            let index = usize::from(net.face == Face::Inner);
            for pair in &pairs.0[index] {
                let at = |point: usize| {
                    let [e, f] = net.elements_of(pair.patches[point]);
                    let [along, around] = pair.functions[point];
                    let mut sum = [0.0; 3];
                    for a in 0..4 {
                        for b in 0..4 {
                            let position = positions[(e + a) * net.around + net.ring(f, b)];
                            sum = plus(sum, along[0][a] * around[0][b], position);
                        }
                    }
                    sum
                };
                let back = pair.force.map(|f| -f);
                for (at, own) in [(at(0), pair.force), (at(1), back)] {
                    force = plus(force, 1.0, own);
                    moment = plus(moment, 1.0, cross(at, own));
                    size += vector::length(own);
                }
            }
        }
        assert!(size > 0.0);
        for sum in [force, moment] {
            assert!(
                vector::length(sum) < 1e-12 * size,
                "{name}: {sum:?} of {size}"
            );
        }
    }
}

#[test]
fn the_product_is_the_derivative_of_the_forces() {
    for (name, tube, u) in states() {
        let contact = SurfaceContact::new(&tube);
        let residual = |u: &[f64]| {
            let mut residual = vec![0.0; u.len()];
            contact.add_forces(&contact.at(u), &mut residual);
            residual
        };
        let v = random(u.len(), 2);
        let mut product = vec![0.0; u.len()];
        let tangent = contact.tangent(&u).unwrap();
        contact.add_product(&tangent, 1.0, &v, &mut product);
        let size = product.iter().fold(0.0_f64, |most, p| most.max(p.abs()));
        let error = |h: f64| {
            let (low, high) = (residual(&moved(&u, &v, -h)), residual(&moved(&u, &v, h)));
            let pairs = low.iter().zip(&high).zip(&product);
            let errors = pairs.map(|((low, high), p)| ((high - low) / (2.0 * h) - p).abs());
            errors.fold(0.0, f64::max) / size
        };
        let order = (error(2e-4) / error(1e-4)).log2();
        println!(
            "{name}: errors {:.1e} {:.1e}, order {order}",
            error(4e-4),
            error(4e-5)
        );
        assert!((order - 2.0).abs() < 0.3, "{name}: order {order}");
        assert!(error(4e-5) < 1e-4, "{name}: {}", error(4e-5));
        let w = random(u.len(), 3);
        let mut other = vec![0.0; u.len()];
        contact.add_product(&tangent, 1.0, &w, &mut other);
        let (a, b) = (dot_of(&product, &w), dot_of(&other, &v));
        assert!((a - b).abs() < 1e-11 * a.abs(), "{name}: {a} {b}");
    }
}

#[test]
fn the_average_is_that_of_all_rotations_and_mirror_images() {
    for (name, tube, u) in states() {
        let (contact, k) = (SurfaceContact::new(&tube), tube.sector.rings);
        let tangent = contact.tangent(&u).unwrap();
        let of_ring = random(u.len() / k, 4);
        for n in 0..=k / 2 {
            let band = BlockBanded::zeros(tube.axial.functions(), 3 * tube.wall.functions(), 3);
            let mut matrix = CoupledBanded::from(band);
            tangent.add_harmonic(n, &mut matrix);
            let mut product = vec![0.0; of_ring.len()];
            matrix.multiply_add(1.0, &of_ring, &mut product);
            let own = dot_of(&product, &of_ring);
            let mut mean = 0.0;
            for quarter in [false, true] {
                let wave: Vec<f64> = of_ring
                    .iter()
                    .enumerate()
                    .flat_map(|(i, x)| {
                        (0..k).map(move |ring| {
                            let (sin, cos) = (TAU * (n * ring) as f64 / k as f64).sin_cos();
                            x * match (i % 3 == 2, quarter) {
                                (false, false) | (true, true) => cos,
                                (false, true) => sin,
                                (true, false) => -sin,
                            }
                        })
                    })
                    .collect();
                let mut product = vec![0.0; u.len()];
                contact.add_product(&tangent, 1.0, &wave, &mut product);
                mean += dot_of(&product, &wave) / k as f64;
            }
            assert!(
                (own / mean - 1.0).abs() < 1e-11,
                "{name}, {n}: {own} {mean}"
            );
        }
    }
}

#[test]
fn steps_stop_before_faces_meet() {
    // Opposite sides of the lumen approach a plane.
    let tube = tube(12, 12, 12);
    let contact = SurfaceContact::new(&tube);
    let rest = vec![0.0; tube.unknowns()];
    let step = tube.control_values_from(|z, _, ring| {
        let (sin, cos) = tube.sector.ring_angle(ring).sin_cos();
        let across = -1.5 * (-(2.0 * (z - 1.5)).powi(2)).exp() * sin;
        [0.0, across * sin, across * cos]
    });
    let t = contact.longest_step(&rest, &step);
    // The sides meet at 0.34.
    assert!((0.1..0.34).contains(&t), "{t}");
    assert_eq!(contact.crossing(&moved(&rest, &step, t)), None);
    assert_eq!(
        contact.crossing(&moved(&rest, &step, 0.36)),
        Some(Face::Inner)
    );
    // A motion of the whole tube is free, and so is a uniform stretch.
    let shift = tube.control_values_from(|z, _, ring| {
        let (sin, cos) = tube.sector.ring_angle(ring).sin_cos();
        [5.0 + 2.0 * z, 3.0 * cos + sin, cos - 3.0 * sin]
    });
    assert_eq!(contact.longest_step(&rest, &shift), 1.0);
    // In a fold, the step stops where that of the meridian stops, or a little before.
    let ring = super::tests::tube(1, 31, 12);
    let u = hairpin(&ring, 0.0);
    let push = ring.control_values_from(|z, _, _| [0.0, if z < 1.0 { -0.02 } else { 0.0 }, 0.0]);
    let of_ring = MeridianContact::new(&ring).longest_step(&u, &push);
    assert!(of_ring > 0.1 && of_ring < 0.8, "{of_ring}");
    for rings in [1, 4] {
        let tube = super::tests::tube(rings, 31, 12);
        let contact = SurfaceContact::new(&tube);
        let all = |v: &[f64]| -> Vec<f64> {
            v.iter()
                .flat_map(|x| std::iter::repeat_n(*x, rings))
                .collect()
        };
        let t = contact.longest_step(&all(&u), &all(&push));
        assert!(t <= 1.01 * of_ring && t > 0.4 * of_ring, "{t} {of_ring}");
    }
}

#[test]
fn wrinkled_faces_that_do_not_meet_are_free() {
    let tube = tube(12, 12, 12);
    let contact = SurfaceContact::new(&tube);
    for size in [0.02, 0.08] {
        let u: Vec<f64> = random(tube.unknowns(), 7)
            .iter()
            .map(|x| size * x)
            .collect();
        assert_eq!(contact.crossing(&u), None, "{size}");
    }
}
