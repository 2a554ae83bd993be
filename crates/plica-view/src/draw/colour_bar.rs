//! The colour bar of a cut-away: its ends, ticks and title.

use super::DrawError;
use super::canvas::{Anchor, Canvas, INK, Pen};
use super::cutaway::{Cutaway, SIDE, TEXT, TITLE};
use super::range::{INTERVALS, Spanned};
use super::text::{CAPITAL, text_width};
use super::ticks::{power_of_ten, short, ticks};

impl Cutaway {
    /// What its colours span.
    ///
    /// # Errors
    /// As [`Cutaway::png`].
    pub fn spanned(&self) -> Result<Spanned, DrawError> {
        let surfaces = self.panels.iter().flat_map(|p| &p.surfaces);
        self.range.of(surfaces.flat_map(|s| &s.values).copied())
    }

    /// The bar with its ticks and title, left of `end`; an arrow and a note where the field goes on beyond it.
    pub(super) fn draw_colour_bar(&self, canvas: &mut Canvas, top: f64, end: f64, scale: Spanned) {
        let hair = (scale.high - scale.low) * 1e-6;
        let (above, below) = (
            scale.largest > scale.high + hair,
            scale.least < scale.low - hair,
        );
        let exponent = ticks(scale.low, scale.high, INTERVALS).exponent;
        // In the power of ten of the ticks, with as many digits as it takes to lie beyond the bar.
        let told = |value: f64| {
            let end = if value > scale.high {
                scale.high
            } else {
                scale.low
            };
            let [value, end] = [value, end].map(|x| x / 10f64.powi(exponent));
            let digits = (2..8).find(|&digits| short(value, digits) != short(end, digits));
            short(value, digits.unwrap_or(8))
        };
        let note = match (below, above) {
            (false, false) => String::new(),
            (false, true) => format!("up to {}", told(scale.largest)),
            (true, false) => format!("down to {}", told(scale.least)),
            (true, true) => format!("{} to {}", told(scale.least), told(scale.largest)),
        };
        let (left, tip, height) = (SIDE + 8.0, 7.0, 8.0);
        let room = end - left - tip - 4.0 - text_width(&note, TEXT);
        let width = room.clamp(40.0, 240.0);
        let strip = 0.5;
        let count = (width / strip) as usize;
        for i in 0..count {
            let t = (i as f64 + 0.5) / count as f64;
            // Each strip reaches under the next ones, so that no seam shows.
            let start = left + width * i as f64 / count as f64;
            let length = (left + width - start).min(8.0 * strip);
            canvas.rectangle((start, top), length, height, self.map.colour(t));
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
        if !note.is_empty() {
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
