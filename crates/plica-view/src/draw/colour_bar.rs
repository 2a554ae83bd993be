//! The colour bar of a cutaway: ends, ticks and title.

use super::canvas::{Anchor, Canvas, INK, Pen, Position};
use super::colour::ColourMap;
use super::range::{MAX_INTERVALS, ResolvedRange};
use super::text::{HALF_CAP, TEXT_SIZE, text_width};
use super::ticks::{format_number, power_of_ten, ticks};

/// Draws a bar that ends before `right_limit`, with ticks and title. An arrow and a note show values beyond its ends, followed by
/// the words that say of which states they are.
pub(super) fn draw_colour_bar(
    canvas: &mut Canvas,
    (left, top): Position,
    right_limit: f64,
    (range, extremes_of): (ResolvedRange, &str),
    map: ColourMap,
    label: &str,
) {
    let tolerance = (range.high - range.low) * 1e-6;
    let (above, below) = (
        range.max > range.high + tolerance,
        range.min < range.low - tolerance,
    );
    let exponent = ticks(range.low, range.high, MAX_INTERVALS).exponent;
    // In the power of ten of the ticks, with enough digits to differ from the end of the bar.
    let formatted = |value: f64| {
        let end = if value > range.high {
            range.high
        } else {
            range.low
        };
        let [value, end] = [value, end].map(|x| x / 10f64.powi(exponent));
        let digits =
            (2..8).find(|&digits| format_number(value, digits) != format_number(end, digits));
        format_number(value, digits.unwrap_or(8))
    };
    let mut note = match (below, above) {
        (false, false) => String::new(),
        (false, true) => format!("up to {}", formatted(range.max)),
        (true, false) => format!("down to {}", formatted(range.min)),
        (true, true) => format!("{} to {}", formatted(range.min), formatted(range.max)),
    };
    if !note.is_empty() && !extremes_of.is_empty() {
        note += &format!(" {extremes_of}");
    }
    let (tip, height) = (7.0, 8.0);
    let available = right_limit - left - tip - 4.0 - text_width(&note, TEXT_SIZE);
    let width = available.clamp(40.0, 240.0);
    let strip = 0.5;
    let count = (width / strip) as usize;
    for i in 0..count {
        let t = (i as f64 + 0.5) / count as f64;
        // Strips overlap so that no gaps are visible.
        let start = left + width * i as f64 / count as f64;
        let length = (left + width - start).min(8.0 * strip);
        canvas.rectangle((start, top), length, height, map.colour(t));
    }
    let middle = top + height / 2.0;
    let right = left + width;
    if above {
        canvas.polygon(
            &[(right, top), (right + tip, middle), (right, top + height)],
            map.colour(1.0),
        );
    }
    if below {
        canvas.polygon(
            &[(left, top), (left - tip, middle), (left, top + height)],
            map.colour(0.0),
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
        range.low,
        range.high,
        ((width / 26.0) as usize).clamp(2, MAX_INTERVALS),
    );
    for (at, text) in marks.at.iter().zip(&marks.labels) {
        let x = left + width * (at - range.low) / (range.high - range.low);
        canvas.line((x, top + height), (x, top + height + 2.5), pen);
        canvas.text((x, top + height + 11.0), text, Anchor::Middle);
    }
    let mut title = label.to_owned();
    if exponent != 0 {
        title += &format!(" ({})", power_of_ten(exponent));
    }
    canvas.title(
        (left + width / 2.0, top + height + 23.5),
        &title,
        Anchor::Middle,
    );
    if !note.is_empty() {
        canvas.text((right + tip + 4.0, middle + HALF_CAP), &note, Anchor::Start);
    }
}
