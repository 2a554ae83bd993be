//! The walls of a path as numbers that a browser draws: sampled, quantised, packed.

use crate::draw::ColourMap;
use crate::report::Field;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use plica::assembly::{Point, Sample, SplineTube};
use plica::saved_state::SavedState;
use plica::study::Plan;
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

/// A path of walls.
///
/// A state is a list of bytes: for each of its coordinates (along, up, towards the viewer) and then each of its fields the
/// low bytes of all points and then the high bytes, of the difference to the point before, modulo 2¹⁶; of a coordinate in
/// 65535 steps between `low` and `high`, of a field in 4095 steps between that state's own ends, or 65535 where it has no value. Points run along the tube,
/// then through the wall, then around.
#[derive(Clone, Debug, Serialize)]
pub struct Scene {
    /// Whether there is anything to draw.
    pub drawn: bool,
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
    /// Whether its colours are those of two signs, with zero in the middle.
    pub signed: bool,
    /// What its colours span over the whole path.
    pub range: [f64; 2],
    /// Its least value.
    pub least: f64,
    /// Its largest.
    pub largest: f64,
    /// Its least and largest value in each state.
    pub ends: Vec<[f64; 2]>,
}

/// A state before it is quantised: by component or field, then by point.
struct Wall {
    position: [Vec<f64>; 3],
    values: Vec<Vec<f64>>,
}

/// Which of a run's saved states are drawn, in so many bytes at most before they are packed.
pub fn drawn(plan: &Plan, saved: &[usize], largest: usize) -> Vec<usize> {
    let tube = tube_of(plan);
    let (points, _) = fineness(&tube, saved.len(), largest);
    let every = (bytes(points) * saved.len()).div_ceil(largest).max(1);
    // The last one always.
    let kept = |(i, _): &(usize, &usize)| (saved.len() - 1 - i).is_multiple_of(every);
    let kept = saved.iter().enumerate().filter(kept);
    kept.map(|(_, number)| *number).collect()
}

fn tube_of(plan: &Plan) -> SplineTube {
    SplineTube::new(&plan.tube, &plan.mesh, plan.mesh.rings(plan.symmetry))
}

impl Scene {
    /// The path of a run that has saved no state: its rows, and nothing to draw.
    pub fn without(plan: &Plan, rows: Vec<usize>) -> Self {
        Self {
            drawn: false,
            points: [0; 3],
            turns: 0,
            low: [0.0; 3],
            high: [0.0; 3],
            diameter: Field::Displacement.label(plan).1,
            radius: 0.0,
            fields: vec![],
            rows,
            missing: 0,
            data: String::new(),
        }
    }

    /// The states of a path; the meridian at the angle `upwards` comes first. As fine as so many bytes allow.
    pub fn of(plan: &Plan, states: &[SavedState], upwards: f64, largest: usize) -> Self {
        let tube = tube_of(plan);
        let (points, turns) = fineness(&tube, states.len(), largest);
        let labels: Vec<(String, f64)> = Field::ALL.iter().map(|f| f.label(plan)).collect();
        let length = Field::Displacement.label(plan).1;
        let walls: Vec<Wall> = states
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
        let colouring = fields.map(|(i, (field, (label, _)))| {
            let values = walls.iter().flat_map(|wall| &wall.values[i]).copied();
            let spanned = field.range().resolve(values).ok();
            Colouring {
                name: field.name(),
                label: crate::draw::label::plain(&label),
                signed: field.map() == ColourMap::Diverging,
                range: spanned.map_or([0.0, 1.0], |field| [field.low, field.high]),
                least: spanned.map_or(0.0, |field| field.min),
                largest: spanned.map_or(1.0, |field| field.max),
                ends: walls
                    .iter()
                    .map(|wall| ends(wall.values[i].iter()))
                    .collect(),
            }
        });
        Self {
            drawn: true,
            points,
            turns,
            low: bounds.map(|[low, _]| low),
            high: bounds.map(|[_, high]| high),
            diameter: length,
            radius: walls.iter().map(Wall::radius).fold(0.0, f64::max),
            fields: colouring.collect(),
            rows: states.iter().map(|state| state.row).collect(),
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
    use crate::fixture::{plan, state};
    use flate2::read::ZlibDecoder;
    use plica::tube::Symmetry;
    use std::io::Read;

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
        let (states, upwards) = ([1, 2].map(|row| state(&plan, row)), 0.4);
        let scene = Scene::of(&plan, &states, upwards, 1 << 30);
        assert_eq!(scene.rows, [1, 2]);
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
        let saved: Vec<usize> = (0..7).collect();
        let two = 2 * bytes(fineness(&tube, 7, 1).0);
        // The last one always.
        assert_eq!(drawn(&plan, &saved, two), [2, 6]);
        assert_eq!(drawn(&plan, &saved, 100 * two), saved);
        assert!(drawn(&plan, &[], two).is_empty());
    }

    #[test]
    fn what_has_no_value_spoils_nothing() {
        let values = [1.0, f64::NAN, 3.0, -f64::NAN, f64::INFINITY];
        assert_eq!(ends(values.iter()), [1.0, 3.0]);
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
    fn a_run_without_saved_states_has_its_rows() {
        let scene = Scene::without(&plan(Symmetry::Axisymmetric), vec![0, 1, 2]);
        assert!(!scene.drawn && scene.data.is_empty() && scene.rows == [0, 1, 2]);
    }
}
