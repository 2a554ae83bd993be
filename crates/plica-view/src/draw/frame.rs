//! The frame of a chart: data ranges and the rectangle they fill on the page.

use super::DrawError;
use super::canvas::Position;
use super::text::{ROW_HEIGHT, TEXT_SIZE, text_width};
use super::ticks::{Ticks, ticks};

/// Smallest width of a frame divided by that of the page: it has space for two tick labels.
const MIN_WIDTH: f64 = 0.35;

/// Lower and upper end of an axis.
pub(super) type Interval = (f64, f64);

/// Rectangle of the data on the page in points, and the ranges of the data.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub left: f64,
    pub top: f64,
    pub width: f64,
    pub height: f64,
    pub x: Interval,
    pub y: Interval,
}

/// Properties of a chart that determine its frame.
pub(super) struct Shape {
    pub equal_aspect: bool,
    pub proportion: f64,
    pub width_pt: f64,
    pub has_title: bool,
    pub has_y_label: bool,
    /// Rows of the legend.
    pub legend_rows: usize,
    /// Rows of labels of vertical lines.
    pub label_rows: usize,
}

impl Frame {
    /// Returns the frame for the ranges `x` and `y`, and the ticks of both axes.
    pub fn new(shape: &Shape, mut x: Interval, y: Interval) -> (Self, Ticks, Ticks) {
        let aspect = (y.1 - y.0) / (x.1 - x.0);
        // The width of the tick labels depends on the height and vice versa; an estimate of the height is enough.
        let estimate = if shape.equal_aspect {
            aspect * (shape.width_pt - 60.0)
        } else {
            0.94 * shape.proportion * shape.width_pt
        };
        let y_ticks = ticks(y.0, y.1, ((estimate / 24.0) as usize).clamp(2, 7));
        let label_widths = y_ticks.labels.iter().map(|t| text_width(t, TEXT_SIZE));
        let widest = label_widths.fold(0.0, f64::max);
        let left = widest + if shape.has_y_label { 24.0 } else { 12.0 };
        let mut width = (shape.width_pt - left - 12.0).max(shape.width_pt * 0.2);
        let mut height = if shape.equal_aspect {
            aspect * width
        } else {
            shape.proportion * width
        };
        let max_height = 1.2 * shape.width_pt;
        if height > max_height {
            (height, width) = (max_height, max_height / aspect);
            let min_width = MIN_WIDTH * shape.width_pt;
            if width < min_width {
                // Data much higher than wide get an empty margin on both sides.
                let middle = f64::midpoint(x.0, x.1);
                let half = 0.5 * (x.1 - x.0) * min_width / width;
                (x, width) = ((middle - half, middle + half), min_width);
            }
        }
        let x_ticks = ticks(x.0, x.1, ((width / 38.0) as usize).clamp(2, 8));
        let title = if shape.has_title { 1.0 } else { 0.0 };
        let top = 8.0
            + ROW_HEIGHT * (title * 1.3 + shape.legend_rows as f64 * 1.1 + shape.label_rows as f64);
        let frame = Self {
            left,
            top,
            width,
            height,
            x,
            y,
        };
        (frame, x_ticks, y_ticks)
    }

    /// Returns the position on the page of a point of the data.
    pub fn position(&self, (x, y): (f64, f64)) -> Position {
        let across = (x - self.x.0) / (self.x.1 - self.x.0);
        let up = (y - self.y.0) / (self.y.1 - self.y.0);
        (
            self.left + across * self.width,
            self.top + (1.0 - up) * self.height,
        )
    }

    pub fn bottom(&self) -> f64 {
        self.top + self.height
    }

    /// Returns true for a position in the frame or on its edge.
    pub fn contains(&self, (x, y): Position) -> bool {
        let across = self.left - 0.1..=self.left + self.width + 0.1;
        across.contains(&x) && (self.top - 0.1..=self.bottom() + 0.1).contains(&y)
    }
}

/// Returns the given range, or that of the values plus a margin; an axis starts at zero if the values begin not far above it.
pub(super) fn axis_range(
    given: Option<Interval>,
    values: impl Iterator<Item = f64>,
) -> Result<Interval, DrawError> {
    if let Some((low, high)) = given {
        let valid = low.is_finite() && high.is_finite() && low < high;
        return if valid {
            Ok((low, high))
        } else {
            Err(DrawError::Range { low, high })
        };
    }
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| {
        (a.min(v), b.max(v))
    });
    let margin = 0.04 * (high - low);
    if margin <= f64::EPSILON * high.abs() {
        let margin = if high == 0.0 { 1.0 } else { 0.1 * high.abs() };
        return Ok((low - margin, high + margin));
    }
    let start = if (0.0..0.35 * high).contains(&low) {
        0.0
    } else {
        low - margin
    };
    Ok((start, high + margin))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_aspect_gives_both_axes_the_same_scale() {
        let shape = Shape {
            equal_aspect: true,
            proportion: 0.66,
            width_pt: 500.0,
            has_title: false,
            has_y_label: false,
            legend_rows: 0,
            label_rows: 0,
        };
        let (frame, ..) = Frame::new(&shape, (0.0, 3.1), (0.0, 0.52));
        let (x0, y0) = frame.position((0.0, 0.0));
        let (x1, y1) = frame.position((1.0, 1.0));
        assert!((x1 - x0 - (y0 - y1)).abs() < 1e-9);
    }

    #[test]
    fn ranges_have_margins_and_start_at_zero_when_near() {
        let range = |values: [f64; 2]| axis_range(None, values.into_iter()).unwrap();
        assert_eq!(range([0.5, 3.0]), (0.0, 3.1));
        assert_eq!(range([1.0, 1.25]), (0.99, 1.26));
        let (low, high) = range([2.0, 2.0]);
        assert!(low < 2.0 && high > 2.0);
    }
}
