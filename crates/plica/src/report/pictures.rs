//! The pictures of a run.

use super::opened::opened;
use super::{Abscissa, Story};
use crate::assembly::SplineTube;
use crate::draw::{Chart, Curve, Cutaway, DrawError, Marker, Panel, Rule, Stroke};
use crate::measure::{Departure, Face, Meridians};
use crate::study::{Plan, Row, Scale, Snapshot, Summary};
use rayon::prelude::*;

/// Width of every picture, in pixels.
const WIDTH: usize = 1800;
/// Points per element along a drawn wall.
const POINTS_PER_ELEMENT: usize = 4;
/// Departure from axisymmetry, in D, below which both sides of a tube are drawn as one line.
const VISIBLE: f64 = 2e-3;

/// How a picture comes about.
type Drawing<'a> = dyn Fn() -> Result<Vec<u8>, DrawError> + Sync + 'a;

/// Draws a run: names of files and their PNG bytes. Nothing if the run kept no snapshots.
///
/// - `energy.png`: strain energy along the path;
/// - `walls.png`: outer and inner wall at chosen states;
/// - `tube.png`: the tube cut open at the same states, coloured by strain energy density.
pub fn pictures(plan: &Plan, summary: &Summary) -> Result<Vec<(String, Vec<u8>)>, DrawError> {
    if summary.snapshots().is_empty() || summary.rows().len() < 2 {
        return Ok(vec![]);
    }
    let rings = plan.mesh.rings(plan.symmetry);
    let tube = SplineTube::new(&plan.tube, &plan.mesh, rings);
    let story = Story::of(summary);
    let departure = departure(summary, &story, &tube);
    let drawings: [(&str, &Drawing<'_>); 3] = [
        ("energy.png", &|| energy(plan, summary, &story).png(WIDTH)),
        ("walls.png", &|| {
            walls(plan, summary, &story, &tube, departure).png(WIDTH)
        }),
        ("tube.png", &|| {
            cutaway(plan, summary, &story, &tube, departure.crest).png(WIDTH)
        }),
    ];
    drawings
        .par_iter()
        .map(|(name, draw)| Ok(((*name).to_owned(), draw()?)))
        .collect()
}

/// What the axis of energies is called.
pub(super) fn energy_label(plan: &Plan) -> String {
    let scale = Scale::of(plan.units.as_ref());
    match &plan.units {
        None => "strain energy *W*/(*E* *D*^{3})".into(),
        Some(_) => format!(
            "strain energy *W* ({})",
            scale.energy_name.replace('u', "µ")
        ),
    }
}

/// Strain energy against what changes along the path.
fn energy(plan: &Plan, summary: &Summary, story: &Story<'_>) -> Chart {
    let x = |row: &Row| story.abscissa.of(row);
    let within = |row: &&Row| story.rows.iter().any(|r| r.step == row.step);
    let minimum = summary.findings().energy_minimum().filter(within);
    let rule = |shape: &str, label: &str| {
        let row = story.rows.iter().find(|row| row.shape == shape)?;
        Some(Rule {
            at: x(row),
            label: label.to_owned(),
        })
    };
    Chart {
        x_label: story.abscissa.label().to_owned(),
        y_label: energy_label(plan),
        curves: vec![Curve {
            points: story.rows.iter().map(|row| (x(row), row.energy)).collect(),
            dots: true,
            colour: 1,
            ..Curve::default()
        }],
        markers: minimum
            .map(|row| Marker {
                at: (x(row), row.energy),
                label: format!("minimum at {:.2}", x(row)),
                colour: 2,
            })
            .into_iter()
            .collect(),
        rules: rule("square", "square")
            .into_iter()
            .chain(rule("invaginated", "overhang"))
            .collect(),
        ..Chart::default()
    }
}

/// The largest departure from axisymmetry among the chosen states: all are drawn in its plane.
fn departure(summary: &Summary, story: &Story<'_>, tube: &SplineTube) -> Departure {
    let of = |row: &&Row| {
        let Snapshot { load, u } = &summary.snapshots()[row.step];
        Meridians::of(tube, load, u).departure()
    };
    let chosen = story.chosen.iter().map(of);
    let largest = chosen.max_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
    largest.unwrap_or_default()
}

/// Outer and inner wall at the chosen states; of a tube that is visibly not axisymmetric two
/// meridians, that at the crest above the axis and that at the trough below it.
fn walls(
    plan: &Plan,
    summary: &Summary,
    story: &Story<'_>,
    tube: &SplineTube,
    departure: Departure,
) -> Chart {
    let both = departure.crest_and_trough();
    let one_line = departure.amplitude < VISIBLE;
    let angles = if one_line { &both[..1] } else { &both };
    let z = tube
        .axial
        .spread(tube.axial.elements() * POINTS_PER_ELEMENT + 1);
    let mut curves = vec![];
    for (colour, row) in story.chosen.iter().enumerate() {
        let Snapshot { load, u } = &summary.snapshots()[row.step];
        let meridians = Meridians::of(tube, load, u);
        for (face, stroke) in [(Face::Outer, Stroke::Solid), (Face::Inner, Stroke::Fine)] {
            let label = if face == Face::Outer {
                label(story, row)
            } else {
                String::new()
            };
            let mut points = vec![];
            for (wall, side) in (meridians.walls(face, angles, &z).iter()).zip([1.0, -1.0]) {
                points.extend(wall.points.iter().map(|&(z, r)| (z, side * r)));
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
    curves.push(Curve {
        label: "inner wall".into(),
        stroke: Stroke::Fine,
        ..Curve::default()
    });
    let finite = |p: &&(f64, f64)| p.0.is_finite();
    let points = || curves.iter().flat_map(|curve| &curve.points).filter(finite);
    let highest = points().map(|p| p.1).fold(0.55, f64::max);
    let lowest = if one_line {
        0.0
    } else {
        points().map(|p| p.1).fold(-0.55, f64::min) - 0.05
    };
    let (low, high) = points().fold((0.0_f64, plan.tube.length), |(low, high), p| {
        (low.min(p.0), high.max(p.0))
    });
    if !one_line {
        let axis = Curve {
            points: vec![(low, 0.0), (high, 0.0)],
            stroke: Stroke::Dashed,
            ..Curve::default()
        };
        curves.push(axis);
    }
    let [crest, trough] = both.map(|angle| angle.to_degrees().round().rem_euclid(360.0));
    Chart {
        title: if one_line {
            String::new()
        } else {
            format!("above *r* = 0 the meridian at {crest}°, below it that at {trough}°")
        },
        x_label: "*z*/*D*".into(),
        y_label: "*r*/*D*".into(),
        equal_aspect: true,
        x_range: Some((low, high)),
        y_range: Some((lowest, 0.05 + highest)),
        width_pt: 510.0,
        curves,
        ..Chart::default()
    }
}

/// The tube cut open at the chosen states, along the plane of an angle, which points up.
fn cutaway(
    plan: &Plan,
    summary: &Summary,
    story: &Story<'_>,
    tube: &SplineTube,
    upwards: f64,
) -> Cutaway {
    let panel = |row: &&Row| {
        let Snapshot { load, u } = &summary.snapshots()[row.step];
        let surfaces = opened(tube, load, u, upwards);
        Panel {
            label: label(story, row),
            surfaces,
        }
    };
    Cutaway {
        title: plan.title.clone(),
        panels: story.chosen.iter().map(panel).collect(),
        value_label: "strain energy density *w*/*E*".into(),
        ..Cutaway::default()
    }
}

/// What a state is called in a legend.
fn label(story: &Story<'_>, row: &Row) -> String {
    let (label, value) = (story.abscissa.label(), story.abscissa.of(row));
    let value = match story.abscissa {
        Abscissa::InnerPressure | Abscissa::OuterPressure if value != 0.0 => {
            format!("{value:.2e}")
        }
        Abscissa::InnerPressure | Abscissa::OuterPressure => "0".into(),
        _ => format!("{value:.2}"),
    };
    format!("{label} = {value} ({})", row.shape)
}
