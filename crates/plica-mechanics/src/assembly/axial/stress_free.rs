//! Stress-free shape at the quadrature points of an axial batch.

use super::super::kinematics::GradientMap;
use super::super::stress_free::StressFreeStretch;
use super::{Input, contract_along, contract_through, gradients};
use crate::tensor::with_vectors;
use fearless_simd::{Simd, SimdBase, f64x8};

/// Returns the stretch of the stress-free shape whose control points are displaced by `input.u`, at
/// (layer, element around, point along, point through, point around). `N` is the degree plus one.
pub fn stress_free_stretch<const N: usize>(input: &Input<'_>) -> Vec<StressFreeStretch> {
    with_vectors!(simd => kernel::<_, N>(simd, input))
}

#[inline(always)]
fn kernel<S: Simd, const N: usize>(simd: S, input: &Input<'_>) -> Vec<StressFreeStretch> {
    let local_rings = input.local_rings();
    let one = f64x8::splat(simd, 1.0);
    let zero = [f64x8::splat(simd, 0.0); 3];
    let mut u = vec![zero; N * N * local_rings];
    let mut along = vec![[zero; 2]; N * local_rings];
    let mut through = vec![[zero; 3]; local_rings];
    let mut out = vec![];
    for layer in input.layers {
        for element in 0..input.rings {
            input.gather::<S, N>(simd, layer, element, &mut u);
            for qz in 0..N {
                contract_along::<S, N>(simd, input.batch, qz, &u, &mut along);
                for qr in 0..N {
                    let radius = layer.radius[qr];
                    contract_through::<S, N>(simd, layer, qr, &along, &mut through);
                    for point in input.around {
                        let gradient_map = GradientMap::new(point, radius, [one; 2], [1.0; 2]);
                        let g = gradients(simd, point, &through);
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
