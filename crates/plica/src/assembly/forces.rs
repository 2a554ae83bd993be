//! Energy and residual of a slab: W and R = ∂W/∂u_cp.

use super::kinematics::{Columns, Vector, turn, turn_back};
use super::tables::{Around, Layer, Slab};
use crate::material::Law;
use crate::tensor::{LANES, Lanes, Real};
use multiversion::multiversion;

/// What every slab kernel reads.
#[derive(Clone, Copy)]
pub struct SlabInput<'a> {
    pub slab: &'a Slab,
    pub layers: &'a [Layer],
    pub around: &'a [Around],
    /// Control points through the wall, and rings of the sector.
    pub points: usize,
    pub rings: usize,
    /// 1/θζ and 1/θη at the quadrature points along the slab.
    pub inverse_stretch: &'a [(Lanes, Lanes)],
    /// Displacements of the slab's rows, one after the other: (point, component, ring) in each.
    pub u: &'a [f64],
}

impl SlabInput<'_> {
    /// Unknowns of one row of control points.
    pub fn row_size(&self) -> usize {
        self.points * 3 * self.rings
    }

    /// Where a component of a control point sits in its row.
    #[inline(always)]
    pub fn place(&self, point: usize, component: usize, ring: usize) -> usize {
        (point * 3 + component) * self.rings + ring
    }

    /// The displacements of one element per lane, at `((a * N + c) * slots + r)`.
    #[inline(always)]
    pub fn gather<const N: usize>(&self, layer: &Layer, element: usize, out: &mut [Vector<Lanes>]) {
        let (size, slots) = (self.row_size(), self.around[0].slots.len());
        for a in 0..N {
            for c in 0..N {
                for r in 0..slots {
                    let ring = (element + r) % self.rings;
                    for i in 0..3 {
                        let place = self.place(layer.first + c, i, ring);
                        let lanes = &mut out[(a * N + c) * slots + r][i];
                        for l in 0..LANES {
                            lanes.0[l] = self.u[(self.slab.row(l) + a) * size + place];
                        }
                    }
                }
            }
        }
    }
}

/// What a slab adds to the energy and the residual.
#[derive(Clone, Debug, Default)]
pub struct SlabForces {
    /// ∫ w det Fp dV₀.
    pub energy: f64,
    /// ∫ w dV₀.
    pub energy_ungrown: f64,
    /// Smallest det Fe, and its element (along, through, around) and quadrature point.
    pub worst: (f64, [usize; 3], [usize; 3]),
    /// R, row by row as `u`.
    pub residual: Vec<f64>,
    /// Sum of the squares of what the elements add to each entry of R.
    pub squares: f64,
}

/// Energy and residual of one slab. `N` is the degree plus one.
#[multiversion(targets(
    "x86_64+avx512f+avx512dq+avx512vl+avx512bw+avx2+fma",
    "x86_64+avx2+fma"
))]
pub fn slab_forces<L: Law, const N: usize>(law: &L, input: &SlabInput<'_>) -> SlabForces {
    let SlabInput {
        slab,
        layers,
        around,
        ..
    } = *input;
    let slots = around[0].slots.len();
    let zero = [Lanes::zero(); 3];

    let mut out = SlabForces {
        worst: (f64::INFINITY, [0; 3], [0; 3]),
        residual: vec![0.0; input.u.len()],
        ..SlabForces::default()
    };
    let (mut energy, mut energy_ungrown) = (Lanes::zero(), Lanes::zero());
    let mut squares = Lanes::zero();

    // Control points of the elements at hand, (a, c, r); contracted along the tube, (c, r);
    // contracted through the wall, (r): value, slope over ζ, slope over R.
    let mut u = vec![zero; N * N * slots];
    let mut force = vec![zero; N * N * slots];
    let mut along = vec![[zero; 2]; N * slots];
    let mut along_force = vec![[zero; 2]; N * slots];
    let mut through = vec![[zero; 3]; slots];
    let mut through_force = vec![[zero; 3]; slots];

    for (t, layer) in layers.iter().enumerate() {
        for element in 0..input.rings {
            input.gather::<N>(layer, element, &mut u);
            force.fill(zero);
            for qz in 0..N {
                let (inverse_along, inverse_around) = input.inverse_stretch[qz];
                let growth = Lanes::splat(1.0) / (inverse_along * inverse_around);
                contract_along::<N>(slab, qz, slots, &u, &mut along);
                along_force.fill([zero; 2]);
                for qr in 0..N {
                    contract_through::<N>(layer, qr, slots, &along, &mut through);
                    through_force.fill([zero; 3]);
                    let radius = layer.radius[qr];
                    for (qs, point) in around.iter().enumerate() {
                        let columns = Columns::new(point, radius, inverse_along, inverse_around);
                        let Fe = columns.elastic(point, radius, gradients(point, &through));
                        let J = Fe.determinant().min();
                        if !(J >= out.worst.0) {
                            out.worst = (J, [slab.first, t, element], [qz, qr, qs]);
                        }
                        // dV₀ = R b |C| dζ ds dR
                        let volume = slab.weight[qz]
                            * Lanes::splat(
                                layer.weight[qr]
                                    * point.weight
                                    * radius
                                    * point.across
                                    * point.radius,
                            );
                        let grown = volume * growth;
                        let w = law.energy(&Fe);
                        energy = w.mul_add(grown, energy);
                        energy_ungrown = w.mul_add(volume, energy_ungrown);
                        // ∂N : P Fp⁻ᵀ det Fp
                        let q = columns.pulled_back(&law.stress(&Fe).scaled(grown));
                        for (r, slot) in point.slots.iter().enumerate() {
                            let f = &mut through_force[r];
                            f[0] = turn_back(slot, 1, q[1], f[0]);
                            f[1] = turn_back(slot, 0, q[0], f[1]);
                            f[2] = turn_back(slot, 0, q[2], f[2]);
                        }
                    }
                    for c in 0..N {
                        let m = Lanes::splat(layer.value[qr * N + c]);
                        let dm = Lanes::splat(layer.slope[qr * N + c]);
                        for r in 0..slots {
                            let (f, from) = (&mut along_force[c * slots + r], &through_force[r]);
                            for i in 0..3 {
                                f[0][i] = m.mul_add(from[0][i], dm.mul_add(from[2][i], f[0][i]));
                                f[1][i] = m.mul_add(from[1][i], f[1][i]);
                            }
                        }
                    }
                }
                for a in 0..N {
                    let (n, dn) = (slab.value[qz * N + a], slab.slope[qz * N + a]);
                    for (f, from) in force[a * N * slots..][..N * slots]
                        .iter_mut()
                        .zip(&along_force)
                    {
                        for i in 0..3 {
                            f[i] = n.mul_add(from[0][i], dn.mul_add(from[1][i], f[i]));
                        }
                    }
                }
            }
            scatter::<N>(input, layer, element, &force, &mut out.residual);
            for f in &force {
                for x in f {
                    squares = x.mul_add(*x, squares);
                }
            }
        }
    }
    out.energy = energy.sum();
    out.energy_ungrown = energy_ungrown.sum();
    out.squares = squares.sum();
    out
}

/// Values and slopes along the tube at quadrature point `qz`.
#[inline(always)]
pub fn contract_along<const N: usize>(
    slab: &Slab,
    qz: usize,
    slots: usize,
    u: &[Vector<Lanes>],
    out: &mut [[Vector<Lanes>; 2]],
) {
    for (k, sum) in out.iter_mut().enumerate().take(N * slots) {
        *sum = [[Lanes::zero(); 3]; 2];
        for a in 0..N {
            let from = &u[a * N * slots + k];
            for i in 0..3 {
                sum[0][i] = slab.value[qz * N + a].mul_add(from[i], sum[0][i]);
                sum[1][i] = slab.slope[qz * N + a].mul_add(from[i], sum[1][i]);
            }
        }
    }
}

/// Value, slope over ζ and slope over R at quadrature point `qr` through the wall.
#[inline(always)]
pub fn contract_through<const N: usize>(
    layer: &Layer,
    qr: usize,
    slots: usize,
    along: &[[Vector<Lanes>; 2]],
    out: &mut [[Vector<Lanes>; 3]],
) {
    for (r, sum) in out.iter_mut().enumerate().take(slots) {
        *sum = [[Lanes::zero(); 3]; 3];
        for c in 0..N {
            let m = Lanes::splat(layer.value[qr * N + c]);
            let dm = Lanes::splat(layer.slope[qr * N + c]);
            let from = &along[c * slots + r];
            for i in 0..3 {
                sum[0][i] = m.mul_add(from[0][i], sum[0][i]);
                sum[1][i] = m.mul_add(from[1][i], sum[1][i]);
                sum[2][i] = dm.mul_add(from[0][i], sum[2][i]);
            }
        }
    }
}

/// Displacement gradients over ζ, s and R at a point around the element.
#[inline(always)]
pub fn gradients(point: &Around, through: &[[Vector<Lanes>; 3]]) -> [Vector<Lanes>; 3] {
    let mut g = [[Lanes::zero(); 3]; 3];
    for (slot, [value, over_zeta, over_r]) in point.slots.iter().zip(through) {
        g[0] = turn(slot, 0, *over_zeta, g[0]);
        g[1] = turn(slot, 1, *value, g[1]);
        g[2] = turn(slot, 0, *over_r, g[2]);
    }
    g
}

/// Adds the forces of one element per lane to the rows of the slab, lane after lane.
#[inline(always)]
fn scatter<const N: usize>(
    input: &SlabInput<'_>,
    layer: &Layer,
    element: usize,
    force: &[Vector<Lanes>],
    residual: &mut [f64],
) {
    let (size, slots) = (input.row_size(), input.around[0].slots.len());
    for a in 0..N {
        for c in 0..N {
            for r in 0..slots {
                let ring = (element + r) % input.rings;
                for i in 0..3 {
                    let place = input.place(layer.first + c, i, ring);
                    let lanes = force[(a * N + c) * slots + r][i];
                    for l in 0..input.slab.elements {
                        residual[(l + a) * size + place] += lanes.0[l];
                    }
                }
            }
        }
    }
}
