//! The stress-free shape of an imperfect wall at the points of a circumferential batch.

use super::super::kinematics::GradientMap;
use super::super::stress_free::StressFreeStretch;
use super::{Input, gradients, ring_values, sum_along, sum_through};
use crate::tensor::with_vectors;
use fearless_simd::{Simd, SimdBase, f64x8};

/// Returns the stretch of the stress-free shape of a circumferential batch whose control points are
/// displaced by `input.u`, at (point along, layer, point through, vector of elements, point
/// around). `N` is the degree plus one.
pub fn stress_free_stretch<const N: usize>(input: &Input<'_>) -> Vec<StressFreeStretch> {
    with_vectors!(simd => kernel::<_, N>(simd, input))
}

#[inline(always)]
fn kernel<S: Simd, const N: usize>(simd: S, input: &Input<'_>) -> Vec<StressFreeStretch> {
    let (row, W) = (input.row(), input.rings.wide());
    let one = f64x8::splat(simd, 1.0);
    let ring_values = ring_values::<N>(input.around);
    let mut along = vec![0.0; 2 * row];
    let mut through = vec![0.0; 9 * W];
    let mut out = vec![];
    for qz in 0..input.batch.z.len() {
        sum_along::<S, N>(simd, input, qz, &mut along);
        for layer in input.layers {
            for (qr, &radius) in layer.radius.iter().enumerate() {
                sum_through::<S, N>(simd, input, layer, qr, &along, &mut through);
                for v in 0..input.rings.vectors() {
                    for (point, ring_values) in input.around.iter().zip(&ring_values) {
                        let gradient_map = GradientMap::new(point, radius, [one; 2], [1.0; 2]);
                        let g = gradients::<S, N>(simd, ring_values, &through, W, v);
                        out.push(StressFreeStretch::from_gradient(
                            gradient_map.elastic_gradient(point, radius, g),
                        ));
                    }
                }
            }
        }
    }
    out
}
