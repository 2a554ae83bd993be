//! Energy and residual of a circumferential batch.

use super::super::axial::{BatchForces, SmallestJacobian};
use super::super::kinematics::to_ring_frame;
use super::{Input, gradients, load, ring_values, store, sum_along, sum_through};
use crate::material::Law;
use crate::tensor::{LANES, Lanes, Real, with_vectors};
use fearless_simd::{Simd, SimdBase, f64x8};

/// Computes energy and residual of a circumferential batch and adds R to `residual`, p + 1 rows of
/// (point, component) times R rings. `N` is the degree plus one.
pub fn forces<L: Law, const N: usize>(
    law: &L,
    input: &Input<'_>,
    residual: &mut [f64],
) -> BatchForces {
    if input.modified.is_none() {
        with_vectors!(wide if L::WIDE_VECTORS_ONLY, simd => kernel::<_, L, N, true>(simd, law, input, residual))
    } else {
        with_vectors!(wide if L::WIDE_VECTORS_ONLY, simd => kernel::<_, L, N, false>(simd, law, input, residual))
    }
}

#[inline(always)]
fn kernel<S: Simd, L: Law, const N: usize, const PERFECT: bool>(
    simd: S,
    law: &L,
    input: &Input<'_>,
    residual: &mut [f64],
) -> BatchForces {
    let (row, R, W) = (input.row(), input.rings.padded, input.rings.wide());
    let nil = f64x8::splat(simd, 0.0);
    let ring_values = ring_values::<N>(input.around);
    let mut smallest = SmallestJacobian::default();
    let (mut energy, mut energy_ungrown, mut squares) = (nil, nil, nil);

    let mut along = vec![0.0; N * 2 * row];
    for qz in 0..N {
        sum_along::<S, N>(simd, input, qz, &mut along[qz * 2 * row..][..2 * row]);
    }
    let mut through = vec![0.0; 9 * W];
    // Per (c, r), gradient (value, ζ) and component: R elements. Then per (a, c, r) and component.
    let mut along_force = vec![0.0; N * N * 6 * R];
    let mut force = vec![0.0; N * N * N * 3 * R];

    for (t, layer) in input.layers.iter().enumerate() {
        force.fill(0.0);
        for qz in 0..N {
            along_force.fill(0.0);
            for qr in 0..N {
                let radius = layer.radius[qr];
                let rows = &along[qz * 2 * row..][..2 * row];
                sum_through::<S, N>(simd, input, layer, qr, rows, &mut through);
                for v in 0..input.rings.vectors() {
                    let mut pulled_back = [[[nil; 3]; 3]; N];
                    for qs in 0..N {
                        let point = &input.around[qs];
                        let (gradient_map, [volume, grown]) =
                            input.gradient_map::<_, PERFECT>(simd, qz, [t, qr], [v, qs]);
                        let g = gradients::<S, N>(simd, &ring_values[qs], &through, W, v);
                        let Fe = gradient_map.elastic_gradient(point, radius, g);
                        smallest.update(Fe.determinant(), |lane| [0, t, v * LANES + lane], qr);

                        let w = law.energy(&Fe);
                        energy = Real::mul_add(w, grown, energy);
                        energy_ungrown = Real::mul_add(w, volume, energy_ungrown);
                        pulled_back[qs] = gradient_map.pull_back(&law.stress(&Fe).scaled(grown));
                    }
                    for r in 0..N {
                        let mut f = [[nil; 3]; 3];
                        for qs in 0..N {
                            let [zeta, s, over_r] = pulled_back[qs];
                            f[0] = to_ring_frame(&ring_values[qs][r], 1, s, f[0]); // ∂N : P Fp⁻ᵀ det Fp
                            f[1] = to_ring_frame(&ring_values[qs][r], 0, zeta, f[1]);
                            f[2] = to_ring_frame(&ring_values[qs][r], 0, over_r, f[2]);
                        }
                        for c in 0..N {
                            let m = nil.like(layer.value[qr * N + c]);
                            let dm = nil.like(layer.slope[qr * N + c]);
                            for i in 0..3 {
                                let at = ((c * N + r) * 6 + i) * R + v * LANES;
                                let sum = Real::mul_add(dm, f[2][i], load(simd, &along_force, at));
                                store(Real::mul_add(m, f[0][i], sum), &mut along_force, at);
                                let at = at + 3 * R;
                                let sum = load(simd, &along_force, at);
                                store(Real::mul_add(m, f[1][i], sum), &mut along_force, at);
                            }
                        }
                    }
                }
            }
            for a in 0..N {
                let (n, dn) = input.along::<N>(qz, a);
                for cr in 0..N * N {
                    for x in (0..3 * R).step_by(LANES) {
                        let at = (a * N * N + cr) * 3 * R + x;
                        let value = load(simd, &along_force, cr * 6 * R + x);
                        let slope = load(simd, &along_force, (cr * 6 + 3) * R + x);
                        let sum = Real::mul_add(slope, nil.like(dn), load(simd, &force, at));
                        store(Real::mul_add(value, nil.like(n), sum), &mut force, at);
                    }
                }
            }
        }
        for x in (0..force.len()).step_by(LANES) {
            let f = load(simd, &force, x);
            squares = Real::mul_add(f, f, squares);
        }
        scatter::<N>(input, layer.first, &force, residual);
    }
    BatchForces {
        energy: Lanes::store(energy).sum(),
        energy_ungrown: Lanes::store(energy_ungrown).sum(),
        squares: Lanes::store(squares).sum(),
        smallest,
        residual: vec![],
    }
}

/// Adds the forces of the elements to their rings.
fn scatter<const N: usize>(input: &Input<'_>, first: usize, force: &[f64], residual: &mut [f64]) {
    let (row, R, k) = (input.row(), input.rings.padded, input.rings.rings);
    for a in 0..N {
        for c in 0..N {
            for r in 0..N {
                let from = &force[((a * N + c) * N + r) * 3 * R..][..3 * R];
                let to = &mut residual[a * row + (first + c) * 3 * R..][..3 * R];
                for (to, from) in to.chunks_exact_mut(R).zip(from.chunks_exact(R)) {
                    // Element e adds to ring e + r.
                    let wrap = r % k;
                    for (to, f) in to[wrap..k].iter_mut().zip(&from[..k - wrap]) {
                        *to += f;
                    }
                    for (to, f) in to[..wrap].iter_mut().zip(&from[k - wrap..k]) {
                        *to += f;
                    }
                }
            }
        }
    }
}
