//! Stiffness of contact on the low harmonics of a tube of many rings.

use super::net::FaceNet;
use super::pairs::Pair;
use super::vector::dot;
use crate::assembly::LowHarmonics;
use crate::contact::Face;
use crate::matrix::CoupledBanded;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// Adds the stiffness of pairs against approach, Σ ½ A b″ (n · a)², to the tangent on low harmonics. The tangent there is that of
/// a preconditioner: the parts of a contact force that turns are left out, and what is added is positive.
pub fn add_approach(net: &FaceNet, pairs: &[Pair], low: &LowHarmonics, matrix: &mut CoupledBanded) {
    let columns = 3 * low.modes();
    let waves = control_waves(net.rings, low.modes());
    let mut blocks: BTreeMap<(usize, usize), Vec<f64>> = BTreeMap::new();
    for pair in pairs {
        let n = pair.normal;
        let stiff = [0, 1, 2].map(|i| dot(n, [0, 1, 2].map(|j| pair.stiffness[i][j])));
        let stiffness = dot(n, stiff);
        // How the waves of each row of control points move the points of the pair together.
        let mut rows: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
        for (point, sign) in [(0, 1.0), (1, -1.0)] {
            let [e, element] = net.elements_of(pair.patches[point]);
            let [along, around] = pair.functions[point];
            let mut sum = vec![0.0; columns];
            for b in 0..=net.degree {
                let ring = net.ring(element, b);
                let (sin, cos) = net.turn(ring);
                let value = sign * around[0][b];
                let axes = [n[0], n[1] * cos + n[2] * sin, n[2] * cos - n[1] * sin];
                let waves = &waves[ring % net.rings];
                for (sum, wave) in sum.chunks_exact_mut(3).zip(waves) {
                    for i in 0..3 {
                        sum[i] += value * wave[i] * axes[i];
                    }
                }
            }
            for a in 0..=net.degree {
                let row = rows.entry(e + a).or_insert_with(|| vec![0.0; columns]);
                for (row, sum) in row.iter_mut().zip(&sum) {
                    *row += along[0][a] * sum;
                }
            }
        }
        for (i, a) in &rows {
            for (j, b) in rows.range(..=i) {
                let block = blocks.entry((*i, *j));
                let block = block.or_insert_with(|| vec![0.0; columns * columns]);
                for (line, a) in block.chunks_exact_mut(columns).zip(a) {
                    for (sum, b) in line.iter_mut().zip(b) {
                        *sum += stiffness * a * b;
                    }
                }
            }
        }
    }
    // 1, t, t² at the face.
    let t = match net.face {
        Face::Outer => 1.0,
        Face::Inner => -1.0,
    };
    let through = [1.0, t, 1.0];
    let size = low.row_size();
    for ((i, j), block) in &blocks {
        for (c, f) in through.iter().enumerate() {
            for (d, g) in through.iter().enumerate() {
                for (x, line) in block.chunks_exact(columns).enumerate() {
                    for (y, value) in line.iter().enumerate() {
                        let (row, column) =
                            (i * size + c * columns + x, j * size + d * columns + y);
                        if row >= column {
                            matrix.add_at(row, column, f * g * value);
                        }
                    }
                }
            }
        }
    }
}

/// Returns the control values (axial, radial, circumferential) of 1, cos φ, sin φ, … at each ring of a sector.
fn control_waves(rings: usize, modes: usize) -> Vec<Vec<[f64; 3]>> {
    let at = |ring: usize| {
        let of_mode = |mode: usize| {
            let n = mode.div_ceil(2);
            let (sin, cos) = (TAU * (n * ring % rings) as f64 / rings as f64).sin_cos();
            match mode {
                0 => [1.0; 3],
                _ if mode % 2 == 1 => [cos, cos, -sin],
                _ => [sin, sin, cos],
            }
        };
        (0..modes).map(of_mode).collect()
    };
    (0..rings).map(at).collect()
}
