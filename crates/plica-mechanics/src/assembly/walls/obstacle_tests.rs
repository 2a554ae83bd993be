//! Contact with obstacles: forces and tangents of every form against differences and against each other.

use super::super::tests::{
    TubeAndLoad, direction, dot, largest, linearised, moved, tube_and_load, wavy,
};
use super::super::{Barrier, Forces, SplineTube};
use crate::tube::{Load, Obstacle, ObstacleShape, Placement};

/// Wide enough that many points are in contact with the wavy walls, some of them overlapping.
const WIDE: Barrier = Barrier {
    range: 0.3,
    stiffness: 0.2,
};

fn obstacle(shape: ObstacleShape, radius: f64, position: [f64; 3]) -> Obstacle {
    Obstacle {
        name: String::new(),
        shape,
        rest: Placement { radius, position },
        friction: 0.0,
    }
}

pub(super) fn axisymmetric_obstacles() -> Vec<Obstacle> {
    vec![
        obstacle(
            ObstacleShape::Rod { half_length: 0.2 },
            0.2,
            [0.4, 0.0, 0.0],
        ),
        obstacle(ObstacleShape::Sheath, 0.62, [0.0; 3]),
        obstacle(ObstacleShape::Ball, 0.3, [1.3, 0.0, 0.0]),
    ]
}

pub(super) fn all_obstacles() -> Vec<Obstacle> {
    let plate = ObstacleShape::Plate {
        normal: [0.0, -0.8, -0.6],
    };
    let mut all = axisymmetric_obstacles();
    all.push(obstacle(ObstacleShape::Ball, 0.15, [0.9, 0.7, 0.1]));
    all.push(obstacle(plate, 0.0, [0.0, 0.5, 0.3]));
    all
}

/// Returns a tube of `rings` rings of ten, or of six, with obstacles.
pub(super) fn with(
    obstacles: Vec<Obstacle>,
    degree: usize,
    elements: [usize; 3],
    rings: usize,
) -> SplineTube {
    let TubeAndLoad { mut tube, .. } = tube_and_load(degree, elements, rings);
    tube.tube.obstacles = obstacles;
    tube.with_barrier(WIDE)
}

fn tubes() -> Vec<SplineTube> {
    vec![
        with(all_obstacles(), 3, [5, 2, 6], 6),
        with(all_obstacles(), 2, [4, 1, 8], 4),
        with(axisymmetric_obstacles(), 3, [9, 2, 6], 1),
        with(all_obstacles(), 1, [3, 2, 8], 8),
    ]
}

fn alone(tube: &SplineTube, u: &[f64]) -> Forces {
    let mut forces = Forces {
        residual: vec![0.0; u.len()],
        ..Forces::default()
    };
    tube.add_walls(&tube.tube.rest(), u, &mut forces);
    forces
}

/// The load without obstacles.
fn free(tube: &SplineTube) -> Load {
    Load {
        obstacles: vec![],
        ..tube.tube.rest()
    }
}

#[test]
fn contact_forces_are_the_derivative_of_the_energy() {
    for tube in tubes() {
        let (u, v) = (wavy(&tube), direction(&tube));
        let at = alone(&tube, &u);
        assert!(at.contact > 1e-3 && at.potential == 0.0, "{at:?}");
        let exact = dot(&at.residual, &v) * tube.sector.repeats();
        let error = |h: f64| {
            let energy = |h: f64| alone(&tube, &moved(&u, &v, h)).contact;
            (energy(h) - energy(-h)) / (2.0 * h) - exact
        };
        let (wide, narrow) = (error(1e-3), error(5e-4));
        let order = (wide / narrow).log2();
        assert!(
            (order - 2.0).abs() < 0.3 && narrow.abs() < 1e-5 * exact.abs(),
            "order {order}: {wide} {narrow} of {exact}"
        );
    }
}

#[test]
fn the_contact_tangent_is_the_derivative_of_the_forces() {
    for tube in tubes() {
        let (load, u, v) = (tube.tube.rest(), wavy(&tube), direction(&tube));
        let h = 1e-5;
        let [ahead, behind] = [h, -h].map(|h| alone(&tube, &moved(&u, &v, h)).residual);
        let slope = |i: usize| (ahead[i] - behind[i]) / (2.0 * h);
        let mut product = vec![0.0; u.len()];
        let at = tube.wall_tangent(&load, &u).unwrap();
        tube.add_wall_product(&at, 1.0, &v, &mut product);
        let mut assembled = vec![0.0; u.len()];
        tube.tangent(&load, &u)
            .multiply_add(1.0, &v, &mut assembled);
        tube.tangent(&free(&tube), &u)
            .multiply_add(-1.0, &v, &mut assembled);
        let size = largest(&product);
        for i in 0..u.len() {
            assert!(
                (product[i] - slope(i)).abs() < 1e-6 * size,
                "{i}: {} {}",
                product[i],
                slope(i)
            );
            assert!((assembled[i] - product[i]).abs() < 1e-10 * size, "{i}");
        }
    }
}

#[test]
fn the_average_and_the_harmonic_blocks_agree_with_the_product() {
    let tube = with(axisymmetric_obstacles(), 3, [5, 2, 10], 10);
    let one = tube.axisymmetric();
    let mut ring = wavy(&one);
    ring.iter_mut().skip(2).step_by(3).for_each(|x| *x = 0.0);
    let u: Vec<f64> = ring.iter().flat_map(|x| [*x; 10]).collect();
    let load = tube.tube.rest();
    let at = tube.wall_tangent(&load, &u).unwrap();
    let free_average = linearised(&tube, &free(&tube), &u).average;
    let mut average = free_average.clone();
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
        let averaged = form(&average.harmonic(n)) - form(&free_average.harmonic(n));
        let block = |load: &Load| match n {
            0 => form(&one.tangent(load, &ring)),
            n => form(&one.tangent_in_harmonic(load, &ring, n)),
        };
        let block = block(&load) - block(&free(&tube));
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

#[test]
fn obstacles_are_the_same_for_every_sector() {
    // A ball beside the tube stands for two in a sector of half the tube.
    let half = with(all_obstacles(), 3, [5, 2, 8], 4);
    let u = wavy(&half);
    let mut both = all_obstacles();
    for mirrored in all_obstacles().split_off(3) {
        both.push(Obstacle {
            shape: mirrored.shape.turned((0.0, -1.0)),
            rest: mirrored.rest.turned((0.0, -1.0)),
            ..mirrored
        });
    }
    let whole = with(both, 3, [5, 2, 8], 8);
    let twice: Vec<f64> = u.chunks_exact(4).flat_map(|x| [x, x].concat()).collect();
    let (a, b) = (alone(&half, &u), alone(&whole, &twice));
    assert!((a.contact / b.contact - 1.0).abs() < 1e-13);
    let reports = |tube: &SplineTube, u: &[f64]| tube.obstacle_contacts(&tube.tube.rest(), u);
    let (a_reports, b_reports) = (reports(&half, &u), reports(&whole, &twice));
    for (i, of_half) in a_reports.iter().enumerate() {
        let of_whole = &b_reports[i];
        let all = if i < 3 { 1.0 } else { 2.0 };
        assert_eq!(of_half.copies as f64, all);
        assert!((of_half.energy / (all * of_whole.energy) - 1.0).abs() < 1e-12);
        for k in 0..3 {
            let (x, y) = (of_half.reaction[k], of_whole.reaction[k]);
            assert!((x - y).abs() < 1e-12 * of_half.force, "{i} {k}: {x} {y}");
        }
    }
    for (i, x) in a.residual.iter().enumerate() {
        let y = b.residual[8 * (i / 4) + i % 4];
        assert!((x - y).abs() < 1e-14, "{i}: {x} {y}");
    }
}

#[test]
fn the_report_of_an_obstacle_is_the_derivative_by_its_placement() {
    let tube = with(all_obstacles(), 3, [5, 2, 6], 6);
    let (u, load) = (wavy(&tube), tube.tube.rest());
    let contacts = tube.obstacle_contacts(&load, &u);
    let total: f64 = contacts.iter().map(|contact| contact.energy).sum();
    assert!((total / alone(&tube, &u).contact - 1.0).abs() < 1e-13);
    let energy = |load: &Load| -> f64 {
        let contacts = tube.obstacle_contacts(load, &u);
        contacts.iter().map(|contact| contact.energy).sum()
    };
    for (i, contact) in contacts.iter().enumerate() {
        let h = 1e-5;
        let slope = |change: &dyn Fn(&mut Placement, f64)| {
            let [low, high] = [-h, h].map(|h| {
                let mut load = load.clone();
                change(&mut load.obstacles[i], h);
                energy(&load)
            });
            (high - low) / (2.0 * h)
        };
        let by_radius = slope(&|placement, h| placement.radius += h);
        assert!((by_radius - contact.radius_force).abs() < 1e-6, "{i}");
        for direction in 0..3 {
            let by_position = slope(&|placement, h| placement.position[direction] += h);
            assert!(
                (by_position + contact.reaction[direction]).abs() < 1e-6,
                "{i} {direction}"
            );
        }
        assert!(contact.force > 0.0 && contact.area > 0.0 && contact.gap < WIDE.range);
        let [from, to] = contact.from_to.unwrap();
        assert!((0.0..to).contains(&from) && to < 1.5);
    }
}
