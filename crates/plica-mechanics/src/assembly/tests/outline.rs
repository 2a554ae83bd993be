//! Tubes whose diameter and thickness vary along them.

use super::{TubeAndLoad, assert_close, dot, mesh, moved, tube_and_load, unknowns, wavy};
use crate::assembly::{Point, SplineTube};
use crate::tube::{
    Foundation, Imperfection, Outline, Part, Region, Shape, SpringDirection, Support, Tube,
};
use std::f64::consts::PI;

fn with(tube: Tube, outline: Outline, elements: [usize; 3], rings: usize) -> SplineTube {
    let tube = Tube {
        imperfections: vec![Imperfection {
            of: Part::Geometry,
            amplitude: 1.0,
            shape: Shape::Outline(outline),
        }],
        ..tube
    };
    SplineTube::new(&tube, &mesh(3, elements), rings)
}

#[test]
fn a_tube_of_another_diameter_is_the_same_tube_scaled() {
    let elements = [9, 2, 12];
    for rings in [12, 6, 1] {
        let TubeAndLoad { tube, mut load } = tube_and_load(3, elements, rings);
        let scale = 1.3;
        let mut tube = tube.tube;
        tube.foundations = vec![Foundation {
            region: Region {
                zone: [0.2, 1.2],
                edge: 0.2,
                sector: None,
            },
            stiffness: 0.7,
            direction: SpringDirection::Normal,
        }];
        (load.pressures[0].dead, load.pressures[1].dead) = (0.02, 0.05);
        let small = SplineTube::new(&tube, &mesh(3, elements), rings);
        let u = wavy(&small);
        let expected = small.forces(&load, &u).unwrap();
        let mut tube = small.tube.clone();
        tube.length *= scale;
        for muscle in &mut tube.muscles {
            muscle.zone = muscle.zone.map(|z| scale * z);
        }
        // Its force per displacement and area is a stress over a length.
        let foundation = &mut tube.foundations[0];
        foundation.stiffness /= scale;
        foundation.region.edge *= scale;
        foundation.region.zone = foundation.region.zone.map(|z| scale * z);
        let outline = Outline {
            diameter: vec![[0.0, scale]],
            thickness: vec![[0.0, scale * tube.thickness]],
        };
        let large = with(tube, outline, elements, rings);
        let rest = large.geometric_imperfection().unwrap();
        assert!(large.forces(&large.tube.rest(), rest).unwrap().energy < 1e-25);
        let volume = large.lumen_volume_at_rest() / small.lumen_volume_at_rest();
        assert!((volume / scale.powi(3) - 1.0).abs() < 1e-3, "{volume}");
        let moved: Vec<f64> = rest
            .iter()
            .zip(&u)
            .map(|(rest, u)| rest + scale * u)
            .collect();
        let found = large.forces(&load, &moved).unwrap();
        for (found, expected) in [
            (found.energy, expected.energy),
            (found.potential, expected.potential),
            (found.foundation, expected.foundation),
        ] {
            let energy = found / expected / scale.powi(3);
            assert!((energy - 1.0).abs() < 1e-11, "{rings} rings: {energy}");
        }
        let residual = found.residual.iter().map(|r| r / scale.powi(2));
        assert_close("residual", residual, &expected.residual);
    }
}

#[test]
fn a_cone_has_straight_faces_and_muscles_along_them_and_no_stress() {
    let elements = [18, 2, 60];
    let of = tube_and_load(3, elements, 1);
    let outline = Outline {
        diameter: vec![[0.0, 1.2], [1.5, 0.6]],
        thickness: vec![[0.0, 0.1]],
    };
    let cone = with(of.tube.tube, outline, elements, 1);
    let rest = cone.tube.rest();
    let u = cone.initial_guess();
    assert_eq!(u, cone.geometric_imperfection().unwrap());
    assert!(cone.forces(&rest, &u).unwrap().energy < 1e-25);
    let slope = -0.2_f64;
    let size = slope.hypot(1.0);
    for z in [0.5, 0.7, 0.9] {
        for (radius, depth) in [
            (0.5, 0.0),
            (0.46, 0.1 * 0.04 / 0.15),
            (cone.tube.inner_radius(), 0.1),
        ] {
            let at = Point {
                z,
                radius,
                angle: 0.0,
            };
            let sample = cone.sample(&rest, &u, at);
            let [along, x, _] = sample.position;
            let expected = [z + depth * slope / size, 0.6 + slope * z - depth / size];
            assert!((along - expected[0]).abs() < 1e-8, "{z} {radius}: {along}");
            assert!((x - expected[1]).abs() < 1e-6, "{z} {radius}: {x}");
            // The first column of Fe is the direction of a longitudinal muscle.
            let direction = [0, 1].map(|i| sample.elastic.0[i][0]);
            assert!((direction[0] - 1.0 / size).abs() < 1e-6, "{direction:?}");
            assert!((direction[1] - slope / size).abs() < 1e-6, "{direction:?}");
        }
    }
}

#[test]
fn a_corner_is_rounded_and_does_not_overshoot() {
    let elements = [30, 1, 60];
    let of = tube_and_load(3, elements, 1);
    let outline = Outline {
        diameter: vec![[0.5, 1.0], [1.0, 0.5]],
        thickness: vec![],
    };
    let mut tube = of.tube.tube;
    tube.ends = [Support::Sliding; 2];
    let tube = with(tube, outline.clone(), elements, 1);
    let (rest, u) = (tube.tube.rest(), tube.initial_guess());
    let mut before = 0.5;
    for i in 0..=150 {
        let (z, radius) = (0.01 * f64::from(i), 0.5);
        let sample = tube.sample(
            &rest,
            &u,
            Point {
                z,
                radius,
                angle: 0.0,
            },
        );
        let [_, x, y] = sample.position;
        let found = x.hypot(y);
        let expected = 0.5 * outline.diameter_at(z);
        let far = [0.5, 1.0].iter().all(|corner| (z - corner).abs() > 0.1);
        let error = (found - expected).abs();
        assert!(
            error < if far { 1e-6 } else { 0.02 },
            "{z}: {found} {expected}"
        );
        assert!(
            found <= before + 1e-9 && found >= 0.25 - 1e-6,
            "{z}: {found}"
        );
        before = found;
    }
}

#[test]
fn dead_loads_and_springs_act_on_the_area_of_a_cone() {
    let (elements, shift, k, p) = ([12, 1, 60], 0.01, 0.7, 0.03);
    for (rings, direction) in [
        (1, SpringDirection::All),
        (1, SpringDirection::Normal),
        (3, SpringDirection::Normal),
    ] {
        let mut tube = tube_and_load(3, elements, 1).tube.tube;
        tube.foundations = vec![Foundation {
            region: Region {
                zone: [-1.0, 3.0],
                edge: 0.1,
                sector: None,
            },
            stiffness: k,
            direction,
        }];
        let outline = Outline {
            diameter: vec![[0.0, 1.2], [1.5, 0.6]],
            thickness: vec![[0.0, 0.1]],
        };
        let cone = with(tube, outline, elements, rings);
        let shape = cone.geometric_imperfection().unwrap();
        let along = unknowns(&cone, |_, _, _| [shift, 0.0, 0.0]);
        let u = moved(shape, &along, 1.0);
        let mut load = cone.tube.rest();
        load.pressures[1].dead = p;
        let [at_rest, forces] = [shape, &u].map(|u| cone.forces(&load, u).unwrap());
        assert!(at_rest.potential.abs() < 1e-15 && at_rest.foundation < 1e-25);
        // The lateral area, and its projection along the axis.
        let slant = 0.3_f64.hypot(1.5);
        let (area, projected) = (PI * 0.9 * slant, PI * (0.36 - 0.09));
        let part = match direction {
            SpringDirection::All => 1.0,
            _ => (0.3 / slant).powi(2),
        };
        let springs = 0.5 * k * shift * shift * area * part;
        let close = |found: f64, expected: f64| {
            assert!(
                (found / expected - 1.0).abs() < 1e-5,
                "{rings} {direction:?}: {found} {expected}"
            );
        };
        close(forces.foundation, springs);
        close(forces.potential - forces.foundation, p * shift * projected);
        let work = dot(&forces.residual, &along) * cone.sector.repeats();
        close(work, p * shift * projected + 2.0 * springs);
    }
}
