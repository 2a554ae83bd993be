//! Moduli at the elements of a circumferential batch.

use super::{AVERAGED, Input, gradients, ring_values, store, sum_along, sum_through};
use crate::material::Law;
use crate::tensor::{LANES, with_vectors};
use fearless_simd::Simd;

/// Writes the weighted blocks of [`GradientMap::pull_back_moduli`](super::super::kinematics::GradientMap)
/// of every element around: R values at (point along, layer, entry). Uses the first point through
/// each layer and the first around.
pub fn moduli<L: Law, const N: usize>(law: &L, input: &Input<'_>, out: &mut [f64]) {
    with_vectors!(wide if L::WIDE_VECTORS_ONLY, simd => kernel::<_, L, N>(simd, law, input, out));
}

#[inline(always)]
fn kernel<S: Simd, L: Law, const N: usize>(simd: S, law: &L, input: &Input<'_>, out: &mut [f64]) {
    let (row, R, W) = (input.row(), input.rings.padded, input.rings.wide());
    let ring_values = ring_values::<N>(input.around);
    let mut along = vec![0.0; 2 * row];
    let mut through = vec![0.0; 9 * W];
    let mut out = out.chunks_exact_mut(AVERAGED * R);
    for qz in 0..input.batch.z.len() {
        sum_along::<S, N>(simd, input, qz, &mut along);
        for (t, layer) in input.layers.iter().enumerate() {
            let (radius, point) = (layer.radius[0], &input.around[0]);
            sum_through::<S, N>(simd, input, layer, 0, &along, &mut through);
            let Some(out) = out.next() else { return };
            for v in 0..input.rings.vectors() {
                let (gradient_map, [_, grown]) =
                    input.gradient_map::<_, false>(simd, qz, [t, 0], [v, 0]);
                let g = gradients::<S, N>(simd, &ring_values[0], &through, W, v);
                let Fe = gradient_map.elastic_gradient(point, radius, g);
                let blocks = gradient_map.pull_back_moduli(&law.moduli(&Fe), grown);
                for (b, block) in blocks.iter().enumerate() {
                    for j in 0..3 {
                        for i in 0..3 {
                            store(block[j][i], out, (9 * b + 3 * j + i) * R + v * LANES);
                        }
                    }
                }
            }
        }
    }
}
