//! Adaptive sampling of a wall to the accuracy that a picture needs.

use crate::draw::vec3::{dot, minus};
use crate::draw::{Opening, linspace};
use std::f64::consts::TAU;

/// Position (x, y, z) in units of D, and the value of a field.
pub(super) type Sampled = ([f64; 3], f64);

/// Maximum error of the piecewise linear surfaces relative to the wall and its field, at the probed points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tolerance {
    /// Error of the position, in units of D.
    pub position: f64,
    /// Error of the field, relative to the colour range.
    pub value: f64,
    /// Colour range; colours are constant beyond it.
    pub colours: (f64, f64),
}

/// Properties of the mesh of a wall.
#[derive(Clone, Copy, Debug)]
pub(super) struct MeshInfo {
    /// Elements along the tube and through the wall.
    pub elements: [usize; 2],
    /// True if all meridians are equal.
    pub axisymmetric: bool,
}

/// Share of the tolerance of each of three steps whose errors add up: subdividing along, merging along, and subdividing
/// around or through.
const SHARE: f64 = 1.0 / 3.0;
/// Minimum length of an interval, in units of the tolerance of the position: about half a pixel.
const MIN_LENGTH: f64 = 1.25;
/// Minimum number of probed cells along the tube; long elements consist of several cells.
const MIN_CELLS: usize = 64;
/// Maximum number of intervals per cell.
const MAX_INTERVALS: f64 = 64.0;
/// Angle of a cell around the tube; it resolves circumferential modes up to 12.
const CELL_ANGLE: f64 = TAU / 24.0;
/// Maximum number of probed cross-sections.
const SECTIONS: usize = 16;
/// Number of probed meridians of a tube that is not axisymmetric.
const MERIDIANS: usize = 8;
/// Distance between probed meridians as a fraction of the kept part; it is incommensurable with any lobes.
const GOLDEN: f64 = 0.618_033_988_749_895;
/// Maximum number of intervals that are merged.
const MAX_MERGED: usize = 32;

/// Parameters between two points at which the error is probed. The error of an arc there is 3/4 of its maximum, and an S-shaped
/// curve is detected as well.
const PROBES: [f64; 2] = [0.25, 0.75];

impl Tolerance {
    /// Returns the sampling of the part of a wall between two angles. The argument ζ of `at(zeta, eta, xi)` counts elements.
    pub(super) fn opening(
        &self,
        kept: (f64, f64),
        wall: MeshInfo,
        at: impl Fn(f64, f64, f64) -> Sampled,
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
        let cells_per_element = MIN_CELLS.div_ceil(elements);
        let mut along = vec![0.0];
        for cell in 0..elements * cells_per_element {
            let on = |t: f64| (cell as f64 + t) / cells_per_element as f64;
            let intervals = lines.iter();
            let intervals = intervals.map(|&(a, xi)| self.intervals(|t| at(on(t), a, xi)));
            let intervals = largest(intervals).clamp(1.0, MAX_INTERVALS).ceil();
            along.extend((1..=intervals as usize).map(|i| on(i as f64 / intervals)));
        }
        let sample = |zeta: &f64| lines.iter().map(|&(a, xi)| at(*zeta, a, xi)).collect();
        let samples: Vec<Vec<Sampled>> = along.iter().map(sample).collect();
        let along = self
            .needed(&samples)
            .into_iter()
            .map(|i| along[i] / elements as f64);

        let steps = ((kept.1 - kept.0) / CELL_ANGLE).ceil().max(1.0);
        let probed = if wall.axisymmetric { 1.0 } else { steps };
        let arcs = (0..probed as usize)
            .flat_map(|k| sections.iter().map(move |&section| (k as f64, section)));
        let arcs = arcs.flat_map(|(k, section)| [0.0, 1.0].map(|xi| (k, section, xi)));
        let intervals = arcs
            .map(|(k, section, xi)| self.intervals(|t| at(section, angle((k + t) / steps), xi)));
        let around = steps * largest(intervals).clamp(1.0, MAX_INTERVALS);

        let lines = angles
            .iter()
            .flat_map(|&a| sections.iter().map(move |&section| (a, section)));
        let lines = lines.flat_map(|(a, section)| (0..layers).map(move |k| (a, section, k)));
        let intervals = lines.map(|(a, section, k)| {
            self.intervals(|t| at(section, a, (k as f64 + t) / layers as f64))
        });
        let through = layers as f64 * largest(intervals).clamp(1.0, MAX_INTERVALS).ceil();
        Opening {
            kept,
            parameters: [
                along.collect(),
                linspace(around.ceil() as usize + 1),
                linspace(through as usize + 1),
            ],
        }
    }

    /// Returns the required number of intervals of a line from t = 0 to 1; the error decreases with their square.
    fn intervals(&self, line: impl Fn(f64) -> Sampled) -> f64 {
        let (begin, end) = (line(0.0), line(1.0));
        let between = PROBES.map(line);
        let errors = between
            .each_ref()
            .map(|sample| self.error(&begin, &end, sample));
        let [first, last] = &between;
        let length = distance(&begin, first) + distance(first, last) + distance(last, &end);
        let visible = length / (MIN_LENGTH * self.position);
        (largest(errors.into_iter()) * 4.0 / 3.0)
            .sqrt()
            .min(visible)
    }

    /// Returns the indices of the points that are needed to keep the error along several lines within the tolerance.
    fn needed(&self, samples: &[Vec<Sampled>]) -> Vec<usize> {
        let mut needed = vec![0];
        let mut begin = 0;
        for end in 2..samples.len() {
            let straight = |between: usize| {
                let ends = samples[begin].iter().zip(&samples[end]);
                let mut lines = ends.zip(&samples[between]);
                lines.all(|((begin, end), between)| self.error(begin, end, between) <= 1.0)
            };
            if end - begin > MAX_MERGED || !(begin + 1..end).all(straight) {
                begin = end - 1;
                needed.push(begin);
            }
        }
        needed.extend(samples.len().checked_sub(1).filter(|&last| last > 0));
        needed
    }

    /// Returns the error of linear interpolation between two points at a third one, relative to its share of the tolerance. The
    /// error is zero for an undefined position, and infinite if only some of the three values are undefined.
    fn error(&self, begin: &Sampled, end: &Sampled, between: &Sampled) -> f64 {
        let (chord, offset) = (minus(end.0, begin.0), minus(between.0, begin.0));
        let t = dot(offset, chord) / dot(chord, chord).max(f64::MIN_POSITIVE);
        let t = t.clamp(0.0, 1.0);
        let deviation = minus(offset, chord.map(|c| t * c));
        let [begin, end, value] = [begin, end, between].map(|sample| self.shade(sample.1));
        let value = if value.is_nan() == begin.is_nan() && value.is_nan() == end.is_nan() {
            (value - (begin + t * (end - begin))).abs()
        } else {
            f64::INFINITY
        };
        let errors = [
            dot(deviation, deviation).sqrt() / self.position,
            value / self.value,
        ];
        largest(errors.into_iter()) / SHARE
    }

    /// Returns the position of a value in the colour range, clamped to 0 to 1; NaN for a missing value.
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

fn distance(a: &Sampled, b: &Sampled) -> f64 {
    let difference = minus(a.0, b.0);
    dot(difference, difference).sqrt()
}

/// Returns the largest number, ignoring NaN; at least zero.
fn largest(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::REAR_HALF;

    const FINE: Tolerance = Tolerance {
        position: 3e-3,
        value: 0.03,
        colours: (0.0, 1.0),
    };
    const ROUND: MeshInfo = MeshInfo {
        elements: [80, 3],
        axisymmetric: true,
    };
    const LOBED: MeshInfo = MeshInfo {
        axisymmetric: false,
        ..ROUND
    };

    /// A tube of length 8 with the given radius at ζ (in elements) and η.
    fn tube(radius: impl Fn(f64, f64) -> f64) -> impl Fn(f64, f64, f64) -> Sampled {
        move |zeta, eta, xi| {
            let r = radius(zeta, eta) - 0.06 * (1.0 - xi);
            ([r * eta.cos(), r * eta.sin(), 0.1 * zeta], xi * xi)
        }
    }

    /// Largest distance of a meridian from its chords.
    fn deviation(along: &[f64], radius: impl Fn(f64) -> f64) -> f64 {
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
    fn a_cylinder_is_subdivided_only_around() {
        let opening = FINE.opening(REAR_HALF, ROUND, tube(|_, _| 0.5));
        let [along, around, through] = &opening.parameters;
        // 32 intervals are merged at a time.
        assert_eq!(along, &[0.0, 0.4, 0.8, 1.0]);
        // The distance of an arc from its chord is r (1 − cos(step / 2)).
        let step = std::f64::consts::PI / (around.len() - 1) as f64;
        let error = 0.5 * (1.0 - (0.5 * step).cos());
        assert!((0.8e-3..1.02e-3).contains(&error), "{error}");
        // Interpolating ξ² linearly over a third of the wall has an error of 1/36.
        assert_eq!(through.len(), 3 * 2 + 1);
    }

    #[test]
    fn folds_are_subdivided_and_straight_parts_are_not() {
        let radius = |zeta: f64| 0.5 - 0.3 * (-((zeta - 40.0) / 4.0).powi(2)).exp();
        let of = |tolerance: Tolerance| {
            let opening = tolerance.opening(REAR_HALF, ROUND, tube(|zeta, _| radius(zeta)));
            let [along, ..] = opening.parameters;
            assert!(along.windows(2).all(|pair| pair[0] < pair[1]));
            assert_eq!((along[0], along[along.len() - 1]), (0.0, 1.0));
            let error = deviation(&along, radius);
            assert!(error < tolerance.position, "{error}");
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
            position: 1e-4,
            ..FINE
        };
        assert!(of(finer).len() > 2 * along.len());
    }

    #[test]
    fn long_elements_have_many_intervals() {
        let radius = |zeta: f64| 0.5 + 0.05 * (zeta * std::f64::consts::PI).cos();
        let long = MeshInfo {
            elements: [3, 3],
            ..ROUND
        };
        let on = |zeta: f64| radius(zeta * 80.0 / 3.0 / 3.0);
        let opening = FINE.opening(REAR_HALF, long, |zeta, eta, xi| {
            let ([x, y, _], value) = tube(|zeta, _| on(zeta))(zeta, eta, xi);
            ([x, y, 8.0 * zeta / 3.0], value)
        });
        let error = deviation(&opening.parameters[0], |zeta| radius(zeta / 9.0));
        assert!(error < FINE.position, "{error}");
    }

    #[test]
    fn values_beyond_the_colour_range_and_tiny_intervals_are_not_refined() {
        let rough = |zeta: f64, eta: f64, xi: f64| {
            let (position, _) = tube(|_, _| 0.5)(zeta, eta, xi);
            (position, (1e3 * zeta).sin())
        };
        let along = |colours, position| {
            let tolerance = Tolerance {
                colours,
                position,
                ..FINE
            };
            tolerance.opening(REAR_HALF, ROUND, rough).parameters[0].len()
        };
        assert!(along((2.0, 3.0), 1e-3) < 5);
        // Intervals of at least 1.25e-2, of a tube of length 8.
        let many = along((-1.0, 1.0), 1e-2);
        assert!((320..=720).contains(&many), "{many}");
    }

    #[test]
    fn lobes_are_resolved() {
        let around = |radius: fn(f64, f64) -> f64| {
            let [_, around, _] = FINE.opening((0.0, TAU), LOBED, tube(radius)).parameters;
            around.len() as f64
        };
        let (lobed, round) = (
            around(|_, eta| 0.5 + 0.05 * (5.0 * eta).cos()),
            around(|_, _| 0.5),
        );
        assert!(lobed > 1.5 * round, "{lobed} {round}");
        // Any number of lobes in part of the tube.
        for n in 2..15 {
            let radius = |zeta: f64, eta: f64| {
                0.5 + 0.05 * (-((zeta - 40.0) / 4.0).powi(2)).exp() * (f64::from(n) * eta).cos()
            };
            let [along, ..] = FINE.opening((0.0, TAU), LOBED, tube(radius)).parameters;
            let error = deviation(&along, |zeta| radius(zeta, 0.0));
            assert!(error < FINE.position, "{n} {error}");
        }
    }

    #[test]
    fn undefined_surfaces_are_not_refined() {
        let nothing = |_: f64, _: f64, _: f64| ([f64::NAN; 3], f64::NAN);
        let opening = FINE.opening(REAR_HALF, ROUND, nothing);
        assert_eq!(opening.parameters.map(|p| p.len()), [4, 13, 4]);
        let none = Tolerance {
            position: 0.0,
            value: f64::NAN,
            colours: (1.0, 1.0),
        };
        let opening = none.opening(REAR_HALF, ROUND, tube(|_, _| 0.5));
        assert!(opening.parameters[0].len() <= 80 * 64 + 1);
    }
}
