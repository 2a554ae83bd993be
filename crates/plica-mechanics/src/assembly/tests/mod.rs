//! Tests of assembly, and the tubes and displacements that they share.

mod active_stress;
mod batches;
mod boundary_conditions;
mod imperfection;
mod layers;
mod mechanics;
mod outline;
mod patches;
mod reduced_integration;
mod reference;
mod stress_free;
mod symmetry;

use super::{MatrixFreeTangent, SplineTube};
use crate::activation::{Direction, Muscle, Profile};
use crate::material::{Material, NeoHookean};
use crate::tube::{Load, Mesh, Support, Tube, WallLayer};
use std::f64::consts::TAU;

/// A short, thick tube and a load under which both its muscles are active.
pub(in crate::assembly) struct TubeAndLoad {
    pub(in crate::assembly) tube: SplineTube,
    pub(in crate::assembly) load: Load,
}

/// Returns a tube of `elements` along, through and around, with a sector of `rings` rings.
pub(in crate::assembly) fn tube_and_load(
    degree: usize,
    elements: [usize; 3],
    rings: usize,
) -> TubeAndLoad {
    let muscle =
        |direction, zone| Muscle::new(String::new(), direction, zone, Profile::RaisedCosine);
    let tube = Tube {
        length: 1.5,
        thickness: 0.15,
        layers: vec![WallLayer::of(Material::NeoHookean(NeoHookean::new(
            1.0, 0.45,
        )))],
        muscles: vec![
            muscle(Direction::Circular, [0.2, 1.3]),
            muscle(Direction::Longitudinal, [0.3, 1.2]),
        ],
        ends: [Support::Fixed; 2],
        imperfections: vec![],
        obstacles: vec![],
        patches: vec![],
        foundations: vec![],
    };
    let load = Load {
        muscles: vec![0.7, 1.15],
        ..tube.rest()
    };
    TubeAndLoad {
        tube: SplineTube::new(&tube, &mesh(degree, elements), rings),
        load,
    }
}

/// Returns a mesh of `elements` along, through and around.
pub(in crate::assembly) fn mesh(degree: usize, [along, through, around]: [usize; 3]) -> Mesh {
    Mesh {
        axial: along + degree,
        around,
        thickness: through + degree,
        degree,
        refinements: vec![],
        grading: 1.0,
        contact_range: 0.25,
        volumetric: Default::default(),
        layers: vec![],
    }
}

/// Returns the matrix-free tangent at a state.
pub(in crate::assembly) fn linearised(
    tube: &SplineTube,
    load: &Load,
    u: &[f64],
) -> MatrixFreeTangent {
    let mut tangent = MatrixFreeTangent::default();
    tube.linearise(load, u, &mut tangent);
    tangent
}

/// Returns unknowns from a function of z, reference radius and ring (0 to 1 over the sector) that
/// returns the axial, radial and circumferential component.
pub(in crate::assembly) fn unknowns(
    tube: &SplineTube,
    field: impl Fn(f64, f64, f64) -> [f64; 3],
) -> Vec<f64> {
    let rings = tube.sector.rings as f64;
    tube.control_values_from(|z, r, ring| field(z, r, ring as f64 / rings))
}

/// Returns a displacement without symmetry other than the sector's: waves as large as the wall
/// thickness, and small deterministic noise.
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

/// Returns another displacement, a direction for derivatives.
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

/// Returns the unknowns of a sector of one ring, repeated on `rings` rings.
fn replicated(u: &[f64], rings: usize) -> Vec<f64> {
    repeated(u, 1, rings)
}

/// Returns the unknowns of a sector of `few` rings, repeated on `many` rings.
pub(in crate::assembly) fn repeated(u: &[f64], few: usize, many: usize) -> Vec<f64> {
    let sectors = u.chunks(few);
    sectors
        .flat_map(|sector| sector.iter().copied().cycle().take(many))
        .collect()
}

/// Asserts equality within a few roundings of the largest entry: both sides are sums of up to a few
/// thousand products, in different orders.
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
