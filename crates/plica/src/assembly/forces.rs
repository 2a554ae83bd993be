//! Energy and residual of a slab: W and R = ∂W/∂u_cp.

use super::kinematics::{Vector, turn_back};
use super::slab::{SlabInput, contract_along, contract_through, gradients};
use super::tables::Layer;
use crate::material::Law;
use crate::tensor::{Lanes, Real};
use fearless_simd::{Level, Simd, SimdBase, SimdMask, dispatch, f64x8};

/// What a slab adds to the energy and the residual.
#[derive(Clone, Debug, Default)]
pub struct SlabForces {
    /// ∫ w det Fp dV₀.
    pub energy: f64,
    /// ∫ w dV₀.
    pub energy_ungrown: f64,
    /// The smallest det Fe.
    pub worst: Worst,
    /// R, row by row as the displacements.
    pub residual: Vec<f64>,
    /// Sum of the squares of what the elements add to each entry of R.
    pub squares: f64,
}

/// Where det Fe is smallest.
#[derive(Clone, Copy, Debug, Default)]
pub struct Worst {
    /// det Fe there; NaN where Fe is not a number.
    pub jacobian: f64,
    /// Element along the slab (its lane; 0 in a pencil), layer and element around.
    pub element: [usize; 3],
    /// Quadrature point through the wall.
    pub qr: usize,
}

impl Worst {
    /// Keeps the smallest det Fe, and its point; one that is not a number counts as smallest.
    /// `element` names the element of a lane.
    #[inline(always)]
    pub fn note<S: Simd>(&mut self, J: f64x8<S>, element: impl Fn(usize) -> [usize; 3], qr: usize) {
        // Hardly ever is there a smaller one; what is not a number is not greater either.
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

/// Energy and residual of one slab. `N` is the degree plus one.
pub fn slab_forces<L: Law, const N: usize>(law: &L, input: &SlabInput<'_>) -> SlabForces {
    dispatch!(Level::new(), simd => kernel::<_, L, N>(simd, law, input))
}

#[inline(always)]
fn kernel<S: Simd, L: Law, const N: usize>(simd: S, law: &L, input: &SlabInput<'_>) -> SlabForces {
    let SlabInput {
        slab,
        layers,
        around,
        ..
    } = *input;
    let slots = input.slots();
    let nil = f64x8::splat(simd, 0.0);
    let zero = [nil; 3];

    let mut worst = Worst {
        jacobian: f64::INFINITY,
        ..Worst::default()
    };
    let mut residual = vec![0.0; input.u.len()];
    let (mut energy, mut energy_ungrown, mut squares) = (nil, nil, nil);

    // Displacements and forces of the control points of the elements at hand, per (a, c, r); the
    // same contracted along the tube, per (c, r): value, slope over ζ; and through the wall, per
    // r: value, slope over ζ, slope over R.
    let mut u = vec![zero; N * N * slots];
    let mut force = vec![zero; N * N * slots];
    let mut along = vec![[zero; 2]; N * slots];
    let mut along_force = vec![[zero; 2]; N * slots];
    let mut through = vec![[zero; 3]; slots];
    let mut through_force = vec![[zero; 3]; slots];

    for (t, layer) in layers.iter().enumerate() {
        for element in 0..input.rings {
            input.gather::<S, N>(simd, layer, element, &mut u);
            force.fill(zero);
            for qz in 0..N {
                let (inverse_along, inverse_around) = input.inverse_stretch[qz];
                let inverse_along = inverse_along.load(simd);
                let inverse_around = inverse_around.load(simd);
                let along_point = (qz, [inverse_along, inverse_around]);
                let growth = nil.like(1.0) / (inverse_along * inverse_around); // det Fp
                let weight = slab.weight[qz].load(simd);
                contract_along::<S, N>(simd, slab, qz, &u, &mut along);
                along_force.fill([zero; 2]);
                for qr in 0..N {
                    let radius = layer.radius[qr];
                    contract_through::<S, N>(simd, layer, qr, &along, &mut through);
                    through_force.fill([zero; 3]);
                    for (qs, point) in around.iter().enumerate() {
                        let columns = input.columns(simd, along_point, [t, element], [qr, qs]);
                        let Fe = columns.elastic(point, radius, gradients(simd, point, &through));
                        worst.note(Fe.determinant(), |lane| [lane, t, element], qr);

                        let volume = weight.times(layer.weight[qr] * point.volume(radius)); // dV₀
                        let volume = columns.volume(volume);
                        let grown = volume * growth;
                        let w = law.energy(&Fe);
                        energy = Real::mul_add(w, grown, energy);
                        energy_ungrown = Real::mul_add(w, volume, energy_ungrown);

                        let [zeta, s, r] = columns.pulled_back(&law.stress(&Fe).scaled(grown));
                        for (slot, f) in point.slots.iter().zip(&mut through_force) {
                            f[0] = turn_back(slot, 1, s, f[0]); // ∂N : P Fp⁻ᵀ det Fp
                            f[1] = turn_back(slot, 0, zeta, f[1]);
                            f[2] = turn_back(slot, 0, r, f[2]);
                        }
                    }
                    for c in 0..N {
                        let m = nil.like(layer.value[qr * N + c]);
                        let dm = nil.like(layer.slope[qr * N + c]);
                        for (r, from) in through_force.iter().enumerate() {
                            let f = &mut along_force[c * slots + r];
                            for i in 0..3 {
                                let sum = Real::mul_add(dm, from[2][i], f[0][i]);
                                f[0][i] = Real::mul_add(m, from[0][i], sum);
                                f[1][i] = Real::mul_add(m, from[1][i], f[1][i]);
                            }
                        }
                    }
                }
                for a in 0..N {
                    let n = slab.value[qz * N + a].load(simd);
                    let dn = slab.slope[qz * N + a].load(simd);
                    for (k, from) in along_force.iter().enumerate() {
                        let f = &mut force[a * N * slots + k];
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
    SlabForces {
        energy: Lanes::store(energy).sum(),
        energy_ungrown: Lanes::store(energy_ungrown).sum(),
        squares: Lanes::store(squares).sum(),
        worst,
        residual,
    }
}

/// Adds the forces of one element per lane to the rows of the slab, lane after lane.
#[inline(always)]
fn scatter<S: Simd, const N: usize>(
    input: &SlabInput<'_>,
    layer: &Layer,
    element: usize,
    force: &[Vector<f64x8<S>>],
    residual: &mut [f64],
) {
    let (size, slots) = (input.row_size(), input.slots());
    for a in 0..N {
        for c in 0..N {
            for r in 0..slots {
                let ring = (element + r) % input.rings;
                for i in 0..3 {
                    let place = input.place(layer.first + c, i, ring);
                    let lanes = Lanes::store(force[(a * N + c) * slots + r][i]);
                    for l in 0..input.slab.elements {
                        residual[(l + a) * size + place] += lanes.0[l];
                    }
                }
            }
        }
    }
}
