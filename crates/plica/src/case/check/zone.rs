//! Zones of the tube, and numbers in messages.

use super::super::keys::Case;
use super::super::problem::Problems;

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
    } else if !problems.are_sound(&["tube.length", "tube.diameter"]) {
        return [from, to];
    } else if from < 0.0 || to > length * (1.0 + ROUNDING) {
        let end = length * case.tube.diameter;
        problems.value(key, format!("must lie within the tube, 0 to {end}"), "");
    } else if to - from < 1e-3 {
        let rule = "must be at least a thousandth of the diameter long";
        problems.value(key, rule, "");
    }
    [from, to.min(length)]
}

/// Rounds away the digits that scaling leaves behind.
pub(super) fn tidy(x: f64) -> f64 {
    format!("{x:.6e}").parse().unwrap_or(x)
}
