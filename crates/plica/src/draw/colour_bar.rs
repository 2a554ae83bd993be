//! The colour bar of a cut-away: its ends, ticks and title.

use super::DrawError;
use super::canvas::{Anchor, CAPITAL, Canvas, INK, Pen};
use super::cutaway::{Cutaway, Range, SIDE, TEXT, TITLE, ends};
use super::ticks::{power_of_ten, short, step, ticks};

/// Most intervals on the bar.
const INTERVALS: usize = 6;

/// Ends of the colour bar, and the field's own ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scale {
    pub low: f64,
    pub high: f64,
    pub least: f64,
    pub largest: f64,
}

impl Cutaway {
    pub(super) fn scale(&self) -> Result<Scale, DrawError> {
        let values = self
            .panels
            .iter()
            .flat_map(|p| &p.surfaces)
            .flat_map(|s| &s.values);
        let mut finite: Vec<f64> = values.copied().filter(|v| v.is_finite()).collect();
        let (least, largest) = ends(finite.iter().copied());
        if finite.is_empty() {
            return Err(DrawError::Empty { what: "field" });
        }
        let (low, high) = match self.range {
            Range::Given(low, high) => {
                if !(low.is_finite() && high.is_finite() && low < high) {
                    return Err(DrawError::Range { low, high });
                }
                (low, high)
            }
            Range::Full => (least, largest),
            Range::Automatic => {
                let place = (finite.len() - 1) * 995 / 1000;
                let (_, high, _) = finite.select_nth_unstable_by(place, f64::total_cmp);
                let high = *high;
                let low = if (0.0..0.25 * high).contains(&least) {
                    0.0
                } else {
                    least
                };
                rounded(low, high)
            }
        };
        // A field of one value still needs a bar.
        let (low, high) = if high > low {
            (low, high)
        } else {
            (low - 0.5 * low.abs() - 0.5, low + 0.5 * low.abs() + 0.5)
        };
        Ok(Scale {
            low,
            high,
            least,
            largest,
        })
    }

    /// The bar with its ticks and title, left of `end`; an arrow and a note where the field goes on beyond it.
    pub(super) fn draw_colour_bar(&self, canvas: &mut Canvas, top: f64, end: f64, scale: Scale) {
        let hair = (scale.high - scale.low) * 1e-6;
        let (above, below) = (
            scale.largest > scale.high + hair,
            scale.least < scale.low - hair,
        );
        let exponent = ticks(scale.low, scale.high, INTERVALS).exponent;
        let beyond = short(scale.largest / 10f64.powi(exponent), 2);
        let note = if above {
            format!("up to {beyond}")
        } else {
            String::new()
        };
        let (left, tip, height) = (SIDE + 8.0, 7.0, 8.0);
        let room = end - left - tip - 4.0 - canvas.text_width(&note, TEXT);
        let width = room.clamp(40.0, 240.0);
        let strip = 0.5;
        let count = (width / strip) as usize;
        for i in 0..count {
            let t = (i as f64 + 0.5) / count as f64;
            // Each strip reaches to the bar's end under the next ones, so that no seam shows.
            let start = left + width * i as f64 / count as f64;
            canvas.rectangle(
                (start, top),
                left + width - start,
                height,
                self.map.colour(t),
            );
        }
        let middle = top + height / 2.0;
        let right = left + width;
        if above {
            canvas.polygon(
                &[(right, top), (right + tip, middle), (right, top + height)],
                self.map.colour(1.0),
            );
        }
        if below {
            canvas.polygon(
                &[(left, top), (left - tip, middle), (left, top + height)],
                self.map.colour(0.0),
            );
        }
        let pen = Pen::new(INK, 0.6);
        let start = if below { left - tip } else { left };
        let end = if above { right + tip } else { right };
        let outline = [
            (left, top),
            (right, top),
            (end, middle),
            (right, top + height),
            (left, top + height),
            (start, middle),
        ];
        canvas.polyline(&outline, pen);
        canvas.line(outline[5], outline[0], pen);

        let marks = ticks(
            scale.low,
            scale.high,
            ((width / 26.0) as usize).clamp(2, INTERVALS),
        );
        for (at, text) in marks.at.iter().zip(&marks.labels) {
            let x = left + width * (at - scale.low) / (scale.high - scale.low);
            canvas.line((x, top + height), (x, top + height + 2.5), pen);
            canvas.text((x, top + height + 11.0), text, TEXT, Anchor::Middle, INK);
        }
        let mut title = self.value_label.clone();
        if exponent != 0 {
            title += &format!(" ({})", power_of_ten(exponent));
        }
        canvas.text(
            (left + width / 2.0, top + height + 23.5),
            &title,
            TITLE,
            Anchor::Middle,
            INK,
        );
        if above {
            canvas.text(
                (right + tip + 4.0, middle + TEXT * CAPITAL / 2.0),
                &note,
                TEXT,
                Anchor::Start,
                INK,
            );
        }
    }
}

/// The range widened to whole ticks; one without length stays as it is.
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
    use crate::draw::cutaway::tests::straight;

    #[test]
    fn a_peak_does_not_stretch_the_bar() {
        let scale = straight(|z| if z == 0.5 { 100.0 } else { z })
            .scale()
            .unwrap();
        assert_eq!((scale.low, scale.high), (0.0, 1.0));
        let scale = straight(|z| 3.0 + 0.0 * z).scale().unwrap();
        assert!(scale.low < 3.0 && scale.high > 3.0);
    }
}
