//! Sectors of any number of rings, and harmonic tangents, against the whole tube.

use super::{
    TubeAndLoad, assert_close, direction, largest, moved, repeated, replicated, tube_and_load,
    unknowns, wavy,
};
use crate::assembly::SplineTube;
use crate::tube::Load;
use std::f64::consts::PI;

#[test]
fn larger_sectors_agree_with_a_sector_of_one_ring() {
    for degree in 1..=5 {
        let one = tube_and_load(degree, [9, 2, 6], 1);
        let (load, u) = (&one.load, wavy(&one.tube)); // with twist
        let forces = one.tube.forces(load, &u).unwrap();
        let (tangent, damping) = (one.tube.tangent(load, &u), one.tube.damping());
        for rings in [2, 3, 6] {
            let name = format!("degree {degree}, {rings} rings");
            let TubeAndLoad { tube, .. } = tube_and_load(degree, [9, 2, 6], rings);
            let many = replicated(&u, rings);
            let f = tube.forces(load, &many).unwrap();
            assert!((f.energy / forces.energy - 1.0).abs() < 1e-13, "{name}");
            let off = moved(&f.residual, &replicated(&forces.residual, rings), -1.0);
            assert!(
                largest(&off) < 1e-13 * largest(&forces.residual).max(forces.residual_scale),
                "{name}"
            );

            let n = one.tube.unknowns();
            let entries = (0..n * n).map(|e| tangent.entry(e / n, e % n).abs());
            let size = entries.fold(0.0, f64::max);
            let (many_tangent, many_drag) = (tube.tangent(load, &many), tube.damping());
            for (i, j) in (0..n * n).map(|e| (e / n, e % n)) {
                for ring in 0..rings {
                    let row = i * rings + ring;
                    let columns = j * rings..(j + 1) * rings;
                    let k: f64 = columns.clone().map(|c| many_tangent.entry(row, c)).sum();
                    assert!((k - tangent.entry(i, j)).abs() < 1e-12 * size, "{name}");
                    let c: f64 = columns.map(|c| many_drag.entry(row, c)).sum();
                    assert!((c - damping.entry(i, j)).abs() < 1e-15, "{name}");
                }
            }
        }
    }
}

#[test]
fn whole_tube_agrees_with_a_sector_of_few_rings() {
    for degree in 1..=5 {
        for rings in [2, 3] {
            let TubeAndLoad { tube, load } = tube_and_load(degree, [9, 2, 6], rings);
            let whole = tube_and_load(degree, [9, 2, 6], 6).tube;
            let u = wavy(&tube);
            let few = tube.forces(&load, &u).unwrap();
            let many = whole.forces(&load, &repeated(&u, rings, 6)).unwrap();
            let name = format!("degree {degree}, {rings} rings");
            assert!((many.energy / few.energy - 1.0).abs() < 1e-12, "{name}");
            assert_close(&name, many.residual, &repeated(&few.residual, rings, 6));
        }
    }
}

/// Returns the displacement (z cos nφ, r cos nφ, −θ sin nφ) of a whole tube, from (z, r, θ) of one
/// ring.
pub(super) fn harmonic(whole: &SplineTube, u: &[f64], n: usize) -> Vec<f64> {
    let rings = whole.sector.rings;
    let waves: Vec<(f64, f64)> = (0..rings)
        .map(|j| (n as f64 * whole.sector.ring_angle(j)).sin_cos())
        .collect();
    let mut pattern = replicated(u, rings);
    for (i, rings) in pattern.chunks_mut(rings).enumerate() {
        for (x, (sin, cos)) in rings.iter_mut().zip(&waves) {
            *x *= if i % 3 == 2 { -sin } else { *cos };
        }
    }
    pattern
}

#[test]
fn harmonic_tangents_are_blocks_of_the_whole_tangent() {
    let around = 12;
    let one = tube_and_load(3, [5, 2, around], 1).tube;
    let whole = tube_and_load(3, [5, 2, around], around).tube;
    // Strong enough to buckle the wall.
    let load = Load {
        muscles: vec![0.5, 1.5],
        ..one.tube.rest()
    };
    let u = unknowns(&one, |z, r, _| {
        let inside = (PI * z / 1.5).sin();
        [0.02 * (2.0 * z).sin() * inside, -0.1 * r * inside, 0.0]
    });
    let mut K = whole.tangent(&load, &replicated(&u, around));
    let v = direction(&one);
    for n in 1..around / 2 {
        // Both the quadratic form and |cos nφ|² carry the factor 2/N_C, so the blocks are equal.
        let mut block = vec![0.0; v.len()];
        one.tangent_in_harmonic(&load, &u, n)
            .multiply_add(1.0, &v, &mut block);
        let mut product = vec![0.0; whole.unknowns()];
        K.multiply_add(1.0, &harmonic(&whole, &v, n), &mut product);
        let expected = harmonic(&whole, &block, n);
        assert_close(&format!("harmonic {n}"), product, &expected);
    }

    let negative = |n: usize| {
        let mut block = match n {
            0 => one.tangent(&load, &u),
            _ => one.tangent_in_harmonic(&load, &u, n),
        };
        block.constrain(&one.prescribed_in_harmonic(n));
        block.factor().unwrap().negative_pivots()
    };
    let counts: Vec<usize> = (0..=around / 2).map(negative).collect();
    assert!(counts[1..around / 2].iter().any(|&n| n > 0), "{counts:?}");
    // Every harmonic but the first and the last has a cosine and a sine.
    let expected = 2 * counts.iter().sum::<usize>() - counts[0] - counts[around / 2];
    K.constrain(whole.prescribed());
    let found = K.factor().unwrap().negative_pivots();
    assert_eq!(found, expected, "{counts:?}");
}
