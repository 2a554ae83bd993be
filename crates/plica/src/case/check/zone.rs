//! Zones of the tube, and numbers in messages.

use super::super::keys::Case;
use super::super::problem::Problems;
use super::material::youngs_modulus;

/// Relative rounding error that is allowed for when lengths are scaled to D.
pub(super) const ROUNDING: f64 = 1e-12;

/// Checks a zone, and returns it in D.
pub(super) fn zone(
    key: &str,
    case: &Case,
    zone: [f64; 2],
    length: f64,
    problems: &mut Problems,
) -> [f64; 2] {
    let [from, to] = moving_zone(key, case, zone, problems);
    if !problems.are_sound(&[key, "tube.length", "tube.diameter"]) {
        return [from, to];
    }
    if from < 0.0 || to > length * (1.0 + ROUNDING) {
        let end = self::length(case, length);
        problems.value(key, format!("must lie within the tube, 0 to {end}"), "");
    }
    [from, to.min(length)]
}

/// Checks a zone that may lie outside the tube, and returns it in D.
pub(super) fn moving_zone(
    key: &str,
    case: &Case,
    zone: [f64; 2],
    problems: &mut Problems,
) -> [f64; 2] {
    let [from, to] = zone.map(|z| z / case.tube.diameter);
    if !problems.are_sound(&[key]) {
        return [from, to];
    }
    if from >= to {
        let help = match from > to {
            true => format!("try [{}, {}]", zone[1], zone[0]),
            false => String::new(),
        };
        problems.value(key, "must be [from, to] with from below to", help);
    } else if problems.are_sound(&["tube.length", "tube.diameter"]) && to - from < 1e-3 {
        let least = self::length(case, 1e-3);
        let rule = format!("must be at least a thousandth of the diameter long, {least}");
        problems.value(key, rule, "");
    }
    [from, to]
}

/// Writes a length, given in D, in the unit of the case.
pub(super) fn length(case: &Case, in_diameters: f64) -> String {
    let x = tidy(in_diameters * case.tube.diameter);
    match &case.units {
        Some(units) => format!("{x} {}", units.length),
        None => x.to_string(),
    }
}

/// Writes a stress, given in Young's moduli, in the unit of the case.
pub(super) fn stress(case: &Case, in_moduli: f64) -> String {
    let x = tidy(in_moduli * youngs_modulus(case));
    match &case.units {
        Some(units) => format!("{x} {}", units.stress),
        None => x.to_string(),
    }
}

/// Rounds away the digits that scaling leaves behind.
pub(super) fn tidy(x: f64) -> f64 {
    format!("{x:.6e}").parse().unwrap_or(x)
}
