//! The moduli around a pencil, one by one.

use super::{AVERAGED, PencilInput, gradients, slots, store, sum_along, sum_through};
use crate::material::Law;
use crate::tensor::LANES;
use fearless_simd::{Level, Simd, dispatch};

/// The blocks of [`Columns::moduli`], with the weight of their point, of every element around: at
/// (point along, layer, number) there are R of them. Takes the first point through each layer and the
/// first around.
pub fn pencil_moduli<L: Law, const N: usize>(law: &L, input: &PencilInput<'_>, out: &mut [f64]) {
    dispatch!(Level::new(), simd => kernel::<_, L, N>(simd, law, input, out));
}

#[inline(always)]
fn kernel<S: Simd, L: Law, const N: usize>(
    simd: S,
    law: &L,
    input: &PencilInput<'_>,
    out: &mut [f64],
) {
    let (row, R, W) = (input.row(), input.rings.padded, input.rings.wide());
    let slots = slots::<N>(input.around);
    let mut along = vec![0.0; 2 * row];
    let mut through = vec![0.0; 9 * W];
    let mut out = out.chunks_exact_mut(AVERAGED * R);
    for qz in 0..input.slab.z.len() {
        sum_along::<S, N>(simd, input, qz, &mut along);
        for (t, layer) in input.layers.iter().enumerate() {
            let (radius, point) = (layer.radius[0], &input.around[0]);
            sum_through::<S, N>(simd, input, layer, 0, &along, &mut through);
            let Some(out) = out.next() else { return };
            for v in 0..input.rings.vectors() {
                let (columns, [_, grown]) = input.columns::<_, false>(simd, qz, [t, 0], [v, 0]);
                let g = gradients::<S, N>(simd, &slots[0], &through, W, v);
                let Fe = columns.elastic(point, radius, g);
                let blocks = columns.moduli(&law.moduli(&Fe), grown);
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
