//! Profiles of the outer and inner wall at several states.

use super::VISIBLE_ASYMMETRY;
use super::labels::unit;
use crate::draw::{Chart, Curve, Stroke};
use crate::obstacle_shapes::sections;
use plica::assembly::SplineTube;
use plica::measure::{Asymmetry, Face, Meridians};
use plica::study::{Plan, Scale};
use plica::tube::Load;

/// Points per element along a drawn wall.
const POINTS_PER_ELEMENT: usize = 4;

/// A state and its label.
#[derive(Clone, Debug)]
pub(super) struct Wall<'a> {
    /// Name in the legend.
    pub label: String,
    /// Load.
    pub load: &'a Load,
    /// Vector of unknowns.
    pub u: &'a [f64],
}

/// Returns the largest asymmetry of the states; all are drawn in its plane.
fn asymmetry(tube: &SplineTube, states: &[Wall<'_>]) -> Asymmetry {
    let of = |state: &Wall<'_>| Meridians::of(tube, state.load, state.u).asymmetry();
    let largest = states.iter().map(of);
    let largest = largest.max_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
    largest.unwrap_or_default()
}

/// Plots the outer and inner wall of states. A visibly asymmetric tube is shown by two meridians: at the crest above the axis
/// and at the trough below it.
pub(super) fn walls(plan: &Plan, tube: &SplineTube, states: &[Wall<'_>]) -> Chart {
    let scale = Scale::of(plan.units.as_ref());
    let length = scale.length;
    let asymmetry = asymmetry(tube, states);
    let both = asymmetry.crest_and_trough();
    let axisymmetric = asymmetry.amplitude < VISIBLE_ASYMMETRY;
    let angles = if axisymmetric { &both[..1] } else { &both };
    let z = tube
        .axial
        .positions(tube.axial.elements() * POINTS_PER_ELEMENT + 1);
    let mut curves = vec![];
    for (colour, state) in states.iter().enumerate() {
        let meridians = Meridians::of(tube, state.load, state.u);
        for (face, stroke) in [(Face::Outer, Stroke::Solid), (Face::Inner, Stroke::Thin)] {
            let label = if face == Face::Outer {
                state.label.clone()
            } else {
                String::new()
            };
            let mut points = vec![];
            for (wall, side) in (meridians.walls(face, angles, &z).iter()).zip([1.0, -1.0]) {
                points.extend(
                    wall.points
                        .iter()
                        .map(|&(z, r)| (length * z, length * side * r)),
                );
                points.push((f64::NAN, f64::NAN));
            }
            curves.push(Curve {
                label,
                points,
                colour: colour + 1,
                stroke,
                ..Curve::default()
            });
        }
    }
    curves.extend(obstacles(tube, states, angles, length));
    curves.push(Curve {
        label: "inner wall".into(),
        stroke: Stroke::Thin,
        ..Curve::default()
    });
    let finite = |p: &&(f64, f64)| p.0.is_finite();
    let points = || curves.iter().flat_map(|curve| &curve.points).filter(finite);
    let highest = points().map(|p| p.1).fold(0.55 * length, f64::max);
    let lowest = if axisymmetric {
        0.0
    } else {
        points().map(|p| p.1).fold(-0.55 * length, f64::min) - 0.05 * length
    };
    let (low, high) = points().fold((0.0_f64, length * plan.tube.length), |(low, high), p| {
        (low.min(p.0), high.max(p.0))
    });
    if !axisymmetric {
        let axis = Curve {
            points: vec![(low, 0.0), (high, 0.0)],
            stroke: Stroke::Dashed,
            ..Curve::default()
        };
        curves.push(axis);
    }
    let [crest, trough] = both.map(|angle| (angle.to_degrees().round() + 0.0).rem_euclid(360.0));
    Chart {
        title: if axisymmetric {
            String::new()
        } else {
            format!("meridian at {crest}° above *r* = 0, at {trough}° below")
        },
        x_label: format!("*z* ({})", unit(&scale.length_name)),
        y_label: format!("*r* ({})", unit(&scale.length_name)),
        equal_aspect: true,
        x_range: Some((low, high)),
        y_range: Some((lowest, 0.05 * length + highest)),
        width_pt: 510.0,
        curves,
        ..Chart::default()
    }
}

/// Returns the sections of obstacles by the half-planes at angles, the second below the axis: in the colour of their state, or
/// black if they are the same in all states.
fn obstacles(tube: &SplineTube, states: &[Wall<'_>], angles: &[f64], length: f64) -> Vec<Curve> {
    let first = states.first().map(|state| &state.load.obstacles);
    let mut curves = vec![];
    for (number, obstacle) in tube.tube.obstacles.iter().enumerate() {
        let is_placed_as_first = |state: &Wall<'_>| {
            first.is_some_and(|first| first[number] == state.load.obstacles[number])
        };
        let moves = !states.iter().all(is_placed_as_first);
        let shown = match moves {
            true => states,
            false => &states[..states.len().min(1)],
        };
        let before = curves.len();
        for (colour, state) in shown.iter().enumerate() {
            let mut points = vec![];
            for (&angle, side) in angles.iter().zip([1.0, -1.0]) {
                let sections = sections(tube, state.load, angle).into_iter();
                let own = sections.filter(|section| section.obstacle == number);
                for line in own.flat_map(|section| section.lines) {
                    points.extend(line.iter().map(|[z, r]| (length * z, length * side * r)));
                    points.push((f64::NAN, f64::NAN));
                }
            }
            if !points.is_empty() {
                curves.push(Curve {
                    label: String::new(),
                    points,
                    colour: if moves { colour + 1 } else { 0 },
                    stroke: Stroke::Dashed,
                    ..Curve::default()
                });
            }
        }
        if curves.len() > before {
            curves.push(Curve {
                label: obstacle.name.clone(),
                stroke: Stroke::Dashed,
                ..Curve::default()
            });
        }
    }
    curves
}
