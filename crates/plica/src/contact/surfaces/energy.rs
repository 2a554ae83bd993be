//! Energy, forces and tangent product of pairs.
//!
//! The displacement of the control points enters a pair in five numbers: the relative displacement a = δx − δy and the turns
//! c_α = n · δy_α of the face at y. A displacement of the face moves y as a material point; that y stays the nearest point is in
//! [`Pair::stiffness`].

use super::net::FaceNet;
use super::pairs::Pair;
use super::vector::{Vector, dot, minus, plus};
use rayon::prelude::*;

/// Number of parts that pairs are divided into. Their sums are added in order, whatever the number of threads.
const PARTS: usize = 8;

/// Returns the energy of pairs, of the sector.
pub fn energy(pairs: &[Pair]) -> f64 {
    pairs.iter().map(|pair| pair.energy).sum()
}

/// Adds the forces of pairs to a residual and returns the sum of the squares of their parts.
pub fn add_forces(net: &FaceNet, pairs: &[Pair], residual: &mut [f64]) -> f64 {
    let forces = summed(net, pairs, |pair, forces| {
        let back = pair.force.map(|f| -f);
        add_at(net, pair, 0, [pair.force, [0.0; 3], [0.0; 3]], forces);
        add_at(net, pair, 1, [back, [0.0; 3], [0.0; 3]], forces);
    });
    net.add_forces(1.0, &forces, residual);
    let squares = |pair: &Pair| {
        let of_point = |[along, around]: [super::net::Functions; 2]| {
            let sum = |values: [f64; 6]| values.iter().map(|x| x * x).sum::<f64>();
            sum(along[0]) * sum(around[0])
        };
        let [x, y] = pair.functions.map(of_point);
        dot(pair.force, pair.force) * (x + y)
    };
    pairs.iter().map(squares).sum()
}

/// Adds `factor` times the tangent of pairs times v to y.
pub fn add_product(net: &FaceNet, pairs: &[Pair], factor: f64, v: &[f64], y: &mut [f64]) {
    if pairs.is_empty() {
        return;
    }
    let motions = net.motions(v);
    let forces = summed(net, pairs, |pair, forces| {
        let [x, ..] = motion(net, pair, 0, &motions);
        let [y, along, around] = motion(net, pair, 1, &motions);
        let a = minus(x, y);
        let moved = [
            a[0],
            a[1],
            a[2],
            dot(pair.normal, along),
            dot(pair.normal, around),
        ];
        let force = pair
            .stiffness
            .map(|row| row.iter().zip(&moved).map(|(k, x)| k * x).sum::<f64>());
        let on_x = [force[0], force[1], force[2]];
        let turns = [3, 4].map(|i| pair.normal.map(|n| force[i] * n));
        add_at(net, pair, 0, [on_x, [0.0; 3], [0.0; 3]], forces);
        add_at(net, pair, 1, [on_x.map(|f| -f), turns[0], turns[1]], forces);
    });
    net.add_forces(factor, &forces, y);
}

/// Returns the displacement of a point of a pair (0: x, 1: y) and its derivatives along and around.
fn motion(net: &FaceNet, pair: &Pair, point: usize, motions: &[Vector]) -> [Vector; 3] {
    let [e, f] = net.elements_of(pair.patches[point]);
    let [[values, slopes], [around, around_slopes]] = pair.functions[point];
    let mut sum = [[0.0; 3]; 3];
    for a in 0..=net.degree {
        let row = &motions[(e + a) * net.around..][..net.around];
        let mut of_row = [[0.0; 3]; 2];
        for b in 0..=net.degree {
            let moved = row[net.ring(f, b)];
            of_row[0] = plus(of_row[0], around[b], moved);
            of_row[1] = plus(of_row[1], around_slopes[b], moved);
        }
        sum[0] = plus(sum[0], values[a], of_row[0]);
        sum[1] = plus(sum[1], slopes[a], of_row[0]);
        sum[2] = plus(sum[2], values[a], of_row[1]);
    }
    sum
}

/// Adds the forces that work on the displacement of a point of a pair, and on its derivatives along and around.
fn add_at(
    net: &FaceNet,
    pair: &Pair,
    point: usize,
    [f, along, turned]: [Vector; 3],
    forces: &mut [Vector],
) {
    let [e, element] = net.elements_of(pair.patches[point]);
    let [[values, slopes], [around, around_slopes]] = pair.functions[point];
    for a in 0..=net.degree {
        let own = plus([0.0; 3], values[a], f);
        let own = plus(own, slopes[a], along);
        let turned = plus([0.0; 3], values[a], turned);
        let row = &mut forces[(e + a) * net.around..][..net.around];
        for b in 0..=net.degree {
            let at = &mut row[net.ring(element, b)];
            *at = plus(*at, around[b], own);
            *at = plus(*at, around_slopes[b], turned);
        }
    }
}

/// Sums the forces of pairs on the control points of the whole tube.
fn summed(net: &FaceNet, pairs: &[Pair], of: impl Fn(&Pair, &mut [Vector]) + Sync) -> Vec<Vector> {
    let nothing = || vec![[0.0; 3]; net.rows * net.around];
    let part = |pairs: &[Pair]| {
        let mut forces = nothing();
        pairs.iter().for_each(|pair| of(pair, &mut forces));
        forces
    };
    let length = pairs.len().div_ceil(PARTS).max(1);
    let parts: Vec<Vec<Vector>> = pairs.par_chunks(length).map(part).collect();
    let mut parts = parts.into_iter();
    let mut sum = parts.next().unwrap_or_else(nothing);
    for part in parts {
        for (sum, force) in sum.iter_mut().zip(part) {
            *sum = plus(*sum, 1.0, force);
        }
    }
    sum
}
