//! Diameter and thickness along the tube, as tables.

use super::super::keys::Case;
use super::super::problem::Problems;
use super::zone::{ROUNDING, length};
use crate::tube::{Imperfection, Outline, Part, Shape, Tube};

const DIAMETER: &str = "tube.diameter_along";
const THICKNESS: &str = "tube.thickness_along";
/// Largest number of points.
const MOST: usize = 1000;
/// Smallest and largest diameter and thickness, over those of the tube.
const RATIOS: std::ops::RangeInclusive<f64> = 0.02..=50.0;
/// Smallest thickness, in diameters of the tube.
const THINNEST: f64 = 1e-3;

/// Returns the shape of a tube whose diameter or thickness varies, as an imperfection of its geometry; none without tables.
pub(super) fn outline(case: &Case, tube: &Tube, problems: &mut Problems) -> Option<Imperfection> {
    let [diameter, thickness] =
        [&case.tube.diameter_along, &case.tube.thickness_along].map(|points| {
            points
                .iter()
                .flatten()
                .map(|p| p.map(|x| x / case.tube.diameter))
        });
    let outline = Outline {
        diameter: diameter.collect(),
        thickness: thickness.collect(),
    };
    for (key, points) in [
        (DIAMETER, &case.tube.diameter_along),
        (THICKNESS, &case.tube.thickness_along),
    ] {
        if points.as_ref().is_some_and(Vec::is_empty) && problems.are_sound(&[key]) {
            problems.value(key, "must have at least one point", "leave it out");
        }
    }
    if outline == Outline::default() {
        return None;
    }
    let tables = [
        (DIAMETER, &outline.diameter, 1.0),
        (THICKNESS, &outline.thickness, tube.thickness),
    ];
    let mut sound = problems.are_sound(&["tube"]);
    for (key, points, usual) in tables {
        if let Some((rule, help)) = broken(points, usual, case, tube).filter(|_| sound) {
            problems.value(key, rule, help);
            sound = false;
        }
    }
    if let Some(z) = closed(&outline, tube).filter(|_| sound) {
        let key = if outline.thickness.is_empty() {
            DIAMETER
        } else {
            THICKNESS
        };
        let z = length(case, z);
        let rule = format!(
            "the wall closes the lumen at {z}: the thickness must be below half the diameter"
        );
        problems.value(key, rule, "");
        sound = false;
    }
    sound.then_some(Imperfection {
        of: Part::Geometry,
        amplitude: 1.0,
        shape: Shape::Outline(outline),
    })
}

/// Returns the rule that a table breaks, and help.
fn broken(
    points: &[[f64; 2]],
    usual: f64,
    case: &Case,
    tube: &Tube,
) -> Option<(String, &'static str)> {
    let within = |z: f64| z >= 0.0 && z <= tube.length * (1.0 + ROUNDING);
    if points.len() > MOST {
        Some((format!("must have at most {MOST} points"), ""))
    } else if !points.is_sorted_by(|a, b| a[0] < b[0]) {
        Some((
            "positions must rise".into(),
            "write the points from the colon end on, each position once",
        ))
    } else if points.iter().any(|[z, _]| !within(*z)) {
        let end = length(case, tube.length);
        Some((
            format!("positions must lie within the tube, 0 to {end}"),
            "",
        ))
    } else if points.iter().any(|[_, x]| !RATIOS.contains(&(x / usual))) {
        let [least, most] = [RATIOS.start(), RATIOS.end()].map(|x| length(case, x * usual));
        Some((format!("values must be from {least} to {most}"), ""))
    } else {
        None
    }
}

/// Returns a position at which the tube has no lumen, or hardly a wall.
fn closed(outline: &Outline, tube: &Tube) -> Option<f64> {
    let bad = |z: f64| {
        let thickness = outline.thickness_at(z, tube.thickness);
        thickness >= 0.5 * outline.diameter_at(z) * (1.0 - 1e-6) || thickness < THINNEST
    };
    outline
        .positions()
        .chain([0.0, tube.length])
        .find(|z| bad(*z))
}
