//! Tangent stiffness of a slab: K = ∂²W/∂u_cp².
//!
//! Sum factorisation: at every point the moduli are pulled back to gradients over (ζ, s, R) and
//! turned onto the slots of the element; what is left around the element is added up, then what
//! is left through the wall, then along the tube. With N = p + 1 functions each way and one slot
//! (axisymmetric) an element costs about 500 N³ at the points, 9 N³ (9 + 6 N) through the wall and
//! 9 N⁴ (N + 5) along the tube: 7.2e4 multiply-adds for cubics, where multiplying out BᵀAB
//! would cost 9e5.

use super::slab::{SlabInput, contract_along, contract_through, gradients};
use super::tables::Slab;
use crate::material::Law;
use crate::matrix::BlockBanded;
use crate::rings::Turn;
use crate::tensor::{LANES, Lanes, Real, Tensor2};
use fearless_simd::{Level, Simd, SimdBase, SimdFrom, dispatch, f64x8};

/// A block of 3×3 numbers.
pub type Block<V> = [[V; 3]; 3];

/// K of a slab, lower half by rows of control points: the block `d` rows below the diagonal, entry
/// (`row`, `column`) of it, for every row of the slab, is at
/// `((d * m + column) * m + row) * rows`, where m is the size of a row. Diagonal blocks are full.
#[derive(Clone, Debug)]
pub struct SlabTangent {
    /// The numbers.
    pub entries: Vec<f64>,
    /// Rows of control points of the slab.
    pub rows: usize,
}

impl SlabTangent {
    /// Adds it to the rows of a matrix from `first` on; rows hold `m` unknowns, and degree p couples
    /// p + 1 of them.
    pub fn add_to(&self, matrix: &mut BlockBanded, first: usize, m: usize, p: usize) {
        let places: Vec<usize> = (0..(p + 1) * m * m)
            .map(|i| matrix.place(i / (m * m), i % m, i / m % m))
            .collect();
        let panels = matrix.panels_mut().skip(first).take(self.rows);
        for (row, panel) in panels.enumerate() {
            for (&place, entry) in places.iter().zip(self.entries.chunks_exact(self.rows)) {
                panel[place] += entry[row];
            }
        }
    }
}

/// Where a pair of slots (r ≤ r') keeps its numbers.
fn pairs(slots: usize) -> Vec<(usize, usize)> {
    (0..slots)
        .flat_map(|r| (r..slots).map(move |s| (r, s)))
        .collect()
}

/// The tangent of one slab. `N` is the degree plus one.
///
/// `turns` holds, for every point around an element, the sets of slots on which the moduli are
/// turned; what the sets give is added up. The tangent itself has one set, of the element's own
/// slots; a harmonic has two, of one slot each (see [`crate::rings::Sector::harmonic_at`]).
pub fn slab_tangent<L: Law, const N: usize>(
    law: &L,
    input: &SlabInput<'_>,
    turns: &[Vec<Vec<Turn>>],
) -> SlabTangent {
    dispatch!(Level::new(), simd => kernel::<_, L, N>(simd, law, input, turns))
}

#[inline(always)]
fn kernel<S: Simd, L: Law, const N: usize>(
    simd: S,
    law: &L,
    input: &SlabInput<'_>,
    turns: &[Vec<Vec<Turn>>],
) -> SlabTangent {
    let SlabInput {
        slab,
        layers,
        around,
        ..
    } = *input;
    let (m, slots, rows) = (
        input.row_size(),
        around[0].slots.len(),
        slab.elements + N - 1,
    );
    let mut out = SlabTangent {
        entries: vec![0.0; N * m * m * rows],
        rows,
    };
    let pairs = pairs(slots);
    let zero = f64x8::splat(simd, 0.0);

    let mut u = vec![[zero; 3]; N * N * slots];
    let mut along = vec![[[zero; 3]; 2]; N * slots];
    let mut through = vec![[[zero; 3]; 3]; slots];
    // Per pair of slots: moduli on (ζ, s, R) × (ζ, s, R) after the sum around.
    let mut turned = vec![[[[[zero; 3]; 3]; 3]; 3]; pairs.len()];
    // Per pair, (c, c', i, j) and point along the tube, after the sum through the wall: the parts
    // that go with (N', N'), (N', N), (N, N'), (N, N) along the tube.
    let mut wall = vec![[[zero; 4]; N]; pairs.len() * N * N * 9];

    for (t, layer) in layers.iter().enumerate() {
        for element in 0..input.rings {
            input.gather::<S, N>(simd, layer, element, &mut u);
            for qz in 0..N {
                let (inverse_along, inverse_around) = input.inverse_stretch[qz];
                let inverse_along = inverse_along.load(simd);
                let inverse_around = inverse_around.load(simd);
                let along_point = (qz, [inverse_along, inverse_around]);
                let weight = slab.weight[qz].load(simd) / (inverse_along * inverse_around);
                contract_along::<S, N>(simd, slab, qz, &u, &mut along);
                for entry in &mut wall {
                    entry[qz] = [zero; 4];
                }
                for qr in 0..N {
                    contract_through::<S, N>(simd, layer, qr, &along, &mut through);
                    turned.fill([[[[zero; 3]; 3]; 3]; 3]);
                    let radius = layer.radius[qr];
                    for (qs, (point, turns)) in around.iter().zip(turns).enumerate() {
                        let columns = input.columns(simd, along_point, [t, element], [qr, qs]);
                        let Fe = columns.elastic(point, radius, gradients(simd, point, &through));
                        let grown = weight.times(layer.weight[qr] * point.volume(radius)); // det Fp dV₀
                        let grown = columns.volume(grown);
                        let blocks = columns.moduli(&law.moduli(&Fe), grown);
                        for slots in turns {
                            for (turned, &(r, s)) in turned.iter_mut().zip(&pairs) {
                                add_turned(turned, &blocks, &slots[r], &slots[s], r == s);
                            }
                        }
                    }
                    for (k, (turned, &(r, s))) in turned.iter_mut().zip(&pairs).enumerate() {
                        if r == s {
                            mirror(turned);
                        }
                        let wall = &mut wall[k * N * N * 9..][..N * N * 9];
                        let (value, slope) =
                            (&layer.value[qr * N..][..N], &layer.slope[qr * N..][..N]);
                        add_through::<_, N>(wall, qz, turned, value, slope);
                    }
                }
            }
            for (k, &(r, s)) in pairs.iter().enumerate() {
                let (ring_r, ring_s) = ((element + r) % input.rings, (element + s) % input.rings);
                for c in 0..N {
                    for d in 0..N {
                        for i in 0..3 {
                            for j in 0..3 {
                                let wall = &wall[((k * N + c) * N + d) * 9 + 3 * i + j];
                                let places = (
                                    input.place(layer.first + c, i, ring_r),
                                    input.place(layer.first + d, j, ring_s),
                                );
                                add_along::<S, N>(simd, &mut out, slab, m, wall, places, r == s);
                            }
                        }
                    }
                }
            }
        }
    }
    out
}

/// Adds Gᵣᵀ A Gₛ for every pair of gradients; for r = s only those on and above the diagonal.
#[inline(always)]
pub fn add_turned<V: Real>(
    sum: &mut [[Block<V>; 3]; 3],
    blocks: &[Block<V>; 6],
    r: &Turn,
    s: &Turn,
    same: bool,
) {
    const UPPER: [(usize, usize); 6] = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];
    for (block, (alpha, beta)) in blocks.iter().zip(UPPER) {
        add_block(
            &mut sum[alpha][beta],
            block,
            (r, slope(alpha)),
            (s, slope(beta)),
        );
        if !same && alpha != beta {
            let transposed = Tensor2(*block).transpose().0;
            add_block(
                &mut sum[beta][alpha],
                &transposed,
                (r, slope(beta)),
                (s, slope(alpha)),
            );
        }
    }
}

/// Whether a gradient needs the slope around (s) or the value (ζ, R) of a slot.
#[inline(always)]
fn slope(gradient: usize) -> usize {
    usize::from(gradient == 1)
}

/// sum += Gᵣᵀ block Gₛ with G = [[g, 0, 0], [0, a, b], [0, c, d]].
#[inline(always)]
fn add_block<V: Real>(
    sum: &mut Block<V>,
    block: &Block<V>,
    (r, dr): (&Turn, usize),
    (s, ds): (&Turn, usize),
) {
    let plain = |x: f64| block[0][0].like(x);
    let (gr, [ar, br, cr, dr]) = (r.axial[dr], r.plane[dr].map(plain));
    let (gs, [as_, bs, cs, ds]) = (plain(s.axial[ds]), s.plane[ds].map(plain));
    let mut half = *block;
    for j in 0..3 {
        half[0][j] = block[0][j].times(gr);
        half[1][j] = ar.mul_add(block[1][j], cr * block[2][j]);
        half[2][j] = br.mul_add(block[1][j], dr * block[2][j]);
    }
    for i in 0..3 {
        sum[i][0] = half[i][0].mul_add(gs, sum[i][0]);
        sum[i][1] = half[i][1].mul_add(as_, half[i][2].mul_add(cs, sum[i][1]));
        sum[i][2] = half[i][1].mul_add(bs, half[i][2].mul_add(ds, sum[i][2]));
    }
}

/// Fills the pairs of gradients below the diagonal from those above.
#[inline(always)]
pub fn mirror<V: Copy>(sum: &mut [[Block<V>; 3]; 3]) {
    for alpha in 0..3 {
        for beta in 0..alpha {
            for i in 0..3 {
                for j in 0..3 {
                    sum[alpha][beta][i][j] = sum[beta][alpha][j][i];
                }
            }
        }
    }
}

/// Adds what one point through the wall contributes to every (c, c', i, j).
#[inline(always)]
pub fn add_through<V: Real, const N: usize>(
    wall: &mut [[[V; 4]; N]],
    qz: usize,
    a: &[[Block<V>; 3]; 3],
    value: &[f64],
    slope: &[f64],
) {
    let plain = |x: f64| a[0][0][0][0].like(x);
    for i in 0..3 {
        for j in 0..3 {
            for d in 0..N {
                let (m, dm) = (plain(value[d]), plain(slope[d]));
                let zz = a[0][0][i][j] * m;
                let z_ = m.mul_add(a[0][1][i][j], dm * a[0][2][i][j]);
                let s_z = a[1][0][i][j] * m;
                let r_z = a[2][0][i][j] * m;
                let s_ = m.mul_add(a[1][1][i][j], dm * a[1][2][i][j]);
                let r_ = m.mul_add(a[2][1][i][j], dm * a[2][2][i][j]);
                for c in 0..N {
                    let (m, dm) = (plain(value[c]), plain(slope[c]));
                    let t = &mut wall[(c * N + d) * 9 + 3 * i + j][qz];
                    t[0] = m.mul_add(zz, t[0]);
                    t[1] = m.mul_add(z_, t[1]);
                    t[2] = m.mul_add(s_z, dm.mul_add(r_z, t[2]));
                    t[3] = m.mul_add(s_, dm.mul_add(r_, t[3]));
                }
            }
        }
    }
}

/// Adds up along the tube, for one (c, i) and (c', j), and leaves the numbers in the slab.
#[inline(always)]
pub fn add_along<S: Simd, const N: usize>(
    simd: S,
    out: &mut SlabTangent,
    slab: &Slab,
    m: usize,
    wall: &[[f64x8<S>; 4]; N],
    (row, column): (usize, usize),
    same: bool,
) {
    let (rows, zero) = (out.rows, f64x8::splat(simd, 0.0));
    for a in 0..N {
        let mut of_slope = [zero; N];
        let mut of_value = [zero; N];
        for qz in 0..N {
            let n = slab.value[qz * N + a].load(simd);
            let dn = slab.slope[qz * N + a].load(simd);
            let [t11, t10, t01, t00] = wall[qz];
            of_slope[qz] = Real::mul_add(dn, t11, n * t01);
            of_value[qz] = Real::mul_add(dn, t10, n * t00);
        }
        // For r = s the part above the diagonal follows by symmetry.
        for b in 0..if same { a + 1 } else { N } {
            let mut k = zero;
            for qz in 0..N {
                let n = slab.value[qz * N + b].load(simd);
                let dn = slab.slope[qz * N + b].load(simd);
                k = Real::mul_add(of_slope[qz], dn, Real::mul_add(of_value[qz], n, k));
            }
            if a >= b {
                let at = (((a - b) * m + column) * m + row) * rows + b;
                add_lanes(&mut out.entries[at..], k, slab.elements);
            }
            if a <= b && !same {
                let at = (((b - a) * m + row) * m + column) * rows + a;
                add_lanes(&mut out.entries[at..], k, slab.elements);
            }
        }
    }
}

/// Adds the lanes that hold elements to consecutive numbers.
#[inline(always)]
fn add_lanes<S: Simd>(to: &mut [f64], lanes: f64x8<S>, elements: usize) {
    match to.first_chunk_mut::<LANES>() {
        Some(to) if elements == LANES => {
            let sum = f64x8::simd_from(lanes.simd, *to) + lanes;
            *to = sum.into();
        }
        _ => {
            for (to, x) in to.iter_mut().zip(&Lanes::store(lanes).0[..elements]) {
                *to += x;
            }
        }
    }
}
