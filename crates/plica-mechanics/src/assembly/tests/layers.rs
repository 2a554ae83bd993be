//! Walls of several layers, with fibres and residual stretches.

use super::reference::assert_agreement;
use super::{
    TubeAndLoad, assert_close, direction, dot, largest, linearised, mesh, moved, replicated,
    tube_and_load, wavy,
};
use crate::assembly::{Point, ReferenceTube, SplineTube};
use crate::material::{
    Composite, Fibres, Law, LengthTension, Material, Matrix, MooneyRivlin, NeoHookean, Tone,
};
use crate::spline::transfer;
use crate::tube::{Integration, Mesh, MeshLayer, ResidualStretch, WallLayer};

/// A neo-Hookean layer without muscles, one with fibres of one hand and residual stretches, and a third one.
fn layers() -> Vec<WallLayer> {
    let fibres = vec![
        Fibres::new([0.5, 0.8], 0.1, 0.5),
        Fibres::new([0.3, 0.0], 0.0, -0.3),
    ];
    let matrix = Matrix::NeoHookean(NeoHookean::new(1.0, 0.4));
    vec![
        WallLayer {
            share: 0.3,
            idle_muscles: vec![0, 1],
            ..WallLayer::of(Material::NeoHookean(NeoHookean::new(0.5, 0.45)))
        },
        WallLayer {
            share: 0.45,
            residual: ResidualStretch {
                along: [1.0, 0.9],
                around: [0.7, 0.8],
                opening: None,
            },
            idle_muscles: vec![1],
            ..WallLayer::of(Material::Composite(Composite {
                matrix,
                fibres,
                tones: vec![Tone::new(
                    0.2,
                    LengthTension::Rachev {
                        best: 1.5,
                        least: 0.5,
                    },
                    0.2,
                )],
            }))
        },
        WallLayer {
            share: 0.25,
            ..WallLayer::of(Material::MooneyRivlin(MooneyRivlin::new(2.0, 0.4, 0.3)))
        },
    ]
}

/// The elements of the layers above.
fn of_layers(mesh: Mesh) -> Mesh {
    let layers: Vec<MeshLayer> = layers()
        .iter()
        .zip([1, 2, 1])
        .map(|(layer, elements)| MeshLayer {
            share: layer.share,
            elements,
        })
        .collect();
    Mesh {
        thickness: Mesh::points_through(mesh.degree, &layers),
        layers,
        ..mesh
    }
}

fn layered(degree: usize, [along, around]: [usize; 2], rings: usize) -> TubeAndLoad {
    let TubeAndLoad { tube, load } = tube_and_load(degree, [along, 1, around], 1);
    let mut tube = tube.tube;
    tube.layers = layers();
    let mesh = of_layers(mesh(degree, [along, 1, around]));
    TubeAndLoad {
        tube: SplineTube::new(&tube, &mesh, rings),
        load,
    }
}

#[test]
fn layers_agree_with_the_reference_implementation() {
    for (degree, elements) in [(1, [3, 4]), (2, [9, 6])] {
        let made = layered(degree, elements, elements[1]);
        assert_agreement(&format!("degree {degree}"), &made);
        let TubeAndLoad { tube, .. } = made;
        let (n, C) = (tube.unknowns(), tube.damping());
        let entries = (0..n * n).map(|e| C.entry(e / n, e % n));
        let expected = ReferenceTube::new(&tube, &tube.tube.rest()).damping();
        assert_close("damping", entries, &expected);
    }
    // One ring uses other kernels.
    let TubeAndLoad { tube, load } = layered(3, [9, 8], 1);
    let whole = layered(3, [9, 8], 8).tube;
    let u = wavy(&tube);
    let ring = tube.forces(&load, &u).unwrap();
    let expected = ReferenceTube::new(&whole, &load).forces(&replicated(&u, 8));
    assert!((ring.energy / expected.energy - 1.0).abs() < 1e-12);
    assert_close(
        "one ring",
        replicated(&ring.residual, 8),
        &expected.residual,
    );
}

#[test]
fn residual_and_tangent_of_layers_are_derivatives() {
    for (rings, volumetric) in [
        (1, Integration::Full),
        (1, Integration::Reduced),
        (9, Integration::Full),
        (9, Integration::Reduced),
    ] {
        let TubeAndLoad { tube, load } = layered(3, [3, 9], rings);
        let mesh = Mesh {
            volumetric,
            ..of_layers(mesh(3, [3, 1, 9]))
        };
        let tube = SplineTube::new(&tube.tube, &mesh, rings);
        let (u, d) = (wavy(&tube), direction(&tube));
        let forces = |h: f64| tube.forces(&load, &moved(&u, &d, h)).unwrap();
        let (h, here) = (1e-5, forces(0.0));
        let (before, after) = (forces(-h), forces(h));
        let slope = (after.energy - before.energy) / (2.0 * h) / tube.sector.repeats();
        let exact = dot(&here.residual, &d);
        assert!(
            (slope / exact - 1.0).abs() < 1e-6,
            "{rings}: {slope} {exact}"
        );
        let mut K = vec![0.0; d.len()];
        tube.tangent(&load, &u).multiply_add(1.0, &d, &mut K);
        let change = moved(&after.residual, &before.residual, -1.0);
        let off: Vec<f64> = change
            .iter()
            .zip(&K)
            .map(|(c, k)| c / (2.0 * h) - k)
            .collect();
        assert!(largest(&off) < 1e-6 * largest(&K), "{rings}");
        if rings > 1 {
            let mut y = vec![0.0; u.len()];
            tube.add_tangent_product(&linearised(&tube, &load, &u), 1.0, &d, &mut y);
            assert!(largest(&moved(&y, &K, -1.0)) < 1e-5 * largest(&K));
        }
    }
}

#[test]
fn a_wall_of_equal_layers_is_a_wall_of_one_layer() {
    let TubeAndLoad { tube: one, load } = tube_and_load(3, [4, 4, 6], 6);
    let mut tube = one.tube.clone();
    tube.layers = vec![tube.layers[0].clone(); 2];
    (tube.layers[0].share, tube.layers[1].share) = (0.5, 0.5);
    let elements = |elements| MeshLayer {
        share: 0.5,
        elements,
    };
    let mut mesh = mesh(3, [4, 4, 6]);
    mesh.layers = vec![elements(2); 2];
    mesh.thickness = Mesh::points_through(3, &mesh.layers);
    let two = SplineTube::new(&tube, &mesh, 6);
    assert_eq!(two.wall.functions(), one.wall.functions() + 2);
    let u = wavy(&one);
    let rows = u.chunks_exact(one.row_size());
    let v: Vec<f64> = rows
        .flat_map(|row| transfer(&one.wall, &two.wall, row, 3 * 6))
        .collect();
    let [a, b] = [(&one, &u), (&two, &v)].map(|(tube, u)| tube.forces(&load, u).unwrap());
    assert!((a.energy / b.energy - 1.0).abs() < 1e-12);
    assert!((a.smallest_jacobian / b.smallest_jacobian - 1.0).abs() < 1e-9);
    let at = Point {
        z: 0.7,
        radius: 0.41,
        angle: 0.4,
    };
    let [a, b] = [(&one, &u), (&two, &v)].map(|(tube, u)| tube.sample(&load, u, at).stress);
    assert_close("stress", a.0.into_iter().flatten(), b.0.as_flattened());
}

#[test]
fn a_sample_belongs_to_the_layer_of_its_point() {
    let TubeAndLoad { tube, load } = layered(3, [4, 6], 6);
    let u = wavy(&tube);
    let faces = tube.tube.faces();
    for (layer, wall) in faces.windows(2).enumerate() {
        for depth in [0.0, 0.4, 0.999_999] {
            let radius = wall[0] + depth * (wall[1] - wall[0]);
            let at = Point {
                z: 0.7,
                radius,
                angle: 0.4,
            };
            let sample = tube.sample(&load, &u, at);
            let law = &tube.tube.layers[layer].material;
            let w = law.energy(&sample.elastic);
            assert!(
                (sample.energy_density / w - 1.0).abs() < 1e-12,
                "{layer} {depth}"
            );
            let [along, around] = tube.tube.residual_stretch(layer, radius);
            let (theta_z, theta_t) = tube.tube.stretches(layer, at.z, &load);
            assert!((sample.grown[0] - along * theta_z).abs() < 1e-14);
            assert!((sample.grown[1] - around * theta_t).abs() < 1e-14);
        }
    }
    let inverted = vec![f64::NAN; u.len()];
    assert!(tube.forces(&load, &inverted).is_err());
}

#[test]
fn residual_stretch_is_growth() {
    // A uniform residual stretch and muscles over the whole tube of the same stretch differ only in the energy per ungrown
    // volume.
    let TubeAndLoad { tube, .. } = tube_and_load(3, [4, 2, 6], 6);
    let mut residual = tube.tube.clone();
    residual.muscles = vec![];
    residual.layers[0].residual = ResidualStretch {
        along: [1.1; 2],
        around: [0.8; 2],
        opening: None,
    };
    let mut active = residual.clone();
    active.layers[0].residual = ResidualStretch::default();
    let even = crate::activation::Profile::Table(vec![(0.0, 1.0), (1.0, 1.0)]);
    for direction in [
        crate::activation::Direction::Longitudinal,
        crate::activation::Direction::Circular,
    ] {
        active.muscles.push(crate::activation::Muscle::new(
            String::new(),
            direction,
            [0.0, 1.5],
            even.clone(),
        ));
    }
    let mut load = active.rest();
    load.muscles = vec![1.1, 0.8];
    let mesh = mesh(3, [4, 2, 6]);
    let [residual, active] = [residual, active].map(|tube| SplineTube::new(&tube, &mesh, 6));
    let u = wavy(&residual);
    let [a, b] = [
        residual.forces(&residual.tube.rest(), &u).unwrap(),
        active.forces(&load, &u).unwrap(),
    ];
    assert!((a.energy / b.energy - 1.0).abs() < 1e-13);
    assert!((a.energy_ungrown / b.energy - 1.0).abs() < 1e-13);
    assert_close("residual", a.residual, &b.residual);
}
