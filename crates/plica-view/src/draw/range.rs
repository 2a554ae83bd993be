//! Colour ranges of fields.

use super::DrawError;
use super::ticks::round_step;

/// Maximum number of intervals between the ticks of a colour bar.
pub(super) const MAX_INTERVALS: usize = 6;
/// An automatic range leaves out one value in this many at an end with a peak.
const OUTLIER_RATIO: usize = 200;
/// Relative difference below which two values are equal up to rounding.
const ROUNDING: f64 = 1e-9;

/// Rule for the values at the two ends of the colour bar.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Range {
    /// Round numbers that leave out the largest 0.5 % of the values, and the smallest 0.5 % of a field with negative values.
    /// A local peak at a fold therefore does not determine the colours everywhere else. The range starts at zero if that is near.
    #[default]
    Automatic,
    /// Round numbers, symmetric about zero, for fields of two signs.
    Symmetric,
    /// The smallest and the largest value.
    Full,
    /// The two given values.
    Given(f64, f64),
    /// A range resolved before, so that several pictures share it.
    Resolved(ResolvedRange),
}

/// Values at the ends of the colour bar, and the extreme values of the field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResolvedRange {
    /// Value at the lower end of the colours.
    pub low: f64,
    /// Value at the upper end; larger than `low`.
    pub high: f64,
    /// Smallest value of the field.
    pub min: f64,
    /// Largest value of the field.
    pub max: f64,
}

/// Extreme values of a field, and the values that 0.5 % of its points lie below and above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Smallest value.
    pub min: f64,
    /// Value that 0.5 % of the points lie below.
    pub lower: f64,
    /// Value that 0.5 % of the points lie above.
    pub upper: f64,
    /// Largest value.
    pub max: f64,
}

impl Spread {
    /// Returns the spread of the finite ones of some values; none without one.
    pub fn of(values: impl Iterator<Item = f64>) -> Option<Self> {
        let mut finite: Vec<f64> = values.filter(|v| v.is_finite()).collect();
        let last = finite.len().checked_sub(1)?;
        let mut at = |rank: usize| *finite.select_nth_unstable_by(rank, f64::total_cmp).1;
        let few = last / OUTLIER_RATIO;
        Some(Self {
            min: at(0),
            lower: at(few),
            upper: at(last - few),
            max: at(last),
        })
    }

    /// Returns the smallest spread that contains two others.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self {
            min: self.min.min(other.min),
            lower: self.lower.min(other.lower),
            upper: self.upper.max(other.upper),
            max: self.max.max(other.max),
        }
    }

    /// Multiplies all values by a positive factor.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self {
            min: factor * self.min,
            lower: factor * self.lower,
            upper: factor * self.upper,
            max: factor * self.max,
        }
    }
}

impl Range {
    /// Applies the rule to the values of a field; values that are not finite are ignored.
    ///
    /// # Errors
    /// [`DrawError::Empty`] without a finite value, [`DrawError::Range`] for an invalid given range.
    pub fn resolve(self, values: impl Iterator<Item = f64>) -> Result<ResolvedRange, DrawError> {
        match self {
            Self::Resolved(resolved) => Ok(resolved),
            _ => self.of(Spread::of(values)),
        }
    }

    /// Applies the rule to the spread of a field.
    ///
    /// # Errors
    /// As [`Range::resolve`].
    pub fn of(self, spread: Option<Spread>) -> Result<ResolvedRange, DrawError> {
        let Some(spread) = spread else {
            return Err(DrawError::Empty { what: "field" });
        };
        let Spread {
            min,
            lower,
            upper,
            max,
        } = spread;
        let (low, high) = match self {
            Self::Resolved(resolved) => return Ok(resolved),
            Self::Given(low, high) => {
                if !(low.is_finite() && high.is_finite() && low < high) {
                    return Err(DrawError::Range { low, high });
                }
                (low, high)
            }
            Self::Full => (min, max),
            Self::Symmetric => {
                let bound = upper.max(-lower);
                rounded(-bound, bound)
            }
            Self::Automatic => {
                let low = if min < 0.0 { lower } else { min };
                let near = (0.0..0.25 * upper).contains(&low);
                rounded(if near { 0.0 } else { low }, upper)
            }
        };
        // A constant field still needs a bar; it is drawn in the lowest colour.
        let (low, high) = if high - low > ROUNDING * low.abs().max(high.abs()) {
            (low, high)
        } else {
            match low.abs() {
                0.0 => (0.0, 1.0),
                magnitude => (low, low + 0.1 * magnitude),
            }
        };
        Ok(ResolvedRange {
            low,
            high,
            min,
            max,
        })
    }
}

/// Widens a range to whole ticks; an empty range stays as it is.
fn rounded(low: f64, high: f64) -> (f64, f64) {
    if high <= low {
        return (low, high);
    }
    let step = round_step(low, high, MAX_INTERVALS);
    // An end that equals a tick up to rounding stays there.
    (
        (low / step + 1e-9).floor() * step,
        (high / step - 1e-9).ceil() * step,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn automatic(values: &[f64]) -> [f64; 2] {
        let spanned = Range::Automatic.resolve(values.iter().copied()).unwrap();
        [spanned.low, spanned.high]
    }

    #[test]
    fn a_peak_does_not_stretch_the_colours() {
        let mut values: Vec<f64> = (0..=1000).map(|i| i as f64 / 1000.0).collect();
        values.push(100.0);
        assert_eq!(automatic(&values), [0.0, 1.0]);
        values.push(-100.0);
        assert_eq!(automatic(&values), [0.0, 1.0]);
        let spanned = Range::Automatic.resolve(values.into_iter()).unwrap();
        assert_eq!([spanned.min, spanned.max], [-100.0, 100.0]);
    }

    #[test]
    fn an_automatic_range_starts_at_zero_only_if_near() {
        let [low, high] = automatic(&[0.92, 0.95, 0.992]);
        assert!((low - 0.92).abs() < 1e-12 && (high - 1.0).abs() < 1e-12);
        assert_eq!(automatic(&[0.1, 0.7, 1.0]), [0.0, 1.0]);
        assert_eq!(automatic(&[-1.0, 0.7, 1.0]), [-1.0, 1.0]);
    }

    #[test]
    fn a_symmetric_range_has_zero_in_the_middle() {
        let spanned = Range::Symmetric
            .resolve([-0.3, 0.1, 1.0].into_iter())
            .unwrap();
        assert_eq!([spanned.low, spanned.high], [-1.0, 1.0]);
    }

    #[test]
    fn the_range_of_several_states_contains_the_range_of_each() {
        let spread = |factor: f64| Spread::of((0..=1000).map(|i| factor * f64::from(i) / 1000.0));
        let [small, large] = [spread(0.3).unwrap(), spread(-1.0).unwrap()];
        let both = small.union(large);
        assert_eq!([both.min, both.max], [-1.0, 0.3]);
        assert_eq!([both.lower, both.upper], [large.lower, small.upper]);
        assert_eq!(both.times(2.0).max, 0.6);
        assert!(spread(f64::NAN).is_none());
        let whole = Range::Automatic.of(Some(both)).unwrap();
        assert!(whole.low <= large.lower && whole.high >= small.upper);
    }

    #[test]
    fn a_constant_field_has_a_range_and_an_empty_one_has_none() {
        let [low, high] = automatic(&[3.0, 3.0 + 1e-15, f64::NAN]);
        assert!(low == 3.0 && high > 3.0);
        assert_eq!(automatic(&[0.0; 4]), [0.0, 1.0]);
        assert!(Range::Full.resolve([f64::NAN].into_iter()).is_err());
        assert!(Range::Given(1.0, 0.0).resolve([0.5].into_iter()).is_err());
    }
}
