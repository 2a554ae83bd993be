//! Charts: curves with axes, a legend, markers and insets.
//!
//! A curve connects its points in the given order, so a wall that folds over itself is drawn correctly.

use super::annotations::{draw_legend, draw_markers, draw_vertical_lines, label_rows, legend_rows};
use super::canvas::{Anchor, Canvas, INK, Pen, Position};
use super::colour::line_colour;
use super::frame::{Frame, Shape, axis_range};
use super::inset::draw_insets;
use super::text::{CAP_HEIGHT, HALF_CAP, TITLE_SIZE, truncated};
use super::ticks::{Ticks, power_of_ten};
use super::{Compression, Curve, DrawError, Image, Inset, Marker, VerticalLine};

/// Curves in a frame. Labels may contain italics (`*z*/*D*`), subscripts (`_{max}`) and superscripts (`^{3}`).
#[derive(Clone, Debug)]
pub struct Chart {
    /// Title above the chart; empty for none.
    pub title: String,
    /// Title of the horizontal axis.
    pub x_label: String,
    /// Title of the vertical axis; a common power of ten is appended in brackets.
    pub y_label: String,
    /// Curves; later ones are drawn on top.
    pub curves: Vec<Curve>,
    /// Labelled points.
    pub markers: Vec<Marker>,
    /// Labelled values of x.
    pub vertical_lines: Vec<VerticalLine>,
    /// Small tubes inside the frame.
    pub insets: Vec<Inset>,
    /// Draws x and y to the same scale.
    pub equal_aspect: bool,
    /// Height of the frame divided by its width, unless the aspect is equal.
    pub proportion: f64,
    /// Range of the horizontal axis; taken from the data if `None`.
    pub x_range: Option<(f64, f64)>,
    /// Range of the vertical axis; taken from the data if `None`.
    pub y_range: Option<(f64, f64)>,
    /// Printed width in points: a journal column is about 250 points wide, a page about 510.
    pub width_pt: f64,
}

/// Pixels per point of the raster images embedded in an SVG file.
const SVG_PIXELS: f64 = 5.0;

impl Default for Chart {
    fn default() -> Self {
        Self {
            title: String::new(),
            x_label: String::new(),
            y_label: String::new(),
            curves: Vec::new(),
            markers: Vec::new(),
            vertical_lines: Vec::new(),
            insets: Vec::new(),
            equal_aspect: false,
            proportion: 0.66,
            x_range: None,
            y_range: None,
            width_pt: 300.0,
        }
    }
}

impl Chart {
    /// Returns the chart as a PNG file `width_px` pixels wide.
    ///
    /// # Errors
    /// [`DrawError::Empty`] without a finite point, [`DrawError::Range`] for an invalid range,
    /// [`DrawError::Size`] for an image that is too small or too large.
    pub fn png(&self, width_px: usize) -> Result<Vec<u8>, DrawError> {
        let compression = if self.insets.is_empty() {
            Compression::LineArt
        } else {
            Compression::Small
        };
        let image = self.image(width_px)?;
        image.to_png(self.width_pt * 25.4 / 72.0, compression)
    }

    /// Returns the chart as pixels.
    ///
    /// # Errors
    /// As [`Chart::png`].
    pub fn image(&self, width_px: usize) -> Result<Image, DrawError> {
        self.page(width_px)?.rasterise()
    }

    /// Returns the chart as an SVG file in which text stays text.
    ///
    /// # Errors
    /// As [`Chart::png`].
    pub fn svg(&self) -> Result<String, DrawError> {
        self.page((SVG_PIXELS * self.width_pt).ceil() as usize)?
            .to_svg()
    }

    fn page(&self, width_px: usize) -> Result<Canvas, DrawError> {
        let legend = legend_rows(&self.curves, self.width_pt);
        let [x, y] = self.ranges()?;
        let names = label_rows(&self.vertical_lines, x, self.width_pt);
        let shape = Shape {
            equal_aspect: self.equal_aspect,
            proportion: self.proportion,
            width_pt: self.width_pt,
            has_title: !self.title.is_empty(),
            has_y_label: !self.y_label.is_empty(),
            legend_rows: legend.len(),
            label_rows: names.iter().map(|n| n.1 + 1).max().unwrap_or(0),
        };
        let (frame, x, y) = Frame::new(&shape, x, y);

        let tail = if self.x_label.is_empty() { 20.0 } else { 35.0 };
        let mut canvas = Canvas::new(self.width_pt, frame.bottom() + tail, width_px)?;
        if !self.title.is_empty() {
            let title = truncated(&self.title, TITLE_SIZE, self.width_pt - frame.left - 4.0);
            canvas.title((frame.left, 13.0), &title, Anchor::Start);
        }
        draw_legend(&mut canvas, &frame, &legend, shape.has_title);
        self.draw_axes(&mut canvas, &frame, &x, &y)?;
        draw_vertical_lines(&mut canvas, &frame, &names);
        self.draw_curves(&mut canvas, &frame);
        draw_insets(&self.insets, &mut canvas, &frame)?;
        draw_markers(
            &self.markers,
            &self.curves,
            &self.vertical_lines,
            &mut canvas,
            &frame,
        );
        Ok(canvas)
    }

    /// Returns the ranges of x and y: the given ones, or those of the data plus a margin.
    fn ranges(&self) -> Result<[(f64, f64); 2], DrawError> {
        let curves = self.curves.iter().flat_map(|c| &c.points);
        let points = curves.chain(self.markers.iter().map(|m| &m.at));
        let finite: Vec<_> = points
            .filter(|(x, y)| x.is_finite() && y.is_finite())
            .collect();
        if finite.is_empty() {
            return Err(DrawError::Empty { what: "chart" });
        }
        let x = axis_range(self.x_range, finite.iter().map(|p| p.0))?;
        let y = axis_range(self.y_range, finite.iter().map(|p| p.1))?;
        Ok([x, y])
    }

    fn draw_axes(
        &self,
        canvas: &mut Canvas,
        frame: &Frame,
        x: &Ticks,
        y: &Ticks,
    ) -> Result<(), DrawError> {
        let axis = Pen::new(INK, 0.7);
        let (left, bottom) = (frame.left, frame.bottom());
        canvas.polyline(
            &[
                (left, frame.top),
                (left, bottom),
                (left + frame.width, bottom),
            ],
            axis,
        );
        for (at, text) in x.at.iter().zip(&x.labels) {
            let (across, _) = frame.position((*at, frame.y.0));
            canvas.line((across, bottom), (across, bottom + 3.0), axis);
            canvas.text((across, bottom + 12.5), text, Anchor::Middle);
        }
        for (at, text) in y.at.iter().zip(&y.labels) {
            let (_, down) = frame.position((frame.x.0, *at));
            canvas.line((left - 3.0, down), (left, down), axis);
            canvas.text((left - 5.5, down + HALF_CAP), text, Anchor::End);
        }
        let x_title = with_exponent(&self.x_label, x.exponent);
        canvas.title(
            (left + frame.width / 2.0, bottom + 26.0),
            &x_title,
            Anchor::Middle,
        );
        let y_title = with_exponent(&self.y_label, y.exponent);
        if !y_title.is_empty() {
            let position = (
                9.0 + TITLE_SIZE * CAP_HEIGHT / 2.0,
                frame.top + frame.height / 2.0,
            );
            canvas.title_upward(position, &y_title);
        }
        Ok(())
    }

    fn draw_curves(&self, canvas: &mut Canvas, frame: &Frame) {
        // The margin of half a point keeps the full width of a line along the edge.
        canvas.clip(
            (frame.left - 0.5, frame.top - 0.5),
            frame.width + 1.0,
            frame.height + 1.0,
        );
        for curve in &self.curves {
            let positions: Vec<Position> =
                curve.points.iter().map(|&p| frame.position(p)).collect();
            canvas.polyline(&positions, curve.pen());
        }
        canvas.unclip();
        for curve in self.curves.iter().filter(|c| c.dots) {
            for position in curve
                .points
                .iter()
                .map(|&p| frame.position(p))
                .filter(|&p| frame.contains(p))
            {
                canvas.disc(position, 1.7, line_colour(curve.colour), 0.0);
            }
        }
    }
}

fn with_exponent(title: &str, exponent: i32) -> String {
    if exponent == 0 {
        title.to_string()
    } else {
        format!("{title} ({})", power_of_ten(exponent))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::Image;

    fn folded() -> Chart {
        // An S-shaped curve with an overhang: x is not monotone.
        let points = vec![(0.0, 0.5), (1.0, 0.5), (0.7, 0.2), (3.0, 0.2)];
        Chart {
            curves: vec![Curve {
                points,
                ..Curve::default()
            }],
            ..Chart::default()
        }
    }

    #[test]
    fn png_has_the_requested_width_and_shows_the_curve() {
        let image = Image::from_png(&folded().png(600).unwrap()).unwrap();
        assert_eq!(image.width, 600);
        let dark = image.pixels.iter().filter(|p| p[0] < 60).count();
        assert!(dark > 1500, "{dark} dark pixels");
    }

    #[test]
    fn svg_contains_paths_and_text() {
        let chart = Chart {
            x_label: "*z*/*D*".into(),
            y_label: "less < more".into(),
            ..folded()
        };
        let svg = chart.svg().unwrap();
        for part in [
            "width=\"300.00pt\"",
            "rotate(-90)",
            "less &lt; more",
            "url(#clip-",
            "<path d=",
        ] {
            assert!(svg.contains(part), "{part}");
        }
    }

    #[test]
    fn invalid_data_is_an_error() {
        let error = |change: fn(&mut Chart)| {
            let mut chart = folded();
            change(&mut chart);
            chart.png(600).unwrap_err()
        };
        let nan = error(|chart| chart.curves[0].points = vec![(f64::NAN, 1.0)]);
        assert!(matches!(nan, DrawError::Empty { .. }));
        let reversed = error(|chart| chart.x_range = Some((2.0, 1.0)));
        assert!(matches!(reversed, DrawError::Range { .. }));
        let width = error(|chart| chart.width_pt = f64::NAN);
        assert!(matches!(width, DrawError::Size { .. }));
        assert!(matches!(folded().png(0), Err(DrawError::Size { .. })));
    }
}
