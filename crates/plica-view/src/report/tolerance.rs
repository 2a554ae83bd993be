//! How finely a wall is looked at: as finely as its picture shows, and no more.

use crate::draw::{Opening, linspace};
use std::f64::consts::TAU;

/// Position (x, y, z) in D, and the value of a field.
pub(super) type Seen = ([f64; 3], f64);

/// How far what is drawn, which is straight and even between points, may be off a wall and its field, as far as it is probed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Off the wall, in D.
    pub place: f64,
    /// Off the field, as a part of what the colours span.
    pub value: f64,
    /// The values that the colours span: beyond them they do not change.
    pub colours: (f64, f64),
}

/// The wall as a mesh has it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Meshed {
    /// Elements along and through it.
    pub elements: [usize; 2],
    /// Whether all meridians are the same.
    pub axisymmetric: bool,
}

/// Cutting along, joining along, and cutting around or through add up: each may be off by so much of the whole.
const SHARE: f64 = 1.0 / 3.0;
/// How much longer than what it may be off a piece is, at least: shorter than half a pixel it shows nothing.
const SHORTEST: f64 = 1.25;
/// Cells along the tube that are probed, at least: long elements are of several.
const CELLS: usize = 64;
/// Pieces to a cell, at most.
const MOST: f64 = 64.0;
/// Cells around the tube: harmonics up to 12 show.
const STEP: f64 = TAU / 24.0;
/// Cross-sections in which those are probed.
const SECTIONS: usize = 16;
/// Meridians that are probed where not all are the same.
const MERIDIANS: usize = 8;
/// From one to the next, in parts of what stays: they share no period with any lobes.
const GOLDEN: f64 = 0.618_033_988_749_895;
/// Pieces that are drawn as one, at most.
const LONGEST: usize = 32;

/// Where between two points it is looked at how far off they are: an arc is off by 3/4 of the most it ever is, and an S is seen too.
const QUARTERS: [f64; 2] = [0.25, 0.75];

impl Tolerance {
    /// Where to look at the part of a wall between two angles. `at(zeta, eta, xi)` is told ζ in elements.
    pub(super) fn opening(
        &self,
        kept: (f64, f64),
        wall: Meshed,
        at: impl Fn(f64, f64, f64) -> Seen,
    ) -> Opening {
        let [elements, layers] = wall.elements.map(|n| n.max(1));
        let angle = |part: f64| kept.0 + part * (kept.1 - kept.0);
        let meridians = if wall.axisymmetric { 1 } else { MERIDIANS };
        let angles: Vec<f64> = (0..meridians)
            .map(|i| angle((0.5 + i as f64) * GOLDEN % 1.0))
            .collect();
        let sections: Vec<f64> = (0..=elements)
            .step_by(elements.div_ceil(SECTIONS))
            .map(|e| e as f64)
            .collect();

        let lines: Vec<(f64, f64)> = angles
            .iter()
            .flat_map(|&a| [0.0, 0.5, 1.0].map(|xi| (a, xi)))
            .collect();
        let to_an_element = CELLS.div_ceil(elements);
        let mut along = vec![0.0];
        for cell in 0..elements * to_an_element {
            let on = |t: f64| (cell as f64 + t) / to_an_element as f64;
            let pieces = lines.iter();
            let pieces = pieces.map(|&(a, xi)| self.pieces(|t| at(on(t), a, xi)));
            let pieces = largest(pieces).clamp(1.0, MOST).ceil();
            along.extend((1..=pieces as usize).map(|i| on(i as f64 / pieces)));
        }
        let seen = |place: &f64| lines.iter().map(|&(a, xi)| at(*place, a, xi)).collect();
        let seen: Vec<Vec<Seen>> = along.iter().map(seen).collect();
        let along = self
            .needed(&seen)
            .into_iter()
            .map(|i| along[i] / elements as f64);

        let steps = ((kept.1 - kept.0) / STEP).ceil().max(1.0);
        let probed = if wall.axisymmetric { 1.0 } else { steps };
        let arcs = (0..probed as usize)
            .flat_map(|k| sections.iter().map(move |&section| (k as f64, section)));
        let arcs = arcs.flat_map(|(k, section)| [0.0, 1.0].map(|xi| (k, section, xi)));
        let pieces =
            arcs.map(|(k, section, xi)| self.pieces(|t| at(section, angle((k + t) / steps), xi)));
        let around = steps * largest(pieces).clamp(1.0, MOST);

        let threads = angles
            .iter()
            .flat_map(|&a| sections.iter().map(move |&section| (a, section)));
        let threads = threads.flat_map(|(a, section)| (0..layers).map(move |k| (a, section, k)));
        let pieces = threads
            .map(|(a, section, k)| self.pieces(|t| at(section, a, (k as f64 + t) / layers as f64)));
        let through = layers as f64 * largest(pieces).clamp(1.0, MOST).ceil();
        Opening {
            kept,
            parameters: [
                along.collect(),
                linspace(around.ceil() as usize + 1),
                linspace(through as usize + 1),
            ],
        }
    }

    /// Into how many pieces a line between t = 0 and 1 is to be cut: what is off falls with their square.
    fn pieces(&self, line: impl Fn(f64) -> Seen) -> f64 {
        let (begin, end) = (line(0.0), line(1.0));
        let between = QUARTERS.map(line);
        let off = between.each_ref().map(|seen| self.off(&begin, &end, seen));
        let [first, last] = &between;
        let length = distance(&begin, first) + distance(first, last) + distance(last, &end);
        let shown = length / (SHORTEST * self.place);
        (largest(off.into_iter()) * 4.0 / 3.0).sqrt().min(shown)
    }

    /// Of points along several lines, the numbers of those without which a line would be off between others.
    fn needed(&self, seen: &[Vec<Seen>]) -> Vec<usize> {
        let mut needed = vec![0];
        let mut begin = 0;
        for end in 2..seen.len() {
            let straight = |between: usize| {
                let ends = seen[begin].iter().zip(&seen[end]);
                let mut lines = ends.zip(&seen[between]);
                lines.all(|((begin, end), between)| self.off(begin, end, between) <= 1.0)
            };
            if end - begin > LONGEST || !(begin + 1..end).all(straight) {
                begin = end - 1;
                needed.push(begin);
            }
        }
        needed.extend(seen.len().checked_sub(1).filter(|&last| last > 0));
        needed
    }

    /// How far a point is off what is straight and even between two others, over its share. What has no place is not off;
    /// what has a value between points that have none, or none between such that have, is.
    fn off(&self, begin: &Seen, end: &Seen, between: &Seen) -> f64 {
        let minus = |a: &Seen, b: &Seen| -> [f64; 3] { std::array::from_fn(|i| a.0[i] - b.0[i]) };
        let (chord, way) = (minus(end, begin), minus(between, begin));
        let t = dot(way, chord) / dot(chord, chord).max(f64::MIN_POSITIVE);
        let t = t.clamp(0.0, 1.0);
        let apart: [f64; 3] = std::array::from_fn(|i| way[i] - t * chord[i]);
        let [begin, end, value] = [begin, end, between].map(|seen| self.shade(seen.1));
        let value = if value.is_nan() == begin.is_nan() && value.is_nan() == end.is_nan() {
            (value - (begin + t * (end - begin))).abs()
        } else {
            f64::INFINITY
        };
        let off = [dot(apart, apart).sqrt() / self.place, value / self.value];
        largest(off.into_iter()) / SHARE
    }

    /// Where along the colours a value is, 0 to 1; NaN for none.
    fn shade(&self, value: f64) -> f64 {
        let (low, high) = self.colours;
        let shade = (value - low) / (high - low);
        if shade.is_nan() {
            shade
        } else {
            shade.clamp(0.0, 1.0)
        }
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn distance(a: &Seen, b: &Seen) -> f64 {
    let apart: [f64; 3] = std::array::from_fn(|i| a.0[i] - b.0[i]);
    dot(apart, apart).sqrt()
}

/// The largest of what is a number.
fn largest(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::REAR_HALF;

    const FINE: Tolerance = Tolerance {
        place: 3e-3,
        value: 0.03,
        colours: (0.0, 1.0),
    };
    const ROUND: Meshed = Meshed {
        elements: [80, 3],
        axisymmetric: true,
    };
    const LOBED: Meshed = Meshed {
        axisymmetric: false,
        ..ROUND
    };

    /// A tube of that radius at ζ in elements and η, eight long.
    fn turned(radius: impl Fn(f64, f64) -> f64) -> impl Fn(f64, f64, f64) -> Seen {
        move |zeta, eta, xi| {
            let r = radius(zeta, eta) - 0.06 * (1.0 - xi);
            ([r * eta.cos(), r * eta.sin(), 0.1 * zeta], xi * xi)
        }
    }

    /// How far a meridian is off its chords, at most.
    fn off(along: &[f64], radius: impl Fn(f64) -> f64) -> f64 {
        let at = |zeta: f64| (8.0 * zeta, radius(80.0 * zeta));
        let pairs = along.windows(2).flat_map(|pair| {
            let (begin, end) = (at(pair[0]), at(pair[1]));
            let (dz, dr) = (end.0 - begin.0, end.1 - begin.1);
            (1..10).map(move |k| {
                let (z, r) = at(pair[0] + 0.1 * f64::from(k) * (pair[1] - pair[0]));
                ((z - begin.0) * dr - (r - begin.1) * dz).abs() / dz.hypot(dr)
            })
        });
        largest(pairs)
    }

    #[test]
    fn a_cylinder_is_cut_around_alone() {
        let opening = FINE.opening(REAR_HALF, ROUND, turned(|_, _| 0.5));
        let [along, around, through] = &opening.parameters;
        // Joined, 32 pieces at a time.
        assert_eq!(along, &[0.0, 0.4, 0.8, 1.0]);
        // r (1 − cos(step / 2)) is what an arc is off its chord.
        let step = std::f64::consts::PI / (around.len() - 1) as f64;
        let off = 0.5 * (1.0 - (0.5 * step).cos());
        assert!((0.8e-3..1.02e-3).contains(&off), "{off}");
        // ξ² over a third of the wall is off by 1/36.
        assert_eq!(through.len(), 3 * 2 + 1);
    }

    #[test]
    fn folds_are_cut_and_what_is_straight_is_not() {
        let radius = |zeta: f64| 0.5 - 0.3 * (-((zeta - 40.0) / 4.0).powi(2)).exp();
        let of = |tolerance: Tolerance| {
            let opening = tolerance.opening(REAR_HALF, ROUND, turned(|zeta, _| radius(zeta)));
            let [along, ..] = opening.parameters;
            assert!(along.windows(2).all(|pair| pair[0] < pair[1]));
            assert_eq!((along[0], along[along.len() - 1]), (0.0, 1.0));
            let off = off(&along, radius);
            assert!(off < tolerance.place, "{off}");
            along
        };
        let along = of(FINE);
        let within = |from: f64, to: f64| {
            let elements = along.iter().map(|zeta| 80.0 * zeta);
            elements.filter(|zeta| (from..to).contains(zeta)).count()
        };
        assert!(within(-0.5, 25.0) <= 2, "{}", within(-0.5, 25.0));
        assert!(within(35.0, 45.0) >= 8, "{}", within(35.0, 45.0));
        let finer = Tolerance {
            place: 1e-4,
            ..FINE
        };
        assert!(of(finer).len() > 2 * along.len());
    }

    #[test]
    fn few_long_elements_are_cut_into_many_pieces() {
        let radius = |zeta: f64| 0.5 + 0.05 * (zeta * std::f64::consts::PI).cos();
        let long = Meshed {
            elements: [3, 3],
            ..ROUND
        };
        let on = |zeta: f64| radius(zeta * 80.0 / 3.0 / 3.0);
        let opening = FINE.opening(REAR_HALF, long, |zeta, eta, xi| {
            let ([x, y, _], value) = turned(|zeta, _| on(zeta))(zeta, eta, xi);
            ([x, y, 8.0 * zeta / 3.0], value)
        });
        let off = off(&opening.parameters[0], |zeta| radius(zeta / 9.0));
        assert!(off < FINE.place, "{off}");
    }

    #[test]
    fn values_beyond_the_colours_and_pieces_below_a_pixel_are_not_cut() {
        let rough = |zeta: f64, eta: f64, xi: f64| {
            let (place, _) = turned(|_, _| 0.5)(zeta, eta, xi);
            (place, (1e3 * zeta).sin())
        };
        let along = |colours, place| {
            let tolerance = Tolerance {
                colours,
                place,
                ..FINE
            };
            tolerance.opening(REAR_HALF, ROUND, rough).parameters[0].len()
        };
        assert!(along((2.0, 3.0), 1e-3) < 5);
        // Pieces of 1.25e-2 and more, of a tube of 8.
        let many = along((-1.0, 1.0), 1e-2);
        assert!((320..=720).contains(&many), "{many}");
    }

    #[test]
    fn lobes_are_seen_where_meridians_differ() {
        let around = |radius: fn(f64, f64) -> f64| {
            let [_, around, _] = FINE.opening((0.0, TAU), LOBED, turned(radius)).parameters;
            around.len() as f64
        };
        let (lobed, round) = (
            around(|_, eta| 0.5 + 0.05 * (5.0 * eta).cos()),
            around(|_, _| 0.5),
        );
        assert!(lobed > 1.5 * round, "{lobed} {round}");
        // Lobes that come and go along the tube, of any number.
        for n in 2..15 {
            let radius = |zeta: f64, eta: f64| {
                0.5 + 0.05 * (-((zeta - 40.0) / 4.0).powi(2)).exp() * (f64::from(n) * eta).cos()
            };
            let [along, ..] = FINE.opening((0.0, TAU), LOBED, turned(radius)).parameters;
            let off = off(&along, |zeta| radius(zeta, 0.0));
            assert!(off < FINE.place, "{n} {off}");
        }
    }

    #[test]
    fn nothing_to_see_is_cut_no_more_than_it_is_probed() {
        let nothing = |_: f64, _: f64, _: f64| ([f64::NAN; 3], f64::NAN);
        let opening = FINE.opening(REAR_HALF, ROUND, nothing);
        assert_eq!(opening.parameters.map(|p| p.len()), [4, 13, 4]);
        let none = Tolerance {
            place: 0.0,
            value: f64::NAN,
            colours: (1.0, 1.0),
        };
        let opening = none.opening(REAR_HALF, ROUND, turned(|_, _| 0.5));
        assert!(opening.parameters[0].len() <= 80 * 64 + 1);
    }
}
