//! What must hold of a discretised tube: that it is its plain twin, and what must hold of any tube
//! whatever computes it.

use super::plain::PlainTube;
use super::{Inverted, Point, SplineTube};
use crate::activation::{Direction, Muscle, Profile};
use crate::material::{Law, Material, NeoHookean};
use crate::tensor::Tensor2;
use crate::tube::{
    Axial, End, EndMotion, Imperfection, Load, Mesh, Part, Push, Shape, Support, Tube, Wave,
};
use std::f64::consts::{PI, TAU};

/// Degrees and elements along, through and around: counts along the tube below, at and above
/// eight, so that slabs are partly filled, full and summed.
const MESHES: [(usize, [usize; 3]); 7] = [
    (1, [10, 2, 8]),
    (2, [8, 2, 7]),
    (2, [17, 1, 6]),
    (3, [3, 2, 6]),
    (3, [9, 2, 6]),
    (4, [9, 1, 6]),
    (5, [3, 2, 6]),
];

/// A short, thick tube and a load under which both its muscles are active.
pub(in crate::assembly) struct TubeAndLoad {
    pub(in crate::assembly) tube: SplineTube,
    pub(in crate::assembly) load: Load,
}

/// A tube of so many elements, `rings` of which are solved for.
pub(in crate::assembly) fn tube_and_load(
    degree: usize,
    elements: [usize; 3],
    rings: usize,
) -> TubeAndLoad {
    let muscle = |direction, zone| Muscle {
        name: String::new(),
        direction,
        zone,
        profile: Profile::RaisedCosine,
    };
    let tube = Tube {
        length: 1.5,
        thickness: 0.15,
        material: Material::NeoHookean(NeoHookean::new(1.0, 0.45)),
        muscles: vec![
            muscle(Direction::Circular, [0.2, 1.3]),
            muscle(Direction::Longitudinal, [0.3, 1.2]),
        ],
        ends: [Support::Fixed; 2],
        imperfections: vec![],
    };
    let load = Load {
        muscles: vec![0.7, 1.15],
        ..tube.rest()
    };
    let mesh = Mesh {
        axial: elements[0] + degree,
        around: elements[2],
        thickness: elements[1] + degree,
        degree,
        refinements: vec![],
    };
    TubeAndLoad {
        tube: SplineTube::new(&tube, &mesh, rings),
        load,
    }
}

/// Unknowns from a function of z, reference radius and ring (0 to 1 over the sector) that gives
/// the axial, radial and circumferential component.
pub(in crate::assembly) fn unknowns(
    tube: &SplineTube,
    field: impl Fn(f64, f64, f64) -> [f64; 3],
) -> Vec<f64> {
    let rings = tube.sector.rings;
    let mut u = vec![];
    for z in tube.axial.greville() {
        for r in tube.wall.greville() {
            let at = |j: usize| field(z, r, j as f64 / rings as f64);
            for i in 0..3 {
                u.extend((0..rings).map(|j| at(j)[i]));
            }
        }
    }
    u
}

/// A displacement without any symmetry but the sector's: waves as large as the wall is thick,
/// and a small noise from a fixed recurrence.
pub(in crate::assembly) fn wavy(tube: &SplineTube) -> Vec<f64> {
    let mut u = unknowns(tube, |z, r, s| {
        let turn = TAU * s;
        [
            0.05 * (2.0 * z + 1.0).sin() + 0.1 * r * r * (turn + z).cos(),
            r * (0.08 * (3.0 * z + turn).cos() - 0.1 + 0.2 * (r - 0.4)),
            r * (0.1 * z + 0.05 * (2.0 * z - turn).sin() + 0.3 * (r - 0.4)),
        ]
    });
    let mut state = 1_u64;
    for x in &mut u {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        *x += 1e-3 * ((state >> 33) as f64 / (1_u64 << 31) as f64 - 0.5);
    }
    u
}

/// Another, to differentiate along.
pub(in crate::assembly) fn direction(tube: &SplineTube) -> Vec<f64> {
    unknowns(tube, |z, r, s| {
        let turn = TAU * s;
        [
            0.3 * (z - 0.3 + turn).sin(),
            r * (2.0 * z + 0.4).cos() + 0.2 * turn.cos(),
            r * (0.5 + z) * (turn + 1.0).sin() + 0.3 * z * r,
        ]
    })
}

pub(in crate::assembly) fn moved(u: &[f64], direction: &[f64], h: f64) -> Vec<f64> {
    u.iter().zip(direction).map(|(u, d)| u + h * d).collect()
}

pub(in crate::assembly) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

pub(in crate::assembly) fn largest(a: &[f64]) -> f64 {
    a.iter().fold(0.0, |m: f64, x| m.max(x.abs()))
}

/// Entry by entry, within some roundings of the largest entry: both sides are sums of up to a
/// few thousand products, in different orders.
fn assert_close(what: &str, a: impl IntoIterator<Item = f64>, b: &[f64]) {
    let largest = b.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let mut count = 0;
    for (i, a) in a.into_iter().enumerate() {
        let error = (a - b[i]).abs();
        assert!(
            error <= 1e-12 * largest,
            "{what}, entry {i}: {a} is not {}",
            b[i]
        );
        count += 1;
    }
    assert_eq!(count, b.len(), "{what}");
}

#[test]
fn the_kernel_has_the_energy_and_the_residual_of_its_plain_twin() {
    for (degree, elements) in MESHES {
        let TubeAndLoad { tube, load } = tube_and_load(degree, elements, elements[2]);
        let u = wavy(&tube);
        let (fast, plain) = (
            tube.forces(&load, &u).unwrap(),
            PlainTube::new(&tube, &load).forces(&u),
        );
        let name = format!("degree {degree}, {elements:?}");
        let numbers = [fast.energy, fast.energy_ungrown, fast.in_play];
        for (a, b) in numbers
            .into_iter()
            .zip([plain.energy, plain.energy_ungrown, plain.in_play])
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
            PlainTube::new(&tube, &load).tangent(&u),
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
        let (fast, plain) = (tube.drag(), PlainTube::new(&tube, &load).drag());
        let n = tube.unknowns();
        let entries = (0..n * n).map(|e| fast.entry(e / n, e % n));
        assert_close(&format!("degree {degree}, {elements:?}"), entries, &plain);
    }
}

#[test]
fn samples_are_those_of_the_plain_twin() {
    for (degree, elements) in MESHES {
        let TubeAndLoad { tube, load } = tube_and_load(degree, elements, elements[2]);
        let plain = PlainTube::new(&tube, &load);
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

#[test]
fn a_tube_at_rest_has_its_radii_its_volume_and_no_residual() {
    let tube = Tube {
        length: 3.0,
        thickness: 0.06,
        material: Material::NeoHookean(NeoHookean::new(1.0, 0.495)),
        muscles: vec![],
        ends: [Support::Fixed; 2],
        imperfections: vec![],
    };
    let mesh = Mesh {
        axial: 13,
        around: 60,
        thickness: 5,
        degree: 3,
        refinements: vec![],
    };
    let (rest, spline) = (tube.rest(), SplineTube::new(&tube, &mesh, 1));
    let u = vec![0.0; spline.unknowns()];
    for radius in [0.44, 0.47, 0.5] {
        for step in 0..500 {
            let angle = f64::from(step) * 0.031 - 4.0;
            for z in [0.0, 1.234, 3.0] {
                let sample = spline.sample(&rest, &u, Point { z, radius, angle });
                let [along, x, y] = sample.position;
                // The spline circle is round to 3.1e-7.
                assert!((along - z).abs() < 1e-14);
                assert!((x.hypot(y) / radius - 1.0).abs() < 3.2e-7);
                // Its points lie at their angles as nearly as that.
                let off = (y.atan2(x) - angle).rem_euclid(TAU);
                assert!(off.min(TAU - off) < 1e-6);
                assert!(sample.energy_density.abs() < 1e-15);
            }
        }
    }

    // e_z · C e_z integrates one.
    let shift = unknowns(&spline, |_, _, _| [1.0, 0.0, 0.0]);
    let mut weighed = vec![0.0; shift.len()];
    spline.drag().multiply_add(1.0, &shift, &mut weighed);
    let volume = dot(&shift, &weighed) * spline.sector.repeats();
    let exact = PI * (0.25 - 0.44 * 0.44) * 3.0;
    // The projected circle is right on average: its area is off by the square of its error.
    assert!((volume / exact - 1.0).abs() < 1e-12, "{volume}");

    let forces = spline.forces(&rest, &u).unwrap();
    assert!(forces.energy.abs() < 1e-15, "{}", forces.energy);
    assert!(largest(&forces.residual) < 1e-15);
    assert!((forces.smallest_jacobian - 1.0).abs() < 1e-14);
}

/// The unknowns of `x → Q x + t` after a displacement u, for a whole tube.
fn carried(tube: &SplineTube, load: &Load, u: &[f64], Q: [[f64; 3]; 3], t: [f64; 3]) -> Vec<f64> {
    let plain = PlainTube::new(tube, load);
    let mut vectors = plain.cartesian(u);
    for (node, u) in vectors.iter_mut().enumerate() {
        let X = plain.control_point(node);
        let x = [0, 1, 2].map(|i| X[i] + u[i]);
        *u = [0, 1, 2].map(|i| (0..3).map(|j| Q[i][j] * x[j]).sum::<f64>() + t[i] - X[i]);
    }
    plain.cylindrical(&vectors)
}

/// A finite turn about an axis in the cross-section, then one about z.
fn tilted() -> [[f64; 3]; 3] {
    let ((s, c), (v, w)) = (0.8_f64.sin_cos(), 0.6_f64.sin_cos());
    [[c, -s, 0.0], [w * s, w * c, -v], [v * s, v * c, w]]
}

#[test]
fn rigid_motions_of_a_sector_of_one_ring_store_no_energy() {
    for degree in 1..=5 {
        let TubeAndLoad { tube, .. } = tube_and_load(degree, [5, 2, 12], 1);
        let rest = tube.tube.rest();
        let control = tube.circle.control_radius;
        let (sin, cos) = 1.1_f64.sin_cos();
        let u = unknowns(&tube, |_, r, _| {
            let r = r * control;
            [0.7, r * (cos - 1.0), r * sin]
        });
        let forces = tube.forces(&rest, &u).unwrap();
        assert!(forces.energy.abs() < 1e-14, "degree {degree}");
        assert!(largest(&forces.residual) < 1e-13, "degree {degree}");
    }
}

#[test]
fn rigid_motions_of_a_whole_tube_store_no_energy() {
    for degree in 1..=5 {
        let TubeAndLoad { tube, .. } = tube_and_load(degree, [5, 2, 7], 7);
        let rest = tube.tube.rest();
        let zero = vec![0.0; tube.unknowns()];
        let u = carried(&tube, &rest, &zero, tilted(), [0.4, -0.7, 0.9]);
        let forces = tube.forces(&rest, &u).unwrap();
        assert!(forces.energy.abs() < 1e-14, "degree {degree}");
        assert!(largest(&forces.residual) < 1e-13, "degree {degree}");
    }
}

#[test]
fn rigid_motions_leave_the_energy_of_an_active_tube_as_it_is() {
    for degree in 1..=5 {
        let TubeAndLoad { tube, load } = tube_and_load(degree, [5, 2, 7], 7);
        let u = wavy(&tube);
        let before = tube.forces(&load, &u).unwrap();
        let turned = carried(&tube, &load, &u, tilted(), [0.4, -0.7, 0.9]);
        let after = tube.forces(&load, &turned).unwrap();
        assert!(
            (after.energy / before.energy - 1.0).abs() < 1e-12,
            "degree {degree}"
        );
        // The residual turns with the tube: its size is unchanged.
        let size = |r: &[f64]| dot(r, r).sqrt();
        let ratio = size(&after.residual) / size(&before.residual);
        assert!((ratio - 1.0).abs() < 1e-11, "degree {degree}: {ratio}");
    }
}

/// Sectors of one ring, of fewer rings than an element has functions, and the whole.
const SECTORS: [usize; 4] = [1, 2, 3, 6];

#[test]
fn the_residual_is_the_slope_of_the_energy() {
    for rings in SECTORS {
        let TubeAndLoad { tube, load } = tube_and_load(3, [9, 2, 6], rings);
        let (u, d) = (wavy(&tube), direction(&tube));
        let energy = |h: f64| tube.forces(&load, &moved(&u, &d, h)).unwrap().energy;
        let exact = dot(&tube.forces(&load, &u).unwrap().residual, &d) * tube.sector.repeats();
        let error = |h: f64| ((energy(h) - energy(-h)) / (2.0 * h) - exact).abs();
        for h in [4e-3, 2e-3, 1e-3] {
            let order = (error(h) / error(h / 2.0)).log2();
            assert!((order - 2.0).abs() < 0.05, "{rings} rings: order {order}");
        }
    }
}

#[test]
fn the_tangent_is_the_slope_of_the_residual() {
    for rings in SECTORS {
        let TubeAndLoad { tube, load } = tube_and_load(3, [9, 2, 6], rings);
        let (u, d) = (wavy(&tube), direction(&tube));
        let residual = |h: f64| tube.forces(&load, &moved(&u, &d, h)).unwrap().residual;
        let mut exact = vec![0.0; u.len()];
        tube.tangent(&load, &u).multiply_add(1.0, &d, &mut exact);
        let error = |h: f64| {
            let slope = moved(&residual(h), &residual(-h), -1.0);
            let off = moved(&exact, &slope, -0.5 / h);
            dot(&off, &off).sqrt()
        };
        for h in [4e-3, 2e-3, 1e-3] {
            let order = (error(h) / error(h / 2.0)).log2();
            assert!((order - 2.0).abs() < 0.05, "{rings} rings: order {order}");
        }
    }
}

/// The unknowns of a sector of one ring, on every ring of a larger one.
fn replicated(u: &[f64], rings: usize) -> Vec<f64> {
    repeated(u, 1, rings)
}

/// The unknowns of a sector of `few` rings, again and again on `many`.
pub(in crate::assembly) fn repeated(u: &[f64], few: usize, many: usize) -> Vec<f64> {
    let sectors = u.chunks(few);
    sectors
        .flat_map(|sector| sector.iter().copied().cycle().take(many))
        .collect()
}

#[test]
fn larger_sectors_agree_with_a_sector_of_one_ring() {
    for degree in 1..=5 {
        let one = tube_and_load(degree, [9, 2, 6], 1);
        let (load, u) = (&one.load, wavy(&one.tube)); // with twist
        let forces = one.tube.forces(load, &u).unwrap();
        let (tangent, drag) = (one.tube.tangent(load, &u), one.tube.drag());
        for rings in [2, 3, 6] {
            let name = format!("degree {degree}, {rings} rings");
            let TubeAndLoad { tube, .. } = tube_and_load(degree, [9, 2, 6], rings);
            let many = replicated(&u, rings);
            let f = tube.forces(load, &many).unwrap();
            assert!((f.energy / forces.energy - 1.0).abs() < 1e-13, "{name}");
            let off = moved(&f.residual, &replicated(&forces.residual, rings), -1.0);
            assert!(
                largest(&off) < 1e-13 * largest(&forces.residual).max(forces.in_play),
                "{name}"
            );

            let n = one.tube.unknowns();
            let entries = (0..n * n).map(|e| tangent.entry(e / n, e % n).abs());
            let size = entries.fold(0.0, f64::max);
            let (many_tangent, many_drag) = (tube.tangent(load, &many), tube.drag());
            for (i, j) in (0..n * n).map(|e| (e / n, e % n)) {
                for ring in 0..rings {
                    let row = i * rings + ring;
                    let columns = j * rings..(j + 1) * rings;
                    let k: f64 = columns.clone().map(|c| many_tangent.entry(row, c)).sum();
                    assert!((k - tangent.entry(i, j)).abs() < 1e-12 * size, "{name}");
                    let c: f64 = columns.map(|c| many_drag.entry(row, c)).sum();
                    assert!((c - drag.entry(i, j)).abs() < 1e-15, "{name}");
                }
            }
        }
    }
}

#[test]
fn the_whole_tube_agrees_with_a_sector_that_is_not_axisymmetric() {
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

/// The displacement (z cos nφ, r cos nφ, −θ sin nφ) of a whole tube, from (z, r, θ) of one ring.
fn harmonic(whole: &SplineTube, u: &[f64], n: usize) -> Vec<f64> {
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
fn harmonic_blocks_are_those_of_the_whole_tube() {
    let around = 12;
    let one = tube_and_load(3, [5, 2, around], 1).tube;
    let whole = tube_and_load(3, [5, 2, around], around).tube;
    // Strong enough that the wall buckles.
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
        // Quadratic forms are 2/N_C of the whole tube's and so is |cos nφ|²: the blocks are equal.
        let mut block = vec![0.0; v.len()];
        one.harmonic_tangent(&load, &u, n)
            .multiply_add(1.0, &v, &mut block);
        let mut product = vec![0.0; whole.unknowns()];
        K.multiply_add(1.0, &harmonic(&whole, &v, n), &mut product);
        let expected = harmonic(&whole, &block, n);
        assert_close(&format!("harmonic {n}"), product, &expected);
    }

    let negative = |n: usize| {
        let mut block = match n {
            0 => one.tangent(&load, &u),
            _ => one.harmonic_tangent(&load, &u, n),
        };
        block.constrain(&one.given_in_harmonic(n));
        block.factor().unwrap().negative_pivots()
    };
    let counts: Vec<usize> = (0..=around / 2).map(negative).collect();
    assert!(counts[1..around / 2].iter().any(|&n| n > 0), "{counts:?}");
    // Every harmonic but the first and the last comes as a cosine and as a sine.
    let expected = 2 * counts.iter().sum::<usize>() - counts[0] - counts[around / 2];
    K.constrain(whole.given());
    let found = K.factor().unwrap().negative_pivots();
    assert_eq!(found, expected, "{counts:?}");
}

#[test]
fn a_tangent_too_large_to_be_held_at_once_is_summed_in_parts() {
    // Slabs of 90 MB, so that the third is not worked on together with the first two.
    let one = tube_and_load(1, [17, 1, 132], 1);
    let whole = tube_and_load(1, [17, 1, 132], 132).tube;
    let (u, d) = (wavy(&one.tube), direction(&one.tube));
    let product = |tube: &SplineTube, u: &[f64], d: &[f64]| {
        let mut sum = vec![0.0; u.len()];
        tube.tangent(&one.load, u).multiply_add(1.0, d, &mut sum);
        sum
    };
    let expected = replicated(&product(&one.tube, &u, &d), 132);
    let many = product(&whole, &replicated(&u, 132), &replicated(&d, 132));
    let off = largest(&moved(&many, &expected, -1.0));
    assert!(off < 1e-11 * largest(&expected), "{off:e}");
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let TubeAndLoad { tube, load } = tube_and_load(3, [29, 2, 6], 6);
    let u = wavy(&tube);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(|| {
            let forces = tube.forces(&load, &u).unwrap();
            let tangent = tube.tangent(&load, &u);
            let n = tube.unknowns();
            let mut bits: Vec<u64> = (0..n * n)
                .map(|e| tangent.entry(e / n, e % n).to_bits())
                .collect();
            bits.extend(forces.residual.iter().map(|r| r.to_bits()));
            bits.extend([forces.energy, forces.energy_ungrown, forces.in_play].map(f64::to_bits));
            bits
        })
    };
    let alone = with(1);
    for threads in [2, 8] {
        assert!(with(threads) == alone, "{threads} threads");
    }
}

#[test]
fn an_element_turned_inside_out_is_an_error_that_says_where() {
    // One row of control points is pushed past its neighbours: every element there inverts.
    let TubeAndLoad { tube, .. } = tube_and_load(1, [20, 2, 6], 6);
    let rest = tube.tube.rest();
    let middle = tube.axial.greville()[13];
    let u = unknowns(&tube, |z, _, _| {
        [if z == middle { 0.1 } else { 0.0 }, 0.0, 0.0]
    });
    let Inverted {
        element,
        z,
        radius,
        jacobian,
    } = tube.forces(&rest, &u).unwrap_err();
    // Elements are 0.075 long: row 13 passes row 14, and the element between them is mirrored.
    assert_eq!(element[0], 13);
    assert!((z - middle).abs() < 1e-14, "z = {z}");
    assert!((0.35..0.5).contains(&radius) && element[1] < 2 && element[2] < 6);
    assert!((jacobian - (1.0 - 0.1 / 0.075)).abs() < 1e-12, "{jacobian}");
}

#[test]
fn a_displacement_that_is_not_a_number_is_an_error() {
    for rings in [1, 6] {
        let TubeAndLoad { tube, load } = tube_and_load(3, [11, 2, 6], rings);
        for unknown in [0, tube.unknowns() / 2, tube.unknowns() - 1] {
            for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                let mut u = wavy(&tube);
                u[unknown] = bad;
                let error = tube.forces(&load, &u).unwrap_err();
                let row = unknown / tube.row_size();
                assert!(
                    (element_rows(&tube, error.element[0])).contains(&row),
                    "{rings} rings, unknown {unknown}: row {row} is not of {error:?}"
                );
            }
        }
    }
}

/// The rows of control points that an element along the tube reads.
fn element_rows(tube: &SplineTube, element: usize) -> std::ops::RangeInclusive<usize> {
    element..=element + tube.degree()
}

#[test]
fn anchors_are_as_many_as_rigid_motions_are_left() {
    use Support::{Fixed, Free, Sliding};
    // Along z and about z; for the whole circumference also two shifts and two tilts.
    for (ends, one_ring, whole) in [
        ([Fixed, Fixed], 0, 0),
        ([Fixed, Sliding], 0, 0),
        ([Fixed, Free], 0, 0),
        ([Sliding, Fixed], 0, 0),
        ([Sliding, Sliding], 1, 3),
        ([Sliding, Free], 1, 3),
        ([Free, Fixed], 0, 0),
        ([Free, Sliding], 1, 3),
        ([Free, Free], 2, 6),
    ] {
        for (rings, anchors) in [(1, one_ring), (3, one_ring), (6, whole)] {
            let TubeAndLoad { tube, .. } = tube_and_load(2, [4, 1, 6], rings);
            let tube = Tube { ends, ..tube.tube };
            let mesh = Mesh {
                axial: 6,
                around: 6,
                thickness: 3,
                degree: 2,
                refinements: vec![],
            };
            let spline = SplineTube::new(&tube, &mesh, rings);
            assert_eq!(spline.anchors(), anchors, "{ends:?}, {rings} rings");

            // With them the tube at rest is held: its stiffness has no eigenvalue near zero.
            let zero = vec![0.0; spline.unknowns()];
            let mut K = spline.tangent(&tube.rest(), &zero);
            K.constrain(spline.given());
            let n = spline.unknowns();
            let dense = faer::Mat::from_fn(n, n, |i, j| K.entry(i, j));
            let eigenvalues = dense.self_adjoint_eigenvalues(faer::Side::Lower).unwrap();
            assert!(eigenvalues[0] > 1e-5, "{ends:?}: {}", eigenvalues[0]);
        }
    }
}

#[test]
fn ends_move_and_twist_as_the_load_says() {
    for rings in [1, 6] {
        let TubeAndLoad { tube, .. } = tube_and_load(3, [5, 2, 6], rings);
        let mut load = tube.tube.rest();
        load.ends = [
            EndMotion {
                displacement: -0.2,
                twist: 0.0,
            },
            EndMotion {
                displacement: 0.1,
                twist: 0.9,
            },
        ];
        let mut u = vec![0.0; tube.unknowns()];
        tube.impose(&load, &mut u);
        for angle in [0.0, 0.3, 2.0] {
            for radius in [0.35, 0.42, 0.5] {
                for (z, motion) in [(0.0, load.ends[0]), (1.5, load.ends[1])] {
                    let sample = tube.sample(&load, &u, Point { z, radius, angle });
                    let ([_, X, Y], [along, x, y]) = (sample.reference, sample.position);
                    let (sin, cos) = motion.twist.sin_cos();
                    assert!((along - z - motion.displacement).abs() < 1e-14);
                    assert!((x - (X * cos - Y * sin)).abs() < 1e-14);
                    assert!((y - (X * sin + Y * cos)).abs() < 1e-14);
                }
            }
        }
    }
}

/// The tube of the other tests, imperfect, with twelve rings around.
fn imperfect(ends: [Support; 2], of: Part, amplitude: f64, wave: Wave) -> SplineTube {
    let TubeAndLoad { tube, .. } = tube_and_load(3, [9, 2, 12], 1);
    let mesh = Mesh {
        axial: 12,
        around: 12,
        thickness: 5,
        degree: 3,
        refinements: vec![],
    };
    let imperfection = Imperfection {
        of,
        amplitude,
        shape: Shape::Wave(wave),
    };
    let tube = Tube {
        ends,
        imperfections: vec![imperfection],
        ..tube.tube
    };
    SplineTube::new(&tube, &mesh, 12)
}

const COLON: Part = Part::End(End::Colon, Push::Across);

/// Displacement (z, x, y) of a point of a tube at rest whose unknowns are `u`.
fn displacement(tube: &SplineTube, u: &[f64], z: f64, radius: f64, angle: f64) -> [f64; 3] {
    let at = tube.sample(&tube.tube.rest(), u, Point { z, radius, angle });
    [0, 1, 2].map(|i| at.position[i] - at.reference[i])
}

#[test]
fn harmonic_1_of_an_end_shifts_the_drawn_face_sideways() {
    let phase = 0.4;
    let wave = Wave::new(1, phase, Axial::Uniform);
    let tube = imperfect([Support::Fixed; 2], COLON, 0.03, wave);
    let mut u = vec![0.0; tube.unknowns()];
    tube.impose(&tube.tube.rest(), &mut u);
    for i in 0..50 {
        let angle = 0.13 * f64::from(i);
        let moved = displacement(&tube, &u, 0.0, 0.45, angle);
        let shift = [0.0, 0.03 * phase.cos(), 0.03 * phase.sin()];
        for (x, expected) in moved.into_iter().zip(shift) {
            assert!((x - expected).abs() < 1e-16, "{moved:?}");
        }
        assert!(displacement(&tube, &u, 1.5, 0.45, angle)[1].abs() < 1e-16);
    }
}

#[test]
fn harmonic_1_of_an_end_along_the_axis_tilts_the_drawn_face() {
    let wave = Wave::new(1, 0.0, Axial::Uniform);
    let of = Part::End(End::Ileum, Push::Axial);
    let tube = imperfect([Support::Fixed, Support::Sliding], of, 0.03, wave);
    let mut u = vec![0.0; tube.unknowns()];
    tube.impose(&tube.tube.rest(), &mut u);
    for i in 0..50 {
        let (angle, radius) = (0.13 * f64::from(i), 0.35 + 0.003 * f64::from(i));
        let at = tube.sample(
            &tube.tube.rest(),
            &u,
            Point {
                z: 1.5,
                radius,
                angle,
            },
        );
        let [z, x, y] = [0, 1, 2].map(|i| at.position[i] - at.reference[i]);
        // A plane: proportional to x, and the amplitude at x = D/2.
        let expected = 0.03 * at.reference[1] / 0.5;
        assert!((z - expected).abs() < 1e-15, "{z} is not {expected}");
        assert!(x.abs().max(y.abs()) < 1e-16);
    }
}

#[test]
fn harmonic_2_of_an_end_is_oval_as_high_as_asked_and_keeps_lengths() {
    let wave = Wave::new(2, 0.0, Axial::Uniform);
    let tube = imperfect([Support::Fixed; 2], COLON, 0.01, wave);
    let mut u = vec![0.0; tube.unknowns()];
    tube.impose(&tube.tube.rest(), &mut u);
    let turned = |angle: f64| {
        let [_, x, y] = displacement(&tube, &u, 0.0, 0.45, angle);
        let (sin, cos) = angle.sin_cos();
        [x * cos + y * sin, y * cos - x * sin]
    };
    for i in 0..50 {
        let angle = 0.13 * f64::from(i);
        let [radial, around] = turned(angle);
        // Twelve splines draw three turns to 2 %.
        assert!(
            (radial - 0.01 * (2.0 * angle).cos()).abs() < 1e-4,
            "{radial}"
        );
        assert!(
            (around + 0.005 * (2.0 * angle).sin()).abs() < 1e-4,
            "{around}"
        );
    }
}

#[test]
fn an_imperfect_end_is_turned_with_its_shift() {
    let wave = Wave::new(1, 0.0, Axial::Uniform);
    let tube = imperfect([Support::Fixed; 2], COLON, 0.03, wave);
    let mut load = tube.tube.rest();
    load.ends[0] = EndMotion {
        displacement: 0.02,
        twist: 0.5,
    };
    let mut u = vec![0.0; tube.unknowns()];
    tube.impose(&load, &mut u);
    for i in 0..20 {
        let angle = 0.3 * f64::from(i);
        let point = Point {
            z: 0.0,
            radius: 0.45,
            angle,
        };
        let at = tube.sample(&load, &u, point);
        let (sin, cos) = 0.5_f64.sin_cos();
        let [_, x, y] = at.reference;
        let expected = [0.02, (x + 0.03) * cos - y * sin, (x + 0.03) * sin + y * cos];
        for (x, expected) in at.position.into_iter().zip(expected) {
            assert!((x - expected).abs() < 1e-15, "{:?}", at.position);
        }
    }
}

#[test]
fn a_geometric_imperfection_is_zero_at_fixed_ends_and_as_high_as_asked_between() {
    for (axial, middle) in [
        (Axial::HalfWaves(1), 1.0),
        (Axial::Uniform, 1.0),
        (Axial::Zone([0.5, 1.0]), 0.7),
    ] {
        for harmonic in 0..=3 {
            let wave = Wave::new(harmonic, 0.0, axial);
            let tube = imperfect([Support::Fixed; 2], Part::Geometry, 0.01, wave);
            let u = tube.geometric_imperfection().unwrap();
            for z in [0.0, 1.5] {
                for x in displacement(&tube, &u, z, 0.45, 0.3) {
                    assert!(x.abs() < 1e-17, "{wave:?} at {z}: {x}");
                }
            }
            // Control values flatten a crest, that over three elements by a quarter.
            let x = displacement(&tube, &u, 0.75, 0.45, 0.0)[1];
            assert!(x > 0.95 * middle * 0.01 && x < 0.0103, "{wave:?}: {x}");
        }
    }
}

#[test]
fn a_perfect_tube_has_no_imperfect_geometry_and_starts_at_rest() {
    let TubeAndLoad { tube, load } = tube_and_load(3, [9, 2, 6], 6);
    assert_eq!(tube.geometric_imperfection(), None);
    assert!(tube.start().iter().all(|x| x.to_bits() == 0));
    for z in [0.1, 0.3, 0.75, 1.2] {
        assert_eq!(
            tube.tube.stretches_at(z, 2.0, &load),
            tube.tube.stretches(z, &load)
        );
    }
}

#[test]
fn a_start_is_smooth_and_holds_the_ends() {
    let wave = Wave::new(2, 0.3, Axial::Uniform);
    let tube = imperfect([Support::Fixed; 2], COLON, 0.01, wave);
    let u = tube.start();
    let mut imposed = u.clone();
    tube.impose(&tube.tube.rest(), &mut imposed);
    assert_eq!(u, imposed);
    assert!(tube.forces(&tube.tube.rest(), &u).is_ok());
}
