//! What the slab kernels share: their input, and the sums that lead from control points to a
//! quadrature point.

use super::kinematics::{Columns, Vector, turn};
use super::stress_free::StressFree;
use super::tables::{Around, Layer, Slab};
use crate::tensor::{LANES, Lanes, Real};
use fearless_simd::{Simd, SimdBase, SimdFrom, f64x8};

/// What a slab kernel reads.
#[derive(Clone, Copy)]
pub struct SlabInput<'a> {
    pub slab: &'a Slab,
    pub layers: &'a [Layer],
    pub around: &'a [Around],
    /// Control points through the wall.
    pub points: usize,
    /// Rings of the sector.
    pub rings: usize,
    /// 1/θζ and 1/θη at the quadrature points along the slab.
    pub inverse_stretch: &'a [(Lanes, Lanes)],
    /// The stress-free shape at every (layer, element around, point along, point through, point
    /// around), if it is not the perfect tube's.
    pub stress_free: Option<&'a [StressFree]>,
    /// Displacements of the slab's rows, one after the other: (point, component, ring) in each.
    pub u: &'a [f64],
}

impl SlabInput<'_> {
    /// Unknowns of one row of control points.
    pub fn row_size(&self) -> usize {
        self.points * 3 * self.rings
    }

    /// Distinct rings of an element.
    pub fn slots(&self) -> usize {
        self.around[0].slots.len()
    }

    /// What leads from gradients to Fe at a point along (its 1/θζ and 1/θη), layer and element
    /// around, point through and point around.
    #[inline(always)]
    pub fn columns<S: Simd>(
        &self,
        simd: S,
        (qz, [inverse_along, inverse_around]): (usize, [f64x8<S>; 2]),
        [t, element]: [usize; 2],
        [qr, qs]: [usize; 2],
    ) -> Columns<f64x8<S>> {
        let (layer, points) = (&self.layers[t], self.around.len());
        let radius = layer.radius[qr];
        let columns = Columns::new(&self.around[qs], radius, inverse_along, inverse_around);
        columns.measured_from(self.stress_free.map(|at| {
            let at = &at[(((t * self.rings + element) * points + qz) * points + qr) * points + qs];
            at.imperfection_map(simd, inverse_along, inverse_around)
        }))
    }

    /// Where a component of a control point sits in its row.
    #[inline(always)]
    pub fn place(&self, point: usize, component: usize, ring: usize) -> usize {
        (point * 3 + component) * self.rings + ring
    }

    /// The displacements of one element per lane, at `((a * N + c) * slots + r)`.
    #[inline(always)]
    pub fn gather<S: Simd, const N: usize>(
        &self,
        simd: S,
        layer: &Layer,
        element: usize,
        out: &mut [Vector<f64x8<S>>],
    ) {
        let (size, slots) = (self.row_size(), self.slots());
        for a in 0..N {
            for c in 0..N {
                for r in 0..slots {
                    let ring = (element + r) % self.rings;
                    for i in 0..3 {
                        let place = self.place(layer.first + c, i, ring);
                        let mut lanes = [0.0; LANES];
                        for (l, x) in lanes.iter_mut().enumerate() {
                            *x = self.u[(self.slab.row(l) + a) * size + place];
                        }
                        out[(a * N + c) * slots + r][i] = f64x8::simd_from(simd, lanes);
                    }
                }
            }
        }
    }
}

/// Value and slope along the tube at quadrature point `qz`, per (c, r).
#[inline(always)]
pub fn contract_along<S: Simd, const N: usize>(
    simd: S,
    slab: &Slab,
    qz: usize,
    u: &[Vector<f64x8<S>>],
    out: &mut [[Vector<f64x8<S>>; 2]],
) {
    let count = out.len();
    for (k, sum) in out.iter_mut().enumerate() {
        *sum = [[f64x8::splat(simd, 0.0); 3]; 2];
        for a in 0..N {
            let n = slab.value[qz * N + a].load(simd);
            let dn = slab.slope[qz * N + a].load(simd);
            let from = &u[a * count + k];
            for i in 0..3 {
                sum[0][i] = Real::mul_add(n, from[i], sum[0][i]);
                sum[1][i] = Real::mul_add(dn, from[i], sum[1][i]);
            }
        }
    }
}

/// Value, slope over ζ and slope over R at quadrature point `qr` through the wall, per r.
#[inline(always)]
pub fn contract_through<S: Simd, const N: usize>(
    simd: S,
    layer: &Layer,
    qr: usize,
    along: &[[Vector<f64x8<S>>; 2]],
    out: &mut [[Vector<f64x8<S>>; 3]],
) {
    let slots = out.len();
    for (r, sum) in out.iter_mut().enumerate() {
        *sum = [[f64x8::splat(simd, 0.0); 3]; 3];
        for c in 0..N {
            let m = f64x8::splat(simd, layer.value[qr * N + c]);
            let dm = f64x8::splat(simd, layer.slope[qr * N + c]);
            let from = &along[c * slots + r];
            for i in 0..3 {
                sum[0][i] = Real::mul_add(m, from[0][i], sum[0][i]);
                sum[1][i] = Real::mul_add(m, from[1][i], sum[1][i]);
                sum[2][i] = Real::mul_add(dm, from[0][i], sum[2][i]);
            }
        }
    }
}

/// Displacement gradients over ζ, s and R at a point around the element.
#[inline(always)]
pub fn gradients<S: Simd>(
    simd: S,
    point: &Around,
    through: &[[Vector<f64x8<S>>; 3]],
) -> [Vector<f64x8<S>>; 3] {
    let mut g = [[f64x8::splat(simd, 0.0); 3]; 3];
    for (slot, [value, over_zeta, over_r]) in point.slots.iter().zip(through) {
        g[0] = turn(slot, 0, *over_zeta, g[0]);
        g[1] = turn(slot, 1, *value, g[1]);
        g[2] = turn(slot, 0, *over_r, g[2]);
    }
    g
}
