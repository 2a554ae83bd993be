//! Damping matrix C/η = ∫ N N dV₀ of many rings, as a product of three small matrices: along the
//! tube, through the wall, and around it.

use super::SplineTube;
use crate::matrix::BlockBanded;
use rayon::prelude::*;

/// Damping matrix C = A ⊗ W ⊗ Q with A along the tube, W through the wall, and Q around, which is
/// the same at every ring.
#[derive(Clone, Debug)]
pub struct RingDamping {
    rings: usize,
    angle: f64,
    along: Band,
    wall: Band,
    /// Q between ring j and ring j + d, d = −p to p.
    around: Vec<RingProduct>,
}

/// ∫ N_j N_{j+d} of two rings, each in its own components: of the axial components, and of the
/// plane as a complex number (radial + i circumferential).
#[derive(Clone, Copy, Debug)]
struct RingProduct {
    offset: isize,
    axial: f64,
    plane: (f64, f64),
}

/// A symmetric banded matrix: row i holds the entries (i, i − p) to (i, i + p), zero outside.
#[derive(Clone, Debug)]
struct Band {
    rows: Vec<Vec<f64>>,
}

impl Band {
    fn zeros(size: usize, p: usize) -> Self {
        Self {
            rows: vec![vec![0.0; 2 * p + 1]; size],
        }
    }

    fn add(&mut self, i: usize, j: usize, value: f64) {
        let p = self.rows[i].len() / 2;
        self.rows[i][j + p - i] += value;
    }

    /// Returns the entries of a row and their columns.
    fn row(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let (p, size) = (self.rows[i].len() / 2, self.rows.len());
        let entries = self.rows[i].iter().enumerate();
        entries.filter_map(move |(k, &entry)| {
            (i + k)
                .checked_sub(p)
                .filter(|&j| j < size)
                .map(|j| (j, entry))
        })
    }
}

impl RingDamping {
    fn new(tube: &SplineTube) -> Self {
        let (sector, p) = (&tube.sector, tube.degree());
        let (rows, points) = (tube.axial.functions(), tube.wall.functions());
        let n = p + 1;
        let mut along = Band::zeros(rows, p);
        for batch in &tube.batches {
            for l in 0..batch.elements {
                for q in 0..n {
                    let value = |a: usize| batch.value[q * n + a].0[l];
                    for a in 0..n {
                        for b in 0..n {
                            let e = batch.first + l;
                            along.add(e + a, e + b, batch.weight[q].0[l] * value(a) * value(b));
                        }
                    }
                }
            }
        }
        let mut wall = Band::zeros(points, p);
        for layer in tube.elements_through() {
            for q in 0..n {
                let value = |c: usize| layer.value[q * n + c];
                for c in 0..n {
                    for d in 0..n {
                        let weight = layer.weight_at_rest[q] * layer.radius[q];
                        wall.add(
                            layer.first + c,
                            layer.first + d,
                            weight * value(c) * value(d),
                        );
                    }
                }
            }
        }
        let product = |offset: isize| {
            let mut sum = RingProduct {
                offset,
                axial: 0.0,
                plane: (0.0, 0.0),
            };
            for point in &tube.around {
                let weight = point.weight * point.across * point.radius;
                let functions = sector.function_values_at(point.s);
                for (b, f) in functions.iter().enumerate() {
                    let Some(g) = b.checked_add_signed(offset).and_then(|b| functions.get(b))
                    else {
                        continue;
                    };
                    let ((fr, fi), (gr, gi)) = (f.rotated[0], g.rotated[0]);
                    sum.axial += weight * f.axial[0] * g.axial[0];
                    sum.plane.0 += weight * (fr * gr + fi * gi);
                    sum.plane.1 += weight * (fr * gi - fi * gr);
                }
            }
            sum
        };
        let p = p.cast_signed();
        Self {
            rings: sector.rings,
            angle: sector.angle(),
            along,
            wall,
            around: (-p..=p).map(product).collect(),
        }
    }

    /// Computes y += factor · C v.
    pub fn multiply_add(&self, factor: f64, v: &[f64], y: &mut [f64]) {
        let (k, points) = (self.rings, self.wall.rows.len());
        let (point, row) = (3 * k, 3 * k * points);
        let mut through = vec![0.0; v.len()];
        through
            .par_chunks_exact_mut(row)
            .zip(v.par_chunks_exact(row))
            .for_each(|(through, v)| {
                let mut rotated = vec![0.0; row];
                for (rotated, v) in rotated.chunks_exact_mut(point).zip(v.chunks_exact(point)) {
                    self.multiply_around(v, rotated);
                }
                for (c, through) in through.chunks_exact_mut(point).enumerate() {
                    for (d, entry) in self.wall.row(c) {
                        add(through, entry, &rotated[d * point..][..point]);
                    }
                }
            });
        y.par_chunks_exact_mut(row).enumerate().for_each(|(a, y)| {
            for (b, entry) in self.along.row(a) {
                add(y, factor * entry, &through[b * row..][..row]);
            }
        });
    }

    /// Multiplies the three components of k rings by Q.
    fn multiply_around(&self, v: &[f64], out: &mut [f64]) {
        let k = self.rings;
        let (axial, plane) = out.split_at_mut(k);
        let (radial, hoop) = plane.split_at_mut(k);
        let (from_axial, from_radial, from_hoop) = (&v[..k], &v[k..2 * k], &v[2 * k..]);
        for q in &self.around {
            let (re, im) = q.plane;
            let shift = q.offset.rem_euclid(k.cast_signed()).cast_unsigned();
            // Ring j adds ring j + shift: in two runs, so that neither wraps.
            for (to, from, len) in [(0, shift, k - shift), (k - shift, 0, shift)] {
                add(
                    &mut axial[to..to + len],
                    q.axial,
                    &from_axial[from..from + len],
                );
                add(
                    &mut radial[to..to + len],
                    re,
                    &from_radial[from..from + len],
                );
                add(&mut radial[to..to + len], -im, &from_hoop[from..from + len]);
                add(&mut hoop[to..to + len], im, &from_radial[from..from + len]);
                add(&mut hoop[to..to + len], re, &from_hoop[from..from + len]);
            }
        }
    }

    /// Adds `factor` times C on circumferential harmonic n (see [`crate::rings::Circulant`]).
    pub fn add_harmonic(&self, factor: f64, n: usize, block: &mut BlockBanded) {
        let (mut axial, mut plane, mut mixed) = (0.0, 0.0, 0.0);
        for q in &self.around {
            let (sin, cos) = (n as f64 * self.angle * q.offset as f64).sin_cos();
            axial += q.axial * cos;
            plane += q.plane.0 * cos;
            mixed += q.plane.1 * sin;
        }
        let around = [[axial, 0.0, 0.0], [0.0, plane, mixed], [0.0, mixed, plane]];
        let points = self.wall.rows.len();
        for b in 0..self.along.rows.len() {
            for (a, along) in self.along.row(b).filter(|(a, _)| *a >= b) {
                for c in 0..points {
                    for (d, wall) in self.wall.row(c) {
                        for (i, row) in around.iter().enumerate() {
                            for (j, &entry) in row.iter().enumerate().filter(|(_, e)| **e != 0.0) {
                                let value = factor * along * wall * entry;
                                block.add_at(b, a - b, 3 * c + i, 3 * d + j, value);
                            }
                        }
                    }
                }
            }
        }
    }
}

#[inline(always)]
fn add(to: &mut [f64], factor: f64, from: &[f64]) {
    for (to, from) in to.iter_mut().zip(from) {
        *to += factor * from;
    }
}

impl SplineTube {
    /// Returns the damping matrix of the sector as a product of three small matrices.
    pub fn ring_damping(&self) -> RingDamping {
        RingDamping::new(self)
    }
}
