//! Axes of a study: a key of the case and its values.

use std::ops::Range;

/// A key of the base case, and its values in a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The key as the study file has it: dotted, a stage by its name or its number (`stages[1].steps`).
    pub name: String,
    /// The same key with stages by number.
    pub key: String,
    /// The values, written as in TOML.
    pub values: Vec<String>,
    /// The bytes of the study file that give the values.
    pub span: Range<usize>,
}

impl Axis {
    /// Returns the values as numbers; none if one of them is something else.
    pub fn numbers(&self) -> Option<Vec<f64>> {
        self.values.iter().map(|value| number(value)).collect()
    }
}

/// Reads a number as TOML writes it.
pub(super) fn number(text: &str) -> Option<f64> {
    let number: f64 = text.replace('_', "").parse().ok()?;
    number.is_finite().then_some(number)
}

/// Writes a number with at most twelve digits, so that 0.1 + 0.2 is 0.3.
pub(super) fn written(x: f64) -> String {
    let rounded: f64 = format!("{x:.11e}").parse().unwrap_or(x);
    match rounded {
        x if x == x.trunc() && x.abs() < 1e15 => format!("{x:.1}"),
        x => format!("{x}"),
    }
}

/// Returns numbers from one to another, evenly spaced or, on a logarithmic axis, with even ratios. Whole numbers are written
/// without a point if both ends are (`are_whole`), because keys for whole numbers take no others.
pub(super) fn range(
    [from, to]: [f64; 2],
    points: usize,
    is_logarithmic: bool,
    are_whole: bool,
) -> Vec<String> {
    let last = points.saturating_sub(1).max(1) as f64;
    let at = |i: usize| match (i as f64 / last, is_logarithmic) {
        (0.0, _) => from,
        (1.0, _) => to,
        (t, false) => from + t * (to - from),
        (t, true) => from * (to / from).powf(t),
    };
    let write = |x: f64| match written(x).strip_suffix(".0") {
        Some(whole) if are_whole => whole.to_owned(),
        _ => written(x),
    };
    (0..points).map(|i| write(at(i))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_have_round_numbers_and_exact_ends() {
        assert_eq!(
            range([0.2, 0.5], 4, false, false),
            ["0.2", "0.3", "0.4", "0.5"]
        );
        assert_eq!(
            range([1.0, 100.0], 3, true, false),
            ["1.0", "10.0", "100.0"]
        );
        assert_eq!(range([0.0, 1.0], 1, false, false), ["0.0"]);
        assert_eq!(range([3.0, 1.0], 3, false, false), ["3.0", "2.0", "1.0"]);
        assert_eq!(range([2.0, 4.0], 3, false, true), ["2", "3", "4"]);
        assert_eq!(range([1.0, 2.0], 3, false, true), ["1", "1.5", "2"]);
        assert_eq!(written(1e-7), "0.0000001");
        assert_eq!(number("1_000.5"), Some(1000.5));
        assert_eq!(number("inf"), None);
        assert_eq!(number("\"V\""), None);
    }
}
