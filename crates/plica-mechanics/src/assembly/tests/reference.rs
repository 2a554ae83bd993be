//! Comparison of the kernels with the reference implementation.

use super::{
    TubeAndLoad, assert_close, direction, dot, largest, moved, replicated, tube_and_load, wavy,
};
use crate::assembly::reference::ReferenceTube;
use crate::assembly::{MatrixFreeTangent, Point};
use crate::material::{CustomLaw, Law, Material, MooneyRivlin};
use crate::spline::{Basis, gauss_legendre};
use crate::tensor::Tensor2;
use std::f64::consts::TAU;

/// Degrees and elements along, through and around. The counts along the tube are below, at and
/// above eight, so that batches are partly filled, full and summed.
const MESHES: [(usize, [usize; 3]); 7] = [
    (1, [10, 2, 8]),
    (2, [8, 2, 7]),
    (2, [17, 1, 6]),
    (3, [3, 2, 6]),
    (3, [9, 2, 6]),
    (4, [9, 1, 6]),
    (5, [3, 2, 6]),
];

/// Laws that share a kernel.
fn other_laws() -> [Material; 2] {
    let law = MooneyRivlin::new(1.0, 0.45, 0.4);
    [
        Material::MooneyRivlin(law),
        Material::Custom(CustomLaw::new(law)),
    ]
}

fn of_material(
    material: &Material,
    degree: usize,
    elements: [usize; 3],
    rings: usize,
) -> TubeAndLoad {
    let mut made = tube_and_load(degree, elements, rings);
    made.tube.law = material.clone();
    made.tube.tube.layers[0].material = material.clone();
    made
}

pub(super) fn assert_agreement(name: &str, TubeAndLoad { tube, load }: &TubeAndLoad) {
    let u = wavy(tube);
    let reference = ReferenceTube::new(tube, load);
    let (fast, expected) = (tube.forces(load, &u).unwrap(), reference.forces(&u));
    for (a, b) in [
        (fast.energy, expected.energy),
        (fast.energy_ungrown, expected.energy_ungrown),
        (fast.residual_scale, expected.residual_scale),
    ] {
        assert!((a / b - 1.0).abs() < 1e-12, "{name}: {a} is not {b}");
    }
    assert_close(name, fast.residual, &expected.residual);

    let (n, K) = (tube.unknowns(), tube.tangent(load, &u));
    let entries = (0..n * n).map(|e| K.entry(e / n, e % n));
    assert_close(name, entries, &reference.tangent(&u));
}

#[test]
fn kernels_agree_with_the_reference_implementation() {
    for (degree, elements) in MESHES {
        let made = tube_and_load(degree, elements, elements[2]);
        assert_agreement(&format!("degree {degree}, {elements:?}"), &made);
    }
    for material in other_laws() {
        let made = of_material(&material, 2, [3, 1, 12], 12);
        assert_agreement(&format!("{material:?}"), &made);
    }
}

#[test]
fn axisymmetric_tubes_agree_with_the_reference_implementation() {
    for material in other_laws() {
        let TubeAndLoad { tube, load } = of_material(&material, 3, [9, 2, 6], 1);
        let whole = of_material(&material, 3, [9, 2, 6], 6).tube;
        let u = wavy(&tube);
        let ring = tube.forces(&load, &u).unwrap();
        let expected = ReferenceTube::new(&whole, &load).forces(&replicated(&u, 6));
        for (a, b) in [
            (ring.energy, expected.energy),
            (ring.energy_ungrown, expected.energy_ungrown),
            (ring.potential, expected.energy),
        ] {
            assert!((a / b - 1.0).abs() < 1e-12, "{a} is not {b}");
        }
        assert_close(
            "one ring",
            replicated(&ring.residual, 6),
            &expected.residual,
        );
    }
}

#[test]
fn energy_residual_and_tangent_of_other_laws_are_consistent() {
    for material in other_laws() {
        let TubeAndLoad { tube, load } = of_material(&material, 3, [3, 1, 9], 9);
        let (u, d) = (wavy(&tube), direction(&tube));
        let forces = |h: f64| tube.forces(&load, &moved(&u, &d, h)).unwrap();
        let h = 1e-5;
        let (before, here, after) = (forces(-h), forces(0.0), forces(h));

        let slope = (after.energy - before.energy) / (2.0 * h);
        assert!(
            (dot(&here.residual, &d) / slope - 1.0).abs() < 1e-7,
            "{material:?}"
        );

        let slope: Vec<f64> = moved(&after.residual, &before.residual, -1.0);
        let mut tangent = MatrixFreeTangent::default();
        tube.linearise(&load, &u, &mut tangent);
        let mut product = vec![0.0; d.len()];
        tube.add_tangent_product(&tangent, 2.0 * h, &d, &mut product);
        let error = moved(&slope, &product, -1.0);
        assert!(largest(&error) < 1e-6 * largest(&product), "{material:?}");
    }
}

#[test]
fn the_damping_matrix_agrees_with_the_reference_implementation() {
    for (degree, elements) in MESHES {
        let TubeAndLoad { tube, load } = tube_and_load(degree, elements, elements[2]);
        let (n, C) = (tube.unknowns(), tube.damping());
        let entries = (0..n * n).map(|e| C.entry(e / n, e % n));
        let expected = ReferenceTube::new(&tube, &load).damping();
        assert_close(
            &format!("degree {degree}, {elements:?}"),
            entries,
            &expected,
        );
    }
}

#[test]
fn samples_agree_with_the_reference_implementation() {
    for (degree, elements) in MESHES {
        let TubeAndLoad { tube, load } = tube_and_load(degree, elements, elements[2]);
        let reference = ReferenceTube::new(&tube, &load);
        let u = wavy(&tube);
        let displacements = reference.cartesian(&u);
        let alpha = TAU / elements[2] as f64;
        // Points inside, on an edge and on both ends; angles below zero and beyond a full turn too.
        for (z, radius, around) in [
            (0.0, 0.35, 0.0),
            (0.4, 0.41, 1.3),
            (0.9, 0.5, -2.2),
            (1.5, 0.44, 0.5),
            (1.1, 0.36, elements[2] as f64 + 0.75),
        ] {
            let angle = around * alpha;
            let sample = tube.sample(&load, &u, Point { z, radius, angle });
            let middle = (around + 0.5_f64).floor();
            let element = [
                tube.axial.find(z),
                tube.wall.find(radius),
                middle.rem_euclid(elements[2] as f64) as usize,
            ];
            let at = reference.at(element, z, radius, around + 0.5 - middle);
            let nodes = reference.element_nodes(element);
            let (mut X, mut x) = ([0.0; 3], [0.0; 3]);
            for (&node, n) in nodes.iter().zip(&at.value) {
                for i in 0..3 {
                    X[i] += n * reference.control_point(node)[i];
                    x[i] += n * (reference.control_point(node)[i] + displacements[node][i]);
                }
            }
            let Fe = reference.elastic(&nodes, &at, &displacements);
            // Rows in the frame at the element's middle, columns along the polar directions.
            let (sin, cos) = (middle * alpha).sin_cos();
            let rotation = Tensor2([[1.0, 0.0, 0.0], [0.0, cos, sin], [0.0, -sin, cos]]);
            let elastic = rotation.times(Fe);

            let name = format!("degree {degree}, {elements:?}, z = {z}");
            assert_close(&name, sample.reference, &X);
            assert_close(&name, sample.position, &x);
            let found = sample.elastic.0.into_iter().flatten();
            assert_close(&name, found, elastic.0.as_flattened());
            assert_close(&name, [sample.jacobian], &[Fe.determinant()]);
            assert_close(
                &name,
                [sample.energy_density],
                &[reference.law(element).energy(&Fe)],
            );
        }
    }
}

#[test]
fn the_smallest_jacobian_is_that_of_the_quadrature_points_for_any_number_of_rings() {
    let TubeAndLoad { tube: one, load } = tube_and_load(2, [5, 2, 12], 1);
    let u = wavy(&one);
    let rule = gauss_legendre(3);
    let points = |basis: &Basis| -> Vec<f64> {
        let spans = (0..basis.elements()).map(|e| basis.element(e));
        spans
            .flat_map(|(from, to)| rule.iter().map(move |(x, _)| from + (to - from) * x))
            .collect()
    };
    let mut smallest = f64::INFINITY;
    for z in points(&one.axial) {
        for radius in points(&one.wall) {
            for (x, _) in &rule {
                let angle = (x - 0.5) * TAU / 12.0;
                let sample = one.sample(&load, &u, Point { z, radius, angle });
                smallest = smallest.min(sample.jacobian);
            }
        }
    }
    assert!(smallest < 0.9, "{smallest}");
    for rings in [1, 6, 12] {
        let TubeAndLoad { tube, load } = tube_and_load(2, [5, 2, 12], rings);
        let found = tube.forces(&load, &replicated(&u, rings)).unwrap();
        assert!(
            (found.smallest_jacobian / smallest - 1.0).abs() < 1e-12,
            "{rings} rings: {} is not {smallest}",
            found.smallest_jacobian
        );
    }
}

#[test]
fn the_stress_of_a_sample_is_the_derivative_of_its_energy() {
    for material in other_laws() {
        let TubeAndLoad { tube, load } = of_material(&material, 3, [5, 2, 12], 12);
        let (z, radius, angle) = (0.8, 0.41, 2.2);
        let sample = tube.sample(&load, &wavy(&tube), Point { z, radius, angle });
        // σ = (det Fe)⁻¹ ∂w/∂Fe Feᵀ
        let h = 1e-5;
        for i in 0..3 {
            for j in 0..3 {
                let energy = |h: f64| {
                    let mut moved = sample.elastic;
                    // Fe → (I + h e_i ⊗ e_j) Fe changes w by h det Fe σ_ij.
                    for k in 0..3 {
                        moved.0[i][k] += h * sample.elastic.0[j][k];
                    }
                    material.energy(&moved)
                };
                let slope = (energy(h) - energy(-h)) / (2.0 * h);
                let expected = slope / sample.elastic.determinant();
                assert!(
                    (sample.stress.0[i][j] - expected).abs() < 1e-8,
                    "{i} {j}: {} is not {expected}",
                    sample.stress.0[i][j]
                );
            }
        }
    }
}

#[test]
fn stretches_and_von_mises_stress_have_the_values_of_simple_states() {
    let TubeAndLoad { tube, .. } = tube_and_load(3, [3, 1, 6], 1);
    let at = Point {
        z: 0.5,
        radius: 0.4,
        angle: 0.0,
    };
    let mut sample = tube.sample(&tube.tube.rest(), &vec![0.0; tube.unknowns()], at);
    for (stress, expected) in [
        ([[-3.0, 0.0, 0.0], [0.0; 3], [0.0; 3]], 3.0),
        ([[2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]], 0.0),
        (
            [[0.0, 2.0, 0.0], [2.0, 0.0, 0.0], [0.0; 3]],
            2.0 * 3.0_f64.sqrt(),
        ),
        (
            [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]],
            3.0_f64.sqrt(),
        ),
    ] {
        sample.stress = Tensor2(stress);
        assert!((sample.von_mises() - expected).abs() < 1e-14, "{stress:?}");
    }
    let (sin, cos) = 0.7_f64.sin_cos();
    let rotation = Tensor2([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]]);
    let stretched = Tensor2([[0.5, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 1.5]]);
    sample.elastic = rotation.times(stretched);
    let [first, second, third] = sample.stretches();
    for ((found, direction), (expected, along)) in [first, second, third].into_iter().zip([
        (2.0, [-sin, cos, 0.0]),
        (1.5, [0.0, 0.0, 1.0]),
        (0.5, [cos, sin, 0.0]),
    ]) {
        assert!((found - expected).abs() < 1e-12, "{found}");
        assert!(
            (dot(&direction, &along).abs() - 1.0).abs() < 1e-12,
            "{direction:?}"
        );
    }
    assert!(!sample.is_inverted());
    sample.elastic = sample.elastic.scaled(-1.0);
    assert!(sample.is_inverted());
}
