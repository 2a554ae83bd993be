//! Assembled tangent stiffness of an axial batch.
//!
//! Sum factorisation: at every point the moduli are pulled back to gradients over (ζ, s, R) and
//! rotated to the distinct rings of the element; the results are summed around the element, then
//! through the wall, then along the tube. With N = p + 1 functions per direction and one ring
//! (axisymmetric), an element takes about 500 N³ multiply-adds at the points, 9 N³ (9 + 6 N)
//! through the wall and 9 N⁴ (N + 5) along the tube: 7.2e4 for cubics, where the product BᵀAB would
//! take 9e5.

use super::super::blocks::{Block, add_rotated, mirror};
use super::super::tables::AxialBatch;
use super::{Input, contract_along, contract_through, gradients};
use crate::material::Law;
use crate::matrix::BlockBanded;
use crate::rings::Rotation;
use crate::tensor::{LANES, Lanes, Real, with_vectors};
use fearless_simd::{Simd, SimdBase, SimdFrom, f64x8};

/// K of a batch, the lower half by rows of control points. For every row of the batch, entry
/// (`row`, `column`) of the block `d` rows below the diagonal is at `((d * m + column) * m + row) *
/// rows`, where m is the size of a row. Diagonal blocks are full.
#[derive(Clone, Debug, Default)]
pub struct BatchTangent {
    /// The entries.
    pub entries: Vec<f64>,
    /// Number of rows of control points.
    pub rows: usize,
}

impl BatchTangent {
    /// Adds the batch to the rows of a matrix from `first` on; rows hold `m` unknowns, and degree p
    /// couples p + 1 of them.
    pub fn add_to(&self, matrix: &mut BlockBanded, first: usize, m: usize, p: usize) {
        let indices: Vec<usize> = (0..(p + 1) * m * m)
            .map(|i| matrix.place(i / (m * m), i % m, i / m % m))
            .collect();
        let panels = matrix.panels_mut().skip(first).take(self.rows);
        for (row, panel) in panels.enumerate() {
            for (&place, entry) in indices.iter().zip(self.entries.chunks_exact(self.rows)) {
                panel[place] += entry[row];
            }
        }
    }
}

/// Returns the pairs of local ring indices r ≤ r', in the order of storage.
fn pairs(local_rings: usize) -> Vec<(usize, usize)> {
    (0..local_rings)
        .flat_map(|r| (r..local_rings).map(move |s| (r, s)))
        .collect()
}

/// Computes the tangent of an axial batch. `N` is the degree plus one.
///
/// `rotations` holds, for every point around an element, sets of ring rotations; the tangent is the
/// sum over the sets. The tangent of a sector has one set, the element's distinct rings; that of a
/// harmonic has two of one ring each (see [`crate::rings::Sector::harmonic_at`]).
pub fn tangent<L: Law, const N: usize>(
    law: &L,
    input: &Input<'_>,
    rotations: &[Vec<Vec<Rotation>>],
) -> BatchTangent {
    with_vectors!(wide if L::WIDE_VECTORS_ONLY, simd => kernel::<_, L, N>(simd, law, input, rotations))
}

#[inline(always)]
fn kernel<S: Simd, L: Law, const N: usize>(
    simd: S,
    law: &L,
    input: &Input<'_>,
    rotations: &[Vec<Vec<Rotation>>],
) -> BatchTangent {
    let Input {
        batch,
        layers,
        around,
        ..
    } = *input;
    let (m, local_rings, rows) = (
        input.row_size(),
        around[0].ring_values.len(),
        batch.elements + N - 1,
    );
    let mut out = BatchTangent {
        entries: vec![0.0; N * m * m * rows],
        rows,
    };
    let pairs = pairs(local_rings);
    let zero = f64x8::splat(simd, 0.0);

    let mut u = vec![[zero; 3]; N * N * local_rings];
    let mut along = vec![[[zero; 3]; 2]; N * local_rings];
    let mut through = vec![[[zero; 3]; 3]; local_rings];
    // Per pair of rings: moduli on (ζ, s, R) × (ζ, s, R) after the sum around.
    let mut rotated = vec![[[[[zero; 3]; 3]; 3]; 3]; pairs.len()];
    // Per pair, (c, c', i, j) and point along the tube, after the sum through the wall: the parts
    // that multiply (N', N'), (N', N), (N, N'), (N, N) along the tube.
    let mut wall = vec![[[zero; 4]; N]; pairs.len() * N * N * 9];

    for (t, layer) in layers.iter().enumerate() {
        for element in 0..input.rings {
            input.gather::<S, N>(simd, layer, element, &mut u);
            for qz in 0..N {
                let [inverse_along, inverse_around] = input.stretch(simd, qz);
                let along_point = (qz, [inverse_along, inverse_around]);
                let weight = batch.weight[qz].load(simd) / (inverse_along * inverse_around);
                contract_along::<S, N>(simd, batch, qz, &u, &mut along);
                for entry in &mut wall {
                    entry[qz] = [zero; 4];
                }
                for qr in 0..N {
                    contract_through::<S, N>(simd, layer, qr, &along, &mut through);
                    rotated.fill([[[[zero; 3]; 3]; 3]; 3]);
                    let radius = layer.radius[qr];
                    for (qs, (point, rotations)) in around.iter().zip(rotations).enumerate() {
                        let gradient_map =
                            input.gradient_map(simd, along_point, [t, element], [qr, qs]);
                        let Fe = gradient_map.elastic_gradient(
                            point,
                            radius,
                            gradients(simd, point, &through),
                        );
                        let grown = weight.times(layer.weight[qr] * point.volume(radius)); // det Fp dV₀
                        let grown =
                            gradient_map.grown_volume(gradient_map.stress_free_volume(grown));
                        let blocks = gradient_map.pull_back_moduli(&law.moduli(&Fe), grown);
                        for set in rotations {
                            for (rotated, &(r, s)) in rotated.iter_mut().zip(&pairs) {
                                add_rotated(rotated, &blocks, &set[r], &set[s], r == s);
                            }
                        }
                    }
                    for (k, (rotated, &(r, s))) in rotated.iter_mut().zip(&pairs).enumerate() {
                        if r == s {
                            mirror(rotated);
                        }
                        let wall = &mut wall[k * N * N * 9..][..N * N * 9];
                        let (value, slope) =
                            (&layer.value[qr * N..][..N], &layer.slope[qr * N..][..N]);
                        add_through::<_, N>(wall, qz, rotated, value, slope);
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
                                let indices = (
                                    input.index(layer.first + c, i, ring_r),
                                    input.index(layer.first + d, j, ring_s),
                                );
                                add_along::<S, N>(simd, &mut out, batch, m, wall, indices, r == s);
                            }
                        }
                    }
                }
            }
        }
    }
    out
}

/// Adds the contribution of one point through the wall to every (c, c', i, j).
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

/// Sums along the tube for one (c, i) and (c', j), and adds the entries to the batch.
#[inline(always)]
pub fn add_along<S: Simd, const N: usize>(
    simd: S,
    out: &mut BatchTangent,
    batch: &AxialBatch,
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
            let n = batch.value[qz * N + a].load(simd);
            let dn = batch.slope[qz * N + a].load(simd);
            let [t11, t10, t01, t00] = wall[qz];
            of_slope[qz] = Real::mul_add(dn, t11, n * t01);
            of_value[qz] = Real::mul_add(dn, t10, n * t00);
        }
        // For r = s the part above the diagonal follows from symmetry.
        for b in 0..if same { a + 1 } else { N } {
            let mut k = zero;
            for qz in 0..N {
                let n = batch.value[qz * N + b].load(simd);
                let dn = batch.slope[qz * N + b].load(simd);
                k = Real::mul_add(of_slope[qz], dn, Real::mul_add(of_value[qz], n, k));
            }
            if a >= b {
                let at = (((a - b) * m + column) * m + row) * rows + b;
                add_lanes(&mut out.entries[at..], k, batch.elements);
            }
            if a <= b && !same {
                let at = (((b - a) * m + row) * m + column) * rows + a;
                add_lanes(&mut out.entries[at..], k, batch.elements);
            }
        }
    }
}

/// Adds the lanes that hold elements to consecutive entries.
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
