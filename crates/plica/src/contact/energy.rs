//! Energy, forces and tangent of pairs.
//!
//! With a = δx − δy, t = y′ · a, c = n · δy′, m = |y′|² and b₂ = n · y″, where y stays the nearest point,
//!
//! δg = n · a, δ²g = −[(b₂/m) t² + 2 t c + g c²] / (m − g b₂).

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
    let mut squares = 0.0;
    for pair in pairs {
        let force = SHARE * pair.area * pair.barrier.slope;
        for of in variations(face, pair) {
            let part = force * of.normal;
            residual[of.unknown] += part;
            squares += part * part;
        }
    }
    squares
}

/// Calls `add` with row, column and value of every entry of the tangent of pairs on or below the diagonal; entries of
/// one place add up.
pub fn add_tangent(face: &FaceCurve, pairs: &[Pair], mut add: impl FnMut(usize, usize, f64)) {
    for pair in pairs {
        let share = SHARE * pair.area;
        let (m, g) = (dot(pair.slope, pair.slope), pair.gap);
        let stretch = m - g * pair.curvature;
        let all = variations(face, pair);
        for a in &all {
            for b in &all {
                if a.unknown < b.unknown {
                    continue;
                }
                let second = pair.curvature / m * a.tangential * b.tangential
                    + a.tangential * b.turn
                    + a.turn * b.tangential
                    + g * a.turn * b.turn;
                let value = pair.barrier.curvature * a.normal * b.normal
                    - pair.barrier.slope * second / stretch;
                add(a.unknown, b.unknown, share * value);
            }
        }
    }
}

/// Returns the variations of a pair over the unknowns of both elements. An unknown of both elements appears twice.
fn variations(face: &FaceCurve, pair: &Pair) -> Vec<Variation> {
    let (element, values) = &pair.x;
    let mut all = Vec::with_capacity(24);
    let mut add = |unknown: usize, component: usize, per_unit: f64, moved: f64, turned: f64| {
        let along = |v: Point| per_unit * v[component];
        all.push(Variation {
            unknown,
            normal: moved * along(pair.normal),
            tangential: moved * along(pair.slope),
            turn: turned * along(pair.normal),
        });
    };
    for ((unknowns, per_unit), n) in face.unknowns(*element).zip(values) {
        for i in 0..2 {
            add(unknowns[i], i, per_unit[i], *n, 0.0);
        }
    }
    let (element, [values, slopes]) = &pair.y;
    for (((unknowns, per_unit), n), slope) in face.unknowns(*element).zip(values).zip(slopes) {
        for i in 0..2 {
            add(unknowns[i], i, per_unit[i], -n, *slope);
        }
    }
    all
}
