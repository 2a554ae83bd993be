//! The points of a patch nearest to a point.

use super::patch::Patch;
use super::tree::Box3;
use super::vector::{Vector, dot, length, minus, plus};

/// Most halvings of a patch.
const MAX_HALVINGS: usize = 16;

/// Distance, over the place in the patch, by which a minimum on an edge may lie outside.
const EDGE: f64 = 1e-10;

/// Size of a step, over the place in the patch, after which Newton's method takes one step more.
const SMALL: f64 = 1e-8;

/// Most steps of Newton's method.
const STEPS: usize = 40;

/// A part of a patch.
struct Part {
    patch: Patch,
    /// Smallest and largest place, along and around.
    from: [f64; 2],
    to: [f64; 2],
    halvings: usize,
}

/// Calls `found` with every place (v, w) of a patch at which the distance from x has a local minimum below a range. A
/// minimum on an edge is found on both sides of it.
///
/// The patch is halved until its parts are too far from x, or the square of the distance is a convex function on them,
/// which has at most one minimum.
pub fn local_minima(patch: &Patch, x: Vector, range: f64, found: &mut impl FnMut([f64; 2])) {
    let whole = Part {
        patch: *patch,
        from: [0.0; 2],
        to: [1.0; 2],
        halvings: 0,
    };
    search(patch, whole, x, range, found);
}

fn search(patch: &Patch, part: Part, x: Vector, range: f64, found: &mut impl FnMut([f64; 2])) {
    if Box3::around(part.patch.all_points()).distance(x) >= range {
        return;
    }
    let slopes = [0, 1].map(|direction| Spread::of(part.patch.differences(direction)));
    let towards = Spread::of(part.patch.all_points().map(|y| minus(y, x)));
    if slopes.iter().any(|slopes| has_one_sign(&towards, slopes)) {
        return;
    }
    if part.halvings == MAX_HALVINGS || is_convex(&part.patch, &slopes, x) {
        if let Some(place) = minimum(patch, &part, x) {
            found(place);
        }
        return;
    }
    let direction = usize::from(length(slopes[1].mean) > length(slopes[0].mean));
    let halves = part.patch.halves(direction);
    let middle = f64::midpoint(part.from[direction], part.to[direction]);
    for (i, half) in halves.into_iter().enumerate() {
        let (mut from, mut to) = (part.from, part.to);
        [&mut to, &mut from][i][direction] = middle;
        let half = Part {
            patch: half,
            from,
            to,
            halvings: part.halvings + 1,
        };
        search(patch, half, x, range, found);
    }
}

/// The mean of some vectors, and the largest distance of one from it.
struct Spread {
    mean: Vector,
    radius: f64,
    /// Smallest component along the mean.
    least: f64,
}

impl Spread {
    fn of(vectors: impl Iterator<Item = Vector> + Clone) -> Self {
        let (sum, count) = vectors.clone().fold(([0.0; 3], 0.0), |(sum, count), v| {
            (plus(sum, 1.0, v), count + 1.0)
        });
        let mean = sum.map(|s| s / count);
        let size = length(mean).max(f64::MIN_POSITIVE);
        let (mut radius, mut least) = (0.0_f64, f64::INFINITY);
        for v in vectors {
            radius = radius.max(length(minus(v, mean)));
            least = least.min(dot(v, mean) / size);
        }
        Self {
            mean,
            radius,
            least,
        }
    }
}

/// Returns whether the derivative (y − x) · y_α of the distance surely has one sign.
fn has_one_sign(towards: &Spread, slopes: &Spread) -> bool {
    let error = length(towards.mean) * slopes.radius
        + length(slopes.mean) * towards.radius
        + towards.radius * slopes.radius;
    dot(towards.mean, slopes.mean).abs() > 1.001 * error
}

/// Returns whether half the square of the distance from x is surely a convex function of the place: its second derivatives
/// are y_α · y_β + (y − x) · y_αβ.
fn is_convex(part: &Patch, [along, around]: &[Spread; 2], x: Vector) -> bool {
    let farthest = part
        .all_points()
        .map(|y| length(minus(y, x)))
        .fold(0.0, f64::max);
    let [vv, vw, ww] = part.largest_curvatures().map(|c| farthest * c);
    if along.least <= 0.0 || around.least <= 0.0 {
        return false;
    }
    let mixed = dot(along.mean, around.mean).abs()
        + length(along.mean) * around.radius
        + length(around.mean) * along.radius
        + along.radius * around.radius
        + vw;
    let (a, b) = (
        along.least * along.least - vv,
        around.least * around.least - ww,
    );
    a > 0.0 && b > 0.0 && a * b > mixed * mixed
}

/// Returns the minimum within a part, by Newton's method with halved steps.
fn minimum(patch: &Patch, part: &Part, x: Vector) -> Option<[f64; 2]> {
    let sizes = [0, 1].map(|i| part.to[i] - part.from[i]);
    // Newton's method may leave the part by a little on its way.
    let [low, high] = [-0.2, 1.2].map(|t| [0, 1].map(|i| part.from[i] + t * sizes[i]));
    let clamped = |place: [f64; 2]| [0, 1].map(|i| place[i].clamp(low[i], high[i]));
    let mut place = [0, 1].map(|i| f64::midpoint(part.from[i], part.to[i]));
    let mut at = patch.at(place);
    let mut last = f64::INFINITY;
    for _ in 0..STEPS {
        let d = minus(at.position, x);
        let gradient = at.slopes.map(|s| dot(d, s));
        let [vv, vw, ww] = [
            dot(at.slopes[0], at.slopes[0]) + dot(d, at.curvatures[0]),
            dot(at.slopes[0], at.slopes[1]) + dot(d, at.curvatures[1]),
            dot(at.slopes[1], at.slopes[1]) + dot(d, at.curvatures[2]),
        ];
        let determinant = vv * ww - vw * vw;
        if !(determinant > 0.0 && vv > 0.0) {
            return None;
        }
        let step = [
            (vw * gradient[1] - ww * gradient[0]) / determinant,
            (vw * gradient[0] - vv * gradient[1]) / determinant,
        ];
        let before = (place, dot(d, d));
        let mut t = 1.0;
        loop {
            place = clamped([0, 1].map(|i| before.0[i] + t * step[i]));
            at = patch.at(place);
            let d = minus(at.position, x);
            if dot(d, d) <= before.1 * (1.0 + 1e-14) || t < 0.01 {
                break;
            }
            t *= 0.5;
        }
        // One step more after a small one, whose error is of the size of rounding errors.
        let before_last = std::mem::replace(&mut last, step[0].abs().max(step[1].abs()));
        if before_last < SMALL || place == before.0 {
            break;
        }
    }
    let inside = |i: usize| place[i] >= part.from[i] - EDGE && place[i] <= part.to[i] + EDGE;
    (last < SMALL && inside(0) && inside(1)).then_some(place)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::bernstein::MAX_POINTS;
    use crate::contact::surfaces::random::Random;

    fn minima(patch: &Patch, x: Vector, range: f64) -> Vec<[f64; 2]> {
        let mut all: Vec<[f64; 2]> = vec![];
        local_minima(patch, x, range, &mut |place| {
            let is_new = |other: &[f64; 2]| (0..2).any(|i| (place[i] - other[i]).abs() > 1e-8);
            if all.iter().all(is_new) {
                all.push(place);
            }
        });
        all
    }

    #[test]
    fn minima_are_those_of_a_fine_lattice() {
        let mut random = Random::new(5);
        let count = 100;
        let (mut none, mut several) = (0, 0);
        for trial in 0..60 {
            let degree = 1 + trial % 5;
            let mut points = [[[0.0; 3]; MAX_POINTS]; MAX_POINTS];
            for (i, row) in points.iter_mut().enumerate() {
                for (j, point) in row.iter_mut().enumerate() {
                    let place = [i, j].map(|i| i as f64 / degree as f64);
                    let rough = [(); 3].map(|()| random.next() - 0.5);
                    *point = [
                        place[0] + 0.1 * rough[0],
                        place[1] + 0.1 * rough[1],
                        2.0 * rough[2],
                    ];
                }
            }
            let patch = Patch { points, degree };
            let x = [random.next(), random.next(), random.next() - 0.5];
            let range = 0.5;
            let lattice: Vec<f64> = (0..=count)
                .flat_map(|i| (0..=count).map(move |j| [i, j].map(|i| i as f64 / count as f64)))
                .map(|place| length(minus(patch.position(place), x)))
                .collect();
            let at = |i: usize, j: usize| lattice[i * (count + 1) + j];
            let mut sampled = vec![];
            for i in 1..count {
                for j in 1..count {
                    let own = at(i, j);
                    let around = (0..9)
                        .filter(|n| *n != 4)
                        .map(|n| at(i + n / 3 - 1, j + n % 3 - 1));
                    if own < 0.99 * range && around.into_iter().all(|other| own <= other) {
                        sampled.push([i, j].map(|i| i as f64 / count as f64));
                    }
                }
            }
            let found = minima(&patch, x, range);
            none += usize::from(found.is_empty());
            several += usize::from(found.len() > 1);
            for place in &sampled {
                let near = |other: &[f64; 2]| (0..2).all(|i| (place[i] - other[i]).abs() < 0.04);
                assert!(found.iter().any(near), "{trial}: {place:?} {found:?}");
            }
            for place in &found {
                let point = patch.at(*place);
                let d = minus(point.position, x);
                assert!(point.slopes.iter().all(|s| dot(*s, d).abs() < 1e-12));
            }
        }
        assert!(none > 3 && several > 1, "{none} {several}");
    }

    #[test]
    fn a_minimum_on_an_edge_is_found_from_both_sides() {
        // A flat square, halved.
        let mut points = [[[0.0; 3]; MAX_POINTS]; MAX_POINTS];
        for (i, row) in points.iter_mut().enumerate() {
            for (j, point) in row.iter_mut().enumerate() {
                *point = [i as f64 / 3.0, j as f64 / 3.0, 0.0];
            }
        }
        let patch = Patch { points, degree: 3 };
        let [left, right] = patch.halves(0);
        let x = [0.5, 0.25, 0.1];
        let places = [left, right].map(|half| minima(&half, x, 0.2));
        for (found, v) in places.iter().zip([1.0, 0.0]) {
            assert_eq!(found.len(), 1);
            assert!((found[0][0] - v).abs() < 1e-12 && (found[0][1] - 0.25).abs() < 1e-12);
        }
        assert!(minima(&left, x, 0.05).is_empty());
    }
}
