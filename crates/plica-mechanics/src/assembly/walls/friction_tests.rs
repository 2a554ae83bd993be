//! Friction on obstacles: forces and tangents of every form against differences and against each other.

use super::super::tests::{direction, dot, largest, linearised, moved, wavy};
use super::super::{Forces, LowHarmonics, MatrixFreeTangent, SplineTube};
use super::WallTangent;
use super::friction::{Friction, StepStart};
use super::obstacle_tests::{all_obstacles, axisymmetric_obstacles, with};
use crate::matrix::BlockBanded;
use crate::tube::{Load, Obstacle};

/// Elastic slip in ranges of contact: some points stick and some slide.
const ELASTIC: f64 = 0.1;

fn rough(obstacles: Vec<Obstacle>) -> Vec<Obstacle> {
    let with_friction = |(i, obstacle)| Obstacle {
        friction: 0.2 + 0.1 * i as f64,
        ..obstacle
    };
    (0..).zip(obstacles).map(with_friction).collect()
}

fn tubes() -> Vec<SplineTube> {
    let tubes = [
        with(rough(all_obstacles()), 3, [5, 2, 6], 6),
        with(rough(all_obstacles()), 2, [4, 1, 8], 4),
        with(rough(axisymmetric_obstacles()), 3, [9, 2, 6], 1),
        with(rough(all_obstacles()), 1, [3, 2, 8], 8),
    ];
    tubes.map(|tube| tube.with_elastic_slip(ELASTIC)).into()
}

/// Returns the load with every obstacle moved a little.
fn pushed(tube: &SplineTube) -> Load {
    let mut load = tube.tube.rest();
    for (i, placement) in load.obstacles.iter_mut().enumerate() {
        placement.position[0] += 0.03 - 0.02 * i as f64;
        placement.radius *= 1.01;
    }
    load
}

/// Returns the friction of a step from a wavy state, in which obstacles and walls move, with slips from a step before.
fn stepped(tube: &SplineTube, u: &[f64]) -> Friction {
    let v = direction(tube);
    let start = |x: f64, slips| StepStart {
        load: tube.tube.rest(),
        u: moved(u, &v, x),
        slips,
    };
    let rest = tube.tube.rest();
    let at = |start: &StepStart, x: f64| tube.friction(start, &rest, &moved(u, &v, x));
    let first = start(-0.03, vec![]);
    let slips = tube.elastic_slips(&at(&first, -0.01), &rest, &moved(u, &v, -0.01));
    assert!(slips.len() > 50);
    at(&start(-0.01, slips), 0.02)
}

fn alone(tube: &SplineTube, friction: &Friction, u: &[f64]) -> Forces {
    let mut forces = Forces {
        residual: vec![0.0; u.len()],
        ..Forces::default()
    };
    tube.add_friction(friction, &pushed(tube), u, &mut forces);
    forces
}

fn product(tube: &SplineTube, friction: &Friction, u: &[f64], v: &[f64]) -> Vec<f64> {
    let at = WallTangent {
        walls: tube.friction_walls(Some(friction), &pushed(tube)).into(),
        u: u.to_vec(),
    };
    let mut product = vec![0.0; u.len()];
    tube.add_wall_product(&at, 1.0, v, &mut product);
    product
}

fn with_friction(tube: &SplineTube, friction: &Friction, u: &[f64]) -> MatrixFreeTangent {
    let free = Load {
        obstacles: vec![],
        ..tube.tube.rest()
    };
    let mut at = linearised(tube, &free, u);
    tube.add_friction_to(friction, &pushed(tube), u, &mut at);
    at
}

#[test]
fn friction_forces_are_the_derivative_of_the_potential() {
    for tube in tubes() {
        let (u, v) = (wavy(&tube), direction(&tube));
        let friction = stepped(&tube, &u);
        let at = alone(&tube, &friction, &u);
        assert!(at.friction > 1e-3 && at.contact == 0.0, "{at:?}");
        let exact = dot(&at.residual, &v) * tube.sector.repeats();
        let error = |h: f64| {
            let energy = |h: f64| alone(&tube, &friction, &moved(&u, &v, h)).friction;
            (energy(h) - energy(-h)) / (2.0 * h) - exact
        };
        let (wide, narrow) = (error(1e-3), error(5e-4));
        let order = (wide / narrow).log2();
        assert!(
            (order - 2.0).abs() < 0.4 && narrow.abs() < 1e-4 * exact.abs(),
            "order {order}: {wide} {narrow} of {exact}"
        );
    }
}

#[test]
fn the_friction_tangent_is_the_derivative_of_the_forces() {
    for tube in tubes() {
        let (u, v) = (wavy(&tube), direction(&tube));
        let friction = stepped(&tube, &u);
        let h = 1e-6;
        let [ahead, behind] = [h, -h].map(|h| alone(&tube, &friction, &moved(&u, &v, h)).residual);
        let product = product(&tube, &friction, &u, &v);
        let m = tube.row_size();
        let mut matrix = BlockBanded::zeros(tube.axial.functions(), m, tube.degree());
        tube.add_friction_tangent(&friction, &pushed(&tube), &u, &mut matrix);
        let mut assembled = vec![0.0; u.len()];
        matrix.multiply_add(1.0, &v, &mut assembled);
        let size = largest(&product);
        assert!(size > 1e-3);
        for i in 0..u.len() {
            let slope = (ahead[i] - behind[i]) / (2.0 * h);
            assert!(
                (product[i] - slope).abs() < 1e-5 * size,
                "{i}: {} {slope}",
                product[i]
            );
            assert!((assembled[i] - product[i]).abs() < 1e-12 * size, "{i}");
        }
    }
}

#[test]
fn the_average_agrees_with_the_product() {
    let tube = with(rough(axisymmetric_obstacles()), 3, [5, 2, 10], 10).with_elastic_slip(ELASTIC);
    let one = tube.axisymmetric();
    let without_twist = |mut u: Vec<f64>| {
        u.iter_mut().skip(2).step_by(3).for_each(|x| *x = 0.0);
        u
    };
    let ring = without_twist(wavy(&one));
    let all = |x: &[f64]| -> Vec<f64> { x.iter().flat_map(|x| [*x; 10]).collect() };
    let u = all(&ring);
    let v = without_twist(direction(&one));
    let start = |tube: &SplineTube, u: Vec<f64>| StepStart {
        load: tube.tube.rest(),
        u,
        slips: vec![],
    };
    let rest = tube.tube.rest();
    let friction = tube.friction(&start(&tube, moved(&u, &all(&v), 0.1)), &rest, &u);
    let of_ring = one.friction(&start(&one, moved(&ring, &v, 0.1)), &rest, &ring);
    let whole = dot(&product(&tube, &friction, &u, &all(&v)), &all(&v)) / 10.0;
    let single = dot(&product(&one, &of_ring, &ring, &v), &v);
    assert!((single / whole - 1.0).abs() < 1e-12, "{single} {whole}");
    let forces = [alone(&tube, &friction, &u), alone(&one, &of_ring, &ring)];
    assert!((forces[0].friction / forces[1].friction - 1.0).abs() < 1e-12);
    for (i, x) in forces[1].residual.iter().enumerate() {
        assert!((x - forces[0].residual[10 * i]).abs() < 1e-15);
    }
    let mut free = MatrixFreeTangent::default();
    let load = Load {
        obstacles: vec![],
        ..rest
    };
    tube.linearise(&load, &u, &mut free);
    let form = |at: &MatrixFreeTangent| {
        let mut y = vec![0.0; v.len()];
        at.average.harmonic(0).multiply_add(1.0, &v, &mut y);
        dot(&y, &v)
    };
    let averaged = form(&with_friction(&tube, &friction, &u)) - form(&free);
    assert!((averaged / whole - 1.0).abs() < 1e-9, "{averaged} {whole}");
}

#[test]
fn friction_on_low_harmonics_is_the_product_on_smooth_motions() {
    let tube = with(rough(all_obstacles()), 3, [5, 2, 12], 12).with_elastic_slip(ELASTIC);
    let u = wavy(&tube);
    let friction = stepped(&tube, &u);
    let low = LowHarmonics::new(&tube, 3);
    let mut matrix = BlockBanded::zeros(tube.axial.functions(), low.row_size(), tube.degree());
    tube.add_low_harmonic_friction(&low, &friction, &pushed(&tube), &u, &mut matrix);
    // A rigid motion along z, and one across.
    let columns = 3 * low.modes();
    let amplitudes: [Vec<usize>; 2] = [vec![0], vec![3 + 1, 3 + 2]];
    let k = tube.sector.rings;
    for (which, amplitudes) in amplitudes.into_iter().enumerate() {
        let mut x = vec![0.0; matrix.blocks() * low.row_size()];
        let mut v = vec![0.0; u.len()];
        for row in x.chunks_exact_mut(3 * columns) {
            amplitudes.iter().for_each(|i| row[*i] = 1.0);
        }
        for point in v.chunks_exact_mut(3 * k) {
            for j in 0..k {
                let (sin, cos) = (tube.sector.ring_angle(j) - tube.sector.ring_angle(0)).sin_cos();
                match which {
                    0 => point[j] = 1.0,
                    _ => (point[k + j], point[2 * k + j]) = (cos, -sin),
                }
            }
        }
        let exact = dot(&product(&tube, &friction, &u, &v), &v);
        let mut y = vec![0.0; x.len()];
        matrix.multiply_add(1.0, &x, &mut y);
        let found = dot(&x, &y);
        assert!(
            exact > 1e-3 && (found / exact - 1.0).abs() < 1e-10,
            "{which}: {found} {exact}"
        );
    }
}

#[test]
fn reactions_are_the_sum_of_the_forces_and_work_is_not_negative() {
    let tube = tubes().remove(0);
    let u = wavy(&tube);
    let friction = stepped(&tube, &u);
    let found = tube.friction_on_obstacles(&friction, &pushed(&tube), &u);
    let forces = alone(&tube, &friction, &u);
    let k = tube.sector.rings;
    // The forces on the tube along z are the negative residual.
    let along: f64 = forces
        .residual
        .chunks_exact(3 * k)
        .flat_map(|point| &point[..k])
        .sum();
    let reaction: f64 = found.iter().map(|friction| friction.reaction[0]).sum();
    assert!((along - reaction).abs() < 1e-13, "{along} {reaction}");
    for friction in &found {
        let size: f64 = friction.reaction.iter().map(|x| x * x).sum();
        assert!(friction.force >= size.sqrt() && friction.dissipated >= 0.0);
    }
    assert!(found.iter().any(|friction| friction.dissipated > 0.0));
}

#[test]
fn a_copy_of_an_obstacle_has_its_own_friction() {
    // A ball beside the tube stands for two in a sector of half the tube.
    let half = with(rough(all_obstacles()), 3, [5, 2, 8], 4).with_elastic_slip(ELASTIC);
    let mut both = rough(all_obstacles());
    for mirrored in rough(all_obstacles()).split_off(3) {
        both.push(Obstacle {
            shape: mirrored.shape.turned((0.0, -1.0)),
            rest: mirrored.rest.turned((0.0, -1.0)),
            ..mirrored
        });
    }
    let whole = with(both, 3, [5, 2, 8], 8).with_elastic_slip(ELASTIC);
    let u = wavy(&half);
    let twice =
        |u: &[f64]| -> Vec<f64> { u.chunks_exact(4).flat_map(|x| [x, x].concat()).collect() };
    let of = |tube: &SplineTube, from: Vec<f64>, u: &[f64]| {
        let start = StepStart {
            load: tube.tube.rest(),
            u: from,
            slips: vec![],
        };
        let friction = tube.friction(&start, &tube.tube.rest(), u);
        let on = tube.friction_on_obstacles(&friction, &tube.tube.rest(), u);
        let mut forces = Forces {
            residual: vec![0.0; u.len()],
            ..Forces::default()
        };
        tube.add_friction(&friction, &tube.tube.rest(), u, &mut forces);
        (on, forces)
    };
    let from = moved(&u, &direction(&half), 0.05);
    let a = of(&half, from.clone(), &u);
    let b = of(&whole, twice(&from), &twice(&u));
    assert!((a.1.friction / b.1.friction - 1.0).abs() < 1e-12);
    for (i, x) in a.1.residual.iter().enumerate() {
        let y = b.1.residual[8 * (i / 4) + i % 4];
        assert!((x - y).abs() < 1e-14, "{i}: {x} {y}");
    }
    for (i, of_half) in a.0.iter().enumerate() {
        let of_whole = &b.0[i];
        let all = if i < 3 { 1.0 } else { 2.0 };
        assert!((of_half.force / (all * of_whole.force) - 1.0).abs() < 1e-12);
        for k in 0..3 {
            let (x, y) = (of_half.reaction[k], of_whole.reaction[k]);
            assert!((x - y).abs() < 1e-12 * of_half.force, "{i} {k}: {x} {y}");
        }
    }
}
