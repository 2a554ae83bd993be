//! Parts of the tube with smooth edges: zones along it, and sectors of the circumference.

use super::super::keys::{self, Case};
use super::super::problem::Problems;
use super::zone::{length, zone};
use crate::activation::AngularSector;
use crate::tube::{Region, Symmetry};

/// Share of a zone or a sector over which it rises at an edge, if the case does not give it.
const EDGE: f64 = 0.25;
/// Relative rounding error that is allowed for where sectors fill the circumference.
const ROUNDING: f64 = 1e-9;

/// Returns the region of a table with `zone`, `edge` and `sector`; without a zone the whole tube, which has no edges.
pub(super) fn region(
    path: &str,
    case: &Case,
    (written, edge, sector): (Option<[f64; 2]>, Option<f64>, Option<&keys::Sector>),
    tube_length: f64,
    problems: &mut Problems,
) -> Region {
    let sector = sector.map(|own| self::sector(&format!("{path}.sector"), own, case, problems));
    let diameter = case.tube.diameter;
    let (zone, usual) = match written {
        Some(written) => {
            let key = format!("{path}.zone");
            let zone = zone(&key, case, written, tube_length, problems);
            (zone, EDGE * (zone[1] - zone[0]))
        }
        None => ([0.0, tube_length], 0.0),
    };
    let edge = edge.map_or(usual, |edge| edge / diameter);
    let key = format!("{path}.edge");
    let half = 0.5 * (zone[1] - zone[0]);
    if edge > half * (1.0 + ROUNDING)
        && half > 0.0
        && problems.are_sound(&[&key, &format!("{path}.zone"), "tube"])
    {
        let rule = format!("must be at most half of the zone, {}", length(case, half));
        problems.value(&key, rule, "make it smaller");
    }
    Region { zone, edge, sector }
}

/// Returns a sector. With an m-fold symmetry it repeats as often as the tube does.
pub(super) fn sector(
    path: &str,
    written: &keys::Sector,
    case: &Case,
    problems: &mut Problems,
) -> AngularSector {
    let edge = written.edge_degrees.unwrap_or(EDGE * written.width_degrees);
    let key = format!("{path}.edge_degrees");
    if edge > 0.5 * written.width_degrees * (1.0 + ROUNDING) && problems.are_sound(&[path]) {
        let half = 0.5 * written.width_degrees;
        let rule = format!("must be at most half of the width, {half} degrees");
        problems.value(&key, rule, "make it smaller");
    }
    let repeats = match case.symmetry {
        Symmetry::Fold(m) => least_common_multiple(written.repeat, m),
        Symmetry::Axisymmetric | Symmetry::None => written.repeat,
    };
    let all = repeats as f64 * written.width_degrees;
    if problems.are_sound(&[path, "symmetry"]) {
        if case.symmetry == Symmetry::Axisymmetric {
            let rule = "an axisymmetric tube is the same all around";
            let help = "use symmetry = \"none\" or a fold, or leave the sector out";
            problems.key(path, rule, help);
        } else if all > 360.0 * (1.0 + ROUNDING) {
            let rule = match repeats == written.repeat {
                true => format!("{repeats} of them are {all} degrees together, and overlap"),
                false => format!(
                    "with the symmetry there are {repeats} of them, {all} degrees together, which overlap"
                ),
            };
            let help = format!("at most {} degrees fit", 360.0 / repeats as f64);
            problems.value(&format!("{path}.width_degrees"), rule, help);
        }
    }
    AngularSector {
        centre: written.centre_degrees.to_radians(),
        width: written.width_degrees.to_radians(),
        edge: edge.to_radians(),
        repeats,
    }
}

fn least_common_multiple(a: usize, b: usize) -> usize {
    let (mut divisor, mut rest) = (a, b);
    while rest != 0 {
        (divisor, rest) = (rest, divisor % rest);
    }
    a / divisor * b
}
