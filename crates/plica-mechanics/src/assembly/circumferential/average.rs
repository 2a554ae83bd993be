//! The tangent averaged around the tube, as blocks between rings at a fixed distance.
//!
//! K̄_d is the mean over the rings j of the tangent between ring j and ring j + d. At an
//! axisymmetric state it is the same for all rings, and the K̄_d are the tangent; elsewhere they
//! are the nearest matrix that is invariant under rotation of the tube by a ring.

use super::super::axial::{BatchTangent, add_along, add_through};
use super::super::blocks::{add_rotated, mirror};
use super::super::tables::{AxialBatch, CircumferentialPoint, Layer};
use crate::rings::{Rotation, Sector};
use crate::tensor::{LANES, Lanes, Real, with_vectors};
use fearless_simd::{Simd, SimdBase, f64x8};

/// Entries of the moduli at a point: six blocks of 3×3.
pub const AVERAGED: usize = 54;

/// Computes the contribution of an axial batch to the blocks between rings d = 0 to p apart,
/// symmetrised by reflection in a plane through the axis: M_0 = K̄_0, M_d = K̄_d + S K̄_dᵀ S, where
/// S changes the sign of circumferential components. Each is the lower half by rows of control
/// points of one ring.
///
/// `summed` holds weighted moduli, pulled back to (ζ, s, R) and summed around the tube: for every
/// element along the batch, [`AVERAGED`] entries at (point along, layer, point through, point
/// around).
pub fn offset_blocks<const N: usize>(
    batch: &AxialBatch,
    layers: &[Layer],
    points: usize,
    sector: &Sector,
    around: &[CircumferentialPoint],
    summed: &[f64],
) -> Vec<BatchTangent> {
    with_vectors!(simd => {
        kernel::<_, N>(simd, batch, layers, points, sector, around, summed)
    })
}

#[inline(always)]
fn kernel<S: Simd, const N: usize>(
    simd: S,
    batch: &AxialBatch,
    layers: &[Layer],
    points: usize,
    sector: &Sector,
    around: &[CircumferentialPoint],
    summed: &[f64],
) -> Vec<BatchTangent> {
    let m = points * 3;
    let rows = batch.elements + N - 1;
    let scale = 1.0 / sector.rings as f64;
    let zero = f64x8::splat(simd, 0.0);
    let rotations: Vec<Vec<Rotation>> = around
        .iter()
        .map(|point| {
            sector
                .function_values_at(point.s)
                .iter()
                .map(Rotation::from)
                .collect()
        })
        .collect();
    let mut out = vec![
        BatchTangent {
            entries: vec![0.0; N * m * m * rows],
            rows,
        };
        N
    ];
    let mut wall = vec![[[zero; 4]; N]; N * N * N * 9];
    let mut rotated = vec![[[[[zero; 3]; 3]; 3]; 3]; N];

    for (t, layer) in layers.iter().enumerate() {
        wall.fill([[zero; 4]; N]);
        for qz in 0..N {
            for qr in 0..N {
                rotated.fill([[[[zero; 3]; 3]; 3]; 3]);
                for (qs, rotations) in rotations.iter().enumerate() {
                    let at = (((qz * layers.len() + t) * N + qr) * N + qs) * AVERAGED;
                    let blocks = load(simd, batch, scale, summed, at);
                    for r in 0..N {
                        for s in r..N {
                            add_rotated(
                                &mut rotated[s - r],
                                &blocks,
                                &rotations[r],
                                &rotations[s],
                                s == r,
                            );
                        }
                    }
                }
                let (value, slope) = (&layer.value[qr * N..][..N], &layer.slope[qr * N..][..N]);
                for (d, rotated) in rotated.iter_mut().enumerate() {
                    if d == 0 {
                        mirror(rotated);
                    }
                    reflect(rotated, d == 0);
                    let wall = &mut wall[d * N * N * 9..][..N * N * 9];
                    add_through::<_, N>(wall, qz, rotated, value, slope);
                }
            }
        }
        for (d, out) in out.iter_mut().enumerate() {
            for c in 0..N {
                for e in 0..N {
                    for i in 0..3 {
                        for j in 0..3 {
                            let wall = &wall[((d * N + c) * N + e) * 9 + 3 * i + j];
                            let indices = ((layer.first + c) * 3 + i, (layer.first + e) * 3 + j);
                            add_along::<S, N>(simd, out, batch, m, wall, indices, true);
                        }
                    }
                }
            }
        }
    }
    out
}

/// Loads the moduli of eight elements along the tube, scaled.
#[inline(always)]
fn load<S: Simd>(
    simd: S,
    batch: &AxialBatch,
    scale: f64,
    summed: &[f64],
    at: usize,
) -> [[[f64x8<S>; 3]; 3]; 6] {
    let element = summed.len() / batch.elements;
    let elements: [&[f64]; LANES] =
        std::array::from_fn(|l| &summed[batch.row(l) * element + at..][..AVERAGED]);
    // Unused lanes must be zero, since add_along sums all lanes.
    let scale: [f64; LANES] = std::array::from_fn(|l| if l < batch.elements { scale } else { 0.0 });
    let mut blocks = [[[f64x8::splat(simd, 0.0); 3]; 3]; 6];
    for (b, block) in blocks.iter_mut().enumerate() {
        for j in 0..3 {
            for i in 0..3 {
                let number = 9 * b + 3 * j + i;
                let lanes = Lanes(std::array::from_fn(|l| scale[l] * elements[l][number]));
                block[j][i] = lanes.load(simd);
            }
        }
    }
    blocks
}

/// Replaces T by T + S Tᵀ S for all pairs of gradients. For a block of a ring with itself, which is
/// symmetric already, it only removes the part that the reflection changes.
#[inline(always)]
fn reflect<S: Simd>(rotated: &mut [[[[f64x8<S>; 3]; 3]; 3]; 3], own: bool) {
    let t = *rotated;
    for alpha in 0..3 {
        for beta in 0..3 {
            for i in 0..3 {
                for j in 0..3 {
                    let across = (i == 2) != (j == 2);
                    let (a, b) = (t[alpha][beta][i][j], t[beta][alpha][j][i]);
                    rotated[alpha][beta][i][j] = match (own, across) {
                        (true, false) => a,
                        (true, true) => a.like(0.0),
                        (false, false) => a + b,
                        (false, true) => a - b,
                    };
                }
            }
        }
    }
}
