//! Circumferential batches: kernels for all elements around the tube at one axial position, eight
//! neighbours around the tube per SIMD vector.
//!
//! Sums along the tube and through the wall are the same for all rings, so the kernels do them once
//! per ring, for the p + 1 elements that share it; only the sum around the element remains at a
//! point. All elements around the tube see the same numbers in the same order, so a symmetric state
//! stays symmetric to the last bit.
//!
//! With N = p + 1 functions per direction, a point takes about 15 N multiply-adds forward and as
//! many backward, some 100 for the law, and N/2 for its share of the earlier sums: 250 for cubics.
//!
//! | length | meaning |
//! |---|---|
//! | k | rings of the sector |
//! | R | k rounded up to whole vectors |
//! | W | R plus one vector: the rings, continued periodically |

mod average;
mod forces;
mod moduli;
mod stress_free;
mod tangent;
#[cfg(test)]
mod tests;

pub use average::{AVERAGED, offset_blocks};
pub use forces::forces;
pub use moduli::moduli;
pub use stress_free::stress_free_stretch;
pub use tangent::{PackedTangentData, linearise, tangent_data_len, tangent_product};

use super::kinematics::{GradientMap, Vector, to_element_frame};
use super::modified_wall::ModifiedWall;
use super::tables::{AxialBatch, CircumferentialPoint, Layer};
use crate::rings::RingValues;
use crate::tensor::{LANES, Lanes, Real};
use fearless_simd::{Simd, SimdBase, f64x8};

/// Input of a circumferential kernel.
#[derive(Clone, Copy)]
pub struct Input<'a> {
    /// Axial batch and lane of the element along the tube.
    pub batch: &'a AxialBatch,
    pub lane: usize,
    pub layers: &'a [Layer],
    pub around: &'a [CircumferentialPoint],
    /// Control points through the wall.
    pub points: usize,
    pub rings: &'a PaddedRings,
    /// 1/θζ and 1/θη of the muscles: at the quadrature points along the element or, if they vary around the tube,
    /// at every (point along, point around, vector of elements).
    pub inverse_stretch: &'a [(Lanes, Lanes)],
    /// The stress-free shape at every (point along, layer, point through, vector of elements, point around) and the factors
    /// of patches at every (point along, point around, vector of elements); none if the wall is plain.
    pub modified: Option<ModifiedWall<'a>>,
    /// The p + 1 rows of control points, one after the other; (point, component) times R rings in
    /// each.
    pub u: &'a [f64],
}

impl Input<'_> {
    /// Returns the size of a row.
    pub fn row(&self) -> usize {
        self.points * 3 * self.rings.padded
    }

    #[inline(always)]
    fn weight(&self, qz: usize) -> f64 {
        self.batch.weight[qz].0[self.lane]
    }

    #[inline(always)]
    fn along<const N: usize>(&self, qz: usize, a: usize) -> (f64, f64) {
        let at = qz * N + a;
        (
            self.batch.value[at].0[self.lane],
            self.batch.slope[at].0[self.lane],
        )
    }

    /// Returns 1/θζ and 1/θη at a point along, a point around and a vector of elements.
    #[inline(always)]
    fn stretch<S: Simd>(&self, simd: S, qz: usize, qs: usize, v: usize) -> (f64x8<S>, f64x8<S>) {
        let at = if self.inverse_stretch.len() == self.batch.z.len() {
            qz
        } else {
            (qz * self.around.len() + qs) * self.rings.vectors() + v
        };
        let (along, around) = &self.inverse_stretch[at];
        (along.load(simd), around.load(simd))
    }

    /// Returns the map from displacement gradients to Fe at a point along, layer and point through
    /// it, vector of elements and point around them; and dV and det Fp dV there, times the factor of patches, zero in unused
    /// lanes. `PERFECT` excludes an imperfect or patched wall at compile time: a branch at every point makes a
    /// kernel up to twice as slow.
    #[inline(always)]
    fn gradient_map<S: Simd, const PERFECT: bool>(
        &self,
        simd: S,
        qz: usize,
        [t, qr]: [usize; 2],
        [v, qs]: [usize; 2],
    ) -> (GradientMap<f64x8<S>>, [f64x8<S>; 2]) {
        let (layer, point) = (&self.layers[t], &self.around[qs]);
        let (inverse_along, inverse_around) = self.stretch(simd, qz, qs, v);
        let (radius, residual) = (layer.radius[qr], layer.inverse_residual[qr]);
        let inverse = [inverse_along, inverse_around];
        let gradient_map = GradientMap::new(point, radius, inverse, residual);
        let modified = self.modified.filter(|_| !PERFECT);
        let gradient_map = gradient_map.with_imperfection(modified.map(|wall| {
            let through = (qz * self.layers.len() + t) * layer.radius.len() + qr;
            let shape = (through * self.rings.vectors() + v) * self.around.len() + qs;
            let patch = (qz * self.around.len() + qs) * self.rings.vectors() + v;
            let inverse = [
                inverse_along.times(residual[0]),
                inverse_around.times(residual[1]),
            ];
            wall.map(simd, inverse, [shape, patch])
        }));
        let mask = self.rings.mask[v].load(simd);
        let volume = mask.times(self.weight(qz) * layer.weight[qr] * point.volume(radius));
        let volume = gradient_map.stress_free_volume(volume);
        (
            gradient_map,
            [
                volume,
                gradient_map.grown_volume(volume / (inverse_along * inverse_around)),
            ],
        )
    }
}

/// The rings of a sector, padded to vectors of eight.
#[derive(Clone, Debug)]
pub struct PaddedRings {
    /// k.
    pub rings: usize,
    /// R.
    pub padded: usize,
    /// One for every element around, zero in unused lanes.
    pub mask: Vec<Lanes>,
}

impl PaddedRings {
    /// Pads k rings.
    pub fn new(rings: usize) -> Self {
        let padded = rings.next_multiple_of(LANES);
        let mask = (0..padded / LANES)
            .map(|v| {
                let lane = |l| f64::from(u8::from(v * LANES + l < rings));
                Lanes(std::array::from_fn(lane))
            })
            .collect();
        Self {
            rings,
            padded,
            mask,
        }
    }

    /// Returns the number of vectors of elements around the sector.
    pub fn vectors(&self) -> usize {
        self.mask.len()
    }

    /// Returns W.
    pub fn wide(&self) -> usize {
        self.padded + LANES
    }

    /// Copies rows of k rings to rows of R, padded with zeros.
    pub fn pad(&self, u: &[f64]) -> Vec<f64> {
        let mut padded = vec![0.0; u.len() / self.rings * self.padded];
        for (to, from) in padded
            .chunks_exact_mut(self.padded)
            .zip(u.chunks_exact(self.rings))
        {
            to[..self.rings].copy_from_slice(from);
        }
        padded
    }
}

/// Basis functions of the rings of an element by point around and local index. If the sector has
/// fewer than N rings, the last ones are zero.
type RingValueTable<const N: usize> = [[RingValues; N]; N];

fn ring_values<const N: usize>(around: &[CircumferentialPoint]) -> RingValueTable<N> {
    let mut ring_values = [[RingValues::default(); N]; N];
    for (to, point) in ring_values.iter_mut().zip(around) {
        to[..point.ring_values.len()].copy_from_slice(&point.ring_values);
    }
    ring_values
}

#[inline(always)]
fn load<S: Simd>(simd: S, from: &[f64], at: usize) -> f64x8<S> {
    f64x8::from_slice(simd, &from[at..at + LANES])
}

#[inline(always)]
fn store<S: Simd>(vector: f64x8<S>, to: &mut [f64], at: usize) {
    vector.store_slice(&mut to[at..at + LANES]);
}

/// Sums along the tube: writes value and slope at a quadrature point for everything in a row, as
/// two rows.
#[inline(always)]
fn sum_along<S: Simd, const N: usize>(simd: S, input: &Input<'_>, qz: usize, out: &mut [f64]) {
    let row = input.row();
    let functions: [_; N] = std::array::from_fn(|a| input.along::<N>(qz, a));
    let (values, slopes) = out.split_at_mut(row);
    for at in (0..row).step_by(LANES) {
        let mut value = f64x8::splat(simd, 0.0);
        let mut slope = value;
        for (a, (n, dn)) in functions.iter().enumerate() {
            let u = load(simd, input.u, a * row + at);
            value = Real::mul_add(u, value.like(*n), value);
            slope = Real::mul_add(u, value.like(*dn), slope);
        }
        store(value, values, at);
        store(slope, slopes, at);
    }
}

/// Sums through the wall: writes value, slope over ζ and slope over R at a quadrature point for
/// every component and ring, as nine rows of W.
#[inline(always)]
fn sum_through<S: Simd, const N: usize>(
    simd: S,
    input: &Input<'_>,
    layer: &Layer,
    qr: usize,
    along: &[f64],
    out: &mut [f64],
) {
    let (row, R, W) = (input.row(), input.rings.padded, input.rings.wide());
    let k = input.rings.rings;
    for i in 0..3 {
        for j in (0..R).step_by(LANES) {
            let mut sum = [f64x8::splat(simd, 0.0); 3];
            for c in 0..N {
                let m = sum[0].like(layer.value[qr * N + c]);
                let dm = sum[0].like(layer.slope[qr * N + c]);
                let at = ((layer.first + c) * 3 + i) * R + j;
                let (value, slope) = (load(simd, along, at), load(simd, along, row + at));
                sum[0] = Real::mul_add(value, m, sum[0]);
                sum[1] = Real::mul_add(slope, m, sum[1]);
                sum[2] = Real::mul_add(value, dm, sum[2]);
            }
            for (d, sum) in sum.into_iter().enumerate() {
                store(sum, out, (d * 3 + i) * W + j);
            }
        }
    }
    for ring in out.chunks_exact_mut(W) {
        for j in k..W {
            ring[j] = ring[j - k];
        }
    }
}

/// Sums around the elements: returns the displacement gradients over ζ, s and R at a point of eight
/// elements.
#[inline(always)]
fn gradients<S: Simd, const N: usize>(
    simd: S,
    ring_values: &[RingValues; N],
    through: &[f64],
    wide: usize,
    v: usize,
) -> [Vector<f64x8<S>>; 3] {
    let mut g = [[f64x8::splat(simd, 0.0); 3]; 3];
    for (r, values) in ring_values.iter().enumerate() {
        let at = v * LANES + r;
        // Written out: `map` on arrays is not always inlined, and then passes vectors through
        // memory.
        let row = |i: usize| load(simd, through, i * wide + at);
        let ring = |d: usize| [row(3 * d), row(3 * d + 1), row(3 * d + 2)];
        g[0] = to_element_frame(values, 0, ring(1), g[0]);
        g[1] = to_element_frame(values, 1, ring(0), g[1]);
        g[2] = to_element_frame(values, 0, ring(2), g[2]);
    }
    g
}
