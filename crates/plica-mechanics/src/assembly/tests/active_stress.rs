//! Muscles with active stress.

use super::patches::sector;
use super::reference::assert_agreement;
use super::symmetry::harmonic;
use super::{
    TubeAndLoad, assert_close, direction, dot, largest, linearised, mesh, moved, repeated,
    replicated, tube_and_load, unknowns, wavy,
};
use crate::activation::{Direction, Muscle, Profile};
use crate::assembly::{LowHarmonics, Point, SplineTube};
use crate::material::{Composite, LengthTension, Material, Matrix, NeoHookean, Tone};
use crate::matrix::BlockBanded;
use crate::tube::{
    Axial, Imperfection, Integration, Load, Mesh, MeshLayer, Part, Patch, Region, Shape, Tube,
    WallLayer, Wave,
};

const RACHEV: LengthTension = LengthTension::Rachev {
    best: 1.5,
    least: 0.5,
};
const GAUSSIAN: LengthTension = LengthTension::Gaussian {
    best: 1.3,
    width: 0.4,
};

/// Returns a tube with two muscles that change the stress, one of them oblique and repeated, beside those that change the
/// stress-free state if `growing`. In `repeats` sectors around it unless that is zero.
fn active(
    (degree, elements, rings): (usize, [usize; 3], usize),
    repeats: usize,
    growing: bool,
    change: impl Fn(&mut Tube),
) -> TubeAndLoad {
    let TubeAndLoad { tube, load } = tube_and_load(degree, elements, 1);
    let mut tube = tube.tube;
    let muscle = |direction, zone| {
        let muscle = Muscle::new(String::new(), direction, zone, Profile::RaisedCosine);
        Muscle {
            sector: (repeats > 0).then(|| sector(repeats)),
            ..muscle
        }
    };
    tube.muscles
        .push(muscle(Direction::Circular, [0.1, 1.1]).with_active_stress(RACHEV, 0.0));
    let oblique = muscle(Direction::Longitudinal, [0.5, 1.0]).with_active_stress(GAUSSIAN, 1.2);
    tube.muscles.push(Muscle {
        repeat: Some(0.7),
        ..oblique
    });
    change(&mut tube);
    let grown = match growing {
        true => load.muscles,
        false => vec![1.0; 2],
    };
    TubeAndLoad {
        tube: SplineTube::new(&tube, &mesh(degree, elements), rings),
        load: Load {
            muscles: [grown, vec![0.4, 0.25]].concat(),
            shifts: vec![0.0, 0.0, 0.1, -0.2],
            patches: vec![1.2; tube.patches.len()],
            ..tube.rest()
        },
    }
}

/// Adds a patch that weakens the first of the muscles with active stress, an imperfection of the second, and a bent
/// stress-free shape.
fn modified(tube: &mut Tube) {
    tube.patches = vec![Patch {
        name: "scar".into(),
        region: Region {
            zone: [0.3, 1.2],
            edge: 0.3,
            sector: tube.muscles[2].sector,
        },
        layers: vec![0],
        stiffness: 2.0,
        muscles: vec![1.0, 1.0, 0.3, 1.0],
    }];
    let wave = Shape::Wave(Wave::new(0, 0.3, Axial::Uniform));
    tube.imperfections = [Part::Muscle(3), Part::Geometry]
        .map(|of| Imperfection {
            of,
            amplitude: 0.02,
            shape: wave.clone(),
        })
        .to_vec();
}

#[test]
fn active_stresses_agree_with_the_reference_implementation() {
    for (degree, elements, repeats) in [(1, [4, 2, 8], 1), (2, [9, 1, 6], 2), (2, [3, 1, 9], 0)] {
        for growing in [false, true] {
            let mesh = (degree, elements, elements[2]);
            let made = active(mesh, repeats, growing, |_| {});
            assert_agreement(&format!("degree {degree}, {growing}"), &made);
        }
        let made = active((degree, elements, elements[2]), repeats, true, modified);
        assert_agreement(&format!("degree {degree}, modified"), &made);
    }
}

#[test]
fn residual_and_tangent_are_derivatives() {
    for (rings, repeats) in [(1, 0), (3, 2), (6, 1)] {
        for (growing, change) in [
            (false, &(|_: &mut Tube| {}) as &dyn Fn(&mut Tube)),
            (true, &modified),
        ] {
            let TubeAndLoad { tube, load } =
                active((3, [5, 2, 6], rings), repeats, growing, change);
            let (u, d) = (wavy(&tube), direction(&tube));
            let forces = |h: f64| tube.forces(&load, &moved(&u, &d, h)).unwrap();
            let here = forces(0.0);
            let (exact, mut K) = (dot(&here.residual, &d), vec![0.0; d.len()]);
            tube.tangent(&load, &u).multiply_add(1.0, &d, &mut K);
            // Errors of central differences over 2h, which fall with h².
            let errors = |h: f64| {
                let (before, after) = (forces(-h), forces(h));
                let slope = (after.energy - before.energy) / (2.0 * h) / tube.sector.repeats();
                let change = moved(&after.residual, &before.residual, -1.0);
                let off = change.iter().zip(&K).map(|(c, k)| c / (2.0 * h) - k);
                let off: Vec<f64> = off.collect();
                [(slope / exact - 1.0).abs(), largest(&off) / largest(&K)]
            };
            let [coarse, fine] = [4e-3, 2e-3].map(errors);
            for i in 0..2 {
                let order = (coarse[i] / fine[i]).log2();
                assert!(
                    (order - 2.0).abs() < 0.1,
                    "{rings} {i}: {coarse:?} {fine:?}"
                );
                assert!(fine[i] < 1e-3, "{rings} {i}: {fine:?}");
            }
            if rings > 1 {
                let mut y = vec![0.0; u.len()];
                tube.add_tangent_product(&linearised(&tube, &load, &u), 1.0, &d, &mut y);
                assert!(largest(&moved(&y, &K, -1.0)) < 1e-6 * largest(&K));
            }
        }
    }
}

#[test]
fn a_muscle_all_over_is_a_tone_of_the_layer() {
    // Also with reduced integration, for one ring and many.
    let tone = Tone::new(0.3, RACHEV, 0.4);
    let matrix = NeoHookean::new(1.0, 0.45);
    let TubeAndLoad { tube, .. } = tube_and_load(3, [5, 2, 8], 1);
    let layer = |share, material| WallLayer {
        share,
        ..WallLayer::of(material)
    };
    let of_tone = Material::Composite(Composite {
        matrix: Matrix::NeoHookean(matrix),
        fibres: vec![],
        tones: vec![tone],
    });
    let plain = Material::NeoHookean(matrix);
    let layers = |outer| vec![layer(0.5, plain.clone()), layer(0.5, outer)];
    let toned = Tube {
        layers: layers(of_tone),
        muscles: vec![],
        ..tube.tube.clone()
    };
    let even = Profile::Table(vec![(0.0, 0.4), (1.0, 0.4)]);
    let muscle = Muscle::new(String::new(), Direction::Circular, [0.0, 1.5], even);
    let mut driven = Tube {
        layers: layers(plain.clone()),
        muscles: vec![muscle.with_active_stress(RACHEV, 0.4)],
        ..tube.tube
    };
    driven.layers[0].idle_muscles = vec![0];
    let load = Load {
        muscles: vec![0.3],
        ..driven.rest()
    };
    for volumetric in [Integration::Full, Integration::Reduced] {
        let mesh = Mesh {
            thickness: 7,
            layers: vec![
                MeshLayer {
                    share: 0.5,
                    elements: 1
                };
                2
            ],
            volumetric,
            ..mesh(3, [5, 2, 8])
        };
        for rings in [1, 8] {
            let [toned, driven] = [&toned, &driven].map(|tube| SplineTube::new(tube, &mesh, rings));
            let u = wavy(&toned);
            let rest = toned.tube.rest();
            let [a, b] = [(&toned, &rest), (&driven, &load)].map(|(tube, load)| {
                let at = Point {
                    z: 0.7,
                    radius: 0.47,
                    angle: 0.3,
                };
                let mut K = vec![0.0; u.len()];
                let d = direction(tube);
                tube.tangent(load, &u).multiply_add(1.0, &d, &mut K);
                (tube.forces(load, &u).unwrap(), K, tube.sample(load, &u, at))
            });
            assert!((a.0.energy / b.0.energy - 1.0).abs() < 1e-13);
            assert!((a.0.smallest_jacobian / b.0.smallest_jacobian - 1.0).abs() < 1e-13);
            assert_close("residual", a.0.residual, &b.0.residual);
            assert_close("tangent", a.1, &b.1);
            let stress = moved(
                a.2.stress.0.as_flattened(),
                b.2.stress.0.as_flattened(),
                -1.0,
            );
            assert!(largest(&stress) < 1e-13);
            assert!((a.2.energy_density - b.2.energy_density).abs() < 1e-13);
            assert!(a.2.tension == 0.0 && (b.2.tension - 0.3).abs() < 1e-14);
        }
    }
}

#[test]
fn sectors_averages_and_harmonics_agree_with_the_whole_tube() {
    let one = active((3, [9, 2, 12], 1), 0, true, |tube| {
        tube.muscles[3] = tube.muscles[3]
            .clone()
            .with_active_stress(GAUSSIAN, 0.5 * std::f64::consts::PI);
    });
    let (load, tube) = (&one.load, &one.tube.tube);
    let [whole, few] = [12, 2].map(|rings| SplineTube::new(tube, &mesh(3, [9, 2, 12]), rings));
    let u = unknowns(&one.tube, |z, r, _| {
        [0.05 * (2.0 * z).sin(), 0.05 * r * (3.0 * z).cos(), 0.0]
    });
    let ring = one.tube.forces(load, &u).unwrap();
    let all = whole.forces(load, &replicated(&u, 12)).unwrap();
    let pair = few.forces(load, &replicated(&u, 2)).unwrap();
    assert!((all.energy / ring.energy - 1.0).abs() < 1e-13);
    assert_close("sector", repeated(&pair.residual, 2, 12), &all.residual);

    let many = replicated(&u, 12);
    let at = linearised(&whole, load, &many);
    for n in [1, 2, 3] {
        let v = direction(&one.tube);
        let (mut exact, mut found) = (vec![0.0; u.len()], vec![0.0; u.len()]);
        let block = one.tube.tangent_in_harmonic(load, &u, n);
        block.multiply_add(1.0, &v, &mut exact);
        at.average.harmonic(n).multiply_add(1.0, &v, &mut found);
        assert!(largest(&moved(&found, &exact, -1.0)) < 1e-12 * largest(&exact));
        let mut y = vec![0.0; many.len()];
        whole.add_tangent_product(&at, 1.0, &harmonic(&whole, &v, n), &mut y);
        let off = moved(&y, &harmonic(&whole, &exact, n), -1.0);
        assert!(largest(&off) < 1e-6 * largest(&y), "{n}");
    }
}

#[test]
fn the_low_harmonic_tangent_has_the_tension() {
    // Its change with the tension, against the change of the averaged tangent, which is exact at an axisymmetric state.
    let made = active((3, [12, 2, 16], 16), 0, false, |_| {});
    let (tube, load) = (&made.tube, &made.load);
    let u = unknowns(tube, |z, r, _| [0.0, 0.05 * r * (3.0 * z).cos(), 0.0]);
    let low = LowHarmonics::new(tube, 2);
    let form = |load: &Load| {
        let mut coupled = BlockBanded::zeros(tube.axial.functions(), low.row_size(), tube.degree());
        tube.low_harmonic_tangent(&low, load, &u, &mut coupled);
        // A radial displacement of mode 0, uniform through the wall.
        let x: Vec<f64> = (0..coupled.unknowns())
            .map(|i| match i % low.row_size() {
                1 => (0.4 * (i / low.row_size()) as f64).sin(),
                _ => 0.0,
            })
            .collect();
        let mut y = vec![0.0; x.len()];
        coupled.multiply_add(1.0, &x, &mut y);
        dot(&x, &y)
    };
    let exact = |load: &Load| {
        let average = linearised(tube, load, &u).average.harmonic(0);
        let x: Vec<f64> = (0..average.unknowns())
            .map(|i| match i % 3 {
                1 => (0.4 * (i / (3 * tube.wall.functions())) as f64).sin(),
                _ => 0.0,
            })
            .collect();
        let mut y = vec![0.0; x.len()];
        average.multiply_add(1.0, &x, &mut y);
        16.0 * dot(&x, &y)
    };
    let rest = tube.tube.rest();
    let [found, exact] = [form(load) - form(&rest), exact(load) - exact(&rest)];
    assert!(
        exact.abs() > 1e-2 && (found / exact - 1.0).abs() < 0.02,
        "{found} {exact}"
    );
}

#[test]
fn a_muscle_without_tension_changes_nothing() {
    for rings in [1, 8] {
        let TubeAndLoad { tube, load } = active((3, [5, 2, 8], rings), 0, true, |_| {});
        let plain = Tube {
            muscles: tube.tube.muscles[..2].to_vec(),
            ..tube.tube.clone()
        };
        let plain = SplineTube::new(&plain, &mesh(3, [5, 2, 8]), rings);
        let mut idle = load.clone();
        idle.muscles[2..].fill(0.0);
        let u = wavy(&tube);
        let without = Load {
            muscles: load.muscles[..2].to_vec(),
            shifts: vec![0.0; 2],
            ..load
        };
        let (own, other) = (plain.forces(&without, &u), tube.forces(&idle, &u));
        let (own, other) = (own.unwrap(), other.unwrap());
        assert_eq!(own.residual, other.residual);
        assert_eq!(own.energy, other.energy);
        assert_eq!(own.residual_scale, other.residual_scale);
        let v = direction(&tube);
        let assembled = |tube: &SplineTube, load: &Load| {
            let mut y = vec![0.0; v.len()];
            tube.tangent(load, &u).multiply_add(1.0, &v, &mut y);
            y
        };
        assert_eq!(assembled(&plain, &without), assembled(&tube, &idle));
        if rings > 1 {
            let products = |tube: &SplineTube, load: &Load| {
                let at = linearised(tube, load, &u);
                let mut y = vec![0.0; v.len()];
                tube.add_tangent_product(&at, 1.0, &v, &mut y);
                let block = at.average.harmonic(2);
                let mut averaged = vec![0.0; block.unknowns()];
                block.multiply_add(1.0, &v[..averaged.len()], &mut averaged);
                (y, averaged)
            };
            assert_eq!(products(&plain, &without), products(&tube, &idle));
        }
    }
}
