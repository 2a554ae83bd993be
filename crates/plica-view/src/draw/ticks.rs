//! Round numbers for axes.

/// Ticks at integer multiples of 1, 2, 2.5 or 5 times a power of ten.
#[derive(Clone, Debug)]
pub(super) struct Ticks {
    /// Positions of the ticks in data units.
    pub at: Vec<f64>,
    /// Labels in units of 10^`exponent`.
    pub labels: Vec<String>,
    /// Common power of ten of the labels; 0 for numbers of ordinary size.
    pub exponent: i32,
}

/// Returns the smallest round step that gives at most `most` intervals between `low` and `high`.
pub(super) fn round_step(low: f64, high: f64, most: usize) -> f64 {
    let raw = (high - low) / most.max(1) as f64;
    let ten = 10f64.powf(raw.log10().floor());
    let round = [1.0, 2.0, 2.5, 5.0, 10.0];
    ten * round
        .into_iter()
        .find(|r| r * ten >= raw * (1.0 - 1e-9))
        .unwrap_or(10.0)
}

/// Returns the ticks of a finite range with `low < high`, with at most `most` intervals.
pub(super) fn ticks(low: f64, high: f64, most: usize) -> Ticks {
    let step = round_step(low, high, most);
    let first = (low / step - 1e-6).ceil() as i64;
    let last = (high / step + 1e-6).floor() as i64;
    let at: Vec<f64> = (first..=last).map(|i| i as f64 * step).collect();

    let largest = low.abs().max(high.abs());
    let power = largest.log10().floor() as i32;
    let exponent = if (-2..4).contains(&power) { 0 } else { power };
    let scale = 10f64.powi(exponent);
    let decimals = (0..12)
        .find(|&d| is_whole(step / scale * 10f64.powi(d)))
        .unwrap_or(12) as usize;
    let labels = at.iter().map(|v| number(v / scale, decimals)).collect();
    Ticks {
        at,
        labels,
        exponent,
    }
}

/// Formats a value with a typographic minus sign.
fn number(value: f64, decimals: usize) -> String {
    let text = format!("{:.decimals$}", value.abs());
    let is_zero = text.chars().all(|c| c == '0' || c == '.');
    if value < 0.0 && !is_zero {
        format!("−{text}")
    } else {
        text
    }
}

/// Formats a value with about `digits` significant digits, as `0.031` or `3.1×10^{−5}`.
pub(crate) fn format_number(value: f64, digits: usize) -> String {
    let power = if value == 0.0 {
        0
    } else {
        value.abs().log10().floor() as i32
    };
    if (-3..5).contains(&power) {
        return number(value, (digits as i32 - 1 - power).max(0) as usize);
    }
    let mantissa = number(value / 10f64.powi(power), digits.saturating_sub(1));
    format!("{mantissa}×{}", power_of_ten(power))
}

/// Returns a power of ten in label markup, such as `10^{−3}`.
pub(super) fn power_of_ten(exponent: i32) -> String {
    format!("10^{{{}}}", number(f64::from(exponent), 0))
}

fn is_whole(value: f64) -> bool {
    value.abs() > 0.5 && (value - value.round()).abs() < 1e-6 * value.abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_within_the_range() {
        let energy = ticks(0.0, 3.1e-3, 7);
        assert_eq!(energy.exponent, -3);
        assert_eq!(
            energy.labels,
            ["0.0", "0.5", "1.0", "1.5", "2.0", "2.5", "3.0"]
        );
        let relaxation = ticks(0.99, 1.26, 6);
        assert_eq!(
            relaxation.labels,
            ["1.00", "1.05", "1.10", "1.15", "1.20", "1.25"]
        );
        let radius = ticks(-0.5, 0.5, 4);
        assert_eq!(radius.labels, ["−0.50", "−0.25", "0.00", "0.25", "0.50"]);
    }

    #[test]
    fn close_ticks_have_different_labels() {
        let near_one = ticks(1.0 - 1e-7, 1.0, 5);
        let mut labels = near_one.labels.clone();
        labels.dedup();
        assert_eq!(labels, near_one.labels);
    }

    #[test]
    fn numbers_are_formatted_with_few_digits() {
        assert_eq!(format_number(0.0312, 2), "0.031");
        assert_eq!(format_number(-3.14e-5, 2), "−3.1×10^{−5}");
        assert_eq!(format_number(0.0, 2), "0.0");
    }
}
