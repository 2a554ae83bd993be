//! Reduced integration of the volumetric part of the law.

use super::symmetry::harmonic;
use super::{
    direction, largest, linearised, mesh, moved, repeated, replicated, tube_and_load, unknowns,
    wavy,
};
use crate::assembly::{Point, SplineTube};
use crate::tube::{Integration, Mesh};

/// Returns the tube of the other tests with reduced and with full integration.
fn reduced(degree: usize, elements: [usize; 3], rings: usize) -> [SplineTube; 2] {
    let full = tube_and_load(degree, elements, rings).tube;
    let mesh = Mesh {
        volumetric: Integration::Reduced,
        ..mesh(degree, elements)
    };
    [SplineTube::new(&full.tube, &mesh, rings), full]
}

#[test]
fn reduced_residual_and_tangent_are_derivatives() {
    let load = tube_and_load(3, [9, 2, 6], 1).load;
    for (degree, rings) in [(3, 1), (3, 6), (5, 6)] {
        let [tube, _] = reduced(degree, [9, 2, 6], rings);
        let (u, d) = (wavy(&tube), direction(&tube));
        let at = |h: f64| tube.forces(&load, &moved(&u, &d, h)).unwrap();
        let h = 1e-5;
        let (after, before) = (at(h), at(-h));
        // The energy is that of the whole tube, the residual that of the sector.
        let slope = (after.energy - before.energy) / (2.0 * h) / tube.sector.repeats();
        let forces = at(0.0);
        let exact: f64 = forces.residual.iter().zip(&d).map(|(r, d)| r * d).sum();
        assert!(
            (slope / exact - 1.0).abs() < 1e-6,
            "{degree}, {rings}: {slope} {exact}"
        );
        let mut K = vec![0.0; u.len()];
        tube.tangent(&load, &u).multiply_add(1.0, &d, &mut K);
        let change = moved(&after.residual, &before.residual, -1.0);
        let off: Vec<f64> = change
            .iter()
            .zip(&K)
            .map(|(c, k)| c / (2.0 * h) - k)
            .collect();
        assert!(largest(&off) < 1e-6 * largest(&K), "{degree}, {rings}");
        if rings > 1 {
            // The product uses single-precision tangent data.
            let mut y = vec![0.0; u.len()];
            tube.add_tangent_product(&linearised(&tube, &load, &u), 1.0, &d, &mut y);
            assert!(
                largest(&moved(&y, &K, -1.0)) < 1e-5 * largest(&K),
                "{degree}, {rings}"
            );
        }
    }
}

#[test]
fn reduced_sectors_and_harmonics_agree_with_the_whole_tube() {
    let load = tube_and_load(3, [9, 2, 12], 1).load;
    let [one, _] = reduced(3, [9, 2, 12], 1);
    let u = unknowns(&one, |z, r, _| {
        [0.05 * (2.0 * z).sin(), 0.05 * r * (3.0 * z).cos(), 0.0]
    });
    let [whole, _] = reduced(3, [9, 2, 12], 12);
    let many = replicated(&u, 12);
    let (few, all) = (
        one.forces(&load, &u).unwrap(),
        whole.forces(&load, &many).unwrap(),
    );
    assert!((all.energy / few.energy - 1.0).abs() < 1e-13);
    let average = linearised(&whole, &load, &many).average;
    let tangent = whole.tangent(&load, &many);
    for n in [2, 3] {
        let block = one.tangent_in_harmonic(&load, &u, n);
        let (mut exact, mut found) = (vec![0.0; u.len()], vec![0.0; u.len()]);
        let v = direction(&one);
        block.multiply_add(1.0, &v, &mut exact);
        average.harmonic(n).multiply_add(1.0, &v, &mut found);
        let off: f64 = largest(&moved(&found, &exact, -1.0));
        assert!(off < 1e-12 * largest(&exact), "{n}: {off}");
        let mut y = vec![0.0; many.len()];
        tangent.multiply_add(1.0, &harmonic(&whole, &v, n), &mut y);
        let off = moved(&y, &harmonic(&whole, &exact, n), -1.0);
        assert!(largest(&off) < 1e-12 * largest(&exact), "{n}");
    }
    // A sector of two rings.
    let [pair, _] = reduced(3, [9, 2, 12], 2);
    let few = pair.forces(&load, &replicated(&u, 2)).unwrap();
    let off = moved(&all.residual, &repeated(&few.residual, 2, 12), -1.0);
    assert!(largest(&off) < 1e-12 * largest(&all.residual));
}

#[test]
fn reduced_and_full_integration_agree_for_uniform_stress() {
    // Patch test. A flat wall would pass it to rounding; in a round wall the volume grows with R,
    // so the integrand exceeds the degree of the rule by one at the faces of the wall.
    for (degree, tolerance) in [(3, 3e-4), (5, 5e-5)] {
        let [tube, full] = reduced(degree, [7, 3, 24], 1);
        let load = tube.tube.rest();
        let radius = tube.circle.control_radius;
        let u = tube.control_values_from(|z, r, _| [0.2 * z, 0.03 * r * radius, 0.0]);
        let (reduced, whole) = (
            tube.forces(&load, &u).unwrap(),
            full.forces(&load, &u).unwrap(),
        );
        assert!(
            (reduced.energy / whole.energy - 1.0).abs() < 1e-4,
            "{degree}"
        );
        let off = largest(&moved(&reduced.residual, &whole.residual, -1.0));
        let all = largest(&whole.residual);
        assert!(off < tolerance * all, "{degree}");
        // In another state the two integrations differ.
        let u = wavy(&tube);
        let (reduced, whole) = (
            tube.forces(&load, &u).unwrap(),
            full.forces(&load, &u).unwrap(),
        );
        let off = largest(&moved(&reduced.residual, &whole.residual, -1.0));
        assert!(off > 1e-4 * largest(&whole.residual), "{degree}");
    }
}

#[test]
fn sampled_energy_equals_integrated_energy() {
    let load = tube_and_load(3, [9, 1, 24], 1).load;
    for tube in reduced(3, [9, 1, 24], 1) {
        // The volumetric stress is small only at the quadrature points.
        let u = unknowns(&tube, |z, r, _| {
            [0.05 * (2.0 * z).sin(), 0.05 * r * (3.0 * z).cos(), 0.0]
        });
        let energy = tube.forces(&load, &u).unwrap().energy_ungrown;
        let (length, inner, outer) = (tube.tube.length, tube.tube.inner_radius(), 0.5);
        let count = 200;
        let mut sum = 0.0;
        for i in 0..count {
            for j in 0..count {
                let part = |i: i32| (f64::from(i) + 0.5) / f64::from(count);
                let (z, radius) = (length * part(i), inner + (outer - inner) * part(j));
                let at = Point {
                    z,
                    radius,
                    angle: 0.0,
                };
                sum += radius * tube.sample(&load, &u, at).energy_density;
            }
        }
        let area = length * (outer - inner) / f64::from(count * count);
        let sum = std::f64::consts::TAU * area * sum;
        assert!((sum / energy - 1.0).abs() < 0.001, "{sum} {energy}");
    }
}
