//! Circumferential batches against axial batches, whose matrices are assembled.

use crate::assembly::tests::{
    TubeAndLoad, direction, dot, largest, linearised, mesh, repeated, tube_and_load, unknowns, wavy,
};
use crate::assembly::{Barrier, LowHarmonics, SplineTube};
use crate::matrix::{BlockBanded, CoupledFactor, lowest_eigenpairs};
use crate::rings::{HarmonicSolver, LowHarmonicCorrection, Transform};
use crate::tube::{Load, Obstacle, ObstacleShape, Placement, Support, Tube};
use std::f64::consts::TAU;

/// Degrees, elements, and rings of the sector: below, at and above a vector of eight.
const SECTORS: [(usize, [usize; 3], usize); 8] = [
    (1, [10, 2, 8], 8),
    (2, [3, 2, 6], 6),
    (2, [9, 1, 18], 9),
    (3, [3, 2, 12], 12),
    (3, [9, 1, 16], 8),
    (3, [2, 2, 7], 7),
    (4, [2, 1, 10], 10),
    (5, [2, 1, 12], 6),
];

/// Returns an axisymmetric displacement: waves along the tube, the same at every ring.
fn axisymmetric(tube: &SplineTube) -> Vec<f64> {
    unknowns(tube, |z, r, _| {
        [
            0.05 * (2.0 * z + 1.0).sin(),
            r * (0.08 * (3.0 * z).cos() - 0.1 + 0.2 * (r - 0.4)),
            0.0,
        ]
    })
}

fn multiplied(matrix: &BlockBanded, v: &[f64]) -> Vec<f64> {
    let mut y = vec![0.0; v.len()];
    matrix.multiply_add(1.0, v, &mut y);
    y
}

#[test]
fn product_equals_the_assembled_tangent_times_vector() {
    for (degree, elements, rings) in SECTORS {
        let TubeAndLoad { tube, load } = tube_and_load(degree, elements, rings);
        let (u, v) = (wavy(&tube), direction(&tube));
        let assembled = multiplied(&tube.tangent(&load, &u), &v);
        let mut product = vec![0.0; v.len()];
        tube.add_tangent_product(&linearised(&tube, &load, &u), 1.0, &v, &mut product);
        let scale = largest(&assembled);
        for (a, b) in product.iter().zip(&assembled) {
            // The tangent data are single precision.
            assert!(
                (a - b).abs() < 1e-6 * scale,
                "{degree} {elements:?} {rings}: {a} {b}"
            );
        }
    }
}

#[test]
fn product_is_symmetric() {
    let TubeAndLoad { tube, load } = tube_and_load(3, [9, 2, 12], 12);
    let at = linearised(&tube, &load, &wavy(&tube));
    let (v, w) = (direction(&tube), wavy(&tube));
    let product = |v: &[f64]| {
        let mut y = vec![0.0; v.len()];
        tube.add_tangent_product(&at, 1.0, v, &mut y);
        y
    };
    let (vw, wv) = (dot(&w, &product(&v)), dot(&v, &product(&w)));
    assert!((vw - wv).abs() < 1e-13 * vw.abs(), "{vw} {wv}");
}

#[test]
fn averaged_blocks_equal_harmonic_tangents_at_an_axisymmetric_state() {
    for (degree, elements, rings) in SECTORS {
        let TubeAndLoad { tube, load } = tube_and_load(degree, elements, rings);
        let TubeAndLoad { tube: one, .. } = tube_and_load(degree, elements, 1);
        let average = linearised(&tube, &load, &axisymmetric(&tube)).average;
        let u = axisymmetric(&one);
        for n in [1, 2, 3] {
            let exact = one.tangent_in_harmonic(&load, &u, n);
            let block = average.harmonic(n);
            let v = direction(&one);
            let (a, b) = (multiplied(&block, &v), multiplied(&exact, &v));
            let scale = largest(&b);
            for (a, b) in a.iter().zip(&b) {
                assert!(
                    (a - b).abs() < 1e-13 * scale,
                    "{degree} {elements:?}, {n}: {a} {b}"
                );
            }
        }
    }
}

#[test]
fn harmonic_solver_inverts_the_tangent_at_an_axisymmetric_state() {
    for (degree, elements, rings) in SECTORS {
        let TubeAndLoad { tube, load } = tube_and_load(degree, elements, rings);
        let u = axisymmetric(&tube);
        let repeats = elements[2] / rings;
        let average = linearised(&tube, &load, &u).average;
        let TubeAndLoad { tube: one, .. } = tube_and_load(degree, elements, 1);
        let block = |n: usize| {
            let mut block = average.harmonic(n * repeats);
            block.constrain(one.prescribed());
            block.factor().unwrap().into()
        };
        let solver = HarmonicSolver::new(rings, (0..=rings / 2).map(block).collect());
        let x: Vec<f64> = direction(&tube)
            .iter()
            .zip(tube.prescribed())
            .map(|(x, &prescribed)| if prescribed { 0.0 } else { *x })
            .collect();
        let mut K = tube.tangent(&load, &u);
        K.constrain(tube.prescribed());
        let solved = solver.solve(&multiplied(&K, &x));
        let scale = largest(&x);
        for (a, b) in solved.iter().zip(&x) {
            assert!(
                (a - b).abs() < 1e-8 * scale,
                "{degree} {elements:?} {rings}: {a} {b}"
            );
        }
    }
}

#[test]
fn a_symmetric_state_stays_symmetric_to_the_last_bit() {
    let TubeAndLoad { tube, load } = tube_and_load(3, [9, 2, 12], 12);
    let u = repeated(&axisymmetric(&tube_and_load(3, [9, 2, 12], 1).tube), 1, 12);
    let residual = tube.forces(&load, &u).unwrap().residual;
    for rings in residual.chunks_exact(12) {
        assert!(rings.iter().all(|r| r == &rings[0]), "{rings:?}");
    }
}

#[test]
fn low_harmonic_tangent_is_the_projected_tangent() {
    // Eᵀ K E from products, against the assembled matrix with its coarser quadrature.
    for (elements, rings) in [([4, 2, 16], 16), ([9, 1, 24], 12)] {
        let TubeAndLoad { tube, load } = tube_and_load(3, elements, rings);
        let u = unknowns(&tube, |z, r, s| {
            let turn = TAU * s;
            [
                0.02 * (2.0 * z).sin(),
                r * (0.08 * (3.0 * z).cos() * turn.cos() - 0.05 + 0.05 * (2.0 * turn + 0.3).sin()),
                0.03 * r * z * (turn + 0.2).sin(),
            ]
        });
        let low = LowHarmonics::new(&tube, 2);
        let mut coupled = BlockBanded::zeros(tube.axial.functions(), low.row_size(), tube.degree());
        tube.low_harmonic_tangent(&low, &load, &u, &mut coupled);
        let at = linearised(&tube, &load, &u);
        let points = low.through.len();
        let waves = Transform::new(rings);
        // As smooth along the tube as two points per element resolve.
        let of = |i: usize| {
            (0.37 * (i % low.row_size()) as f64 + 0.3 * (i / low.row_size()) as f64).sin()
        };
        let x: Vec<f64> = (0..coupled.unknowns()).map(of).collect();
        // E x: coefficients of waves in columns, then rings.
        let lines = tube.unknowns() / rings;
        let mut coefficients = vec![0.0; tube.unknowns()];
        for row in 0..tube.axial.functions() {
            for (point, through) in low.through.iter().enumerate() {
                for (c, t) in through.iter().enumerate() {
                    for mode in 0..low.modes() {
                        for i in 0..3 {
                            let x = x[((row * 3 + c) * low.modes() + mode) * 3 + i] * t;
                            // −θ sin with r cos, and θ cos with r sin.
                            let (column, sign) = match (i, mode) {
                                (2, m) if m % 2 == 1 => (m + 1, -1.0),
                                (2, m) if m > 0 => (m - 1, 1.0),
                                (_, m) => (m, 1.0),
                            };
                            coefficients[column * lines + (row * points + point) * 3 + i] +=
                                sign * x;
                        }
                    }
                }
            }
        }
        // The inverse transform divides by the sums of squares of the waves.
        for (column, values) in coefficients.chunks_exact_mut(lines).enumerate() {
            let squares = if column == 0 { 1.0 } else { 0.5 } * rings as f64;
            values.iter_mut().for_each(|x| *x *= squares);
        }
        let v = waves.inverse(&coefficients);
        let mut product = vec![0.0; v.len()];
        tube.add_tangent_product(&at, 1.0, &v, &mut product);
        let (exact, found) = (dot(&v, &product), dot(&x, &multiplied(&coupled, &x)));
        assert!(
            (found / exact - 1.0).abs() < 0.005,
            "{rings}: {found} {exact}"
        );

        // Contribution of pressure.
        let mut pressed = load.clone();
        (pressed.pressures[0].follower, pressed.pressures[1].follower) = (-0.3, 0.7);
        let at = linearised(&tube, &pressed, &u);
        tube.add_tangent_product(&at, -1.0, &v, &mut product);
        let mut of_pressed = coupled.clone();
        tube.low_harmonic_tangent(&low, &pressed, &u, &mut of_pressed);
        let exact = -dot(&v, &product);
        let found = dot(&x, &multiplied(&of_pressed, &x)) - found;
        assert!(
            (found / exact - 1.0).abs() < 0.005,
            "pressure, {rings}: {found} {exact}"
        );

        // Contribution of contact with a sheath and a ball.
        let mut touching = tube.clone().with_barrier(Barrier {
            range: 0.5,
            stiffness: 0.5,
        });
        let obstacle = |shape, radius, position| Obstacle {
            name: String::new(),
            shape,
            rest: Placement { radius, position },
            friction: 0.0,
        };
        touching.tube.obstacles = vec![
            obstacle(ObstacleShape::Sheath, 0.7, [0.0; 3]),
            obstacle(ObstacleShape::Ball, 0.3, [0.8, 0.8, 0.2]),
        ];
        let near = Load {
            obstacles: touching.tube.rest().obstacles,
            ..load.clone()
        };
        let product_of = |load: &Load| {
            let mut product = vec![0.0; v.len()];
            let at = linearised(&touching, load, &u);
            touching.add_tangent_product(&at, 1.0, &v, &mut product);
            dot(&v, &product)
        };
        let mut of_touching = coupled.clone();
        touching.low_harmonic_tangent(&low, &near, &u, &mut of_touching);
        let exact = product_of(&near) - product_of(&load);
        let found = dot(&x, &multiplied(&of_touching, &x)) - dot(&x, &multiplied(&coupled, &x));
        assert!(
            (found / exact - 1.0).abs() < 0.01,
            "contact, {rings}: {found} {exact}"
        );

        let damping = tube.ring_damping();
        let mut metric = BlockBanded::zeros(coupled.blocks(), low.row_size(), 3);
        low.add_damping(&tube, &damping, 2.0, &mut metric);
        let mut product = vec![0.0; v.len()];
        damping.multiply_add(2.0, &v, &mut product);
        let (exact, found) = (dot(&v, &product), dot(&x, &multiplied(&metric, &x)));
        assert!(
            (found / exact - 1.0).abs() < 1e-12,
            "{rings}: {found} {exact}"
        );
    }
}

/// Returns the averaged tangent at rest on low harmonics, with its full quadrature: as one matrix, and the blocks of the
/// harmonics for one wave.
fn averaged_on(tube: &SplineTube, low: &LowHarmonics) -> (BlockBanded, Vec<BlockBanded>) {
    let u = vec![0.0; tube.unknowns()];
    let average = linearised(tube, &tube.tube.rest(), &u).average;
    let (rows, rings) = (tube.axial.functions(), tube.sector.rings as f64);
    let mut whole = BlockBanded::zeros(rows, low.row_size(), tube.degree());
    let mut blocks = vec![];
    for mode in 0..low.modes() {
        let n = mode.div_ceil(2);
        let harmonic = average.harmonic(n);
        let index = |(c, i): (usize, usize)| (c * low.modes() + mode) * 3 + i;
        let mut own = BlockBanded::zeros(rows, low.row_size(), tube.degree());
        low.project(&harmonic, |a, b| (index(a), index(b)), &mut own);
        whole.add_scaled(if n == 0 { rings } else { 0.5 * rings }, &own);
        if mode == 0 || mode % 2 == 1 {
            let mut block = BlockBanded::zeros(rows, 3 * low.functions(), tube.degree());
            let place = |(c, i): (usize, usize)| 3 * c + i;
            low.project(&harmonic, |a, b| (place(a), place(b)), &mut block);
            block.constrain(&low.prescribed_in_harmonic(tube, n));
            blocks.push(block);
        }
    }
    (whole, blocks)
}

fn sliding(degree: usize, elements: [usize; 3]) -> SplineTube {
    let tube = Tube {
        ends: [Support::Sliding; 2],
        ..tube_and_load(degree, elements, elements[2]).tube.tube
    };
    SplineTube::new(&tube, &mesh(degree, elements), elements[2])
}

#[test]
fn the_low_harmonic_tangent_resists_every_displacement_on_few_elements() {
    // Relative to the averaged tangent, with its full quadrature, at a tube that slides at both ends.
    for degree in 1..=5 {
        for along in [1, 2] {
            let tube = sliding(degree, [along, 1, 12]);
            let low = LowHarmonics::new(&tube, 1);
            let (exact, _) = averaged_on(&tube, &low);
            let mut coupled = exact.clone();
            let u = vec![0.0; tube.unknowns()];
            tube.low_harmonic_tangent(&low, &tube.tube.rest(), &u, &mut coupled);
            let prescribed = low.prescribed(&tube);
            // Two control points through the wall do not represent a square.
            let squares = prescribed.chunks_exact(low.row_size()).all(|row| {
                let of_squares = &row[2 * row.len() / 3..];
                of_squares.iter().all(|prescribed| *prescribed)
            });
            assert_eq!(squares, degree == 1);
            let lowest = &lowest_eigenpairs(&coupled.into(), &exact, &prescribed, 1).unwrap()[0];
            assert!(lowest.value > 0.002, "{degree} {along}: {}", lowest.value);
        }
    }
}

#[test]
fn a_correction_by_the_average_itself_changes_nothing() {
    let tube = sliding(3, [3, 1, 12]);
    let low = LowHarmonics::new(&tube, 2);
    let (mut whole, blocks) = averaged_on(&tube, &low);
    whole.constrain(&low.prescribed(&tube));
    let u = vec![0.0; tube.unknowns()];
    let average = linearised(&tube, &tube.tube.rest(), &u).average;
    let factors = || -> Vec<CoupledFactor> {
        let block = |n: usize| {
            let mut block = average.harmonic(n);
            block.constrain(&tube.prescribed_in_harmonic(n));
            block.factor().unwrap().into()
        };
        (0..=6).map(block).collect()
    };
    let plain = HarmonicSolver::new(12, factors());
    let corrected = HarmonicSolver::new(12, factors()).with_correction(LowHarmonicCorrection {
        highest: low.highest,
        through: low.through.clone(),
        coupled: whole.factor().unwrap().into(),
        prescribed: low.prescribed(&tube),
        averaged: blocks
            .into_iter()
            .map(|block| block.factor().unwrap().into())
            .collect(),
    });
    let b = direction(&tube);
    let (a, b) = (corrected.solve(&b), plain.solve(&b));
    for (a, x) in a.iter().zip(&b) {
        assert!((a - x).abs() < 1e-8 * largest(&b), "{a} {x}");
    }
}

#[test]
fn ring_damping_equals_the_assembled_damping_matrix() {
    for (degree, elements, rings) in SECTORS {
        let TubeAndLoad { tube, .. } = tube_and_load(degree, elements, rings);
        let (damping, v) = (tube.ring_damping(), direction(&tube));
        let assembled = multiplied(&tube.damping(), &v);
        let mut product = vec![0.0; v.len()];
        damping.multiply_add(1.0, &v, &mut product);
        let scale = largest(&assembled);
        for (a, b) in product.iter().zip(&assembled) {
            assert!(
                (a - b).abs() < 1e-14 * scale,
                "{degree} {elements:?} {rings}: {a} {b}"
            );
        }
        // The same matrix, by harmonic.
        let TubeAndLoad { tube: one, .. } = tube_and_load(degree, elements, 1);
        let block = |n: usize| {
            let mut block = BlockBanded::zeros(one.axial.functions(), one.row_size(), degree);
            damping.add_harmonic(1.0, n * (elements[2] / rings), &mut block);
            block.factor().unwrap().into()
        };
        let solver = HarmonicSolver::new(rings, (0..=rings / 2).map(block).collect());
        let solved = solver.solve(&assembled);
        for (a, b) in solved.iter().zip(&v) {
            assert!(
                (a - b).abs() < 1e-8 * largest(&v),
                "{degree} {elements:?} {rings}: {a} {b}"
            );
        }
    }
}
