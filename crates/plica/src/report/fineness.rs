//! How finely a wall is looked at: as finely as its picture shows, and no more.

use crate::draw::{Opening, evenly};
use std::f64::consts::TAU;

/// Position (x, y, z) in D, and the value of a field.
pub(super) type Seen = ([f64; 3], f64);

/// How far what is drawn, which is straight and even between points, may be off a wall and its field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fineness {
    /// Off the wall, in D.
    pub place: f64,
    /// Off the field, in what it is drawn in.
    pub value: f64,
}

/// The wall as a mesh has it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wall {
    /// Elements along and through it.
    pub elements: [usize; 2],
    /// Whether all meridians are the same.
    pub axisymmetric: bool,
}

/// Pieces to an element along, and to a [`STEP`] around, at most.
const MOST: f64 = 16.0;
/// Pieces through the wall that are as many as anything needs: it is a few pixels thick.
const THROUGH: f64 = 12.0;
/// How far apart what is looked at lies around the tube, at most: harmonics up to 12 show.
const STEP: f64 = TAU / 24.0;
/// Cross-sections in which that is looked at.
const SECTIONS: usize = 16;
/// Meridians that are looked at along and through the wall where not all are the same.
const MERIDIANS: usize = 8;

/// Pieces of elements that are drawn as one, at most.
const LONGEST: usize = 32;

/// Where between two points it is looked at how far off they are: an arc is off by 3/4 of the most it ever is, and an S is seen too.
const QUARTERS: [f64; 2] = [0.25, 0.75];

impl Fineness {
    /// Where to look at the part of a wall between two angles. `wall(zeta, eta, xi)` is told ζ in elements.
    pub(super) fn opening(
        &self,
        kept: (f64, f64),
        wall: Wall,
        at: impl Fn(f64, f64, f64) -> Seen,
    ) -> Opening {
        let [elements, layers] = wall.elements.map(|n| n.max(1));
        let meridians = if wall.axisymmetric { 1 } else { MERIDIANS };
        let angle = |part: f64| kept.0 + part * (kept.1 - kept.0);
        let angles: Vec<f64> = evenly(meridians)[..meridians]
            .iter()
            .map(|&part| angle(part))
            .collect();
        let sections: Vec<f64> = (0..=elements)
            .step_by(elements.div_ceil(SECTIONS))
            .map(|e| e as f64)
            .collect();

        let lines: Vec<(f64, f64)> = angles
            .iter()
            .flat_map(|&a| [0.0, 0.5, 1.0].map(|xi| (a, xi)))
            .collect();
        let mut along = vec![0.0];
        for e in 0..elements {
            let on = |t: f64| e as f64 + t;
            let faces = lines.iter().filter(|(_, xi)| *xi != 0.5);
            let pieces = faces.map(|&(a, xi)| self.pieces(|t| at(on(t), a, xi)));
            let pieces = most(pieces).clamp(1.0, MOST).ceil();
            along.extend((1..=pieces as usize).map(|i| on(i as f64 / pieces)));
        }
        let seen = |place: &f64| lines.iter().map(|&(a, xi)| at(*place, a, xi)).collect();
        let seen: Vec<Vec<Seen>> = along.iter().map(seen).collect();
        let along = self
            .needed(&seen)
            .into_iter()
            .map(|i| along[i] / elements as f64);

        let steps = ((kept.1 - kept.0) / STEP).ceil().max(1.0);
        let looked_at = if wall.axisymmetric { 1.0 } else { steps };
        let arcs = (0..looked_at as usize)
            .flat_map(|k| sections.iter().map(move |&section| (k as f64, section)));
        let arcs = arcs.flat_map(|(k, section)| [0.0, 1.0].map(|xi| (k, section, xi)));
        let pieces =
            arcs.map(|(k, section, xi)| self.pieces(|t| at(section, angle((k + t) / steps), xi)));
        let around = steps * most(pieces).clamp(1.0, MOST);

        let threads = angles
            .iter()
            .flat_map(|&a| sections.iter().map(move |&section| (a, section)));
        let threads = threads.flat_map(|(a, section)| (0..layers).map(move |k| (a, section, k)));
        let pieces = threads
            .map(|(a, section, k)| self.pieces(|t| at(section, a, (k as f64 + t) / layers as f64)));
        let enough = (THROUGH / layers as f64).max(1.0);
        let through = layers as f64 * most(pieces).clamp(1.0, enough).ceil();
        Opening {
            kept,
            places: [
                along.collect(),
                evenly(around.ceil() as usize + 1),
                evenly(through as usize + 1),
            ],
        }
    }

    /// Into how many pieces a line between t = 0 and 1 is to be cut: what is off falls with their square.
    fn pieces(&self, line: impl Fn(f64) -> Seen) -> f64 {
        let (begin, end) = (line(0.0), line(1.0));
        let off = QUARTERS.map(|t| self.off(&begin, &end, &line(t)));
        (most(off.into_iter()) * 4.0 / 3.0).sqrt()
    }

    /// Of points along several lines, the numbers of those without which a line would be off between others.
    fn needed(&self, seen: &[Vec<Seen>]) -> Vec<usize> {
        let mut needed = vec![0];
        let mut begin = 0;
        for end in 2..seen.len() {
            let straight = |between: usize| {
                let lines = seen[begin].iter().zip(&seen[end]).zip(&seen[between]);
                lines
                    .into_iter()
                    .all(|((begin, end), between)| self.off(begin, end, between) <= 1.0)
            };
            if end - begin > LONGEST || !(begin + 1..end).all(straight) {
                begin = end - 1;
                needed.push(begin);
            }
        }
        needed.extend(seen.len().checked_sub(1).filter(|&last| last > 0));
        needed
    }

    /// How far a point is off what is straight and even between two others, over how far it may be. What has no place is not off;
    /// what has a value between points that have none, or none between such that have, is.
    fn off(&self, begin: &Seen, end: &Seen, between: &Seen) -> f64 {
        let minus = |a: &Seen, b: &Seen| -> [f64; 3] { std::array::from_fn(|i| a.0[i] - b.0[i]) };
        let (chord, way) = (minus(end, begin), minus(between, begin));
        let t = dot(way, chord) / dot(chord, chord).max(f64::MIN_POSITIVE);
        let t = t.clamp(0.0, 1.0);
        let apart: [f64; 3] = std::array::from_fn(|i| way[i] - t * chord[i]);
        let value =
            if between.1.is_nan() == begin.1.is_nan() && between.1.is_nan() == end.1.is_nan() {
                (between.1 - (begin.1 + t * (end.1 - begin.1))).abs()
            } else {
                f64::INFINITY
            };
        most([dot(apart, apart).sqrt() / self.place, value / self.value].into_iter())
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The largest of what is a number.
fn most(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::HALF;

    const FINE: Fineness = Fineness {
        place: 1e-3,
        value: 0.01,
    };
    const WALL: Wall = Wall {
        elements: [20, 3],
        axisymmetric: true,
    };

    /// A tube of that radius at ζ in elements.
    fn turned(radius: impl Fn(f64) -> f64) -> impl Fn(f64, f64, f64) -> Seen {
        move |zeta, eta, xi| {
            let r = radius(zeta) - 0.06 * (1.0 - xi);
            ([r * eta.cos(), r * eta.sin(), 0.1 * zeta], xi * xi)
        }
    }

    #[test]
    fn a_cylinder_is_cut_around_alone() {
        let opening = FINE.opening(HALF, WALL, turned(|_| 0.5));
        let [along, around, through] = &opening.places;
        assert_eq!(along, &[0.0, 1.0]);
        // r (1 − cos(step / 2)) is what an arc is off its chord.
        let step = std::f64::consts::PI / (around.len() - 1) as f64;
        let off = 0.5 * (1.0 - (0.5 * step).cos());
        assert!((0.8e-3..1.02e-3).contains(&off), "{off}");
        // ξ² over a third of the wall is off by 1/36.
        assert_eq!(through.len(), 3 * 2 + 1);
    }

    #[test]
    fn folds_are_cut_and_what_is_straight_is_not() {
        let radius = |zeta: f64| 0.5 - 0.3 * (-((zeta - 10.0) / 3.0_f64).powi(2)).exp();
        let opening = FINE.opening(HALF, WALL, turned(radius));
        let along = &opening.places[0];
        assert!(along.windows(2).all(|pair| pair[0] < pair[1]));
        assert_eq!((along[0], along[along.len() - 1]), (0.0, 1.0));
        let within = |from: f64, to: f64| {
            let elements = along.iter().map(|zeta| 20.0 * zeta);
            elements.filter(|zeta| (from..to).contains(zeta)).count()
        };
        assert!(within(-0.5, 3.5) <= 2, "{}", within(-0.5, 3.5));
        assert!(within(8.5, 11.5) > 7, "{}", within(8.5, 11.5));
        // Nowhere is the meridian off by more than was asked for, once where elements are cut and once where pieces are joined.
        for pair in along.windows(2) {
            let at = |zeta: f64| (2.0 * zeta, radius(20.0 * zeta));
            let (begin, end) = (at(pair[0]), at(pair[1]));
            let (dz, dr) = (end.0 - begin.0, end.1 - begin.1);
            for part in [0.2, 0.5, 0.8] {
                let (z, r) = at(pair[0] + part * (pair[1] - pair[0]));
                let off = ((z - begin.0) * dr - (r - begin.1) * dz).abs() / dz.hypot(dr);
                assert!(off < 2.0 * FINE.place, "{z} {off}");
            }
        }
        let finer = Fineness {
            place: 1e-4,
            ..FINE
        };
        let finer = finer.opening(HALF, WALL, turned(radius));
        assert!(finer.places[0].len() > along.len() + 20);
    }

    #[test]
    fn lobes_are_seen_where_meridians_differ() {
        let wall = Wall {
            axisymmetric: false,
            ..WALL
        };
        let lobes = |_: f64, eta: f64, xi: f64| {
            let r = 0.4 + 0.06 * xi + 0.05 * (5.0 * eta).cos();
            ([r * eta.cos(), r * eta.sin(), 0.0], 0.0)
        };
        let [_, lobed, _] = FINE.opening((0.0, TAU), wall, lobes).places;
        let [_, round, _] = FINE.opening((0.0, TAU), wall, turned(|_| 0.5)).places;
        assert!(
            lobed.len() as f64 > 1.5 * round.len() as f64,
            "{} {}",
            lobed.len(),
            round.len()
        );
    }

    #[test]
    fn nothing_to_see_is_cut_no_more_than_a_mesh_is() {
        let nothing = |_: f64, _: f64, _: f64| ([f64::NAN; 3], f64::NAN);
        let opening = FINE.opening(HALF, WALL, nothing);
        assert_eq!(opening.places.map(|p| p.len()), [2, 13, 4]);
    }
}
