//! The tangent of a pencil without its matrix: what is kept of a state, and the product with it.

use super::super::kinematics::turn_back;
use super::{AVERAGED, PencilInput, gradients, load, slots, store, sum_along, sum_through};
use crate::material::{Law, TangentData};
use crate::tensor::{LANES, Lanes, Real};
use fearless_simd::{Level, Simd, SimdBase, SimdFrom, dispatch, f32x16, f64x8};

/// What is kept of a state at the points of a pencil: two numbers of [`Law::TangentData`] to a
/// vector of sixteen in single precision, in the order in which the product reads them. The product
/// stays symmetric whatever they are, and its rounding (6e-8) is far below what a Newton step asks
/// of it; it is half the memory, which is what the product waits for.
pub type Kept = Vec<[f32; 16]>;

/// Vectors of sixteen per point.
const fn vectors<L: Law>() -> usize {
    let numbers = <L::TangentData<f64> as TangentData<f64, L>>::LEN;
    assert!(numbers.is_multiple_of(2));
    numbers / 2
}

/// Keeps a state, and adds up its moduli around the tube: `averaged` holds, for every (point
/// along, layer, point through, point around), the blocks of [`Columns::moduli`] with the weight of
/// the point, summed over the elements around.
pub fn pencil_keep<L: Law, const N: usize>(
    law: &L,
    input: &PencilInput<'_>,
    kept: &mut [[f32; 16]],
    averaged: &mut [f64],
) {
    let level = Level::new();
    if input.stress_free.is_none() {
        dispatch!(level, simd => keep::<_, L, N, true>(simd, law, input, kept, averaged));
    } else {
        dispatch!(level, simd => keep::<_, L, N, false>(simd, law, input, kept, averaged));
    }
}

#[inline(always)]
fn keep<S: Simd, L: Law, const N: usize, const PERFECT: bool>(
    simd: S,
    law: &L,
    input: &PencilInput<'_>,
    kept: &mut [[f32; 16]],
    averaged: &mut [f64],
) {
    let (row, W) = (input.row(), input.rings.wide());
    let nil = f64x8::splat(simd, 0.0);
    let slots = slots::<N>(input.around);
    let mut kept = kept.chunks_exact_mut(vectors::<L>());
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
                        let (columns, [_, grown]) =
                            input.columns::<_, PERFECT>(simd, qz, [t, qr], [v, qs]);
                        let g = gradients::<S, N>(simd, &slots[qs], &through, W, v);
                        let Fe = columns.elastic(point, radius, g);
                        let data = L::TangentData::linearise(law, &Fe);
                        if let Some(to) = kept.next() {
                            for (to, pair) in to.iter_mut().zip(data.as_ref().chunks_exact(2)) {
                                *to = simd.narrow_f64x8(pair[0], pair[1]).into();
                            }
                        }
                        let blocks = columns.moduli(&law.moduli(&Fe), grown);
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

/// Vectors of sixteen that a pencil keeps.
pub fn kept_len<L: Law, const N: usize>(_: &L, layers: usize, rings: usize) -> usize {
    N.pow(3) * layers * rings * vectors::<L>()
}

/// Adds the tangent of a pencil times `input.u` to `out`, p + 1 rows of (point, component) times R
/// rings.
pub fn pencil_product<L: Law, const N: usize>(
    law: &L,
    input: &PencilInput<'_>,
    kept: &[[f32; 16]],
    out: &mut [f64],
) {
    let level = Level::new();
    if input.stress_free.is_none() {
        dispatch!(level, simd => product::<_, L, N, true>(simd, law, input, kept, out));
    } else {
        dispatch!(level, simd => product::<_, L, N, false>(simd, law, input, kept, out));
    }
}

#[inline(always)]
fn product<S: Simd, L: Law, const N: usize, const PERFECT: bool>(
    simd: S,
    law: &L,
    input: &PencilInput<'_>,
    kept: &[[f32; 16]],
    out: &mut [f64],
) {
    let (row, R, W, k) = (
        input.row(),
        input.rings.padded,
        input.rings.wide(),
        input.rings.rings,
    );
    let nil = f64x8::splat(simd, 0.0);
    let slots = slots::<N>(input.around);
    let mut kept = kept.chunks_exact(vectors::<L>());
    let mut along = vec![0.0; 2 * row];
    let mut along_force = vec![0.0; 2 * row];
    let mut through = vec![0.0; 9 * W];
    // Per slot and row: a vector before, then R elements.
    let mut elements = vec![0.0; N * 9 * W];
    for qz in 0..N {
        sum_along::<S, N>(simd, input, qz, &mut along);
        along_force.fill(0.0);
        for (t, layer) in input.layers.iter().enumerate() {
            for qr in 0..N {
                sum_through::<S, N>(simd, input, layer, qr, &along, &mut through);
                for v in 0..input.rings.vectors() {
                    let mut pulled = [[[nil; 3]; 3]; N];
                    for qs in 0..N {
                        let (columns, [_, grown]) =
                            input.columns::<_, PERFECT>(simd, qz, [t, qr], [v, qs]);
                        let g = gradients::<S, N>(simd, &slots[qs], &through, W, v);
                        let mut data = L::TangentData::zeros(nil);
                        if let Some(from) = kept.next() {
                            for (pair, from) in data.as_mut().chunks_exact_mut(2).zip(from) {
                                let wide = simd.widen_f32x16(f32x16::simd_from(simd, *from));
                                (pair[0], pair[1]) = wide;
                            }
                        }
                        let dP = data.tangent_product(law, &columns.linear(g));
                        pulled[qs] = columns.pulled_back(&dP.scaled(grown));
                    }
                    for r in 0..N {
                        let mut f = [[nil; 3]; 3];
                        for qs in 0..N {
                            let [zeta, s, over_r] = pulled[qs];
                            f[0] = turn_back(&slots[qs][r], 1, s, f[0]);
                            f[1] = turn_back(&slots[qs][r], 0, zeta, f[1]);
                            f[2] = turn_back(&slots[qs][r], 0, over_r, f[2]);
                        }
                        for d in 0..3 {
                            for i in 0..3 {
                                let at = (r * 9 + d * 3 + i) * W + (v + 1) * LANES;
                                store(f[d][i], &mut elements, at);
                            }
                        }
                    }
                }
                // Once around before the first element.
                for ring in elements.chunks_exact_mut(W) {
                    for j in 1..N {
                        ring[LANES - j] = ring[LANES + (N * k - j) % k];
                    }
                }
                // Element e adds to ring e + r; then back through the wall.
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
