//! Curves against axes: energy paths, wall profiles.
//!
//! Curves are drawn in the order of their points, so a wall that folds over itself comes out as it is.

use super::canvas::{Anchor, Canvas, INK, Pen, Place};
use super::colour::{line_colour, mix};
use super::frame::Frame;
use super::inset::Inset;
use super::text::{CAPITAL, fitting};
use super::ticks::{Ticks, power_of_ten};
use super::{DrawError, Image, Packing};

/// Sizes of axis titles and of everything else, in points.
pub(super) const TITLE: f64 = 9.0;
pub(super) const TEXT: f64 = 8.0;
pub(super) const ROW: f64 = 12.0;

/// How a curve is stroked.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Stroke {
    /// A full line.
    #[default]
    Solid,
    /// A thinner, paler line of the same colour: the inner wall beside the outer one.
    Fine,
    /// A dashed line.
    Dashed,
}

/// A polyline through its points in their order; a point that is not finite breaks it.
#[derive(Clone, Debug, Default)]
pub struct Curve {
    /// Name in the legend; a curve without one is left out of it.
    pub label: String,
    /// Places in data units.
    pub points: Vec<(f64, f64)>,
    /// Number of a colour, see [`line_colour`]: 0 is black.
    pub colour: usize,
    /// How it is stroked.
    pub stroke: Stroke,
    /// Whether each point gets a dot.
    pub dots: bool,
}

/// A dot with a label beside it, set where it hides least.
#[derive(Clone, Debug, Default)]
pub struct Marker {
    /// Place in data units.
    pub at: (f64, f64),
    /// What it says.
    pub label: String,
    /// Its colour, as of a curve.
    pub colour: usize,
}

/// A vertical line across the frame, named above it: where the wall turns square.
#[derive(Clone, Debug, Default)]
pub struct Rule {
    /// Place along x.
    pub at: f64,
    /// What it says.
    pub label: String,
}

/// Curves in a frame. Labels may slant (`*z*/*D*`), lower (`_{max}`) and raise (`^{3}`).
#[derive(Clone, Debug)]
pub struct Chart {
    /// Line above everything; empty for none.
    pub title: String,
    /// Title of the horizontal axis.
    pub x_label: String,
    /// Title of the vertical axis; a common power of ten is added to it in brackets.
    pub y_label: String,
    /// The curves, later ones on top.
    pub curves: Vec<Curve>,
    /// Places to point out.
    pub markers: Vec<Marker>,
    /// Values of x to point out.
    pub rules: Vec<Rule>,
    /// Small tubes.
    pub insets: Vec<Inset>,
    /// One unit of x as long as one unit of y.
    pub equal_aspect: bool,
    /// Height of the frame over its width, where the two axes need no equal units.
    pub proportion: f64,
    /// Ends of the horizontal axis; chosen from the data if absent.
    pub x_range: Option<(f64, f64)>,
    /// Ends of the vertical axis; chosen from the data if absent.
    pub y_range: Option<(f64, f64)>,
    /// Printed width in points: a journal's column is about 250, its page about 510.
    pub width_pt: f64,
}

/// Pixels per point of pictures in what is drawn as lines.
const SVG_PIXELS: f64 = 5.0;

impl Default for Chart {
    fn default() -> Self {
        Self {
            title: String::new(),
            x_label: String::new(),
            y_label: String::new(),
            curves: Vec::new(),
            markers: Vec::new(),
            rules: Vec::new(),
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
    /// The chart as the bytes of a PNG file of `width_px` pixels across.
    ///
    /// # Errors
    /// [`DrawError::Empty`] without a finite point, [`DrawError::Range`] for a given range that is none,
    /// [`DrawError::Size`] for an absurd size.
    pub fn png(&self, width_px: usize) -> Result<Vec<u8>, DrawError> {
        let packing = if self.insets.is_empty() {
            Packing::Plain
        } else {
            Packing::Small
        };
        let image = self.image(width_px)?;
        image.to_png(self.width_pt * 25.4 / 72.0, packing)
    }

    /// The chart as pixels.
    ///
    /// # Errors
    /// As [`Chart::png`].
    pub fn image(&self, width_px: usize) -> Result<Image, DrawError> {
        self.page(width_px)?.finish()
    }

    /// The chart as an SVG file, its texts as texts.
    ///
    /// # Errors
    /// As [`Chart::png`].
    pub fn svg(&self) -> Result<String, DrawError> {
        self.page((SVG_PIXELS * self.width_pt).ceil() as usize)?
            .finish_svg()
    }

    fn page(&self, width_px: usize) -> Result<Canvas, DrawError> {
        let legend = self.legend_rows();
        let names = self.rule_rows()?;
        let (frame, x, y) = self.frame(
            legend.len(),
            names.iter().map(|n| n.1 + 1).max().unwrap_or(0),
        )?;

        let tail = if self.x_label.is_empty() { 20.0 } else { 35.0 };
        let mut canvas = Canvas::new(self.width_pt, frame.bottom() + tail, width_px)?;
        if !self.title.is_empty() {
            let title = fitting(&self.title, TITLE, self.width_pt - frame.left - 4.0);
            canvas.text((frame.left, 13.0), &title, TITLE, Anchor::Start, INK);
        }
        self.draw_legend(&mut canvas, &frame, &legend);
        self.draw_axes(&mut canvas, &frame, &x, &y)?;
        self.draw_rules(&mut canvas, &frame, &names);
        self.draw_curves(&mut canvas, &frame);
        self.draw_insets(&mut canvas, &frame)?;
        self.draw_markers(&mut canvas, &frame);
        Ok(canvas)
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
            let (across, _) = frame.place((*at, frame.y.0));
            canvas.line((across, bottom), (across, bottom + 3.0), axis);
            canvas.text((across, bottom + 12.5), text, TEXT, Anchor::Middle, INK);
        }
        for (at, text) in y.at.iter().zip(&y.labels) {
            let (_, down) = frame.place((frame.x.0, *at));
            canvas.line((left - 3.0, down), (left, down), axis);
            canvas.text(
                (left - 5.5, down + TEXT * CAPITAL / 2.0),
                text,
                TEXT,
                Anchor::End,
                INK,
            );
        }
        let x_title = with_exponent(&self.x_label, x.exponent);
        canvas.text(
            (left + frame.width / 2.0, bottom + 26.0),
            &x_title,
            TITLE,
            Anchor::Middle,
            INK,
        );
        let y_title = with_exponent(&self.y_label, y.exponent);
        if !y_title.is_empty() {
            let place = (9.0 + TITLE * CAPITAL / 2.0, frame.top + frame.height / 2.0);
            canvas.text_upward(place, &y_title, TITLE);
        }
        Ok(())
    }

    fn draw_curves(&self, canvas: &mut Canvas, frame: &Frame) {
        // Half a point of room, so that a line along the edge keeps its width.
        canvas.clip(
            (frame.left - 0.5, frame.top - 0.5),
            frame.width + 1.0,
            frame.height + 1.0,
        );
        for curve in &self.curves {
            let places: Vec<Place> = curve.points.iter().map(|&p| frame.place(p)).collect();
            canvas.polyline(&places, pen(curve));
        }
        canvas.unclip();
        for curve in self.curves.iter().filter(|c| c.dots) {
            for place in curve
                .points
                .iter()
                .map(|&p| frame.place(p))
                .filter(|&p| frame.holds(p))
            {
                canvas.disc(place, 1.7, line_colour(curve.colour), 0.0);
            }
        }
    }
}

pub(super) fn pen(curve: &Curve) -> Pen {
    let colour = line_colour(curve.colour);
    match curve.stroke {
        Stroke::Solid => Pen::new(colour, if curve.dots { 1.1 } else { 1.5 }),
        Stroke::Fine => Pen::new(mix(colour, [255; 3], 0.3), 0.8),
        Stroke::Dashed => Pen {
            colour,
            width: 1.2,
            dash: (4.5, 2.5),
        },
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

    fn fold() -> Chart {
        // An S that overhangs: x is not monotone.
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
    fn png_has_the_width_asked_for_and_ink_in_the_fold() {
        let image = Image::from_png(&fold().png(600).unwrap()).unwrap();
        assert_eq!(image.width, 600);
        let dark = image.pixels.iter().filter(|p| p[0] < 60).count();
        assert!(dark > 1500, "{dark} dark pixels");
    }

    #[test]
    fn svg_has_lines_and_texts() {
        let chart = Chart {
            x_label: "*z*/*D*".into(),
            y_label: "less < more".into(),
            ..fold()
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
    fn bad_data_is_an_error() {
        let nan = Curve {
            points: vec![(f64::NAN, 1.0)],
            ..Curve::default()
        };
        assert!(matches!(
            Chart {
                curves: vec![nan],
                ..fold()
            }
            .png(600),
            Err(DrawError::Empty { .. })
        ));
        assert!(matches!(
            Chart {
                x_range: Some((2.0, 1.0)),
                ..fold()
            }
            .png(600),
            Err(DrawError::Range { .. })
        ));
        assert!(matches!(fold().png(0), Err(DrawError::Size { .. })));
        assert!(matches!(
            Chart {
                width_pt: f64::NAN,
                ..fold()
            }
            .png(600),
            Err(DrawError::Size { .. })
        ));
    }
}
