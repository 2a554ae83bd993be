//! The stress-free shape of an imperfect wall at the points of a pencil.

use super::super::kinematics::Columns;
use super::super::stress_free::StressFree;
use super::{PencilInput, gradients, slots, sum_along, sum_through};
use fearless_simd::{Level, Simd, SimdBase, dispatch, f64x8};

/// What [`StressFree`] holds of a pencil whose control points are displaced by `input.u`: at (point
/// along, layer, point through, vector of elements, point around). `N` is the degree plus one.
pub fn pencil_stress_free<const N: usize>(input: &PencilInput<'_>) -> Vec<StressFree> {
    dispatch!(Level::new(), simd => kernel::<_, N>(simd, input))
}

#[inline(always)]
fn kernel<S: Simd, const N: usize>(simd: S, input: &PencilInput<'_>) -> Vec<StressFree> {
    let (row, W) = (input.row(), input.rings.wide());
    let one = f64x8::splat(simd, 1.0);
    let slots = slots::<N>(input.around);
    let mut along = vec![0.0; 2 * row];
    let mut through = vec![0.0; 9 * W];
    let mut out = vec![];
    for qz in 0..input.slab.z.len() {
        sum_along::<S, N>(simd, input, qz, &mut along);
        for layer in input.layers {
            for (qr, &radius) in layer.radius.iter().enumerate() {
                sum_through::<S, N>(simd, input, layer, qr, &along, &mut through);
                for v in 0..input.rings.vectors() {
                    for (point, slots) in input.around.iter().zip(&slots) {
                        let columns = Columns::new(point, radius, one, one);
                        let g = gradients::<S, N>(simd, slots, &through, W, v);
                        out.push(StressFree::of(columns.elastic(point, radius, g)));
                    }
                }
            }
        }
    }
    out
}
