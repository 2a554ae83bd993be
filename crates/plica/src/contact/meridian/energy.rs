//! Energy, forces and tangent of pairs.
//!
//! With a = δx − δy, t = y′ · a, c = n · δy′, m = |y′|² and b₂ = n · y″, where y stays the nearest point,
//!
//! δg = n · a, δ²g = −[(b₂/m) t² + 2 t c + g c²] / (m − g b₂).
//!
//! Under a displacement (z cos nφ, r cos nφ, −θ sin nφ) this is the part of the second variation with cos² nφ. The part
//! with sin² nφ, in which δg is zero, is
//!
//! δ²g = [n_r a² − 2 c a − g c²/r_y] / r_x, a = θ_y − θ_x, c = n_r θ_y − n (n_z z_y + n_r r_y).

use super::bezier::{Point, dot};
use super::curve::FaceCurve;
use super::pairs::Pair;

/// Share of a pair in the energy: the two points of a gap find each other.
const SHARE: f64 = 0.5;

/// First variations of a pair over one unknown.
#[derive(Clone, Copy, Debug, Default)]
struct Variation {
    unknown: usize,
    /// n · a = δg.
    normal: f64,
    /// t = y′ · a.
    tangential: f64,
    /// c = n · δy′.
    turn: f64,
    /// a of the part with sin² nφ.
    around: f64,
    /// c of the part with sin² nφ.
    turn_around: f64,
}

/// Returns the energy of pairs, ½ Σ b A, of one sector.
pub fn energy(pairs: &[Pair]) -> f64 {
    pairs
        .iter()
        .map(|pair| SHARE * pair.area * pair.barrier.value)
        .sum()
}

/// Adds the forces of pairs to a residual and returns the sum of the squares of their parts.
pub fn add_forces(face: &FaceCurve, pairs: &[Pair], residual: &mut [f64]) -> f64 {
    let amplitudes = face.amplitudes(0);
    let mut squares = 0.0;
    for pair in pairs {
        let force = SHARE * pair.area * pair.barrier.slope;
        for of in variations(face, pair, 0, &amplitudes) {
            let part = force * of.normal;
            residual[of.unknown] += part;
            squares += part * part;
        }
    }
    squares
}

/// Calls `add` with row, column and value of every entry on or below the diagonal of the tangent of pairs in a
/// circumferential mode; entries of one place add up.
pub fn add_tangent(
    face: &FaceCurve,
    pairs: &[Pair],
    mode: usize,
    mut add: impl FnMut(usize, usize, f64),
) {
    let amplitudes = face.amplitudes(mode);
    for pair in pairs {
        let share = SHARE * pair.area;
        let (m, g) = (dot(pair.slope, pair.slope), pair.gap);
        let stretch = m - g * pair.curvature;
        let [r_x, r_y] = pair.radii;
        let all = variations(face, pair, mode, &amplitudes);
        for a in &all {
            for b in &all {
                if a.unknown < b.unknown {
                    continue;
                }
                let along = pair.curvature / m * a.tangential * b.tangential
                    + a.tangential * b.turn
                    + a.turn * b.tangential
                    + g * a.turn * b.turn;
                let around = pair.normal[1] * a.around * b.around
                    - a.turn_around * b.around
                    - a.around * b.turn_around
                    - g / r_y * a.turn_around * b.turn_around;
                let value = pair.barrier.curvature * a.normal * b.normal
                    + pair.barrier.slope * (around / r_x - along / stretch);
                add(a.unknown, b.unknown, share * value);
            }
        }
    }
}

/// Returns the variations of a pair over the unknowns of both elements. An unknown of both elements appears twice.
fn variations(
    face: &FaceCurve,
    pair: &Pair,
    mode: usize,
    amplitudes: &[[f64; 3]; 3],
) -> Vec<Variation> {
    let n = mode as f64;
    let components = if mode == 0 { 2 } else { 3 };
    let [x_element, y_element] = [pair.x.0, pair.y.0];
    let mut all = Vec::with_capacity(36);
    for (first, value) in face.unknowns(x_element).zip(&pair.x.1) {
        for (i, [z, r, theta]) in amplitudes.iter().take(components).enumerate() {
            let a: Point = [value * z, value * r];
            all.push(Variation {
                unknown: first + i,
                normal: dot(pair.normal, a),
                tangential: dot(pair.slope, a),
                around: -value * theta,
                ..Variation::default()
            });
        }
    }
    let [values, slopes] = &pair.y.1;
    for ((first, value), slope) in face.unknowns(y_element).zip(values).zip(slopes) {
        for (i, [z, r, theta]) in amplitudes.iter().take(components).enumerate() {
            let moved: Point = [*z, *r];
            all.push(Variation {
                unknown: first + i,
                normal: -value * dot(pair.normal, moved),
                tangential: -value * dot(pair.slope, moved),
                turn: slope * dot(pair.normal, moved),
                around: value * theta,
                turn_around: value * (pair.normal[1] * theta - n * dot(pair.normal, moved)),
            });
        }
    }
    all
}
