//! Energy and residual of an axial batch.

use super::super::kinematics::{Vector, to_ring_frame};
use super::super::tables::Layer;
use super::{Input, contract_along, contract_through, gradients};
use crate::material::Law;
use crate::tensor::{Lanes, Real, with_vectors};
use fearless_simd::{Simd, SimdBase, SimdMask, f64x8};

/// Contribution of a batch to the energy and the residual.
#[derive(Clone, Debug, Default)]
pub struct BatchForces {
    /// ∫ w det Fp dV₀.
    pub energy: f64,
    /// ∫ w dV₀.
    pub energy_ungrown: f64,
    /// Smallest det Fe.
    pub smallest: SmallestJacobian,
    /// R, row by row like the displacements.
    pub residual: Vec<f64>,
    /// Sum of the squares of the element contributions to the entries of R.
    pub squares: f64,
}

/// Smallest det Fe and its quadrature point.
#[derive(Clone, Copy, Debug)]
pub struct SmallestJacobian {
    /// The value; NaN if Fe is not a number.
    pub jacobian: f64,
    /// Element along the batch (its lane; 0 in a circumferential batch), layer, and element around.
    pub element: [usize; 3],
    /// Quadrature point through the wall.
    pub qr: usize,
}

impl Default for SmallestJacobian {
    fn default() -> Self {
        Self {
            jacobian: f64::INFINITY,
            element: [0; 3],
            qr: 0,
        }
    }
}

impl SmallestJacobian {
    /// Takes the smallest lane of J if it is smaller; NaN counts as smallest. `element` returns the
    /// element of a lane.
    #[inline(always)]
    pub fn update<S: Simd>(
        &mut self,
        J: f64x8<S>,
        element: impl Fn(usize) -> [usize; 3],
        qr: usize,
    ) {
        // A smaller value is rare, so one comparison of all lanes comes first; a NaN fails it too.
        if J.simd_ge(J.like(self.jacobian)).all_true() {
            return;
        }
        let J = Lanes::store(J);
        let smallest = J.min();
        if smallest >= self.jacobian || self.jacobian.is_nan() {
            return;
        }
        let is_worst = |x: &f64| *x == smallest || x.is_nan();
        let lane = J.0.iter().position(is_worst).unwrap_or(0);
        *self = Self {
            jacobian: smallest,
            element: element(lane),
            qr,
        };
    }
}

/// Computes energy and residual of an axial batch. `N` is the degree plus one.
pub fn forces<L: Law, const N: usize>(law: &L, input: &Input<'_>) -> BatchForces {
    with_vectors!(wide if L::WIDE_VECTORS_ONLY, simd => kernel::<_, L, N>(simd, law, input))
}

#[inline(always)]
fn kernel<S: Simd, L: Law, const N: usize>(simd: S, law: &L, input: &Input<'_>) -> BatchForces {
    let Input {
        batch,
        layers,
        around,
        ..
    } = *input;
    let local_rings = input.local_rings();
    let nil = f64x8::splat(simd, 0.0);
    let zero = [nil; 3];

    let mut smallest = SmallestJacobian::default();
    let mut residual = vec![0.0; input.u.len()];
    let (mut energy, mut energy_ungrown, mut squares) = (nil, nil, nil);

    // Displacements and forces of the elements' control points, per (a, c, r); the same after the
    // sum along the tube, per (c, r): value, slope over ζ; and through the wall, per r: value,
    // slope over ζ, slope over R.
    let mut u = vec![zero; N * N * local_rings];
    let mut force = vec![zero; N * N * local_rings];
    let mut along = vec![[zero; 2]; N * local_rings];
    let mut along_force = vec![[zero; 2]; N * local_rings];
    let mut through = vec![[zero; 3]; local_rings];
    let mut through_force = vec![[zero; 3]; local_rings];

    for (t, layer) in layers.iter().enumerate() {
        for element in 0..input.rings {
            input.gather::<S, N>(simd, layer, element, &mut u);
            force.fill(zero);
            for qz in 0..N {
                let [inverse_along, inverse_around] = input.stretch(simd, qz);
                let along_point = (qz, [inverse_along, inverse_around]);
                let growth = nil.like(1.0) / (inverse_along * inverse_around); // det Fp
                let weight = batch.weight[qz].load(simd);
                contract_along::<S, N>(simd, batch, qz, &u, &mut along);
                along_force.fill([zero; 2]);
                for qr in 0..N {
                    let radius = layer.radius[qr];
                    contract_through::<S, N>(simd, layer, qr, &along, &mut through);
                    through_force.fill([zero; 3]);
                    for (qs, point) in around.iter().enumerate() {
                        let gradient_map =
                            input.gradient_map(simd, along_point, [t, element], [qr, qs]);
                        let Fe = gradient_map.elastic_gradient(
                            point,
                            radius,
                            gradients(simd, point, &through),
                        );
                        smallest.update(Fe.determinant(), |lane| [lane, t, element], qr);

                        let volume = weight.times(layer.weight[qr] * point.volume(radius)); // dV₀
                        let volume = gradient_map.stress_free_volume(volume);
                        let grown = gradient_map.grown_volume(volume * growth);
                        let w = law.energy(&Fe);
                        energy = Real::mul_add(w, grown, energy);
                        energy_ungrown = Real::mul_add(w, volume, energy_ungrown);

                        let [zeta, s, r] = gradient_map.pull_back(&law.stress(&Fe).scaled(grown));
                        for (ring, f) in point.ring_values.iter().zip(&mut through_force) {
                            f[0] = to_ring_frame(ring, 1, s, f[0]); // ∂N : P Fp⁻ᵀ det Fp
                            f[1] = to_ring_frame(ring, 0, zeta, f[1]);
                            f[2] = to_ring_frame(ring, 0, r, f[2]);
                        }
                    }
                    for c in 0..N {
                        let m = nil.like(layer.value[qr * N + c]);
                        let dm = nil.like(layer.slope[qr * N + c]);
                        for (r, from) in through_force.iter().enumerate() {
                            let f = &mut along_force[c * local_rings + r];
                            for i in 0..3 {
                                let sum = Real::mul_add(dm, from[2][i], f[0][i]);
                                f[0][i] = Real::mul_add(m, from[0][i], sum);
                                f[1][i] = Real::mul_add(m, from[1][i], f[1][i]);
                            }
                        }
                    }
                }
                for a in 0..N {
                    let n = batch.value[qz * N + a].load(simd);
                    let dn = batch.slope[qz * N + a].load(simd);
                    for (k, from) in along_force.iter().enumerate() {
                        let f = &mut force[a * N * local_rings + k];
                        for i in 0..3 {
                            let sum = Real::mul_add(dn, from[1][i], f[i]);
                            f[i] = Real::mul_add(n, from[0][i], sum);
                        }
                    }
                }
            }
            scatter::<S, N>(input, layer, element, &force, &mut residual);
            for f in &force {
                for x in f {
                    squares = Real::mul_add(*x, *x, squares);
                }
            }
        }
    }
    BatchForces {
        energy: Lanes::store(energy).sum(),
        energy_ungrown: Lanes::store(energy_ungrown).sum(),
        squares: Lanes::store(squares).sum(),
        smallest,
        residual,
    }
}

/// Adds the forces of one element per lane to the rows of the batch, lane after lane.
#[inline(always)]
fn scatter<S: Simd, const N: usize>(
    input: &Input<'_>,
    layer: &Layer,
    element: usize,
    force: &[Vector<f64x8<S>>],
    residual: &mut [f64],
) {
    let (size, local_rings) = (input.row_size(), input.local_rings());
    for a in 0..N {
        for c in 0..N {
            for r in 0..local_rings {
                let ring = (element + r) % input.rings;
                for i in 0..3 {
                    let index = input.index(layer.first + c, i, ring);
                    let lanes = Lanes::store(force[(a * N + c) * local_rings + r][i]);
                    for l in 0..input.batch.elements {
                        residual[(l + a) * size + index] += lanes.0[l];
                    }
                }
            }
        }
    }
}
