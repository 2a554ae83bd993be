//! Tubes with an imperfect stress-free shape.

use super::imperfection::displacement;
use super::mechanics::{carried, tilted};
use super::symmetry::harmonic;
use super::{
    TubeAndLoad, assert_close, direction, dot, largest, linearised, mesh, moved, replicated,
    tube_and_load, unknowns, wavy,
};
use crate::assembly::reference::ReferenceTube;
use crate::assembly::{Point, SplineTube};
use crate::tensor::Tensor2;
use crate::tube::{Axial, Imperfection, Mesh, Mode, Part, Shape, Tube, Wave};
use std::f64::consts::TAU;

/// Returns a mode with displacements in all directions, through the wall and at the ends.
fn mode(harmonic: usize, mesh: Mesh) -> Mode {
    let value = |row: usize, point: usize| {
        let z = row as f64 / (mesh.axial - 1) as f64;
        let t = point as f64 / (mesh.thickness - 1) as f64 - 0.5;
        let wave = (4.0 * z + 0.3).sin();
        [
            0.3 * wave * t + 0.1 * z,
            wave + 0.2 * t,
            0.5 * wave - 0.3 * z * t,
        ]
    };
    let points = |row| (0..mesh.thickness).flat_map(move |point| value(row, point));
    Mode {
        harmonic,
        values: (0..mesh.axial).flat_map(points).collect(),
        mesh,
    }
}

fn geometry(amplitude: f64, shape: Shape) -> Imperfection {
    Imperfection {
        of: Part::Geometry,
        amplitude,
        shape,
    }
}

/// Returns the tube of the other tests (wall thickness 0.15) with an imperfect geometry whose
/// harmonics fit the sector.
fn imperfect(degree: usize, elements: [usize; 3], rings: usize) -> TubeAndLoad {
    let TubeAndLoad { tube, load } = tube_and_load(degree, elements, rings);
    let mesh = mesh(degree, elements);
    let repeats = if rings == 1 { 0 } else { elements[2] / rings };
    let wave = Wave::new(repeats, 0.4, Axial::HalfWaves(2));
    let tube = Tube {
        imperfections: vec![
            geometry(0.03, Shape::Mode(mode(repeats, mesh.clone()))),
            geometry(0.02, Shape::Wave(wave)),
        ],
        ..tube.tube
    };
    TubeAndLoad {
        tube: SplineTube::new(&tube, &mesh, rings),
        load,
    }
}

const MESHES: [(usize, [usize; 3]); 4] = [
    (1, [10, 2, 8]),
    (2, [9, 2, 7]),
    (3, [9, 2, 6]),
    (4, [2, 1, 10]),
];

#[test]
fn imperfect_tube_equals_the_reference_implementation() {
    for (degree, elements) in MESHES {
        let TubeAndLoad { tube, load } = imperfect(degree, elements, elements[2]);
        let u = wavy(&tube);
        let reference = ReferenceTube::new(&tube, &load);
        let (forces, expected) = (tube.forces(&load, &u).unwrap(), reference.forces(&u));
        let name = format!("degree {degree}, {elements:?}");
        assert!(
            (forces.energy / expected.energy - 1.0).abs() < 1e-12,
            "{name}"
        );
        let ungrown = forces.energy_ungrown / expected.energy_ungrown;
        assert!((ungrown - 1.0).abs() < 1e-12, "{name}");
        assert_close(&name, forces.residual, &expected.residual);
        // The imperfection changes the energy.
        let perfect = tube_and_load(degree, elements, elements[2]).tube;
        let perfect = perfect.forces(&load, &u).unwrap();
        assert!(
            (perfect.energy / expected.energy - 1.0).abs() > 1e-3,
            "{name}"
        );
        if degree < 3 {
            let n = tube.unknowns();
            let tangent = tube.tangent(&load, &u);
            let entries = (0..n * n).map(|e| tangent.entry(e / n, e % n));
            assert_close(&name, entries, &reference.tangent(&u));
        }
    }
}

#[test]
fn imperfect_tube_sample_equals_the_reference_implementation() {
    let elements = [9, 2, 6];
    let TubeAndLoad { tube, load } = imperfect(3, elements, 6);
    let reference = ReferenceTube::new(&tube, &load);
    let u = wavy(&tube);
    let (z, radius, around) = (0.9, 0.44, 1.3_f64);
    let angle = around * TAU / 6.0;
    let sample = tube.sample(&load, &u, Point { z, radius, angle });
    let element = [tube.axial.find(z), tube.wall.find(radius), 1];
    let at = reference.at(element, z, radius, around - 0.5);
    let Fe = reference.elastic(
        &reference.element_nodes(element),
        &at,
        &reference.cartesian(&u),
    );
    let (sin, cos) = (TAU / 6.0).sin_cos();
    let turn = Tensor2([[1.0, 0.0, 0.0], [0.0, cos, sin], [0.0, -sin, cos]]);
    let left = |F: Tensor2| F.times(F.transpose()); // Fe Feᵀ
    let (found, expected) = (left(sample.elastic), left(turn.times(Fe)));
    assert_close(
        "Fe Feᵀ",
        found.0.into_iter().flatten(),
        expected.0.as_flattened(),
    );
}

#[test]
fn imperfect_residual_and_tangent_are_derivatives() {
    for rings in [1, 2, 6] {
        let TubeAndLoad { tube, load } = imperfect(3, [9, 2, 6], rings);
        let (u, d) = (wavy(&tube), direction(&tube));
        let forces = |h: f64| tube.forces(&load, &moved(&u, &d, h)).unwrap();
        let slope = dot(&forces(0.0).residual, &d) * tube.sector.repeats();
        let mut exact = vec![0.0; u.len()];
        tube.tangent(&load, &u).multiply_add(1.0, &d, &mut exact);
        let errors = |h: f64| {
            let (ahead, behind) = (forces(h), forces(-h));
            let energy = ((ahead.energy - behind.energy) / (2.0 * h) - slope).abs();
            let difference = moved(&ahead.residual, &behind.residual, -1.0);
            let off = moved(&exact, &difference, -0.5 / h);
            [energy, dot(&off, &off).sqrt()]
        };
        let (coarse, fine) = (errors(4e-3), errors(2e-3));
        for i in 0..2 {
            let order = (coarse[i] / fine[i]).log2();
            assert!(
                (order - 2.0).abs() < 0.05,
                "{rings} rings, {i}: order {order}"
            );
        }
        if rings > 1 {
            // The tangent data are single precision.
            let mut product = vec![0.0; u.len()];
            tube.add_tangent_product(&linearised(&tube, &load, &u), 1.0, &d, &mut product);
            let off = largest(&moved(&product, &exact, -1.0));
            assert!(off < 1e-6 * largest(&exact), "{rings} rings: {off:e}");
        }
    }
}

#[test]
fn imperfect_tube_at_rest_is_free_of_stress() {
    for rings in [1, 2, 6] {
        let TubeAndLoad { tube, .. } = imperfect(3, [9, 2, 6], rings);
        let rest = tube.tube.rest();
        let u = tube.geometric_imperfection().unwrap();
        assert!(largest(u) > 0.02);
        let forces = tube.forces(&rest, u).unwrap();
        assert!(forces.energy.abs() < 1e-15, "{rings}: {}", forces.energy);
        assert!(largest(&forces.residual) < 1e-14, "{rings} rings");
        assert!((forces.smallest_jacobian - 1.0).abs() < 1e-13);
        // Its ends are prescribed there, and it is the initial guess.
        assert!(largest(&moved(&tube.initial_guess(), u, -1.0)) < 1e-16);
        let mut held = u.to_vec();
        tube.apply_prescribed(&rest, &mut held);
        assert!(largest(&moved(&held, u, -1.0)) < 1e-16);
    }
}

#[test]
fn rigidly_rotated_stress_free_shape_is_no_imperfection() {
    for degree in [1, 3] {
        let TubeAndLoad { tube, load } = tube_and_load(degree, [5, 2, 7], 7);
        let zero = vec![0.0; tube.unknowns()];
        let delta = carried(&tube, &load, &zero, tilted(), [0.4, -0.7, 0.9]);
        let u = wavy(&tube);
        let perfect = tube.forces(&load, &u).unwrap();
        let rotated = tube.clone().with_stress_free_shape(delta);
        let forces = rotated.forces(&load, &u).unwrap();
        assert!((forces.energy / perfect.energy - 1.0).abs() < 1e-12);
        assert_close("residual", forces.residual, &perfect.residual);
        let (a, b) = (rotated.tangent(&load, &u), tube.tangent(&load, &u));
        let n = tube.unknowns();
        let entries = |K: &crate::matrix::BlockBanded| -> Vec<f64> {
            (0..n * n).map(|e| K.entry(e / n, e % n)).collect()
        };
        assert_close("tangent", entries(&a), &entries(&b));
    }
}

#[test]
fn axisymmetric_imperfection_is_the_same_for_every_sector() {
    let elements = [9, 2, 12];
    let TubeAndLoad { tube: one, load } = imperfect(3, elements, 1);
    let u = unknowns(&one, |z, r, _| {
        [
            0.05 * (2.0 * z + 1.0).sin(),
            r * (0.08 * (3.0 * z).cos() - 0.1),
            0.0,
        ]
    });
    let forces = one.forces(&load, &u).unwrap();
    for rings in [3, 12] {
        let many = SplineTube::new(&one.tube, &mesh(3, elements), rings);
        let f = many.forces(&load, &replicated(&u, rings)).unwrap();
        assert!((f.energy / forces.energy - 1.0).abs() < 1e-13);
        let off = moved(&f.residual, &replicated(&forces.residual, rings), -1.0);
        assert!(largest(&off) < 1e-13 * forces.residual_scale);
        let again = many.axisymmetric().forces(&load, &u).unwrap();
        assert!((again.energy / forces.energy - 1.0).abs() < 1e-15);
        // The same in every harmonic: assembled, averaged, and as a product. The mode is left out,
        // since its circumferential part is a twist.
        let plain = Tube {
            imperfections: vec![one.tube.imperfections[1].clone()],
            ..one.tube.clone()
        };
        let [one, many] =
            [1, rings].map(|rings| SplineTube::new(&plain, &mesh(3, elements), rings));
        let at = linearised(&many, &load, &replicated(&u, rings));
        let v = direction(&one);
        for n in [4, 8] {
            let mut block = vec![0.0; v.len()];
            one.tangent_in_harmonic(&load, &u, n)
                .multiply_add(1.0, &v, &mut block);
            let mut averaged = vec![0.0; v.len()];
            at.average.harmonic(n).multiply_add(1.0, &v, &mut averaged);
            assert_close(&format!("average, {n}"), averaged, &block);
            if rings == 12 {
                let mut product = vec![0.0; many.unknowns()];
                many.add_tangent_product(&at, 1.0, &harmonic(&many, &v, n), &mut product);
                let off = largest(&moved(&product, &harmonic(&many, &block, n), -1.0));
                assert!(off < 1e-6 * largest(&block), "{n}: {off:e}");
            }
        }
    }
}

/// Returns the largest displacement of the wall for given control values, and the largest normal to
/// the perfect wall.
fn largest_displacement(tube: &SplineTube, u: &[f64]) -> [f64; 2] {
    let mut most = [0.0_f64; 2];
    for i in 0..=60 {
        for j in 0..48 {
            for radius in [0.35, 0.425, 0.5] {
                let (z, angle) = (0.025 * f64::from(i), TAU * f64::from(j) / 48.0);
                let [z, x, y] = displacement(tube, u, z, radius, angle);
                let (sin, cos) = angle.sin_cos();
                most[0] = most[0].max((z * z + x * x + y * y).sqrt());
                most[1] = most[1].max((x * cos + y * sin).abs());
            }
        }
    }
    most
}

#[test]
fn amplitude_is_the_largest_displacement() {
    let TubeAndLoad { tube, .. } = tube_and_load(3, [9, 2, 12], 1);
    let with = |shape: Shape, mesh: &Mesh, rings| {
        let tube = Tube {
            imperfections: vec![geometry(0.01, shape)],
            ..tube.tube.clone()
        };
        SplineTube::new(&tube, mesh, rings)
    };
    let fine = mesh(3, [24, 2, 48]);
    for harmonic in 0..=3 {
        for axial in [Axial::Uniform, Axial::HalfWaves(2), Axial::Zone([0.3, 1.0])] {
            let wave = Shape::Wave(Wave::new(harmonic, 0.0, axial));
            let spline = with(wave, &fine, 48);
            let [_, normal] =
                largest_displacement(&spline, spline.geometric_imperfection().unwrap());
            assert!(
                (normal / 0.01 - 1.0).abs() < 5e-3,
                "{harmonic}, {axial:?}: {normal}"
            );
        }
        // A mode of a coarse mesh, on that mesh, on a fine one, and on one of another degree.
        let of = mode(harmonic, mesh(3, [12, 2, 24]));
        for (to, close) in [
            (mesh(3, [12, 2, 24]), 5e-3),
            (fine.clone(), 5e-3),
            (mesh(2, [20, 2, 36]), 2e-2),
        ] {
            let around = to.around;
            let spline = with(Shape::Mode(of.clone()), &to, around);
            let [most, _] = largest_displacement(&spline, spline.geometric_imperfection().unwrap());
            assert!(
                (most / 0.01 - 1.0).abs() < close,
                "mode {harmonic}, {around} around: {most}"
            );
        }
    }
}

#[test]
fn mode_shape_is_the_same_on_every_mesh() {
    let TubeAndLoad { tube, .. } = tube_and_load(3, [9, 2, 12], 1);
    for harmonic in 0..=3 {
        let own = mesh(3, [12, 2, 24]);
        let imperfections = vec![geometry(0.01, Shape::Mode(mode(harmonic, own.clone())))];
        let tube = Tube {
            imperfections,
            ..tube.tube.clone()
        };
        let [a, b] =
            [own, mesh(3, [24, 4, 48])].map(|mesh| SplineTube::new(&tube, &mesh, mesh.around));
        let at = |tube: &SplineTube, i: i32| {
            let u = tube.geometric_imperfection().unwrap();
            let i = f64::from(i);
            displacement(tube, u, 0.03 * i, 0.35 + 0.003 * i, 0.21 * i)
        };
        for i in 0..50 {
            let (a, b) = (at(&a, i), at(&b, i));
            // 24 functions represent four periods to 2e-3.
            let off = (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max);
            assert!(off < 3e-3 * 0.01, "{harmonic}: {a:?}, {b:?}");
        }
    }
}

#[test]
fn folded_stress_free_shape_is_an_error_with_its_place() {
    let TubeAndLoad { tube, .. } = tube_and_load(3, [9, 2, 12], 12);
    let mode = mode(2, mesh(3, [9, 2, 12]));
    let shape = |amplitude| [geometry(amplitude, Shape::Mode(mode.clone()))];
    assert_eq!(tube.check_imperfections(&shape(0.03)), Ok(()));
    let folded = tube.check_imperfections(&shape(3.0)).unwrap_err();
    assert!(
        folded.jacobian <= 0.0 && (0.0..=1.5).contains(&folded.place.z),
        "{folded:?}"
    );
    assert!((0.0..=1.0).contains(&folded.place.depth));
    // A tube with this shape is inverted.
    let tube = Tube {
        imperfections: shape(3.0).to_vec(),
        ..tube.tube
    };
    let tube = SplineTube::new(&tube, &mesh(3, [9, 2, 12]), 12);
    assert!(
        tube.forces(&tube.tube.rest(), &tube.initial_guess())
            .is_err()
    );
}
