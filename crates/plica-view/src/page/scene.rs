//! Walls of a path for the browser: sampling, quantisation, compression.

use crate::draw::ColourMap;
#[cfg(test)]
use crate::draw::ResolvedRange;
use crate::obstacle_shapes::{Body, BodySurface, bodies};
use crate::report::{Field, FieldScales};
use crate::sampled_tube::{FieldSample, SampledTube};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use plica::assembly::{Point, SplineTube};
use plica::saved_state::SavedState;
use plica::study::Plan;
use plica::tube::ObstacleShape;
use rayon::prelude::*;
use serde::Serialize;
use std::f64::consts::TAU;
use std::io::Write;

/// Points through the wall: of an axisymmetric tube, and of any other.
const LEVELS: [usize; 2] = [9, 5];
/// Number of meridians drawn of an axisymmetric tube.
const MERIDIANS: usize = 96;
/// Maximum numbers of points along and around, from fine to coarse. The first resolution within the size limit is used.
const RESOLUTIONS: [[usize; 2]; 4] = [[401, 60], [241, 48], [161, 40], [121, 32]];
/// Quantisation steps of a coordinate and of a field value; 255 steps would be visible as bands.
pub const STEPS: (f64, f64) = (65535.0, 4095.0);
/// Code of a missing value.
const MISSING: u16 = u16::MAX;
/// Returns the numbers per point, two bytes each.
fn numbers(plan: &Plan) -> usize {
    3 + Field::of_plan(plan).len()
}

/// Walls of all drawn states of a path.
///
/// A state is a list of bytes. For each coordinate (along, up, towards the viewer) and then for each field it contains the low
/// bytes of all points followed by the high bytes. They encode the difference to the previous point modulo 2¹⁶, of a coordinate
/// in 65535 steps between `low` and `high`, and of a field in 4095 steps between its ends in that state; 65535 is a missing
/// value. Points are ordered along the tube, then through the wall, then around.
#[derive(Clone, Debug, Serialize)]
pub struct Scene {
    /// True if there are states to draw.
    pub drawn: bool,
    /// Points along the tube, through the wall and around one sector.
    pub points: [usize; 3],
    /// Number of sectors around the tube.
    pub sectors: usize,
    /// Smallest coordinates of all states, in the unit of length of the tables.
    pub low: [f64; 3],
    /// Largest coordinates of all states.
    pub high: [f64; 3],
    /// Outer diameter at rest in that unit.
    pub diameter: f64,
    /// Largest distance of a point from the axis over all states.
    pub radius: f64,
    /// Fields.
    pub fields: Vec<Colouring>,
    /// Obstacles in each state; empty without obstacles.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub obstacles: Vec<Vec<Obstacle>>,
    /// Rows of the history of the states.
    pub rows: Vec<usize>,
    /// Number of points with a missing value.
    pub missing: usize,
    /// All states, compressed with zlib and encoded as base64.
    pub data: String,
}

/// An obstacle near the tube: a profile turned about an axis, or a quadrilateral.
#[derive(Clone, Debug, Serialize)]
pub struct Obstacle {
    /// Points (along, distance from the axis of the body); empty for a quadrilateral.
    profile: Vec<[f64; 2]>,
    /// Position (up, towards the viewer) of the axis.
    axis: [f64; 2],
    /// Corners (along, up, towards the viewer), two rows of two; none of a body with an axis.
    corners: Option<[[f64; 3]; 4]>,
    /// True for a body that would hide the tube.
    translucent: bool,
}

impl Obstacle {
    /// Returns the obstacles in a state, in a unit of length of which D has `length`; the angle `upwards` points up.
    fn all(tube: &SplineTube, state: &SavedState, upwards: f64, length: f64) -> Vec<Self> {
        let (sin, cos) = upwards.sin_cos();
        // A ten thousandth of the diameter is invisible.
        let rounded = |x: f64| length * (1e4 * x).round() / 1e4;
        let turned = |[x, y]: [f64; 2]| [x * cos + y * sin, y * cos - x * sin].map(rounded);
        let of_body = |body: Body| {
            let translucent = matches!(
                body.shape,
                ObstacleShape::Sheath | ObstacleShape::Plate { .. }
            );
            match body.surface {
                BodySurface::Revolved { profile, axis } => Self {
                    profile: profile.into_iter().map(|p| p.map(rounded)).collect(),
                    axis: turned(axis),
                    corners: None,
                    translucent,
                },
                BodySurface::Flat(corners) => Self {
                    profile: vec![],
                    axis: [0.0; 2],
                    corners: Some(corners.map(|[z, x, y]| {
                        let [up, front] = turned([x, y]);
                        [rounded(z), up, front]
                    })),
                    translucent,
                },
            }
        };
        let all = bodies(tube, &state.load).into_iter();
        all.map(of_body).collect()
    }
}

/// A field and its colours.
#[derive(Clone, Debug, Serialize)]
pub struct Colouring {
    /// Name on the command line.
    pub name: &'static str,
    /// Label of the colour bar, as plain text.
    pub label: String,
    /// True for a diverging colour map with zero in the middle.
    pub diverging: bool,
    /// Colour range and extreme values on the whole path.
    pub path: Scale,
    /// Colour range and extreme values in each state.
    pub states: Vec<Scale>,
    /// Smallest and largest value at the drawn points of each state, for the quantisation.
    pub ends: Vec<[f64; 2]>,
}

/// A colour range and the extreme values of a field.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Scale {
    /// Ends of the colour bar.
    pub range: [f64; 2],
    /// Smallest value.
    pub min: f64,
    /// Largest value.
    pub max: f64,
}

impl Scale {
    /// Returns the scale of a field; from 0 to 1 if it has no value.
    fn of(scales: &FieldScales, field: Field, plan: &Plan) -> Self {
        match scales.range(field, plan, None) {
            Ok(found) => Self {
                range: [found.low, found.high],
                min: found.min,
                max: found.max,
            },
            Err(_) => Self {
                range: [0.0, 1.0],
                min: 0.0,
                max: 1.0,
            },
        }
    }
}

/// A state before quantisation: by component or field, then by point.
struct Wall {
    position: [Vec<f64>; 3],
    values: Vec<Vec<f64>>,
}

/// Selects the saved states to draw, which take at most `max_bytes` before compression.
pub fn drawn(plan: &Plan, saved: &[usize], max_bytes: usize) -> Vec<usize> {
    let tube = SampledTube::of(plan);
    let (points, _) = resolution(&tube, numbers(plan), saved.len(), max_bytes);
    let every = (bytes(points, numbers(plan)) * saved.len())
        .div_ceil(max_bytes)
        .max(1);
    // The last state is always kept.
    let kept = |(i, _): &(usize, &usize)| (saved.len() - 1 - i).is_multiple_of(every);
    let kept = saved.iter().enumerate().filter(kept);
    kept.map(|(_, number)| *number).collect()
}

impl Scene {
    /// Creates a scene without states to draw, for a run that has saved none.
    pub fn without(plan: &Plan, rows: Vec<usize>) -> Self {
        Self {
            drawn: false,
            points: [0; 3],
            sectors: 0,
            low: [0.0; 3],
            high: [0.0; 3],
            diameter: Field::Displacement.label(plan).1,
            radius: 0.0,
            fields: vec![],
            obstacles: vec![],
            rows,
            missing: 0,
            data: String::new(),
        }
    }

    /// Samples the states of a path, starting at the meridian at the angle `upwards`, with the finest resolution that
    /// `max_bytes` permits. `path` contains the scales of all saved states.
    pub fn of(
        plan: &Plan,
        states: &[SavedState],
        path: &FieldScales,
        upwards: f64,
        max_bytes: usize,
    ) -> Self {
        let tube = SampledTube::of(plan);
        let (points, sectors) = resolution(&tube, numbers(plan), states.len(), max_bytes);
        let fields = Field::of_plan(plan).into_iter();
        let labels: Vec<(Field, (String, f64))> = fields.map(|f| (f, f.label(plan))).collect();
        let length = Field::Displacement.label(plan).1;
        let walls: Vec<Wall> = states
            .par_iter()
            .map(|state| {
                let sampled = tube.state(&state.load, &state.u);
                let at = |point| sampled.at(point);
                Wall::of(&tube, points, sectors, upwards, length, &labels, at)
            })
            .collect();
        let scales: Vec<FieldScales> = states
            .par_iter()
            .map(|state| FieldScales::of(&tube.state(&state.load, &state.u)))
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
        let fields = labels.into_iter().enumerate();
        let colouring = fields.map(|(i, (field, (label, _)))| Colouring {
            name: field.name(),
            label: crate::draw::label::plain(&label),
            diverging: field.map() == ColourMap::Diverging,
            path: Scale::of(path, field, plan),
            states: scales
                .iter()
                .map(|scales| Scale::of(scales, field, plan))
                .collect(),
            ends: walls
                .iter()
                .map(|wall| ends(wall.values[i].iter()))
                .collect(),
        });
        Self {
            drawn: true,
            points,
            sectors,
            low: bounds.map(|[low, _]| low),
            high: bounds.map(|[_, high]| high),
            diameter: length,
            radius: walls.iter().map(Wall::radius).fold(0.0, f64::max),
            fields: colouring.collect(),
            obstacles: match plan.tube.obstacles.is_empty() {
                true => vec![],
                false => states
                    .iter()
                    .map(|state| Obstacle::all(&tube, state, upwards, length))
                    .collect(),
            },
            rows: states.iter().map(|state| state.row).collect(),
            missing: walls.iter().map(Wall::missing).sum(),
            data: packed(&data),
        }
    }
}

/// Returns the size of a state in bytes.
fn bytes(points: [usize; 3], numbers: usize) -> usize {
    points.iter().product::<usize>() * 2 * numbers
}

/// Returns the number of points along, through and around a sector, and the number of sectors.
fn resolution(
    tube: &SplineTube,
    numbers: usize,
    states: usize,
    max_bytes: usize,
) -> ([usize; 3], usize) {
    let along = 2 * tube.axial.elements() + 1;
    let sector = &tube.sector;
    if sector.rings == 1 {
        return ([along.min(RESOLUTIONS[0][0]), LEVELS[0], 1], MERIDIANS);
    }
    let sectors = sector.around / sector.rings;
    let of = |[most_along, most_around]: [usize; 2]| {
        let around = (3 * sector.around)
            .min(most_around)
            .div_ceil(sectors)
            .max(2);
        [along.min(most_along), LEVELS[1], around]
    };
    let small = |points: &[usize; 3]| bytes(*points, numbers) * states <= max_bytes;
    let points = RESOLUTIONS.map(of).into_iter().find(small);
    (points.unwrap_or(of(RESOLUTIONS[3])), sectors)
}

impl Wall {
    /// Returns the largest distance of a point from the axis.
    fn radius(&self) -> f64 {
        let [_, x, y] = &self.position;
        x.iter()
            .zip(y)
            .map(|(x, y)| x.hypot(*y))
            .fold(0.0, f64::max)
    }

    /// Returns the number of points with a missing value.
    fn missing(&self) -> usize {
        let points = 0..self.position[0].len();
        let none = |p: &usize| self.values.iter().any(|values| !values[*p].is_finite());
        points.filter(none).count()
    }

    fn of(
        tube: &SplineTube,
        [along, through, around]: [usize; 3],
        sectors: usize,
        upwards: f64,
        length: f64,
        labels: &[(Field, (String, f64))],
        sample: impl Fn(Point) -> FieldSample,
    ) -> Self {
        let mut wall = Self {
            position: [vec![], vec![], vec![]],
            values: vec![vec![]; labels.len()],
        };
        let (zs, radii) = (tube.axial.positions(along), tube.wall.positions(through));
        let (sin, cos) = upwards.sin_cos();
        for j in 0..around {
            let angle = upwards + TAU * j as f64 / (around * sectors) as f64;
            for &radius in &radii {
                for &z in &zs {
                    let sample = sample(Point { z, radius, angle });
                    let [z, x, y] = sample.position;
                    let place = [z, x * cos + y * sin, y * cos - x * sin];
                    for (list, x) in wall.position.iter_mut().zip(place) {
                        list.push(length * x);
                    }
                    for (list, (field, (_, factor))) in wall.values.iter_mut().zip(labels) {
                        list.push(factor * field.of(&sample));
                    }
                }
            }
        }
        wall
    }
}

/// Returns the smallest and largest finite value, or zeros if there is none.
fn ends<'a>(values: impl Iterator<Item = &'a f64>) -> [f64; 2] {
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    let finite = values.filter(|x| x.is_finite());
    let [low, high] = finite.fold(none, |[low, high], &x| [low.min(x), high.max(x)]);
    if low <= high { [low, high] } else { [0.0, 0.0] }
}

/// Quantises values in `steps` between two ends and returns the differences between consecutive values.
fn differences(values: &[f64], [low, high]: [f64; 2], steps: f64) -> Vec<u16> {
    let scale = if high > low {
        steps / (high - low)
    } else {
        0.0
    };
    let mut previous = 0_u16;
    let step = |&x: &f64| {
        let code = if x.is_finite() {
            ((x - low) * scale).round() as u16
        } else {
            MISSING
        };
        let difference = code.wrapping_sub(previous);
        previous = code;
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

/// Returns the scene of states for tests.
#[cfg(test)]
pub(crate) fn scene_of_states(plan: &Plan, states: &[SavedState], path: &FieldScales) -> Scene {
    Scene::of(plan, states, path, 0.0, 1 << 30)
}

#[cfg(test)]
impl Scene {
    /// Returns the ranges of a field on the path and in the last state.
    pub fn ends(&self, field: Field) -> (ResolvedRange, ResolvedRange) {
        let one = self.fields.iter().find(|one| one.name == field.name());
        let one = one.unwrap();
        let range = |scale: &Scale| ResolvedRange {
            low: scale.range[0],
            high: scale.range[1],
            min: scale.min,
            max: scale.max,
        };
        (range(&one.path), range(one.states.last().unwrap()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{plan, state};
    use flate2::read::ZlibDecoder;
    use plica::tube::Symmetry;
    use std::io::Read;

    /// Decodes like the script of the page.
    fn decoded(bytes: &[u8], [low, high]: [f64; 2], steps: f64) -> Vec<f64> {
        let (lows, highs) = bytes.split_at(bytes.len() / 2);
        let mut step = 0_u16;
        let number = |(a, b): (&u8, &u8)| {
            step = step.wrapping_add(u16::from_le_bytes([*a, *b]));
            low + (high - low) * f64::from(step) / steps
        };
        lows.iter().zip(highs).map(number).collect()
    }

    fn decoded_scene_equals_the_tube(symmetry: Symmetry) {
        let plan = plan(symmetry);
        let tube = SampledTube::of(&plan);
        let (states, upwards) = ([1, 2].map(|row| state(&plan, row)), 0.4);
        let scales = states
            .each_ref()
            .map(|state| FieldScales::of(&tube.state(&state.load, &state.u)));
        let path = FieldScales::union(scales);
        let scene = Scene::of(&plan, &states, &path, upwards, 1 << 30);
        assert_eq!(scene.rows, [1, 2]);
        let [along, through, around] = scene.points;
        let count = along * through * around;
        let mut bytes = vec![];
        let packed = STANDARD.decode(&scene.data).unwrap();
        ZlibDecoder::new(&packed[..])
            .read_to_end(&mut bytes)
            .unwrap();
        assert_eq!(bytes.len(), 2 * 2 * numbers(&plan) * count);
        for (k, state) in states.iter().enumerate() {
            let part = |which: usize| {
                let start = 2 * count * (numbers(&plan) * k + which);
                &bytes[start..start + 2 * count]
            };
            let position =
                [0, 1, 2].map(|i| decoded(part(i), [scene.low[i], scene.high[i]], STEPS.0));
            let fields = scene.fields.iter().enumerate();
            let values: Vec<Vec<f64>> = fields
                .map(|(f, field)| decoded(part(3 + f), field.ends[k], STEPS.1))
                .collect();
            for point in (0..count).step_by(7) {
                let (i, level, j) = (
                    point % along,
                    point / along % through,
                    point / along / through,
                );
                let angle = TAU * j as f64 / (around * scene.sectors) as f64;
                let sample = tube.state(&state.load, &state.u).at(Point {
                    z: tube.axial.positions(along)[i],
                    radius: tube.wall.positions(through)[level],
                    angle: angle + upwards,
                });
                let [z, x, y] = sample.position;
                let (sin, cos) = upwards.sin_cos();
                // Rotated so that the angle `upwards` points up.
                let expected = [z, x * cos + y * sin, y * cos - x * sin];
                for c in 0..3 {
                    let off = (position[c][point] - expected[c]).abs();
                    assert!(off <= (scene.high[c] - scene.low[c]) / STEPS.0, "{off}");
                }
                for (f, field) in Field::of_plan(&plan).iter().enumerate() {
                    let [low, high] = scene.fields[f].ends[k];
                    let off = (values[f][point] - field.of(&sample)).abs();
                    assert!(off <= (high - low) / STEPS.1 + 1e-15, "{field:?} {off}");
                }
            }
        }
    }

    #[test]
    fn scenes_decode_to_the_sampled_walls() {
        for symmetry in [Symmetry::Axisymmetric, Symmetry::Fold(4), Symmetry::None] {
            decoded_scene_equals_the_tube(symmetry);
        }
    }

    #[test]
    fn scenes_stay_below_the_size_limit() {
        let plan = plan(Symmetry::None);
        let tube = SplineTube::new(&plan.tube, &plan.mesh, 12);
        let whole = |states: usize| {
            let (points, sectors) = resolution(&tube, numbers(&plan), states, 10_000_000);
            assert_eq!(sectors, 1);
            bytes(points, numbers(&plan)) * states
        };
        assert!(whole(10) <= 10_000_000 && whole(100) <= 10_000_000);
        let saved: Vec<usize> = (0..7).collect();
        let two = 2 * bytes(resolution(&tube, numbers(&plan), 7, 1).0, numbers(&plan));
        // The last state is always kept.
        assert_eq!(drawn(&plan, &saved, two), [2, 6]);
        assert_eq!(drawn(&plan, &saved, 100 * two), saved);
        assert!(drawn(&plan, &[], two).is_empty());
    }

    #[test]
    fn missing_values_are_encoded_separately() {
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
    fn a_scene_without_states_contains_the_rows() {
        let scene = Scene::without(&plan(Symmetry::Axisymmetric), vec![0, 1, 2]);
        assert!(!scene.drawn && scene.data.is_empty() && scene.rows == [0, 1, 2]);
    }
}
