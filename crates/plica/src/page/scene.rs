//! The walls of a path as numbers that a browser draws: sampled, quantised, packed.

use crate::assembly::{Point, Sample, SplineTube};
use crate::report::{Field, Shown};
use crate::study::Plan;
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
/// Bytes of all states before they are packed, at most.
const LARGEST: usize = 60_000_000;
/// Steps of a coordinate, and of a value: 255 of the latter would show as bands.
const STEPS: (f64, f64) = (65535.0, 4095.0);
/// Numbers of a point, two bytes each.
const NUMBERS: usize = 3 + Field::ALL.len();
/// The part of all values that the colours span.
const SHOWN: f64 = 0.995;

/// A path of walls.
///
/// A state is a list of bytes: for each of its coordinates (along, up, towards the viewer) and then each of its fields the
/// low bytes of all points and then the high bytes, of the difference to the point before, modulo 2¹⁶; of a coordinate in
/// 65535 steps between `low` and `high`, of a field in 4095 steps between that state's own ends. Points run along the tube,
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
    /// The fields.
    pub fields: Vec<Colouring>,
    /// Which rows of the history the states are.
    pub rows: Vec<usize>,
    /// States that are saved and left out so that the page stays small.
    pub left_out: usize,
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
    /// Its least and largest value in each state.
    pub ends: Vec<[f64; 2]>,
}

/// A state before it is quantised: by component or field, then by point.
struct Wall {
    position: [Vec<f64>; 3],
    values: Vec<Vec<f64>>,
}

impl Scene {
    /// The saved states of a path; the meridian at the angle `upwards` comes first.
    pub fn of(plan: &Plan, states: &[Shown], upwards: f64) -> Self {
        let tube = SplineTube::new(&plan.tube, &plan.mesh, plan.mesh.rings(plan.symmetry));
        let (points, turns) = fineness(&tube, states.len());
        let bytes = points.iter().product::<usize>() * 2 * NUMBERS;
        let every = (bytes * states.len()).div_ceil(LARGEST).max(1);
        // The last one always.
        let kept = |i: &usize| (states.len() - 1 - i).is_multiple_of(every);
        let kept: Vec<&Shown> = (0..states.len()).filter(kept).map(|i| &states[i]).collect();

        let labels: Vec<(String, f64)> = Field::ALL.iter().map(|f| f.label(plan)).collect();
        let length = Field::Displacement.label(plan).1;
        let walls: Vec<Wall> = kept
            .par_iter()
            .map(|(state, _)| {
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
            fields: colouring.collect(),
            rows: kept.iter().map(|(_, row)| row.step).collect(),
            left_out: states.len() - kept.len(),
            data: packed(&data),
        }
    }
}

/// Points along, through and around a sector, and how many sectors there are.
fn fineness(tube: &SplineTube, states: usize) -> ([usize; 3], usize) {
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
    let small =
        |points: &[usize; 3]| points.iter().product::<usize>() * 2 * NUMBERS * states <= LARGEST;
    let points = FINENESS.map(of).into_iter().find(small);
    (points.unwrap_or(of(FINENESS[3])), turns)
}

impl Wall {
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

/// Least and largest.
fn ends<'a>(values: impl Iterator<Item = &'a f64>) -> [f64; 2] {
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    values.fold(none, |[low, high], &x| [low.min(x), high.max(x)])
}

/// The ends of most values; from zero where that is near.
fn shown(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let mut values: Vec<f64> = values.collect();
    let last = values.len() - 1;
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
        let now = ((x - low) * scale).round() as u16;
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
