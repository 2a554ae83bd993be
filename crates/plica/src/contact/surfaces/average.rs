//! The tangent of pairs, averaged around the tube.
//!
//! Averaged over the rotations of the tube by a ring and its mirror images, the tangent is block-circulant: see
//! `rings::Circulant`. Contact couples any two rows and any two rings.

use super::net::FaceNet;
use super::pairs::Pair;
use super::vector::{Vector, dot};
use crate::matrix::CoupledBanded;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

type Block = [[f64; 3]; 3];

/// The averaged tangent of the pairs of a face: K_d, by row, by column, and by d, the number of rings from the ring of the row
/// to that of the column.
#[derive(Clone, Debug)]
pub struct AverageContact {
    blocks: BTreeMap<(usize, usize), Vec<Block>>,
    /// Rings of the sector.
    rings: usize,
    /// Control point through the wall, and unknowns of a row of one ring.
    point: usize,
    row_size: usize,
}

/// A displacement of one component of one ring as it enters a pair, per unit of the functions along the tube.
type Column = [f64; 5];

impl AverageContact {
    /// Averages the tangent of pairs; `row_size` is the number of unknowns of a row of one ring.
    pub fn new(net: &FaceNet, pairs: &[Pair], row_size: usize) -> Self {
        let mut average = Self {
            blocks: BTreeMap::new(),
            rings: net.rings,
            point: net.point,
            row_size,
        };
        let share = 1.0 / net.rings as f64;
        let (n, p) = (net.degree + 1, net.degree);
        // The part with both functions at x depends on the place along the tube in its last factor only.
        let mut both_at_x: BTreeMap<(usize, usize), (Pair, Vec<Block>)> = BTreeMap::new();
        for pair in pairs {
            let [x, y] = pair.patches.map(|patch| net.elements_of(patch));
            let columns = Columns::of(net, pair);
            let apart = |a: &[[Column; 3]], b: &[[Column; 3]]| {
                // K_d for d from −p to p, of two families of columns.
                let mut sums = vec![[[0.0; 3]; 3]; 2 * p + 1];
                for (i, a) in a.iter().enumerate() {
                    let stiff = a.map(|a| pair.stiffness.map(|row| product(&row, &a)));
                    for (j, b) in b.iter().enumerate() {
                        let sum = &mut sums[p + j - i];
                        for (sum, stiff) in sum.iter_mut().zip(&stiff) {
                            for (sum, b) in sum.iter_mut().zip(b) {
                                *sum += share * product(stiff, b);
                            }
                        }
                    }
                }
                sums
            };
            let (moved, turned) = (&columns.of_values[..n], &columns.of_slopes[..n]);
            let at_x = &columns.at_x[..n];
            let own = apart(at_x, at_x);
            let (_, sums) = both_at_x
                .entry((x[0], pair.along))
                .or_insert_with(|| (*pair, vec![[[0.0; 3]; 3]; 2 * p + 1]));
            for (sum, own) in sums.iter_mut().zip(&own) {
                add(sum, 1.0, own);
            }
            let (value_x, [value_y, slope_y]) = (pair.functions[0][0][0], pair.functions[1][0]);
            let mixed = [apart(at_x, moved), apart(at_x, turned)];
            // Rings from x to y.
            let between = (y[1] + net.around - x[1]) % net.around;
            for a in 0..n {
                for b in 0..n {
                    for d in 0..=2 * p {
                        let mut block = [[0.0; 3]; 3];
                        add(&mut block, value_x[a] * value_y[b], &mixed[0][d]);
                        add(&mut block, value_x[a] * slope_y[b], &mixed[1][d]);
                        let rings = (between + d + net.around - p) % net.rings;
                        average.add_pair((x[0] + a, y[0] + b), rings, &block);
                    }
                }
            }
            let own = [
                apart(moved, moved),
                apart(moved, turned),
                apart(turned, moved),
                apart(turned, turned),
            ];
            for a in 0..n {
                for b in 0..=a {
                    let factors = [
                        value_y[a] * value_y[b],
                        value_y[a] * slope_y[b],
                        slope_y[a] * value_y[b],
                        slope_y[a] * slope_y[b],
                    ];
                    for d in 0..=2 * p {
                        let mut block = [[0.0; 3]; 3];
                        for (own, factor) in own.iter().zip(factors) {
                            add(&mut block, factor, &own[d]);
                        }
                        average.add_block(
                            (y[0] + a, y[0] + b),
                            (d + net.around - p) % net.rings,
                            &block,
                        );
                    }
                }
            }
        }
        for ((e, _), (pair, sums)) in &both_at_x {
            let values = pair.functions[0][0][0];
            for a in 0..n {
                for b in 0..=a {
                    for (d, sum) in sums.iter().enumerate() {
                        let mut block = [[0.0; 3]; 3];
                        add(&mut block, values[a] * values[b], sum);
                        average.add_block((e + a, e + b), (d + net.around - p) % net.rings, &block);
                    }
                }
            }
        }
        average
    }

    /// Adds a block that couples a row with one below or equal to it, d rings on.
    fn add_block(&mut self, rows: (usize, usize), d: usize, block: &Block) {
        let rings = self.rings;
        let blocks = self.blocks.entry(rows);
        add(
            &mut blocks.or_insert_with(|| vec![[[0.0; 3]; 3]; rings])[d],
            1.0,
            block,
        );
    }

    /// Adds a block that couples any two rows, d rings apart, and its mirror image.
    fn add_pair(&mut self, (row, column): (usize, usize), d: usize, block: &Block) {
        let back = (self.rings - d) % self.rings;
        let transposed = || [0, 1, 2].map(|i| [0, 1, 2].map(|j| block[j][i]));
        if row >= column {
            self.add_block((row, column), d, block);
        }
        if row <= column {
            self.add_block((column, row), back, &transposed());
        }
    }

    /// Adds the block of a circumferential harmonic of the sector to a matrix of one ring.
    pub fn add_harmonic(&self, harmonic: usize, matrix: &mut CoupledBanded) {
        let turns: Vec<(f64, f64)> = (0..self.rings)
            .map(|d| (TAU * (harmonic * d % self.rings) as f64 / self.rings as f64).sin_cos())
            .collect();
        for ((row, column), blocks) in &self.blocks {
            let mut sum = [[0.0; 3]; 3];
            for (block, (sin, cos)) in blocks.iter().zip(&turns) {
                for i in 0..3 {
                    for j in 0..3 {
                        let factor = match (i == 2, j == 2) {
                            (false, true) => -sin,
                            (true, false) => *sin,
                            _ => *cos,
                        };
                        sum[i][j] += factor * block[i][j];
                    }
                }
            }
            let [row, column] = [row, column].map(|row| row * self.row_size + 3 * self.point);
            for i in 0..3 {
                for j in 0..3 {
                    if row + i >= column + j {
                        matrix.add_at(row + i, column + j, sum[i][j]);
                    }
                }
            }
        }
    }
}

/// Contributions of the rings of both elements around to the five numbers of a pair: by function around and component.
struct Columns {
    at_x: [[Column; 3]; 6],
    /// With the values of the functions along the tube at y, and with their slopes.
    of_values: [[Column; 3]; 6],
    of_slopes: [[Column; 3]; 6],
}

impl Columns {
    fn of(net: &FaceNet, pair: &Pair) -> Self {
        let nothing = [[[0.0; 5]; 3]; 6];
        let mut columns = Self {
            at_x: nothing,
            of_values: nothing,
            of_slopes: nothing,
        };
        let [x, y] = pair.patches.map(|patch| net.elements_of(patch)[1]);
        let around = pair.functions.map(|functions| functions[1]);
        for b in 0..=net.degree {
            for (i, axis) in axes(net, x, b).into_iter().enumerate() {
                let [z, x, y] = axis.map(|d| around[0][0][b] * d);
                columns.at_x[b][i] = [z, x, y, 0.0, 0.0];
            }
            for (i, axis) in axes(net, y, b).into_iter().enumerate() {
                let (value, slope, along) =
                    (around[1][0][b], around[1][1][b], dot(pair.normal, axis));
                let [z, x, y] = axis.map(|d| -value * d);
                columns.of_values[b][i] = [z, x, y, 0.0, slope * along];
                columns.of_slopes[b][i] = [0.0, 0.0, 0.0, value * along, 0.0];
            }
        }
        columns
    }
}

/// Returns the axial, radial and circumferential directions of a ring.
fn axes(net: &FaceNet, element: usize, b: usize) -> [Vector; 3] {
    let (sin, cos) = net.turn(net.ring(element, b));
    [[1.0, 0.0, 0.0], [0.0, cos, sin], [0.0, -sin, cos]]
}

fn product(a: &Column, b: &Column) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn add(sum: &mut Block, factor: f64, block: &Block) {
    for (sum, row) in sum.iter_mut().zip(block) {
        for (sum, x) in sum.iter_mut().zip(row) {
            *sum += factor * x;
        }
    }
}
