//! Volume enclosed by a surface, per point of the surface: its first and second derivatives.

use super::super::blocks::Block;
use super::super::kinematics::Vector;

/// Slopes over ζ and s, and the value, of a displacement or of a position.
pub type Surface = [Vector<f64>; 3];

/// Returns the sum of two.
pub fn sum(a: &Surface, b: &Surface) -> Surface {
    std::array::from_fn(|d| std::array::from_fn(|i| a[d][i] + b[d][i]))
}

/// Returns ½ [(a b_s − b a_s) z_ζ − (a b_ζ − b a_ζ) z_s] less its value at rest, for a position at
/// rest (of a wall along z) and a displacement.
pub fn volume_change(rest: &Surface, moved: &Surface) -> f64 {
    let across = |x: &Vector<f64>, y: &Vector<f64>| x[1] * y[2] - x[2] * y[1];
    let [_, rest_s, rest] = rest;
    let [moved_z, moved_s, moved] = moved;
    let change = across(rest, moved_s) + across(moved, rest_s) + across(moved, moved_s);
    let area = across(rest, rest_s) + change;
    let drawn = across(rest, moved_z) + across(moved, moved_z);
    0.5 * (change + area * moved_z[0] - drawn * moved_s[0])
}

/// Returns its derivatives at a position, with respect to the slopes and the value.
pub fn volume_slopes([x_z, x_s, x]: &Surface) -> Surface {
    let ([z_z, a_z, b_z], [z_s, a_s, b_s], [_, a, b]) = (*x_z, *x_s, *x);
    [
        [0.5 * (a * b_s - b * a_s), 0.5 * b * z_s, -0.5 * a * z_s],
        [-0.5 * (a * b_z - b * a_z), -0.5 * b * z_z, 0.5 * a * z_z],
        [
            0.0,
            0.5 * (b_s * z_z - b_z * z_s),
            0.5 * (a_z * z_s - a_s * z_z),
        ],
    ]
}

/// Returns its second derivatives times a factor: blocks (ζ,ζ), (ζ,s), (ζ,value), (s,s), (s,value),
/// (value,value).
pub fn volume_blocks([x_z, x_s, x]: &Surface, factor: f64) -> [Block<f64>; 6] {
    let half = 0.5 * factor;
    let [z_z, a_z, b_z] = x_z.map(|x| half * x);
    let [z_s, a_s, b_s] = x_s.map(|x| half * x);
    let [_, a, b] = x.map(|x| half * x);
    let nil = [[0.0; 3]; 3];
    [
        nil,
        [[0.0, -b, a], [b, 0.0, 0.0], [-a, 0.0, 0.0]],
        [[0.0, b_s, -a_s], [0.0, 0.0, z_s], [0.0, -z_s, 0.0]],
        nil,
        [[0.0, -b_z, a_z], [0.0, 0.0, -z_z], [0.0, z_z, 0.0]],
        nil,
    ]
}

/// Returns the product of the blocks with the slopes of a displacement.
pub fn product(blocks: &[Block<f64>; 6], v: &Surface) -> Surface {
    let (mut out, [_, zs, zv, _, sv, vv]) = ([[0.0; 3]; 3], blocks);
    for (block, alpha, beta) in [(zs, 0, 1), (zv, 0, 2), (sv, 1, 2)] {
        for i in 0..3 {
            for j in 0..3 {
                out[alpha][i] += block[i][j] * v[beta][j];
                out[beta][j] += block[i][j] * v[alpha][i];
            }
        }
    }
    for i in 0..3 {
        for j in 0..3 {
            out[2][i] += vv[i][j] * v[2][j];
        }
    }
    out
}
