//! That the kernel is its plain twin.

use super::{TubeAndLoad, assert_close, tube_and_load, wavy};
use crate::assembly::Point;
use crate::assembly::reference::ReferenceTube;
use crate::material::Law;
use crate::tensor::Tensor2;
use std::f64::consts::TAU;

/// Degrees and elements along, through and around: counts along the tube below, at and above
/// eight, so that batches are partly filled, full and summed.
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
fn the_kernel_has_the_energy_and_the_residual_of_its_plain_twin() {
    for (degree, elements) in MESHES {
        let TubeAndLoad { tube, load } = tube_and_load(degree, elements, elements[2]);
        let u = wavy(&tube);
        let (fast, plain) = (
            tube.forces(&load, &u).unwrap(),
            ReferenceTube::new(&tube, &load).forces(&u),
        );
        let name = format!("degree {degree}, {elements:?}");
        let numbers = [fast.energy, fast.energy_ungrown, fast.residual_scale];
        for (a, b) in
            numbers
                .into_iter()
                .zip([plain.energy, plain.energy_ungrown, plain.residual_scale])
        {
            assert!((a / b - 1.0).abs() < 1e-12, "{name}: {a} is not {b}");
        }
        assert_close(&name, fast.residual, &plain.residual);
    }
}

#[test]
fn the_kernel_has_the_tangent_of_its_plain_twin() {
    for (degree, elements) in MESHES {
        let TubeAndLoad { tube, load } = tube_and_load(degree, elements, elements[2]);
        let u = wavy(&tube);
        let (fast, plain) = (
            tube.tangent(&load, &u),
            ReferenceTube::new(&tube, &load).tangent(&u),
        );
        let n = tube.unknowns();
        let entries = (0..n * n).map(|e| fast.entry(e / n, e % n));
        assert_close(&format!("degree {degree}, {elements:?}"), entries, &plain);
    }
}

#[test]
fn the_kernel_has_the_drag_of_its_plain_twin() {
    for (degree, elements) in MESHES {
        let TubeAndLoad { tube, load } = tube_and_load(degree, elements, elements[2]);
        let (fast, plain) = (tube.damping(), ReferenceTube::new(&tube, &load).damping());
        let n = tube.unknowns();
        let entries = (0..n * n).map(|e| fast.entry(e / n, e % n));
        assert_close(&format!("degree {degree}, {elements:?}"), entries, &plain);
    }
}

#[test]
fn samples_are_those_of_the_plain_twin() {
    for (degree, elements) in MESHES {
        let TubeAndLoad { tube, load } = tube_and_load(degree, elements, elements[2]);
        let plain = ReferenceTube::new(&tube, &load);
        let u = wavy(&tube);
        let moved = plain.cartesian(&u);
        let alpha = TAU / elements[2] as f64;
        // Points inside, on an edge and on both ends; angles below zero and beyond a turn too.
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
            let at = plain.at(element, z, radius, around + 0.5 - middle);
            let nodes = plain.element_nodes(element);
            let position = [0, 1, 2].map(|i| {
                at.reference[i]
                    + nodes
                        .iter()
                        .zip(&at.value)
                        .map(|(&node, n)| n * moved[node][i])
                        .sum::<f64>()
            });
            let Fe = plain.elastic(&nodes, &at, &moved);
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
            assert_close(&name, [sample.energy_density], &[plain.law().energy(&Fe)]);
        }
    }
}
