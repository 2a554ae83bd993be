//! Patches of the wall, and sectors of muscles.

use super::reference::assert_agreement;
use super::{
    TubeAndLoad, assert_close, direction, dot, largest, linearised, mesh, moved, repeated,
    tube_and_load, unknowns, wavy,
};
use crate::activation::AngularSector;
use crate::assembly::{Point, SplineTube};
use crate::material::{Material, NeoHookean};
use crate::tube::{
    Axial, Imperfection, Load, Part, Patch, Region, ResidualStretch, Shape, Tube, Wave,
};

/// Returns a patch over most of the tube.
fn patch(sector: Option<AngularSector>) -> Patch {
    Patch {
        name: "scar".into(),
        region: Region {
            zone: [0.3, 1.2],
            edge: 0.3,
            sector,
        },
        layers: vec![0],
        stiffness: 3.0,
        muscles: vec![0.2, 1.5],
    }
}

/// Returns most of the circumference, or `repeats` parts of it.
pub(super) fn sector(repeats: usize) -> AngularSector {
    AngularSector {
        centre: 0.4,
        width: 4.5 / repeats as f64,
        edge: 1.5 / repeats as f64,
        repeats,
    }
}

/// Returns the tube of the other tests with a patch that grows, and with muscles in a sector.
fn patched(
    degree: usize,
    elements: [usize; 3],
    (rings, repeats): (usize, usize),
    change: impl Fn(&mut Tube),
) -> TubeAndLoad {
    let TubeAndLoad { tube, load } = tube_and_load(degree, elements, 1);
    let mut tube = tube.tube;
    let sector = (repeats > 0).then(|| sector(repeats));
    tube.muscles[0].sector = sector;
    tube.patches = vec![patch(sector)];
    change(&mut tube);
    TubeAndLoad {
        tube: SplineTube::new(&tube, &mesh(degree, elements), rings),
        load: Load {
            patches: vec![1.4],
            ..load
        },
    }
}

/// Bends the stress-free shape, and gives the wall residual stretches.
fn imperfect(tube: &mut Tube) {
    tube.layers[0].residual = ResidualStretch {
        along: [1.05, 0.95],
        around: [0.9, 1.1],
        opening: None,
    };
    tube.imperfections = vec![Imperfection {
        of: Part::Geometry,
        amplitude: 0.02,
        shape: Shape::Wave(Wave::new(0, 0.3, Axial::Uniform)),
    }];
}

#[test]
fn patches_agree_with_the_reference_implementation() {
    for (name, change) in [
        ("perfect", &(|_: &mut Tube| {}) as &dyn Fn(&mut Tube)),
        ("imperfect", &imperfect),
    ] {
        for (degree, elements, repeats) in [(1, [4, 2, 8], 1), (2, [9, 1, 6], 2), (2, [3, 1, 9], 0)]
        {
            let made = patched(degree, elements, (elements[2], repeats), change);
            assert_agreement(&format!("{name}, degree {degree}"), &made);
        }
    }
}

#[test]
fn residual_and_tangent_of_a_patched_tube_are_derivatives() {
    for (rings, repeats) in [(1, 0), (3, 2), (3, 4), (6, 1)] {
        for change in [&(|_: &mut Tube| {}) as &dyn Fn(&mut Tube), &imperfect] {
            let TubeAndLoad { tube, load } = patched(3, [9, 2, 6], (rings, repeats), change);
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
                assert!(largest(&moved(&y, &K, -1.0)) < 1e-6 * largest(&K));
            }
        }
    }
}

#[test]
fn a_pattern_of_a_period_repeats_on_the_sector() {
    let whole = patched(3, [5, 2, 12], (12, 3), |_| {});
    for rings in [4, 2] {
        // A sector of two rings holds half a period only if the pattern repeats six times.
        let repeats = 12 / rings;
        let whole = match repeats {
            3 => &whole,
            _ => &patched(3, [5, 2, 12], (12, repeats), |_| {}),
        };
        let fold = patched(3, [5, 2, 12], (rings, repeats), |_| {});
        let u = wavy(&fold.tube);
        let all = whole
            .tube
            .forces(&whole.load, &repeated(&u, rings, 12))
            .unwrap();
        let one = fold.tube.forces(&fold.load, &u).unwrap();
        assert!((one.energy / all.energy - 1.0).abs() < 1e-12);
        assert_close(
            "residual",
            repeated(&one.residual, rings, 12),
            &all.residual,
        );
    }
}

#[test]
fn a_patch_all_over_is_another_law() {
    for rings in [1, 8] {
        let TubeAndLoad { tube, load } = tube_and_load(3, [5, 2, 8], 1);
        let mut patched = tube.tube.clone();
        patched.patches = vec![Patch {
            region: Region {
                zone: [0.0, 1.5],
                edge: 0.0,
                sector: None,
            },
            stiffness: 2.0,
            muscles: vec![1.0; 2],
            ..patch(None)
        }];
        let mut twice = tube.tube;
        twice.layers[0].material = Material::NeoHookean(NeoHookean::new(2.0, 0.45));
        let [a, b] = [patched, twice].map(|tube| {
            let load = Load {
                patches: tube.rest().patches,
                ..load.clone()
            };
            let tube = SplineTube::new(&tube, &mesh(3, [5, 2, 8]), rings);
            tube.forces(&load, &wavy(&tube)).unwrap()
        });
        assert!((a.energy / b.energy - 1.0).abs() < 1e-13);
        assert_close("residual", a.residual, &b.residual);
    }
}

#[test]
fn growth_through_the_wall_thickens_it_without_stress() {
    // A grown plate, far from curvature: radial growth alone leaves a free wall nearly free of stress.
    let TubeAndLoad { tube, .. } = tube_and_load(3, [5, 2, 8], 1);
    let mut tube = tube.tube;
    tube.patches = vec![Patch {
        region: Region {
            zone: [0.0, 1.5],
            edge: 0.0,
            sector: None,
        },
        stiffness: 1.0,
        muscles: vec![1.0; 2],
        ..patch(None)
    }];
    for rings in [1, 8] {
        let tube = SplineTube::new(&tube, &mesh(3, [5, 2, 8]), rings);
        let load = Load {
            patches: vec![1.5],
            ..tube.tube.rest()
        };
        // R → outer radius − 1.5 (outer radius − R): Fe is the identity but for the change of the circumference.
        let u = unknowns(&tube, |_, r, _| {
            [0.0, 0.5 * (r - 0.5) * tube.circle.control_radius, 0.0]
        });
        let at = Point {
            z: 0.7,
            radius: 0.5,
            angle: 0.3,
        };
        let sample = tube.sample(&load, &u, at);
        assert!((sample.grown_through - 1.5).abs() < 1e-14);
        for i in 0..3 {
            let direction = sample.elastic.transpose().times(sample.elastic).0[i][i];
            assert!((direction - 1.0).abs() < 1e-3, "{i}: {direction}");
        }
        let inside = tube.sample(&load, &u, Point { radius: 0.4, ..at });
        let around = inside.elastic.transpose().times(inside.elastic).0[2][2].sqrt();
        assert!((around - 0.35 / 0.4).abs() < 1e-3, "{around}");
    }
}

#[test]
fn a_patch_of_other_layers_changes_nothing() {
    let TubeAndLoad { tube, load } = tube_and_load(3, [5, 2, 8], 8);
    let mut elsewhere = tube.tube.clone();
    elsewhere.patches = vec![Patch {
        layers: vec![1],
        ..patch(Some(sector(1)))
    }];
    let elsewhere = SplineTube::new(&elsewhere, &mesh(3, [5, 2, 8]), 8);
    let u = wavy(&tube);
    let own = tube.forces(&load, &u).unwrap();
    let load = Load {
        patches: vec![2.0],
        ..load
    };
    let other = elsewhere.forces(&load, &u).unwrap();
    assert_close("residual", other.residual, &own.residual);
}
