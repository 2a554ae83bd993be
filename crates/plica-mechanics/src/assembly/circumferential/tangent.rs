//! Matrix-free tangent of a circumferential batch: linearisation at a state, and tangent products.

use super::super::kinematics::to_ring_frame;
use super::{AVERAGED, Input, gradients, load, ring_values, store, sum_along, sum_through};
use crate::material::{Law, TangentData};
use crate::tensor::{LANES, Lanes, Real, with_vectors};
use fearless_simd::{Simd, SimdBase, SimdFrom, f32x16, f64x8};

/// Tangent data of a state at the points of a circumferential batch, in the order in which the
/// product reads them: pairs of numbers of [`Law::TangentData`] as vectors of sixteen in single
/// precision. The product stays symmetric for any rounding, and a relative rounding of 6e-8 is far
/// below the tolerance of a Newton step; single precision halves the memory traffic that limits the
/// product.
pub type PackedTangentData = Vec<[f32; 16]>;

/// Returns the number of vectors of sixteen numbers per point.
#[inline(always)]
fn vectors_per_point<L: Law>(law: &L) -> usize {
    L::TangentData::count(law) / 2
}

/// Linearises at a state: writes the tangent data, and to `averaged` the weighted moduli of
/// [`GradientMap::pull_back_moduli`](super::super::kinematics::GradientMap), summed over the
/// elements around, for every (point along, layer, point through, point around).
pub fn linearise<L: Law, const N: usize>(
    law: &L,
    input: &Input<'_>,
    tangent_data: &mut [[f32; 16]],
    averaged: &mut [f64],
) {
    if input.modified.is_none() {
        with_vectors!(wide if L::WIDE_VECTORS_ONLY, simd => kernel_linearise::<_, L, N, true>(simd, law, input, tangent_data, averaged));
    } else {
        with_vectors!(wide if L::WIDE_VECTORS_ONLY, simd => kernel_linearise::<_, L, N, false>(simd, law, input, tangent_data, averaged));
    }
}

#[inline(always)]
fn kernel_linearise<S: Simd, L: Law, const N: usize, const PERFECT: bool>(
    simd: S,
    law: &L,
    input: &Input<'_>,
    tangent_data: &mut [[f32; 16]],
    averaged: &mut [f64],
) {
    let (row, W) = (input.row(), input.rings.wide());
    let nil = f64x8::splat(simd, 0.0);
    let ring_values = ring_values::<N>(input.around);
    let mut tangent_data = tangent_data.chunks_exact_mut(vectors_per_point(law));
    let mut averaged = averaged.chunks_exact_mut(AVERAGED);
    let mut along = vec![0.0; 2 * row];
    let mut through = vec![0.0; 9 * W];
    let mut sums = vec![nil; N * AVERAGED];
    for qz in 0..N {
        sum_along::<S, N>(simd, input, qz, &mut along);
        for (t, layer) in input.layers.iter().enumerate() {
            for qr in 0..N {
                let radius = layer.radius[qr];
                sum_through::<S, N>(simd, input, layer, qr, &along, &mut through);
                sums.fill(nil);
                for v in 0..input.rings.vectors() {
                    for qs in 0..N {
                        let point = &input.around[qs];
                        let (gradient_map, [_, grown]) =
                            input.gradient_map::<_, PERFECT>(simd, qz, [t, qr], [v, qs]);
                        let g = gradients::<S, N>(simd, &ring_values[qs], &through, W, v);
                        let Fe = gradient_map.elastic_gradient(point, radius, g);
                        let mut to = tangent_data.next().unwrap_or_default().iter_mut();
                        L::TangentData::linearise(
                            law,
                            &Fe,
                            #[inline(always)]
                            |[a, b]| {
                                if let Some(to) = to.next() {
                                    *to = simd.narrow_f64x8(a, b).into();
                                }
                            },
                        );
                        let blocks = gradient_map.pull_back_moduli(&law.moduli(&Fe), grown);
                        let sums = &mut sums[qs * AVERAGED..][..AVERAGED];
                        for (sums, block) in sums.chunks_exact_mut(9).zip(&blocks) {
                            for j in 0..3 {
                                for i in 0..3 {
                                    sums[3 * j + i] += block[j][i];
                                }
                            }
                        }
                    }
                }
                for sums in sums.chunks_exact(AVERAGED) {
                    if let Some(to) = averaged.next() {
                        for (to, sum) in to.iter_mut().zip(sums) {
                            *to = Lanes::store(*sum).sum();
                        }
                    }
                }
            }
        }
    }
}

/// Returns the length of the tangent data of a circumferential batch.
pub fn tangent_data_len<L: Law, const N: usize>(law: &L, layers: usize, vectors: usize) -> usize {
    N.pow(3) * layers * vectors * vectors_per_point(law)
}

/// Adds the tangent of a circumferential batch times `input.u` to `out`, p + 1 rows of (point,
/// component) times R rings.
pub fn tangent_product<L: Law, const N: usize>(
    law: &L,
    input: &Input<'_>,
    tangent_data: &[[f32; 16]],
    out: &mut [f64],
) {
    if input.modified.is_none() {
        with_vectors!(wide if L::WIDE_VECTORS_ONLY, simd => kernel_product::<_, L, N, true>(simd, law, input, tangent_data, out));
    } else {
        with_vectors!(wide if L::WIDE_VECTORS_ONLY, simd => kernel_product::<_, L, N, false>(simd, law, input, tangent_data, out));
    }
}

#[inline(always)]
fn kernel_product<S: Simd, L: Law, const N: usize, const PERFECT: bool>(
    simd: S,
    law: &L,
    input: &Input<'_>,
    tangent_data: &[[f32; 16]],
    out: &mut [f64],
) {
    let (row, R, W, k) = (
        input.row(),
        input.rings.padded,
        input.rings.wide(),
        input.rings.rings,
    );
    let nil = f64x8::splat(simd, 0.0);
    let ring_values = ring_values::<N>(input.around);
    let mut tangent_data = tangent_data.chunks_exact(vectors_per_point(law));
    let mut along = vec![0.0; 2 * row];
    let mut along_force = vec![0.0; 2 * row];
    let mut through = vec![0.0; 9 * W];
    // Per local ring and row: one vector for the elements before the first, then R elements.
    let mut elements = vec![0.0; N * 9 * W];
    for qz in 0..N {
        sum_along::<S, N>(simd, input, qz, &mut along);
        along_force.fill(0.0);
        for (t, layer) in input.layers.iter().enumerate() {
            for qr in 0..N {
                sum_through::<S, N>(simd, input, layer, qr, &along, &mut through);
                for v in 0..input.rings.vectors() {
                    let mut pulled_back = [[[nil; 3]; 3]; N];
                    for qs in 0..N {
                        let (gradient_map, [_, grown]) =
                            input.gradient_map::<_, PERFECT>(simd, qz, [t, qr], [v, qs]);
                        let g = gradients::<S, N>(simd, &ring_values[qs], &through, W, v);
                        let Some(from) = tangent_data.next() else {
                            continue;
                        };
                        let dP = L::TangentData::tangent_product(
                            law,
                            #[inline(always)]
                            |n| simd.widen_f32x16(f32x16::simd_from(simd, from[n])).into(),
                            &gradient_map.elastic_gradient_change(g),
                        );
                        pulled_back[qs] = gradient_map.pull_back(&dP.scaled(grown));
                    }
                    for r in 0..N {
                        let mut f = [[nil; 3]; 3];
                        for qs in 0..N {
                            let [zeta, s, over_r] = pulled_back[qs];
                            f[0] = to_ring_frame(&ring_values[qs][r], 1, s, f[0]);
                            f[1] = to_ring_frame(&ring_values[qs][r], 0, zeta, f[1]);
                            f[2] = to_ring_frame(&ring_values[qs][r], 0, over_r, f[2]);
                        }
                        for d in 0..3 {
                            for i in 0..3 {
                                let at = (r * 9 + d * 3 + i) * W + (v + 1) * LANES;
                                store(f[d][i], &mut elements, at);
                            }
                        }
                    }
                }
                // Continue periodically before the first element.
                for ring in elements.chunks_exact_mut(W) {
                    for j in 1..N {
                        ring[LANES - j] = ring[LANES + (N * k - j) % k];
                    }
                }
                // Element e adds to ring e + r; then the transposed sum through the wall.
                for i in 0..3 {
                    for j in (0..R).step_by(LANES) {
                        let mut sum = [nil; 3];
                        for r in 0..N {
                            for (d, sum) in sum.iter_mut().enumerate() {
                                let at = (r * 9 + d * 3 + i) * W + LANES + j - r;
                                *sum += load(simd, &elements, at);
                            }
                        }
                        for c in 0..N {
                            let m = nil.like(layer.value[qr * N + c]);
                            let dm = nil.like(layer.slope[qr * N + c]);
                            let at = ((layer.first + c) * 3 + i) * R + j;
                            let f = Real::mul_add(dm, sum[2], load(simd, &along_force, at));
                            store(Real::mul_add(m, sum[0], f), &mut along_force, at);
                            let at = row + at;
                            let f = load(simd, &along_force, at);
                            store(Real::mul_add(m, sum[1], f), &mut along_force, at);
                        }
                    }
                }
            }
        }
        for a in 0..N {
            let (n, dn) = input.along::<N>(qz, a);
            let out = &mut out[a * row..][..row];
            for at in (0..row).step_by(LANES) {
                let slope = load(simd, &along_force, row + at);
                let f = Real::mul_add(slope, nil.like(dn), load(simd, out, at));
                let value = load(simd, &along_force, at);
                store(Real::mul_add(value, nil.like(n), f), out, at);
            }
        }
    }
}
