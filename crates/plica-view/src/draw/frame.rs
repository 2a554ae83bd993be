//! The frame of a chart: which part of the plane it shows, and where on the page.

use super::DrawError;
use super::canvas::Place;
use super::chart::{Chart, ROW, TEXT};
use super::text::text_width;
use super::ticks::{Ticks, ticks};

/// The least width of a frame, over that of the page: two ticks find room.
const NARROWEST: f64 = 0.35;

/// Lower and upper end of an axis.
pub(super) type Ends = (f64, f64);

/// The rectangle of the data on the page, and the data's ranges.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub left: f64,
    pub top: f64,
    pub width: f64,
    pub height: f64,
    pub x: Ends,
    pub y: Ends,
}

impl Frame {
    /// Where a point of the data lies on the page.
    pub fn place(&self, (x, y): (f64, f64)) -> Place {
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

    /// Whether a place lies in the frame or on its edge.
    pub fn holds(&self, (x, y): Place) -> bool {
        let across = self.left - 0.1..=self.left + self.width + 0.1;
        across.contains(&x) && (self.top - 0.1..=self.bottom() + 0.1).contains(&y)
    }
}

impl Chart {
    /// The ranges of x and y: those given, or those of the data with a little room.
    pub(super) fn ranges(&self) -> Result<(Ends, Ends), DrawError> {
        let points = self
            .curves
            .iter()
            .flat_map(|c| &c.points)
            .chain(self.markers.iter().map(|m| &m.at));
        let finite: Vec<_> = points
            .filter(|(x, y)| x.is_finite() && y.is_finite())
            .collect();
        if finite.is_empty() {
            return Err(DrawError::Empty { what: "chart" });
        }
        let x = range(self.x_range, finite.iter().map(|p| p.0))?;
        let y = range(self.y_range, finite.iter().map(|p| p.1))?;
        Ok((x, y))
    }

    /// The frame below a legend of `legend` rows and `names` rows of names of rules, and the ticks of x and y.
    pub(super) fn frame(
        &self,
        legend: usize,
        names: usize,
    ) -> Result<(Frame, Ticks, Ticks), DrawError> {
        let (mut x, y) = self.ranges()?;
        let aspect = (y.1 - y.0) / (x.1 - x.0);
        // Width of the tick labels depends on the height and the other way round; a guess at the height settles it.
        let guess = if self.equal_aspect {
            aspect * (self.width_pt - 60.0)
        } else {
            0.94 * self.proportion * self.width_pt
        };
        let y_ticks = ticks(y.0, y.1, ((guess / 24.0) as usize).clamp(2, 7));
        let widest = y_ticks
            .labels
            .iter()
            .map(|t| text_width(t, TEXT))
            .fold(0.0, f64::max);
        let left = widest + if self.y_label.is_empty() { 12.0 } else { 24.0 };
        let mut width = (self.width_pt - left - 12.0).max(self.width_pt * 0.2);
        let mut height = if self.equal_aspect {
            aspect * width
        } else {
            self.proportion * width
        };
        let tallest = 1.2 * self.width_pt;
        if height > tallest {
            (height, width) = (tallest, tallest / aspect);
            let narrowest = NARROWEST * self.width_pt;
            if width < narrowest {
                // Of what is much higher than wide, with a bare margin on both sides.
                let middle = f64::midpoint(x.0, x.1);
                let half = 0.5 * (x.1 - x.0) * narrowest / width;
                (x, width) = ((middle - half, middle + half), narrowest);
            }
        }
        let x_ticks = ticks(x.0, x.1, ((width / 38.0) as usize).clamp(2, 8));
        let title = if self.title.is_empty() { 0.0 } else { 1.0 };
        let top = 8.0 + ROW * (title * 1.3 + legend as f64 * 1.1 + names as f64);
        Ok((
            Frame {
                left,
                top,
                width,
                height,
                x,
                y,
            },
            x_ticks,
            y_ticks,
        ))
    }
}

/// The given range, or that of the values with a little room; values not far above zero start there.
fn range(given: Option<Ends>, values: impl Iterator<Item = f64>) -> Result<Ends, DrawError> {
    if let Some((low, high)) = given {
        let sound = low.is_finite() && high.is_finite() && low < high;
        return if sound {
            Ok((low, high))
        } else {
            Err(DrawError::Range { low, high })
        };
    }
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| {
        (a.min(v), b.max(v))
    });
    let room = 0.04 * (high - low);
    if room <= f64::EPSILON * high.abs() {
        let room = if high == 0.0 { 1.0 } else { 0.1 * high.abs() };
        return Ok((low - room, high + room));
    }
    let start = if (0.0..0.35 * high).contains(&low) {
        0.0
    } else {
        low - room
    };
    Ok((start, high + room))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::Curve;

    #[test]
    fn equal_aspect_is_equal() {
        let chart = Chart {
            equal_aspect: true,
            width_pt: 500.0,
            curves: vec![Curve {
                points: vec![(0.0, 0.1), (3.0, 0.5)],
                ..Curve::default()
            }],
            ..Chart::default()
        };
        let (frame, ..) = chart.frame(0, 0).unwrap();
        let (x0, y0) = frame.place((0.0, 0.0));
        let (x1, y1) = frame.place((1.0, 1.0));
        assert!((x1 - x0 - (y0 - y1)).abs() < 1e-9);
    }

    #[test]
    fn ranges_leave_room_and_start_at_zero_when_near() {
        let of = |values: [f64; 2]| range(None, values.into_iter()).unwrap();
        assert_eq!(of([0.5, 3.0]), (0.0, 3.1));
        assert_eq!(of([1.0, 1.25]), (0.99, 1.26));
        let (low, high) = of([2.0, 2.0]);
        assert!(low < 2.0 && high > 2.0);
    }
}
