//! Sums over batches and threads, and errors at invalid states.

use super::{TubeAndLoad, direction, largest, moved, replicated, tube_and_load, unknowns, wavy};
use crate::assembly::{Inverted, SplineTube};

#[test]
fn large_tangent_is_summed_in_parts() {
    // Batch tangents of 90 MB, so that the third is not computed together with the first two.
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
            bits.extend(
                [forces.energy, forces.energy_ungrown, forces.residual_scale].map(f64::to_bits),
            );
            bits
        })
    };
    let alone = with(1);
    for threads in [2, 8] {
        assert!(with(threads) == alone, "{threads} threads");
    }
}

#[test]
fn inverted_element_is_an_error_with_its_place() {
    // One row of control points passes the next: every element between them inverts.
    let TubeAndLoad { tube, .. } = tube_and_load(1, [20, 2, 6], 6);
    let rest = tube.tube.rest();
    let middle = tube.axial.greville()[13];
    let u = unknowns(&tube, |z, _, _| {
        [if z == middle { 0.1 } else { 0.0 }, 0.0, 0.0]
    });
    let Inverted {
        element,
        place,
        jacobian,
    } = tube.forces(&rest, &u).unwrap_err();
    // Elements are 0.075 long: row 13 passes row 14, and the element between them is mirrored.
    assert_eq!(element[0], 13);
    assert!((place.z - middle - 0.5 * 0.075).abs() < 1e-14, "{place:?}");
    assert!((0.0..1.0).contains(&place.depth) && element[1] < 2 && element[2] < 6);
    let around = place.angle.unwrap() / tube.sector.angle();
    assert!((around - element[2] as f64).abs() < 1e-12, "{place:?}");
    assert!((jacobian - (1.0 - 0.1 / 0.075)).abs() < 1e-12, "{jacobian}");
}

#[test]
fn an_inverted_element_has_its_own_layer_for_any_number_of_rings() {
    // Linear elements are 0.075 long and 0.05 thick.
    for (rings, layers, bad) in [(1, 3, 2), (1, 3, 0), (6, 3, 1), (12, 3, 2), (12, 3, 0)] {
        let TubeAndLoad { tube, .. } = tube_and_load(1, [20, layers, 12], rings);
        let (middle, radii) = (tube.axial.greville()[13], tube.wall.greville());
        let ring = 4 % rings;
        // The inner face of the bad layer passes its outer face at one row, and at one ring.
        let u = tube.control_values_from(|z, r, at| {
            let moves = z == middle && r == radii[bad] && at == ring;
            [0.0, if moves { 0.09 } else { 0.0 }, 0.0]
        });
        let error = tube.forces(&tube.tube.rest(), &u).unwrap_err();
        let [along, layer, around] = error.element;
        assert!(along == 12 || along == 13, "{error:?}");
        assert_eq!(layer, bad, "{rings} rings: {error:?}");
        let (from, to) = tube.wall.element(bad);
        let depth = |radius: f64| (0.5 - radius) / 0.15;
        assert!(
            (depth(to)..=depth(from)).contains(&error.place.depth),
            "{error:?}"
        );
        let beside = [around, (around + 1) % rings];
        assert!(beside.contains(&ring), "{rings} rings: {error:?}");
        assert_eq!(error.place.angle.is_some(), rings > 1);
    }
}

#[test]
fn nan_displacement_is_an_error_with_its_element() {
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

/// Returns the rows of control points of an element along the tube.
fn element_rows(tube: &SplineTube, element: usize) -> std::ops::RangeInclusive<usize> {
    element..=element + tube.degree()
}
