//! The walls of a path as numbers that a browser draws: sampled, quantised, packed.

use crate::assembly::{Point, Sample, SplineTube};
use crate::report::Field;
use crate::study::{Plan, SavedState};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use rayon::prelude::*;
use serde::Serialize;
use std::f64::consts::TAU;
use std::io::Write;

/// Levels through the wall: of a tube whose meridians are all the same, and of any other.
const LEVELS: [usize; 2] = [9, 5];
/// Meridians that are drawn of a tube whose meridians are all the same.
const TURNS: usize = 96;
/// Points along and around, at most and at least: the finest that leaves the page small enough is taken.
const FINENESS: [[usize; 2]; 4] = [[401, 60], [241, 48], [161, 40], [121, 32]];
/// Steps of a coordinate, and of a value: 255 of the latter would show as bands.
pub const STEPS: (f64, f64) = (65535.0, 4095.0);
/// What stands for a value that is none.
const MISSING: u16 = u16::MAX;
/// Numbers of a point, two bytes each.
const NUMBERS: usize = 3 + Field::ALL.len();
/// The part of all values that the colours span.
const SHOWN: f64 = 0.995;

/// A path of walls.
///
/// A state is a list of bytes: for each of its coordinates (along, up, towards the viewer) and then each of its fields the
/// low bytes of all points and then the high bytes, of the difference to the point before, modulo 2¹⁶; of a coordinate in
/// 65535 steps between `low` and `high`, of a field in 4095 steps between that state's own ends, or 65535 where it has no value. Points run along the tube,
/// then through the wall, then around.
#[derive(Clone, Debug, Serialize)]
pub struct Scene {
    /// Points along the tube, through the wall and around one sector.
    pub points: [usize; 3],
    /// How often the sector is repeated around the tube.
    pub turns: usize,
    /// Least coordinates of all states, in the tables' unit of length.
    pub low: [f64; 3],
    /// Largest.
    pub high: [f64; 3],
    /// The outer diameter at rest in that unit.
    pub diameter: f64,
    /// The farthest that any point of any state is from the axis.
    pub radius: f64,
    /// The fields.
    pub fields: Vec<Colouring>,
    /// Which rows of the history the states are.
    pub rows: Vec<usize>,
    /// States that are saved and left out so that the page stays small.
    pub left_out: usize,
    /// Drawn points at which a field has no value.
    pub missing: usize,
    /// The states, packed with zlib, as base64.
    pub data: String,
}

/// A field of a path.
#[derive(Clone, Debug, Serialize)]
pub struct Colouring {
    /// Its name on the command line.
    pub name: &'static str,
    /// Its name beside a colour bar, as plain text.
    pub label: String,
    /// Ends of its values over the whole path, outliers aside.
    pub range: [f64; 2],
    /// Its largest value.
    pub largest: f64,
    /// Its least and largest value in each state.
    pub ends: Vec<[f64; 2]>,
}

/// A state before it is quantised: by component or field, then by point.
struct Wall {
    position: [Vec<f64>; 3],
    values: Vec<Vec<f64>>,
}

impl Scene {
    /// The saved states of a path, in so many bytes at most before they are packed; the meridian at the angle `upwards` comes
    /// first.
    pub fn of(plan: &Plan, states: &[SavedState], upwards: f64, largest: usize) -> Self {
        let tube = SplineTube::new(&plan.tube, &plan.mesh, plan.mesh.rings(plan.symmetry));
        let (points, turns) = fineness(&tube, states.len(), largest);
        let every = (bytes(points) * states.len()).div_ceil(largest).max(1);
        // The last one always.
        let kept = |i: &usize| (states.len() - 1 - i).is_multiple_of(every);
        let kept: Vec<&SavedState> = (0..states.len()).filter(kept).map(|i| &states[i]).collect();

        let labels: Vec<(String, f64)> = Field::ALL.iter().map(|f| f.label(plan)).collect();
        let length = Field::Displacement.label(plan).1;
        let walls: Vec<Wall> = kept
            .par_iter()
            .map(|state| {
                let at = |point| tube.sample(&state.load, &state.u, point);
                Wall::of(&tube, points, turns, upwards, length, &labels, at)
            })
            .collect();

        let bounds = |i: usize| ends(walls.iter().flat_map(|wall| &wall.position[i]));
        let bounds = [0, 1, 2].map(bounds);
        let mut data = vec![];
        let mut add = |values: &[f64], ends, steps| {
            let differences = differences(values, ends, steps);
            data.extend(differences.iter().map(|step| *step as u8));
            data.extend(differences.iter().map(|step| (step >> 8) as u8));
        };
        for wall in &walls {
            for (values, ends) in wall.position.iter().zip(bounds) {
                add(values, ends, STEPS.0);
            }
            for values in &wall.values {
                add(values, ends(values.iter()), STEPS.1);
            }
        }
        let fields = Field::ALL.iter().zip(labels).enumerate();
        let colouring = fields.map(|(i, (field, (label, _)))| Colouring {
            name: field.name(),
            label: crate::draw::label::plain(&label),
            range: shown(walls.iter().flat_map(|wall| &wall.values[i]).copied()),
            largest: ends(walls.iter().flat_map(|wall| &wall.values[i]))[1],
            ends: walls
                .iter()
                .map(|wall| ends(wall.values[i].iter()))
                .collect(),
        });
        Self {
            points,
            turns,
            low: bounds.map(|[low, _]| low),
            high: bounds.map(|[_, high]| high),
            diameter: length,
            radius: walls.iter().map(Wall::radius).fold(0.0, f64::max),
            fields: colouring.collect(),
            rows: kept.iter().map(|state| state.row).collect(),
            left_out: states.len() - kept.len(),
            missing: walls.iter().map(Wall::missing).sum(),
            data: packed(&data),
        }
    }
}

/// Bytes of a state.
fn bytes(points: [usize; 3]) -> usize {
    points.iter().product::<usize>() * 2 * NUMBERS
}

/// Points along, through and around a sector, and how many sectors there are.
fn fineness(tube: &SplineTube, states: usize, largest: usize) -> ([usize; 3], usize) {
    let along = 2 * tube.axial.elements() + 1;
    let sector = &tube.sector;
    if sector.rings == 1 {
        return ([along.min(FINENESS[0][0]), LEVELS[0], 1], TURNS);
    }
    let turns = sector.around / sector.rings;
    let of = |[most_along, most_around]: [usize; 2]| {
        let around = (3 * sector.around).min(most_around).div_ceil(turns).max(2);
        [along.min(most_along), LEVELS[1], around]
    };
    let small = |points: &[usize; 3]| bytes(*points) * states <= largest;
    let points = FINENESS.map(of).into_iter().find(small);
    (points.unwrap_or(of(FINENESS[3])), turns)
}

impl Wall {
    /// The farthest of its points from the axis.
    fn radius(&self) -> f64 {
        let [_, x, y] = &self.position;
        x.iter()
            .zip(y)
            .map(|(x, y)| x.hypot(*y))
            .fold(0.0, f64::max)
    }

    /// Points without a value.
    fn missing(&self) -> usize {
        let points = 0..self.position[0].len();
        let none = |p: &usize| self.values.iter().any(|values| !values[*p].is_finite());
        points.filter(none).count()
    }

    fn of(
        tube: &SplineTube,
        [along, through, around]: [usize; 3],
        turns: usize,
        upwards: f64,
        length: f64,
        labels: &[(String, f64)],
        sample: impl Fn(Point) -> Sample,
    ) -> Self {
        let mut wall = Self {
            position: [vec![], vec![], vec![]],
            values: vec![vec![]; Field::ALL.len()],
        };
        let (zs, radii) = (tube.axial.spread(along), tube.wall.spread(through));
        let (sin, cos) = upwards.sin_cos();
        for j in 0..around {
            let angle = upwards + TAU * j as f64 / (around * turns) as f64;
            for &radius in &radii {
                for &z in &zs {
                    let sample = sample(Point { z, radius, angle });
                    let [z, x, y] = sample.position;
                    let place = [z, x * cos + y * sin, y * cos - x * sin];
                    for (list, x) in wall.position.iter_mut().zip(place) {
                        list.push(length * x);
                    }
                    let fields = Field::ALL.iter().zip(labels);
                    for (list, (field, (_, factor))) in wall.values.iter_mut().zip(fields) {
                        list.push(factor * field.of(&sample));
                    }
                }
            }
        }
        wall
    }
}

/// Least and largest of what is finite; nothing and nothing if none is.
fn ends<'a>(values: impl Iterator<Item = &'a f64>) -> [f64; 2] {
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    let finite = values.filter(|x| x.is_finite());
    let [low, high] = finite.fold(none, |[low, high], &x| [low.min(x), high.max(x)]);
    if low <= high { [low, high] } else { [0.0, 0.0] }
}

/// The ends of most values; from zero where that is near.
fn shown(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let mut values: Vec<f64> = values.filter(|x| x.is_finite()).collect();
    let Some(last) = values.len().checked_sub(1) else {
        return [0.0, 1.0];
    };
    let mut at = |part: f64| {
        let place = (last as f64 * part).round() as usize;
        *values.select_nth_unstable_by(place, f64::total_cmp).1
    };
    let (least, low, high) = (at(0.0), at(1.0 - SHOWN), at(SHOWN));
    let low = if least < 0.0 { low } else { least };
    let low = if (0.0..0.25 * high).contains(&low) {
        0.0
    } else {
        low
    };
    if high - low > 1e-9 * high.abs().max(low.abs()) {
        [low, high]
    } else {
        [low - 0.5, low + 0.5]
    }
}

/// Values in so many steps between two ends, each less the one before it.
fn differences(values: &[f64], [low, high]: [f64; 2], steps: f64) -> Vec<u16> {
    let scale = if high > low {
        steps / (high - low)
    } else {
        0.0
    };
    let mut before = 0_u16;
    let step = |&x: &f64| {
        let now = if x.is_finite() {
            ((x - low) * scale).round() as u16
        } else {
            MISSING
        };
        let difference = now.wrapping_sub(before);
        before = now;
        difference
    };
    values.iter().map(step).collect()
}

fn packed(data: &[u8]) -> String {
    let mut encoder = ZlibEncoder::new(vec![], Compression::default());
    // Writing to memory does not fail.
    let bytes = encoder.write_all(data).and_then(|()| encoder.finish());
    STANDARD.encode(bytes.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{Material, NeoHookean};
    use crate::study::{Layout, Output};
    use crate::tube::{Mesh, Support, Symmetry, Tube};
    use flate2::read::ZlibDecoder;
    use std::io::Read;

    /// A tube of `12` rings under a symmetry, its states to come.
    fn plan(symmetry: Symmetry) -> Plan {
        Plan {
            title: String::new(),
            tube: Tube {
                length: 1.0,
                thickness: 0.1,
                material: Material::NeoHookean(NeoHookean::new(1.0, 0.3)),
                muscles: vec![],
                ends: [Support::Free; 2],
                imperfections: vec![],
            },
            mesh: Mesh {
                axial: 6,
                around: 12,
                thickness: 4,
                degree: 3,
                refinements: vec![],
                volumetric: Default::default(),
            },
            symmetry,
            start: None,
            modes: vec![],
            stages: vec![],
            solver: Default::default(),
            output: Output::default(),
            units: None,
        }
    }

    /// A tube that is wider along it, and twisted, the more so the later.
    fn state(plan: &Plan, tube: &SplineTube, row: usize) -> SavedState {
        SavedState {
            stage: String::new(),
            row,
            along: 0.0,
            muscles: vec![],
            load: plan.tube.rest(),
            layout: Layout::of(plan),
            u: tube.control_values(|z, r, _| {
                [0.1 * z * z, 0.2 * z * r, 0.3 * z * r].map(|x| x * row as f64)
            }),
            arrays: Default::default(),
        }
    }

    /// What the page's script does, in Rust.
    fn unpacked(bytes: &[u8], [low, high]: [f64; 2], steps: f64) -> Vec<f64> {
        let (lows, highs) = bytes.split_at(bytes.len() / 2);
        let mut step = 0_u16;
        let number = |(a, b): (&u8, &u8)| {
            step = step.wrapping_add(u16::from_le_bytes([*a, *b]));
            low + (high - low) * f64::from(step) / steps
        };
        lows.iter().zip(highs).map(number).collect()
    }

    fn is_where_the_tube_is(symmetry: Symmetry) {
        let plan = plan(symmetry);
        let tube = SplineTube::new(&plan.tube, &plan.mesh, plan.mesh.rings(symmetry));
        let (states, upwards) = ([1, 2].map(|row| state(&plan, &tube, row)), 0.4);
        let scene = Scene::of(&plan, &states, upwards, 1 << 30);
        assert_eq!((scene.rows.as_slice(), scene.left_out), (&[1, 2][..], 0));
        let [along, through, around] = scene.points;
        let count = along * through * around;
        let mut bytes = vec![];
        let packed = STANDARD.decode(&scene.data).unwrap();
        ZlibDecoder::new(&packed[..])
            .read_to_end(&mut bytes)
            .unwrap();
        assert_eq!(bytes.len(), 2 * 2 * NUMBERS * count);
        for (k, state) in states.iter().enumerate() {
            let part = |which: usize| {
                let start = 2 * count * (NUMBERS * k + which);
                &bytes[start..start + 2 * count]
            };
            let position =
                [0, 1, 2].map(|i| unpacked(part(i), [scene.low[i], scene.high[i]], STEPS.0));
            let fields = scene.fields.iter().enumerate();
            let values: Vec<Vec<f64>> = fields
                .map(|(f, field)| unpacked(part(3 + f), field.ends[k], STEPS.1))
                .collect();
            for point in (0..count).step_by(7) {
                let (i, level, j) = (
                    point % along,
                    point / along % through,
                    point / along / through,
                );
                let angle = TAU * j as f64 / (around * scene.turns) as f64;
                let sample = tube.sample(
                    &state.load,
                    &state.u,
                    Point {
                        z: tube.axial.spread(along)[i],
                        radius: tube.wall.spread(through)[level],
                        angle: angle + upwards,
                    },
                );
                let [z, x, y] = sample.position;
                let (sin, cos) = upwards.sin_cos();
                // Turned back by where it is to point up from.
                let place = [z, x * cos + y * sin, y * cos - x * sin];
                for c in 0..3 {
                    let off = (position[c][point] - place[c]).abs();
                    assert!(off <= (scene.high[c] - scene.low[c]) / STEPS.0, "{off}");
                }
                for (f, field) in Field::ALL.iter().enumerate() {
                    let [low, high] = scene.fields[f].ends[k];
                    let off = (values[f][point] - field.of(&sample)).abs();
                    assert!(off <= (high - low) / STEPS.1 + 1e-15, "{field:?} {off}");
                }
            }
        }
    }

    #[test]
    fn what_is_unpacked_is_where_the_tube_is() {
        for symmetry in [Symmetry::Axisymmetric, Symmetry::Fold(4), Symmetry::None] {
            is_where_the_tube_is(symmetry);
        }
    }

    #[test]
    fn a_long_path_stays_small() {
        let plan = plan(Symmetry::None);
        let tube = SplineTube::new(&plan.tube, &plan.mesh, 12);
        let whole = |states: usize| {
            let (points, turns) = fineness(&tube, states, 10_000_000);
            assert_eq!(turns, 1);
            bytes(points) * states
        };
        assert!(whole(10) <= 10_000_000 && whole(100) <= 10_000_000);
        let states: Vec<SavedState> = (0..7).map(|row| state(&plan, &tube, row)).collect();
        let two = 2 * bytes(fineness(&tube, 7, 1).0);
        let scene = Scene::of(&plan, &states, 0.0, two);
        // Never the last.
        assert_eq!((scene.rows.as_slice(), scene.left_out), (&[2, 6][..], 5));
    }

    #[test]
    fn what_has_no_value_spoils_nothing() {
        let values = [1.0, f64::NAN, 3.0, -f64::NAN, f64::INFINITY];
        assert_eq!(ends(values.iter()), [1.0, 3.0]);
        assert!(shown(values.into_iter()).iter().all(|x| x.is_finite()));
        assert!(shown([f64::NAN].into_iter()).iter().all(|x| x.is_finite()));
        let steps = differences(&values, [1.0, 3.0], STEPS.1);
        let mut at = 0_u16;
        let steps: Vec<u16> = (steps.iter())
            .map(|step| {
                at = at.wrapping_add(*step);
                at
            })
            .collect();
        assert_eq!(steps, [0, MISSING, 4095, MISSING, MISSING]);
    }

    #[test]
    fn colours_span_most_values() {
        let mut values: Vec<f64> = (0..1000).map(|i| 1e-3 * f64::from(i)).collect();
        values.push(50.0);
        let [low, high] = shown(values.iter().copied());
        assert!(low == 0.0 && (0.9..1.0).contains(&high), "{low} {high}");
        assert_eq!(shown([3.0; 5].into_iter()), [2.5, 3.5]);
    }
}
