//! The kernels against the reference implementation.

use super::{TubeAndLoad, assert_close, tube_and_load, wavy};
use crate::assembly::Point;
use crate::assembly::reference::ReferenceTube;
use crate::material::Law;
use crate::tensor::Tensor2;
use std::f64::consts::TAU;

/// Degrees and elements along, through and around: below, at and above eight along the tube, for
/// partly filled, full and several batches.
const MESHES: [(usize, [usize; 3]); 7] = [
    (1, [10, 2, 8]),
    (2, [8, 2, 7]),
    (2, [17, 1, 6]),
    (3, [3, 2, 6]),
    (3, [9, 2, 6]),
    (4, [9, 1, 6]),
    (5, [3, 2, 6]),
];

#[test]
fn energy_and_residual_equal_the_reference_implementation() {
    for (degree, elements) in MESHES {
        let TubeAndLoad { tube, load } = tube_and_load(degree, elements, elements[2]);
        let u = wavy(&tube);
        let (assembled, reference) = (
            tube.forces(&load, &u).unwrap(),
            ReferenceTube::new(&tube, &load).forces(&u),
        );
        let name = format!("degree {degree}, {elements:?}");
        let numbers = [
            assembled.energy,
            assembled.energy_ungrown,
            assembled.residual_scale,
        ];
        for (a, b) in numbers.into_iter().zip([
            reference.energy,
            reference.energy_ungrown,
            reference.residual_scale,
        ]) {
            assert!((a / b - 1.0).abs() < 1e-12, "{name}: {a} is not {b}");
        }
        assert_close(&name, assembled.residual, &reference.residual);
    }
}

#[test]
fn tangent_equals_the_reference_implementation() {
    for (degree, elements) in MESHES {
        let TubeAndLoad { tube, load } = tube_and_load(degree, elements, elements[2]);
        let u = wavy(&tube);
        let (assembled, reference) = (
            tube.tangent(&load, &u),
            ReferenceTube::new(&tube, &load).tangent(&u),
        );
        let n = tube.unknowns();
        let entries = (0..n * n).map(|e| assembled.entry(e / n, e % n));
        assert_close(
            &format!("degree {degree}, {elements:?}"),
            entries,
            &reference,
        );
    }
}

#[test]
fn damping_matrix_equals_the_reference_implementation() {
    for (degree, elements) in MESHES {
        let TubeAndLoad { tube, load } = tube_and_load(degree, elements, elements[2]);
        let (assembled, reference) = (tube.damping(), ReferenceTube::new(&tube, &load).damping());
        let n = tube.unknowns();
        let entries = (0..n * n).map(|e| assembled.entry(e / n, e % n));
        assert_close(
            &format!("degree {degree}, {elements:?}"),
            entries,
            &reference,
        );
    }
}

#[test]
fn samples_equal_the_reference_implementation() {
    for (degree, elements) in MESHES {
        let TubeAndLoad { tube, load } = tube_and_load(degree, elements, elements[2]);
        let reference = ReferenceTube::new(&tube, &load);
        let u = wavy(&tube);
        let moved = reference.cartesian(&u);
        let alpha = TAU / elements[2] as f64;
        // Points inside, on an edge and on both ends; angles below zero and above 2π too.
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
            let position = [0, 1, 2].map(|i| {
                at.reference[i]
                    + nodes
                        .iter()
                        .zip(&at.value)
                        .map(|(&node, n)| n * moved[node][i])
                        .sum::<f64>()
            });
            let Fe = reference.elastic(&nodes, &at, &moved);
            // Rows in the frame at the element's middle, columns along the polar directions.
            let (sin, cos) = (middle * alpha).sin_cos();
            let turn = Tensor2([[1.0, 0.0, 0.0], [0.0, cos, sin], [0.0, -sin, cos]]);
            let elastic = turn.times(Fe).times(at.polar);

            let name = format!("degree {degree}, {elements:?}, z = {z}");
            assert_close(&name, sample.reference, &at.reference);
            assert_close(&name, sample.position, &position);
            assert_close(
                &name,
                sample.elastic.0.into_iter().flatten(),
                elastic.0.as_flattened(),
            );
            assert_close(&name, [sample.jacobian], &[Fe.determinant()]);
            assert_close(
                &name,
                [sample.energy_density],
                &[reference.law().energy(&Fe)],
            );
        }
    }
}
