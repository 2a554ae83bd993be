//! Axial batches: kernels for eight neighbouring elements along the tube, one per SIMD lane.
//!
//! This file holds what the kernels share: their input, and the sums from control points to a
//! quadrature point.

mod forces;
mod stress_free;
mod tangent;

pub use forces::{BatchForces, SmallestJacobian, forces};
pub use stress_free::stress_free_stretch;
pub use tangent::{BatchTangent, add_along, add_through, tangent};

use super::kinematics::{GradientMap, Vector, to_element_frame};
use super::modified_wall::ModifiedWall;
use super::tables::{AxialBatch, CircumferentialPoint, Layer};
use crate::tensor::{LANES, Lanes, Real};
use fearless_simd::{Simd, SimdBase, SimdFrom, f64x8};

/// Input of an axial kernel.
#[derive(Clone, Copy)]
pub struct Input<'a> {
    pub batch: &'a AxialBatch,
    pub layers: &'a [Layer],
    pub around: &'a [CircumferentialPoint],
    /// Control points through the wall.
    pub points: usize,
    /// Rings of the sector.
    pub rings: usize,
    /// 1/θζ and 1/θη at the quadrature points along the batch.
    pub inverse_stretch: &'a [(Lanes, Lanes)],
    /// The stress-free shape at every (layer, element around, point along, point through, point around) and the factors of
    /// patches at every (element around, point along, point around); none if the wall is plain.
    pub modified: Option<ModifiedWall<'a>>,
    /// Displacements of the rows of the batch, one after the other; (point, component, ring) in
    /// each.
    pub u: &'a [f64],
}

impl Input<'_> {
    /// Returns the number of unknowns in a row of control points.
    pub fn row_size(&self) -> usize {
        self.points * 3 * self.rings
    }

    /// Returns the number of distinct rings of an element.
    pub fn local_rings(&self) -> usize {
        self.around[0].ring_values.len()
    }

    /// Returns 1/θζ and 1/θη at a point along the batch.
    #[inline(always)]
    fn stretch<S: Simd>(&self, simd: S, qz: usize) -> [f64x8<S>; 2] {
        let (along, around) = &self.inverse_stretch[qz];
        [along.load(simd), around.load(simd)]
    }

    /// Returns the map from displacement gradients to Fe at a point along (with its 1/θζ and 1/θη),
    /// layer and element around, point through and point around.
    #[inline(always)]
    pub fn gradient_map<S: Simd>(
        &self,
        simd: S,
        (qz, [inverse_along, inverse_around]): (usize, [f64x8<S>; 2]),
        [t, element]: [usize; 2],
        [qr, qs]: [usize; 2],
    ) -> GradientMap<f64x8<S>> {
        let (layer, points) = (&self.layers[t], self.around.len());
        let (radius, residual) = (layer.radius[qr], layer.inverse_residual[qr]);
        let inverse = [inverse_along, inverse_around];
        let gradient_map = GradientMap::new(&self.around[qs], radius, inverse, residual);
        gradient_map.with_imperfection(self.modified.map(|wall| {
            let along = (t * self.rings + element) * points + qz;
            let shape = (along * points + qr) * points + qs;
            let patch = (element * points + qz) * points + qs;
            let inverse = [
                inverse_along.times(residual[0]),
                inverse_around.times(residual[1]),
            ];
            wall.map(simd, inverse, [shape, patch])
        }))
    }

    /// Returns the index of a component of a control point in its row.
    #[inline(always)]
    pub fn index(&self, point: usize, component: usize, ring: usize) -> usize {
        (point * 3 + component) * self.rings + ring
    }

    /// Gathers the displacements of one element per lane, at `((a * N + c) * local_rings + r)`.
    #[inline(always)]
    pub fn gather<S: Simd, const N: usize>(
        &self,
        simd: S,
        layer: &Layer,
        element: usize,
        out: &mut [Vector<f64x8<S>>],
    ) {
        let (size, local_rings) = (self.row_size(), self.local_rings());
        for a in 0..N {
            for c in 0..N {
                for r in 0..local_rings {
                    let ring = (element + r) % self.rings;
                    for i in 0..3 {
                        let index = self.index(layer.first + c, i, ring);
                        let mut lanes = [0.0; LANES];
                        for (l, x) in lanes.iter_mut().enumerate() {
                            *x = self.u[(self.batch.row(l) + a) * size + index];
                        }
                        out[(a * N + c) * local_rings + r][i] = f64x8::simd_from(simd, lanes);
                    }
                }
            }
        }
    }
}

/// Sums along the tube: returns value and slope at quadrature point `qz`, per (c, r).
#[inline(always)]
pub fn contract_along<S: Simd, const N: usize>(
    simd: S,
    batch: &AxialBatch,
    qz: usize,
    u: &[Vector<f64x8<S>>],
    out: &mut [[Vector<f64x8<S>>; 2]],
) {
    let count = out.len();
    for (k, sum) in out.iter_mut().enumerate() {
        *sum = [[f64x8::splat(simd, 0.0); 3]; 2];
        for a in 0..N {
            let n = batch.value[qz * N + a].load(simd);
            let dn = batch.slope[qz * N + a].load(simd);
            let from = &u[a * count + k];
            for i in 0..3 {
                sum[0][i] = Real::mul_add(n, from[i], sum[0][i]);
                sum[1][i] = Real::mul_add(dn, from[i], sum[1][i]);
            }
        }
    }
}

/// Sums through the wall: returns value, slope over ζ and slope over R at quadrature point `qr`,
/// per r.
#[inline(always)]
pub fn contract_through<S: Simd, const N: usize>(
    simd: S,
    layer: &Layer,
    qr: usize,
    along: &[[Vector<f64x8<S>>; 2]],
    out: &mut [[Vector<f64x8<S>>; 3]],
) {
    let local_rings = out.len();
    for (r, sum) in out.iter_mut().enumerate() {
        *sum = [[f64x8::splat(simd, 0.0); 3]; 3];
        for c in 0..N {
            let m = f64x8::splat(simd, layer.value[qr * N + c]);
            let dm = f64x8::splat(simd, layer.slope[qr * N + c]);
            let from = &along[c * local_rings + r];
            for i in 0..3 {
                sum[0][i] = Real::mul_add(m, from[0][i], sum[0][i]);
                sum[1][i] = Real::mul_add(m, from[1][i], sum[1][i]);
                sum[2][i] = Real::mul_add(dm, from[0][i], sum[2][i]);
            }
        }
    }
}

/// Sums around the element: returns the displacement gradients over ζ, s and R at a point.
#[inline(always)]
pub fn gradients<S: Simd>(
    simd: S,
    point: &CircumferentialPoint,
    through: &[[Vector<f64x8<S>>; 3]],
) -> [Vector<f64x8<S>>; 3] {
    let mut g = [[f64x8::splat(simd, 0.0); 3]; 3];
    for (ring, [value, over_zeta, over_r]) in point.ring_values.iter().zip(through) {
        g[0] = to_element_frame(ring, 0, *over_zeta, g[0]);
        g[1] = to_element_frame(ring, 1, *value, g[1]);
        g[2] = to_element_frame(ring, 0, *over_r, g[2]);
    }
    g
}
