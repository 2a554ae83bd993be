//! The tangent averaged around the tube, as blocks between rings a number apart.
//!
//! K̄_d is the mean over the rings j of the tangent between ring j and ring j + d. At an
//! axisymmetric state all rings have the same, and the K̄_d are all there is; elsewhere they are
//! the nearest matrix that does not change when the tube is turned.

use super::super::tables::{Around, Layer, Slab};
use super::super::tangent::{SlabTangent, add_along, add_through, add_turned, mirror};
use crate::rings::{Sector, Turn};
use crate::tensor::{LANES, Lanes, Real};
use fearless_simd::{Level, Simd, SimdBase, dispatch, f64x8};

/// Numbers of the moduli at a point: six blocks of 3×3.
pub const AVERAGED: usize = 54;

/// What a slab adds to the blocks K̄_d between rings d = 0 to p apart, as far as a mirror through
/// the axis leaves them: M_0 = K̄_0, M_d = K̄_d + S K̄_dᵀ S, where S turns the circumferential
/// component around. Lower half by rows of control points, one ring to each.
///
/// `summed` holds moduli pulled back to (ζ, s, R) with their weights, summed around the tube: for
/// every element along the slab, [`AVERAGED`] numbers at (point along, layer, point through, point
/// around).
pub fn slab_offsets<const N: usize>(
    slab: &Slab,
    layers: &[Layer],
    points: usize,
    sector: &Sector,
    around: &[Around],
    summed: &[f64],
) -> Vec<SlabTangent> {
    dispatch!(Level::new(), simd => {
        kernel::<_, N>(simd, slab, layers, points, sector, around, summed)
    })
}

#[inline(always)]
fn kernel<S: Simd, const N: usize>(
    simd: S,
    slab: &Slab,
    layers: &[Layer],
    points: usize,
    sector: &Sector,
    around: &[Around],
    summed: &[f64],
) -> Vec<SlabTangent> {
    let m = points * 3;
    let rows = slab.elements + N - 1;
    let scale = 1.0 / sector.rings as f64;
    let zero = f64x8::splat(simd, 0.0);
    let turns: Vec<Vec<Turn>> = around
        .iter()
        .map(|point| sector.unfolded_at(point.s).iter().map(Turn::from).collect())
        .collect();
    let mut out = vec![
        SlabTangent {
            entries: vec![0.0; N * m * m * rows],
            rows,
        };
        N
    ];
    let mut wall = vec![[[zero; 4]; N]; N * N * N * 9];
    let mut turned = vec![[[[[zero; 3]; 3]; 3]; 3]; N];

    for (t, layer) in layers.iter().enumerate() {
        wall.fill([[zero; 4]; N]);
        for qz in 0..N {
            for qr in 0..N {
                turned.fill([[[[zero; 3]; 3]; 3]; 3]);
                for (qs, turns) in turns.iter().enumerate() {
                    let at = (((qz * layers.len() + t) * N + qr) * N + qs) * AVERAGED;
                    let blocks = load(simd, slab, scale, summed, at);
                    for r in 0..N {
                        for s in r..N {
                            add_turned(&mut turned[s - r], &blocks, &turns[r], &turns[s], s == r);
                        }
                    }
                }
                let (value, slope) = (&layer.value[qr * N..][..N], &layer.slope[qr * N..][..N]);
                for (d, turned) in turned.iter_mut().enumerate() {
                    if d == 0 {
                        mirror(turned);
                    }
                    reflect(turned, d == 0);
                    let wall = &mut wall[d * N * N * 9..][..N * N * 9];
                    add_through::<_, N>(wall, qz, turned, value, slope);
                }
            }
        }
        for (d, out) in out.iter_mut().enumerate() {
            for c in 0..N {
                for e in 0..N {
                    for i in 0..3 {
                        for j in 0..3 {
                            let wall = &wall[((d * N + c) * N + e) * 9 + 3 * i + j];
                            let places = ((layer.first + c) * 3 + i, (layer.first + e) * 3 + j);
                            add_along::<S, N>(simd, out, slab, m, wall, places, true);
                        }
                    }
                }
            }
        }
    }
    out
}

/// The moduli of eight elements along the tube, scaled.
#[inline(always)]
fn load<S: Simd>(
    simd: S,
    slab: &Slab,
    scale: f64,
    summed: &[f64],
    at: usize,
) -> [[[f64x8<S>; 3]; 3]; 6] {
    let element = summed.len() / slab.elements;
    let elements: [&[f64]; LANES] =
        std::array::from_fn(|l| &summed[slab.row(l) * element + at..][..AVERAGED]);
    // Spare lanes have no weight, but add_along would count them.
    let scale: [f64; LANES] = std::array::from_fn(|l| if l < slab.elements { scale } else { 0.0 });
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

/// T + S Tᵀ S of the pairs of gradients; only its part that the mirror keeps for a block of a ring
/// with itself, which is symmetric already.
#[inline(always)]
fn reflect<S: Simd>(turned: &mut [[[[f64x8<S>; 3]; 3]; 3]; 3], own: bool) {
    let t = *turned;
    for alpha in 0..3 {
        for beta in 0..3 {
            for i in 0..3 {
                for j in 0..3 {
                    let across = (i == 2) != (j == 2);
                    let (a, b) = (t[alpha][beta][i][j], t[beta][alpha][j][i]);
                    turned[alpha][beta][i][j] = match (own, across) {
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
