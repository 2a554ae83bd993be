//! A coarse space of low circumferential harmonics for tubes of many rings.
//!
//! The space holds displacements E x of harmonics 0 to H, quadratic through the wall, with the full
//! resolution along the tube; x are the amplitudes of (1, t, t²) × (axial, radial, circumferential)
//! × (cos nφ, sin nφ) at each row of control points. The matrix Eᵀ K E is block-banded, with blocks
//! of size m = 9 (2H + 1). These are the soft motions of a thin wall, which the average around the
//! tube represents worst at a state that is not axisymmetric.
//!
//! The quadrature has four points through each layer of the wall and one in the middle of each element around,
//! where sums over periodic functions converge fastest. Along each element it has two points, or more
//! on a mesh of few elements: with fewer points than functions along the tube, displacements that
//! vanish at all of them, or whose slopes do, would have little energy or none. For each set of points
//! around, projecting the moduli takes 2·9·k·(3 (2H+1))² multiply-adds.

use super::SplineTube;
use super::ring_damping::RingDamping;
use super::tables::{AxialBatch, CircumferentialPoint, Layer};
use crate::matrix::{BlockBanded, FarBlocks};
use crate::rings::Rotation;
use crate::spline::gauss_legendre;

/// Quadrature points through a layer of the wall.
pub(super) const POINTS_THROUGH: usize = 4;

/// Number of functions through the wall: 1, t, t².
pub(super) const THROUGH: usize = 3;

/// The low harmonics of a tube, with the tables for the projection.
#[derive(Clone, Debug)]
pub struct LowHarmonics {
    /// H, the highest harmonic of the sector.
    pub highest: usize,
    /// Control values of 1, t, t² at each control point through the wall.
    pub through: Vec<[f64; THROUGH]>,
    /// Number of quadrature points along an element.
    pub(super) points_along: usize,
    pub(super) batches: Vec<AxialBatch>,
    /// The layers of the wall.
    pub(super) layers: Vec<LayerPoints>,
    pub(super) middle: [CircumferentialPoint; 1],
    /// Displacement of the amplitudes (mode, component) in each element's frame, and its slope
    /// around: rows of (element, component).
    pub(super) waves: [Vec<f64>; 2],
}

/// The points through a layer of the wall.
#[derive(Clone, Debug)]
pub(super) struct LayerPoints {
    pub points: Vec<Layer>,
    /// 1, t, t² at the points, and their slopes.
    pub wall: Vec<([f64; THROUGH], [f64; THROUGH])>,
}

impl LowHarmonics {
    /// Returns harmonics 0 to `highest` of the sector of a tube, as far as its rings resolve them.
    pub fn new(tube: &SplineTube, highest: usize) -> Self {
        let k = tube.sector.rings;
        let highest = highest.min(Self::highest_resolved(k));
        let (inner, outer) = (tube.tube.inner_radius(), crate::tube::Tube::OUTER_RADIUS);
        let t = |radius: f64| (2.0 * radius - inner - outer) / (outer - inner);
        let slope = 2.0 / (outer - inner);
        let points_along = points_along(tube.degree(), tube.axial.elements());
        let along = vec![gauss_legendre(points_along); tube.axial.elements()];
        let of_layer = |part: &SplineTube| {
            let [first, last] = [0, part.layers.len() - 1].map(|i| part.layers[i].element);
            let points = Layer::points(&tube.wall, first..last + 1, POINTS_THROUGH);
            let wall = points.iter().map(|point| {
                let t = t(point.radius[0]);
                ([1.0, t, t * t], [0.0, slope, 2.0 * t * slope])
            });
            LayerPoints {
                wall: wall.collect(),
                points: tube.with_residual(part.wall_layer, points),
            }
        };
        let parts = tube.all_parts().filter(|part| !part.is_volumetric());
        let layers = parts.map(of_layer).collect();
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
            points_along,
            batches: AxialBatch::all(&tube.axial, &along),
            layers,
            middle: [CircumferentialPoint::at(
                &tube.sector,
                &tube.circle,
                0.5,
                1.0,
            )],
            waves: [0, 1].map(|d| waves(tube, highest, d, 0.5)),
        }
    }

    /// Returns the highest harmonic that a sector of k rings resolves. One point per element around
    /// integrates products of two harmonics up to k/4 times variations of the state up to k/2; with
    /// harmonics up to k/2 of 12 rings, a slightly oval tube took eight times the iterations.
    pub fn highest_resolved(rings: usize) -> usize {
        rings / 4
    }

    /// Returns the displacement of the amplitudes (mode, component) at a place in each element around, from 0 to 1, like
    /// `waves`.
    pub(super) fn waves_at(&self, tube: &SplineTube, s: f64) -> Vec<f64> {
        waves(tube, self.highest, 0, s)
    }

    /// Returns the number of modes, 2H + 1.
    pub fn modes(&self) -> usize {
        2 * self.highest + 1
    }

    /// Returns the number of functions through the wall.
    pub fn functions(&self) -> usize {
        THROUGH
    }

    /// Returns the number of unknowns in a row, numbered (function through the wall, mode,
    /// component).
    pub fn row_size(&self) -> usize {
        THROUGH * 3 * self.modes()
    }

    /// Returns for every unknown of harmonic n of the sector, numbered (row, function, component),
    /// whether it is prescribed. A single constrained point prescribes all functions of its row, so
    /// that none of them moves it. Functions beyond the number of control points through the wall
    /// depend on the others, and count as prescribed.
    pub fn prescribed_in_harmonic(&self, tube: &SplineTube, n: usize) -> Vec<bool> {
        let points = tube.wall.functions();
        let prescribed = tube.prescribed_in_harmonic(n * (tube.sector.around / tube.sector.rings));
        let row = |row: &[bool]| {
            let any = |i: usize| row.iter().skip(i).step_by(3).any(|prescribed| *prescribed);
            let prescribed = [0, 1, 2].map(any);
            (0..3 * THROUGH).map(move |at| prescribed[at % 3] || at / 3 >= points)
        };
        prescribed.chunks_exact(3 * points).flat_map(row).collect()
    }

    /// Returns the same for all modes, numbered like [`LowHarmonics::row_size`].
    pub fn prescribed(&self, tube: &SplineTube) -> Vec<bool> {
        let modes = self.modes();
        let harmonics: Vec<_> = (0..=self.highest)
            .map(|n| self.prescribed_in_harmonic(tube, n))
            .collect();
        (0..tube.axial.functions() * self.row_size())
            .map(|at| {
                let (i, mode, function) = (at % 3, at / 3 % modes, at / 3 / modes);
                harmonics[mode.div_ceil(2)][3 * function + i]
            })
            .collect()
    }

    /// Adds α Eᵀ C E.
    pub fn add_damping(
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
                    let index = |(c, i): (usize, usize)| (c * self.modes() + mode) * 3 + i;
                    (index(row), index(column))
                },
                matrix,
            );
        }
    }

    /// Adds Tᵀ B T for a matrix B of one ring, with T the functions through the wall. `place`
    /// returns the indices for (function, component) of row and column.
    pub fn project(
        &self,
        block: &BlockBanded,
        index: impl Fn((usize, usize), (usize, usize)) -> (usize, usize),
        into: &mut BlockBanded,
    ) {
        for j in 0..block.blocks() {
            for d in 0..=block.band().min(block.blocks() - 1 - j) {
                let entry = |row: usize, column: usize| block.in_block(j, d, row, column);
                self.project_block(block.size(), entry, |row, column, value| {
                    let (row, column) = index(row, column);
                    into.add_at(j, d, row, column, value);
                });
            }
        }
    }

    /// Adds Tᵀ B T for the blocks B outside the band of a matrix of one ring, numbered by function and component.
    pub fn project_far(&self, far: &FarBlocks, into: &mut FarBlocks) {
        let (m, size) = (far.size(), into.size());
        for ((i, j), block) in far.blocks() {
            let entry = |row: usize, column: usize| block[column * m + row];
            self.project_block(m, entry, |(c, i_row), (d, i_column), value| {
                into.add_at(i * size + 3 * c + i_row, j * size + 3 * d + i_column, value);
            });
        }
    }

    /// Calls `add` with the entries of Tᵀ B T for one m × m block B: (function, component) of row and column, and value.
    fn project_block(
        &self,
        m: usize,
        entry: impl Fn(usize, usize) -> f64,
        mut add: impl FnMut((usize, usize), (usize, usize), f64),
    ) {
        // B T, then Tᵀ of it.
        let mut right = vec![[0.0; THROUGH * 3]; m];
        for (row, right) in right.iter_mut().enumerate() {
            for column in 0..m {
                let entry = entry(row, column);
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
                    add((c, i), (at / 3, at % 3), sum.sum());
                }
            }
        }
    }
}

/// Returns the number of quadrature points along each of n elements of degree p: two, or more on few
/// elements, so that the tube has as many points as functions, n + p.
fn points_along(degree: usize, elements: usize) -> usize {
    (elements + degree).div_ceil(elements).max(2)
}

/// Returns the displacement of each mode (`d` = 0) or its slope around (1) at a place in each element around: rows
/// (element, component), columns (mode, component).
fn waves(tube: &SplineTube, highest: usize, d: usize, s: f64) -> Vec<f64> {
    let (sector, modes) = (&tube.sector, 2 * highest + 1);
    let repeats = sector.around / sector.rings;
    let mut out = vec![0.0; sector.rings * 3 * 3 * modes];
    for mode in 0..modes {
        let n = mode.div_ceil(2) * repeats;
        let [crest, quarter] = sector.harmonic_at(n, s);
        for e in 0..sector.rings {
            // Measured from the first ring, not from the middle of the first element.
            let phi = n as f64 * (e as f64 * sector.angle() - sector.ring_angle(0));
            let (sin, cos) = phi.sin_cos();
            let (a, b) = match mode {
                0 => (1.0, -1.0), // axial and radial as they are, and circumferential
                _ if mode % 2 == 1 => (cos, sin),
                _ => (sin, -cos),
            };
            let turn = |turn: &Rotation| {
                let [p, q, r, s] = turn.plane[d];
                [[turn.axial[d], 0.0, 0.0], [0.0, p, q], [0.0, r, s]]
            };
            let (crest, quarter) = (turn(&crest), turn(&quarter));
            for j in 0..3 {
                for i in 0..3 {
                    // The axial displacement of a quarter wave does not exist at n = 0.
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
