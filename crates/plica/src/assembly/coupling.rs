//! The tangent on a few low harmonics of a tube of many rings, coupled as a state that is not
//! axisymmetric couples them.
//!
//! Displacements of harmonics 0 to H, quadratic through the wall, as fine along the tube as it is:
//! E x, with x the amplitudes of (1, t, t²) × (axial, radial, circumferential) × (cos nφ, sin nφ)
//! at each row of control points. The matrix Eᵀ K E is block-banded, with blocks of
//! m = 9 (2H + 1). These are the soft motions of a thin wall, and what the average around the tube
//! knows least.
//!
//! It is integrated at two points along each element, four through the wall and one in the middle
//! of each element around (where sums over periodic functions converge fastest). Per such set of
//! points around, projecting the moduli costs 2·9·k·(3 (2H+1))² multiply-adds.

use super::SplineTube;
use super::pencil::{AVERAGED, PencilInput, pencil_moduli};
use super::ring_damping::RingDamping;
use super::spline_tube::{with_degree, with_law_and_degree};
use super::tables::{Around, Layer, Slab};
use crate::material::Material;
use crate::matrix::{BlockBanded, multiply};
use crate::rings::Turn;
use crate::spline::gauss_legendre;
use crate::tube::Load;
use rayon::prelude::*;

/// Quadrature points along an element and through the wall.
const POINTS: [usize; 2] = [2, 4];

/// Functions through the wall: 1, t, t².
const THROUGH: usize = 3;

/// The low harmonics of a tube, and what is needed to project on them.
#[derive(Clone, Debug)]
pub struct LowHarmonics {
    /// H, in harmonics of the sector.
    pub highest: usize,
    /// Control values through the wall of 1, t, t²: point by point.
    pub through: Vec<[f64; THROUGH]>,
    pub(super) slabs: Vec<Slab>,
    points: Vec<Layer>,
    pub(super) middle: [Around; 1],
    /// 1, t, t² at the points through the wall, and their slopes.
    wall: Vec<([f64; THROUGH], [f64; THROUGH])>,
    /// What the amplitudes (mode, component) displace in each element's frame, and its slope
    /// around: rows of (element, component).
    pub(super) waves: [Vec<f64>; 2],
}

impl LowHarmonics {
    /// Harmonics 0 to `highest` of the sector of a tube, as far as its rings resolve them.
    pub fn new(tube: &SplineTube, highest: usize) -> Self {
        let k = tube.sector.rings;
        let highest = highest.min(Self::resolved(k));
        let (inner, outer) = (tube.tube.inner_radius(), crate::tube::Tube::OUTER_RADIUS);
        let t = |radius: f64| (2.0 * radius - inner - outer) / (outer - inner);
        let slope = 2.0 / (outer - inner);
        let along = vec![gauss_legendre(POINTS[0]); tube.axial.elements()];
        let points = Layer::points(&tube.wall, POINTS[1]);
        let wall = points.iter().map(|point| {
            let t = t(point.radius[0]);
            ([1.0, t, t * t], [0.0, slope, 2.0 * t * slope])
        });
        // t = slope · R + shift
        let shift = t(0.0);
        let through = tube.wall.quadratics().into_iter().map(|[one, x, xx]| {
            let square = slope * slope * xx + 2.0 * slope * shift * x + shift * shift;
            [one, slope * x + shift, square]
        });
        let through = through.collect();
        Self {
            highest,
            through,
            slabs: Slab::all(&tube.axial, &along),
            wall: wall.collect(),
            points,
            middle: [Around::at(&tube.sector, &tube.circle, 0.5, 1.0)],
            waves: [0, 1].map(|d| waves(tube, highest, d)),
        }
    }

    /// The highest harmonic of a sector of k rings whose coupling is worth having. A point to each
    /// element around integrates products of two up to k/4 times what the state varies by, up to k/2;
    /// with up to k/2 of 12 rings a tube that was hardly oval took eight times the iterations.
    pub fn resolved(rings: usize) -> usize {
        rings / 4
    }

    /// 2H + 1.
    pub fn modes(&self) -> usize {
        2 * self.highest + 1
    }

    /// Functions through the wall.
    pub fn functions(&self) -> usize {
        THROUGH
    }

    /// Unknowns of a row: numbered (function through the wall, mode, component).
    pub fn row(&self) -> usize {
        THROUGH * 3 * self.modes()
    }

    /// For every unknown of harmonic n of the sector, numbered (row, function, component), whether a
    /// support gives it. A single point that is pinned takes all functions of its row along, so that
    /// none of them moves it.
    pub fn prescribed_in_harmonic(&self, tube: &SplineTube, n: usize) -> Vec<bool> {
        let points = tube.wall.functions();
        let prescribed = tube.prescribed_in_harmonic(n * (tube.sector.around / tube.sector.rings));
        let row = |row: &[bool]| {
            let any = |i: usize| row.iter().skip(i).step_by(3).any(|prescribed| *prescribed);
            let prescribed = [0, 1, 2].map(any);
            (0..3 * THROUGH).map(move |at| prescribed[at % 3])
        };
        prescribed.chunks_exact(3 * points).flat_map(row).collect()
    }

    /// The same for all modes, numbered as [`LowHarmonics::row`] says.
    pub fn prescribed(&self, tube: &SplineTube) -> Vec<bool> {
        let modes = self.modes();
        let harmonics: Vec<_> = (0..=self.highest)
            .map(|n| self.prescribed_in_harmonic(tube, n))
            .collect();
        (0..tube.axial.functions() * self.row())
            .map(|at| {
                let (i, mode, function) = (at % 3, at / 3 % modes, at / 3 / modes);
                harmonics[mode.div_ceil(2)][3 * function + i]
            })
            .collect()
    }

    /// Adds α Eᵀ C E.
    pub fn add_drag(
        &self,
        tube: &SplineTube,
        damping: &RingDamping,
        alpha: f64,
        matrix: &mut BlockBanded,
    ) {
        let (points, rows) = (tube.wall.functions(), tube.axial.functions());
        let repeats = tube.sector.around / tube.sector.rings;
        for mode in 0..self.modes() {
            let n = mode.div_ceil(2);
            let waves = if n == 0 { 1.0 } else { 0.5 } * tube.sector.rings as f64;
            let mut block = BlockBanded::zeros(rows, points * 3, tube.degree());
            damping.add_harmonic(alpha * waves, n * repeats, &mut block);
            self.project(
                &block,
                |row, column| {
                    let place = |(c, i): (usize, usize)| (c * self.modes() + mode) * 3 + i;
                    (place(row), place(column))
                },
                matrix,
            );
        }
    }

    /// Adds Tᵀ B T of a matrix of one ring, T the functions through the wall, at the places that are
    /// given for (function, component) of row and column.
    pub fn project(
        &self,
        block: &BlockBanded,
        place: impl Fn((usize, usize), (usize, usize)) -> (usize, usize),
        into: &mut BlockBanded,
    ) {
        let m = block.size();
        for j in 0..block.blocks() {
            for d in 0..=block.band().min(block.blocks() - 1 - j) {
                // B T, then Tᵀ of it.
                let mut right = vec![[0.0; THROUGH * 3]; m];
                for (row, right) in right.iter_mut().enumerate() {
                    for column in 0..m {
                        let entry = block.in_block(j, d, row, column);
                        for c in 0..THROUGH {
                            right[3 * c + column % 3] += entry * self.through[column / 3][c];
                        }
                    }
                }
                for c in 0..THROUGH {
                    for i in 0..3 {
                        for at in 0..THROUGH * 3 {
                            let rows = right.iter().enumerate().skip(i).step_by(3);
                            let sum = rows.map(|(row, right)| self.through[row / 3][c] * right[at]);
                            let (row, column) = place((c, i), (at / 3, at % 3));
                            into.add_at(j, d, row, column, sum.sum());
                        }
                    }
                }
            }
        }
    }
}

/// Rows (element, component), columns (mode, component).
fn waves(tube: &SplineTube, highest: usize, d: usize) -> Vec<f64> {
    let (sector, modes) = (&tube.sector, 2 * highest + 1);
    let repeats = sector.around / sector.rings;
    let mut out = vec![0.0; sector.rings * 3 * 3 * modes];
    for mode in 0..modes {
        let n = mode.div_ceil(2) * repeats;
        let [crest, quarter] = sector.harmonic_at(n, 0.5);
        for e in 0..sector.rings {
            // As if the first ring, not the middle of the first element, lay at angle zero.
            let phi = n as f64 * (e as f64 * sector.angle() - sector.ring_angle(0));
            let (sin, cos) = phi.sin_cos();
            let (a, b) = match mode {
                0 => (1.0, -1.0), // axial and radial as they are, and circumferential
                _ if mode % 2 == 1 => (cos, sin),
                _ => (sin, -cos),
            };
            let turn = |turn: &Turn| {
                let [p, q, r, s] = turn.plane[d];
                [[turn.axial[d], 0.0, 0.0], [0.0, p, q], [0.0, r, s]]
            };
            let (crest, quarter) = (turn(&crest), turn(&quarter));
            for j in 0..3 {
                for i in 0..3 {
                    // The axial displacement of a quarter wave has no place at n = 0.
                    let lone = mode == 0 && i < 2;
                    let value = if lone {
                        crest[j][i]
                    } else {
                        a * crest[j][i] + b * quarter[j][i]
                    };
                    out[(3 * e + j) * 3 * modes + 3 * mode + i] = value;
                }
            }
        }
    }
    out
}

impl SplineTube {
    /// Makes a matrix, of blocks of [`LowHarmonics::row`], Eᵀ K E at a state; every unknown is free.
    pub fn coupled_tangent(
        &self,
        low: &LowHarmonics,
        load: &Load,
        u: &[f64],
        matrix: &mut BlockBanded,
    ) {
        let imperfect = self.imperfect.as_ref();
        let displacement = imperfect.map(|imperfect| self.lanes.pad(&imperfect.displacement));
        let displacement = displacement.as_deref();
        let (p, size) = (self.degree(), low.row());
        matrix.clear();
        self.add_coupled_pressure(low, load, u, matrix);
        let u = self.lanes.pad(u);
        // A few slabs at a time, added up in their order.
        for slabs in low.slabs.chunks(4) {
            let parts: Vec<Vec<[Vec<f64>; 4]>> = slabs
                .par_iter()
                .map(|slab| {
                    (0..slab.elements)
                        .flat_map(|lane| {
                            self.coupled_pencil(low, (slab, lane), load, &u, displacement)
                        })
                        .collect()
                })
                .collect();
            let (first, last) = (slabs[0].first, slabs[slabs.len() - 1].first);
            let end = last + slabs[slabs.len() - 1].elements + p;
            let panels: Vec<_> = matrix.panels_mut().enumerate().collect();
            let (height, n) = ((p + 1) * size, p + 1);
            panels
                .into_par_iter()
                .filter(|(row, _)| (first..end).contains(row))
                .for_each(|(row, panel)| {
                    for (slab, parts) in slabs.iter().zip(&parts) {
                        for (at, [slopes, mixed, across, values]) in parts.iter().enumerate() {
                            let (lane, q) = (at / POINTS[0], at % POINTS[0]);
                            let Some(b) = row.checked_sub(slab.first + lane).filter(|b| *b < n)
                            else {
                                continue;
                            };
                            let value = |a: usize| slab.value[q * n + a].0[lane];
                            let slope = |a: usize| slab.slope[q * n + a].0[lane];
                            for a in b..n {
                                let [f, g, h, k] = [
                                    slope(a) * slope(b),
                                    slope(a) * value(b),
                                    value(a) * slope(b),
                                    value(a) * value(b),
                                ];
                                for column in 0..size {
                                    let to = &mut panel[column * height + (a - b) * size..][..size];
                                    let from = column * size..(column + 1) * size;
                                    let own =
                                        slopes[from.clone()].iter().zip(&values[from.clone()]);
                                    let both = mixed[from.clone()].iter().zip(&across[from]);
                                    for ((to, (s, v)), (m, t)) in to.iter_mut().zip(own).zip(both) {
                                        *to += f * s + k * v + g * m + h * t;
                                    }
                                }
                            }
                        }
                    }
                });
        }
    }

    /// Of every point along an element: the sums through the wall and around it that go with the
    /// slopes of row and column along the tube, with the slope of the row and the value of the
    /// column, with the value of the row and the slope of the column, and with both values; column
    /// by column.
    fn coupled_pencil(
        &self,
        low: &LowHarmonics,
        (slab, lane): (&Slab, usize),
        load: &Load,
        u: &[f64],
        displacement: Option<&[f64]>,
    ) -> Vec<[Vec<f64>; 4]> {
        let (k, padded) = (self.sector.rings, self.lanes.padded);
        let row = self.wall.functions() * 3 * padded;
        let stretch = self.pencil_stretch(slab, lane, &low.middle, load);
        let shape =
            displacement.map(|u| self.pencil_shape(slab, lane, &low.points, &low.middle, u));
        let input = PencilInput {
            slab,
            lane,
            layers: &low.points,
            around: &low.middle,
            points: self.wall.functions(),
            rings: &self.lanes,
            inverse_stretch: &stretch,
            stress_free: shape.as_deref(),
            u: &u[(slab.first + lane) * row..][..(self.degree() + 1) * row],
        };
        let mut moduli = vec![0.0; POINTS[0] * POINTS[1] * AVERAGED * padded];
        with_law_and_degree!(self, self.tube.material, pencil_moduli, &input, &mut moduli);

        let (columns, size) = (3 * low.modes(), low.row());
        let mut moved = vec![0.0; 3 * k * 3 * columns];
        let mut sums = [
            vec![0.0; 3 * columns * columns],
            vec![0.0; 2 * columns * columns],
            vec![0.0; columns * columns],
        ];
        let mut moduli = moduli.chunks_exact(AVERAGED * padded);
        (0..POINTS[0])
            .map(|_| {
                let mut out = [0, 1, 2].map(|_| vec![0.0; size * size]);
                for ((value, slope), moduli) in low.wall.iter().zip(moduli.by_ref()) {
                    // Blocks (ζ,ζ) (ζ,s) (ζ,R); (s,s) (s,R); (R,R).
                    let mut block = 0;
                    for (alpha, sum) in sums.iter_mut().enumerate() {
                        let width = (3 - alpha) * columns;
                        for beta in alpha..3 {
                            let wave = &low.waves[usize::from(beta == 1)];
                            for e in 0..k {
                                let A: [f64; 9] =
                                    std::array::from_fn(|x| moduli[(9 * block + x) * padded + e]);
                                let from = &wave[3 * e * columns..][..3 * columns];
                                for j in 0..3 {
                                    let to = (3 * e + j) * width + (beta - alpha) * columns;
                                    let to = &mut moved[to..to + columns];
                                    for (x, to) in to.iter_mut().enumerate() {
                                        *to = A[3 * j] * from[x]
                                            + A[3 * j + 1] * from[columns + x]
                                            + A[3 * j + 2] * from[2 * columns + x];
                                    }
                                }
                            }
                            block += 1;
                        }
                        let wave = &low.waves[usize::from(alpha == 1)];
                        multiply(
                            (wave, [columns, 3 * k], [1, columns]),
                            (&moved[..3 * k * width], [3 * k, width], [width, 1]),
                            (sum, [1, columns]),
                        );
                    }
                    add_through(&sums, columns, value, slope, &mut out);
                }
                let [slopes, mixed, values] = out;
                let transposed = |at: usize| mixed[at % size * size + at / size];
                let across = (0..size * size).map(transposed).collect();
                [slopes, mixed, across, values]
            })
            .collect()
    }
}

/// Adds what a point through the wall contributes to the three sums of [`SplineTube::coupled_pencil`].
fn add_through(
    sums: &[Vec<f64>; 3],
    n: usize,
    value: &[f64; THROUGH],
    slope: &[f64; THROUGH],
    out: &mut [Vec<f64>; 3],
) {
    let size = THROUGH * n;
    let [along, around, through] = sums;
    for d in 0..THROUGH {
        for column in 0..n {
            let of = |sum, block| &Vec::as_slice(sum)[block * n * n + column * n..][..n];
            let (zz, zs, zr) = (of(along, 0), of(along, 1), of(along, 2));
            let (ss, sr, rr) = (of(around, 0), of(around, 1), of(through, 0));
            for c in 0..THROUGH {
                let at = (d * n + column) * size + c * n;
                let (m, dm, m2, dm2) = (value[c], slope[c], value[d], slope[d]);
                for row in 0..n {
                    let rs = around[n * n + row * n + column];
                    out[0][at + row] += m * m2 * zz[row];
                    out[1][at + row] += m * (m2 * zs[row] + dm2 * zr[row]);
                    out[2][at + row] +=
                        m * (m2 * ss[row] + dm2 * sr[row]) + dm * (m2 * rs + dm2 * rr[row]);
                }
            }
        }
    }
}
