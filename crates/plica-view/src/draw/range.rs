//! Which values the colours of a field span.

use super::DrawError;
use super::ticks::step;

/// Most intervals between the ticks of a colour bar.
pub(super) const INTERVALS: usize = 6;
/// One value in so many is left out at an end that peaks.
const RARE: usize = 200;
/// Values that differ by less, in themselves, are one value and rounding.
const ALIKE: f64 = 1e-9;

/// Values at the two ends of the colour bar.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Range {
    /// From one round number to another, leaving out half a per cent of the values at the upper end, and at the lower one of a
    /// field that goes below zero: fields peak at folds, and one peak must not darken all the rest. From zero where that is near.
    #[default]
    Automatic,
    /// The same on both sides of zero, for fields of two signs.
    Balanced,
    /// From the least to the largest value.
    Full,
    /// These two.
    Given(f64, f64),
    /// What was found otherwise, the field's own ends with it: of several pictures that tell the same.
    Found(Spanned),
}

/// What the colours of a field span, and the field's own ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spanned {
    /// Value at the lower end of the colours.
    pub low: f64,
    /// At the upper end; above `low`.
    pub high: f64,
    /// Least value.
    pub least: f64,
    /// Largest.
    pub largest: f64,
}

impl Range {
    /// What it comes to over some values; those that are not finite count for nothing.
    ///
    /// # Errors
    /// [`DrawError::Empty`] without a finite value, [`DrawError::Range`] for a given range that is none.
    pub fn of(self, values: impl Iterator<Item = f64>) -> Result<Spanned, DrawError> {
        if let Self::Found(found) = self {
            return Ok(found);
        }
        let mut finite: Vec<f64> = values.filter(|v| v.is_finite()).collect();
        let Some(last) = finite.len().checked_sub(1) else {
            return Err(DrawError::Empty { what: "field" });
        };
        let mut at = |place: usize| *finite.select_nth_unstable_by(place, f64::total_cmp).1;
        let (least, largest) = (at(0), at(last));
        let (low, high) = match self {
            Self::Given(low, high) => {
                if !(low.is_finite() && high.is_finite() && low < high) {
                    return Err(DrawError::Range { low, high });
                }
                (low, high)
            }
            Self::Full | Self::Found(_) => (least, largest),
            Self::Balanced => {
                let most = at(last - last / RARE).max(-at(last / RARE));
                rounded(-most, most)
            }
            Self::Automatic => {
                let high = at(last - last / RARE);
                let low = if least < 0.0 { at(last / RARE) } else { least };
                let near = (0.0..0.25 * high).contains(&low);
                rounded(if near { 0.0 } else { low }, high)
            }
        };
        // A field of one value still needs a bar, and has its lowest colour.
        let (low, high) = if high - low > ALIKE * low.abs().max(high.abs()) {
            (low, high)
        } else {
            match low.abs() {
                0.0 => (0.0, 1.0),
                size => (low, low + 0.1 * size),
            }
        };
        Ok(Spanned {
            low,
            high,
            least,
            largest,
        })
    }
}

/// A range widened to whole ticks; one without length stays as it is.
fn rounded(low: f64, high: f64) -> (f64, f64) {
    if high <= low {
        return (low, high);
    }
    let round = step(low, high, INTERVALS);
    // An end within a hair of a tick is that tick.
    (
        (low / round + 1e-9).floor() * round,
        (high / round - 1e-9).ceil() * round,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn automatic(values: &[f64]) -> [f64; 2] {
        let spanned = Range::Automatic.of(values.iter().copied()).unwrap();
        [spanned.low, spanned.high]
    }

    #[test]
    fn a_peak_does_not_stretch_the_colours() {
        let mut values: Vec<f64> = (0..=1000).map(|i| i as f64 / 1000.0).collect();
        values.push(100.0);
        assert_eq!(automatic(&values), [0.0, 1.0]);
        values.push(-100.0);
        assert_eq!(automatic(&values), [0.0, 1.0]);
        let spanned = Range::Automatic.of(values.into_iter()).unwrap();
        assert_eq!([spanned.least, spanned.largest], [-100.0, 100.0]);
    }

    #[test]
    fn what_is_never_near_zero_does_not_begin_there() {
        let [low, high] = automatic(&[0.92, 0.95, 0.992]);
        assert!((low - 0.92).abs() < 1e-12 && (high - 1.0).abs() < 1e-12);
        assert_eq!(automatic(&[0.1, 0.7, 1.0]), [0.0, 1.0]);
        assert_eq!(automatic(&[-1.0, 0.7, 1.0]), [-1.0, 1.0]);
    }

    #[test]
    fn a_field_of_two_signs_has_zero_in_the_middle() {
        let spanned = Range::Balanced.of([-0.3, 0.1, 1.0].into_iter()).unwrap();
        assert_eq!([spanned.low, spanned.high], [-1.0, 1.0]);
    }

    #[test]
    fn one_value_has_colours_beside_it_and_none_has_none() {
        let [low, high] = automatic(&[3.0, 3.0 + 1e-15, f64::NAN]);
        assert!(low == 3.0 && high > 3.0);
        assert_eq!(automatic(&[0.0; 4]), [0.0, 1.0]);
        assert!(Range::Full.of([f64::NAN].into_iter()).is_err());
        assert!(Range::Given(1.0, 0.0).of([0.5].into_iter()).is_err());
    }
}
