//! Smallest width of the lumen of a tube that is not axisymmetric.

use super::Face;
use super::triangle::{Point, distance};
use crate::assembly::SplineTube;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Least number of angles around the tube at which its width is taken.
const ANGLES: usize = 48;

/// Multiple of which the number of angles is one, so that halves, thirds and quarters of a turn are among them.
const DIVISOR: usize = 12;

/// Every so many rows are compared with those of other axial positions.
const STRIDE: usize = 2;

/// Returns the smallest width of the lumen: for two points of the inner face whose reference angles are a third of a
/// turn or more apart, their distance over that of points with these angles in one section at rest, times the inner
/// diameter. For points of a circle that is its diameter. The angles begin with `first`.
pub fn width(tube: &SplineTube, u: &[f64], first: f64, reference_z: &[f64]) -> f64 {
    let repeats = tube.sector.around / tube.sector.rings;
    // The fewest angles per sector that fit.
    let fits = |&n: &usize| (n * repeats).is_multiple_of(DIVISOR) && n * repeats >= ANGLES;
    let sector = (1..=ANGLES).find(fits).unwrap_or(ANGLES);
    let columns = sector * repeats;
    let angle = |j: usize| first + TAU * j as f64 / columns as f64;
    let angles: Vec<f64> = (0..columns).map(angle).collect();
    let radius = Face::Inner.radius(&tube.tube);
    let rows = tube.positions(u, radius, reference_z, &angles);
    let at_rest = &tube.positions(&vec![0.0; u.len()], radius, &reference_z[..1], &angles)[0];
    // First point, second point, and the square of the diameter over their distance at rest.
    let mut pairs: Vec<(usize, usize, f64)> = vec![];
    for j in 0..sector {
        for l in columns.div_ceil(3)..=columns - columns.div_ceil(3) {
            let other = (j + l) % columns;
            let scale = 2.0 * radius / distance(at_rest[j], at_rest[other]);
            pairs.push((j, other, scale * scale));
        }
    }
    let extent = |row: &Vec<Point>| {
        let empty = (f64::INFINITY, f64::NEG_INFINITY);
        row.iter()
            .fold(empty, |(low, high), p| (low.min(p[0]), high.max(p[0])))
    };
    let extents: Vec<(f64, f64)> = rows.iter().map(extent).collect();
    let of_two_rows = |i: usize, k: usize| {
        let squares = pairs.iter().map(|&(j, l, scale)| {
            let (p, q) = (rows[i][j], rows[k][l]);
            let [z, x, y] = [0, 1, 2].map(|d| p[d] - q[d]);
            scale * (z * z + x * x + y * y)
        });
        squares.fold(f64::INFINITY, f64::min)
    };
    let of_row = |i: usize| {
        let mut least = of_two_rows(i, i);
        if i.is_multiple_of(STRIDE) {
            for k in (i + STRIDE..rows.len()).step_by(STRIDE) {
                let ((a, b), (c, d)) = (extents[i], extents[k]);
                // The scale of a pair is at least 1, up to the rounding of the spline circle.
                if (c - b).max(a - d).max(0.0).powi(2) < least {
                    least = least.min(of_two_rows(i, k));
                }
            }
        }
        least
    };
    let least = (0..rows.len()).into_par_iter().map(of_row);
    least.reduce(|| f64::INFINITY, f64::min).sqrt()
}
