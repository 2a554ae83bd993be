//! Many rings: all elements around the tube at once, eight neighbours around it to a vector.
//!
//! A *pencil* is everything around the tube and through the wall at one element along it. What is
//! summed along the tube and through the wall is the same for all rings, so it is done ring by
//! ring, once, for the four (p + 1) elements that share a ring; what is left at a point is the sum
//! around the element. Every element around the tube sees the same numbers in the same order, so a
//! symmetric state stays symmetric to the last bit.
//!
//! For N = p + 1 functions each way, a point costs about 15 N multiply-adds forward and as many back,
//! whatever the law costs (some 100), and N/2 for its share of the sums before: 250 for cubics.
//!
//! | length | holds |
//! |---|---|
//! | k | rings of the sector |
//! | R | k rounded up to whole vectors |
//! | W | R and a vector more: rings once around and on |

mod average;
mod coupling;
mod forces;
mod linear;
mod stress_free;
#[cfg(test)]
mod tests;

pub use average::{AVERAGED, slab_offsets};
pub use coupling::pencil_moduli;
pub use forces::pencil_forces;
pub use linear::{Kept, kept_len, pencil_keep, pencil_product};
pub use stress_free::pencil_stress_free;

use super::kinematics::{Columns, Vector, turn};
use super::stress_free::StressFree;
use super::tables::{Around, Layer, Slab};
use crate::rings::SlotValues;
use crate::tensor::{LANES, Lanes, Real};
use fearless_simd::{Simd, SimdBase, f64x8};

/// What a pencil kernel reads.
#[derive(Clone, Copy)]
pub struct PencilInput<'a> {
    /// The slab of the element along the tube, and its lane there.
    pub slab: &'a Slab,
    pub lane: usize,
    pub layers: &'a [Layer],
    pub around: &'a [Around],
    /// Control points through the wall.
    pub points: usize,
    pub rings: &'a RingLanes,
    /// 1/θζ and 1/θη: at the quadrature points along the element or, where they differ around the
    /// tube, at every (point along, point around, vector of elements).
    pub inverse_stretch: &'a [(Lanes, Lanes)],
    /// The stress-free shape at every (point along, layer, point through, vector of elements, point
    /// around), if it is not the perfect tube's.
    pub stress_free: Option<&'a [StressFree]>,
    /// The p + 1 rows of control points, one after the other: (point, component) times R rings.
    pub u: &'a [f64],
}

impl PencilInput<'_> {
    /// Numbers of a row.
    pub fn row(&self) -> usize {
        self.points * 3 * self.rings.padded
    }

    #[inline(always)]
    fn weight(&self, qz: usize) -> f64 {
        self.slab.weight[qz].0[self.lane]
    }

    #[inline(always)]
    fn along<const N: usize>(&self, qz: usize, a: usize) -> (f64, f64) {
        let at = qz * N + a;
        (
            self.slab.value[at].0[self.lane],
            self.slab.slope[at].0[self.lane],
        )
    }

    /// 1/θζ and 1/θη at a point along, a point around and a vector of elements.
    #[inline(always)]
    fn stretch<S: Simd>(&self, simd: S, qz: usize, qs: usize, v: usize) -> (f64x8<S>, f64x8<S>) {
        let at = if self.inverse_stretch.len() == self.slab.z.len() {
            qz
        } else {
            (qz * self.around.len() + qs) * self.rings.vectors() + v
        };
        let (along, around) = &self.inverse_stretch[at];
        (along.load(simd), around.load(simd))
    }

    /// What leads from gradients to Fe at a point along, layer and point through it, vector of
    /// elements and point around them; and dV and det Fp dV there, zero in the lanes that are left
    /// over. `PERFECT` says that the wall is: kernels that may depart from it at every point, and do
    /// not, are up to twice as slow.
    #[inline(always)]
    fn columns<S: Simd, const PERFECT: bool>(
        &self,
        simd: S,
        qz: usize,
        [t, qr]: [usize; 2],
        [v, qs]: [usize; 2],
    ) -> (Columns<f64x8<S>>, [f64x8<S>; 2]) {
        let (layer, point) = (&self.layers[t], &self.around[qs]);
        let (inverse_along, inverse_around) = self.stretch(simd, qz, qs, v);
        let radius = layer.radius[qr];
        let columns = Columns::new(point, radius, inverse_along, inverse_around);
        let stress_free = self.stress_free.filter(|_| !PERFECT);
        let columns = columns.measured_from(stress_free.map(|at| {
            let through = (qz * self.layers.len() + t) * layer.radius.len() + qr;
            let at = &at[(through * self.rings.vectors() + v) * self.around.len() + qs];
            at.imperfection_map(simd, inverse_along, inverse_around)
        }));
        let mask = self.rings.mask[v].load(simd);
        let volume = mask.times(self.weight(qz) * layer.weight[qr] * point.volume(radius));
        let volume = columns.volume(volume);
        (columns, [volume, volume / (inverse_along * inverse_around)])
    }
}

/// The rings of a sector in vectors of eight.
#[derive(Clone, Debug)]
pub struct RingLanes {
    /// k.
    pub rings: usize,
    /// R.
    pub padded: usize,
    /// One for every element around, zero in the lanes that are left over.
    pub mask: Vec<Lanes>,
}

impl RingLanes {
    /// For k rings.
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

    /// Vectors of elements around the sector.
    pub fn vectors(&self) -> usize {
        self.mask.len()
    }

    /// W.
    pub fn wide(&self) -> usize {
        self.padded + LANES
    }

    /// Rows of k rings as rows of R, what is left over zero.
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

/// The slots of the points around an element, one for each of the N functions; where the sector has
/// fewer rings than that, the last ones are zero.
type Slots<const N: usize> = [[SlotValues; N]; N];

fn slots<const N: usize>(around: &[Around]) -> Slots<N> {
    let mut slots = [[SlotValues::default(); N]; N];
    for (to, point) in slots.iter_mut().zip(around) {
        to[..point.slots.len()].copy_from_slice(&point.slots);
    }
    slots
}

#[inline(always)]
fn load<S: Simd>(simd: S, from: &[f64], at: usize) -> f64x8<S> {
    f64x8::from_slice(simd, &from[at..at + LANES])
}

#[inline(always)]
fn store<S: Simd>(vector: f64x8<S>, to: &mut [f64], at: usize) {
    vector.store_slice(&mut to[at..at + LANES]);
}

/// Value and slope along the tube at a quadrature point, of everything in a row: two rows.
#[inline(always)]
fn sum_along<S: Simd, const N: usize>(
    simd: S,
    input: &PencilInput<'_>,
    qz: usize,
    out: &mut [f64],
) {
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

/// Value, slope over ζ and slope over R at a quadrature point through the wall, of every component
/// and ring: nine rows of W.
#[inline(always)]
fn sum_through<S: Simd, const N: usize>(
    simd: S,
    input: &PencilInput<'_>,
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

/// Displacement gradients over ζ, s and R at a point around eight elements.
#[inline(always)]
fn gradients<S: Simd, const N: usize>(
    simd: S,
    slots: &[SlotValues; N],
    through: &[f64],
    wide: usize,
    v: usize,
) -> [Vector<f64x8<S>>; 3] {
    let mut g = [[f64x8::splat(simd, 0.0); 3]; 3];
    for (r, slot) in slots.iter().enumerate() {
        let at = v * LANES + r;
        // Written out: `map` on arrays is not always inlined, and then passes vectors by memory.
        let row = |i: usize| load(simd, through, i * wide + at);
        let ring = |d: usize| [row(3 * d), row(3 * d + 1), row(3 * d + 2)];
        g[0] = turn(slot, 0, ring(1), g[0]);
        g[1] = turn(slot, 1, ring(0), g[1]);
        g[2] = turn(slot, 0, ring(2), g[2]);
    }
    g
}
