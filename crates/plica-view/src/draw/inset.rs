//! Small tubes inside a chart, each with a line to the point of the curve that it belongs to.

use super::canvas::{Canvas, Pen};
use super::chart::Chart;
use super::cutaway::{Cutaway, Panel};
use super::frame::Frame;
use super::raster::{View, render};
use super::{DrawError, Surface};

/// A small tube inside a chart, coloured as those of a [`Cutaway`]; all of a chart share their colours.
#[derive(Clone, Debug, Default)]
pub struct Inset {
    /// The tube, in units of D; see [`super::Opening::surfaces`].
    pub surfaces: Vec<Surface>,
    /// The point it belongs to, in data units.
    pub at: (f64, f64),
    /// Where its middle is shown: parts of the frame, from its left and from its bottom.
    pub shown: (f64, f64),
    /// Its width, as a part of the frame's.
    pub width: f64,
}

/// Samples per pixel, in a row.
const SAMPLES: usize = 3;

impl Chart {
    pub(super) fn draw_insets(&self, canvas: &mut Canvas, frame: &Frame) -> Result<(), DrawError> {
        if self.insets.is_empty() {
            return Ok(());
        }
        let panel = |inset: &Inset| Panel {
            surfaces: inset.surfaces.clone(),
            ..Panel::default()
        };
        let all = Cutaway {
            panels: self.insets.iter().map(panel).collect(),
            ..Cutaway::default()
        };
        let spanned = all.spanned()?;
        let [right, up, toward] = View::axes(all.toward);
        let pixels = canvas.pixels_per_point();
        for (inset, panel) in self.insets.iter().zip(&all.panels) {
            let (left, width) = all.extent([panel].into_iter(), right)?;
            let (low, height) = all.extent([panel].into_iter(), up)?;
            let per_unit = inset.width * frame.width / width;
            let size = (width * per_unit, height * per_unit);
            let middle = (
                frame.left + inset.shown.0 * frame.width,
                frame.bottom() - inset.shown.1 * frame.height,
            );
            // From the point to the nearest place on the edge of the tube's box.
            let from = frame.place(inset.at);
            let near =
                |x: f64, middle: f64, size: f64| x.clamp(middle - 0.5 * size, middle + 0.5 * size);
            let to = (
                near(from.0, middle.0, size.0),
                near(from.1, middle.1, size.1),
            );
            let pen = Pen {
                colour: [150; 3],
                width: 0.5,
                dash: (0.0, 0.0),
            };
            canvas.line(from, to, pen);
            let view = View {
                right,
                up,
                toward,
                corner: (left, low + height),
                scale: per_unit * pixels,
                size: [size.0, size.1]
                    .map(|s| (s * pixels).ceil().max(1.0) as usize)
                    .into(),
            };
            let range = (spanned.low, spanned.high);
            let tube = render(&panel.surfaces, &view, range, all.map, SAMPLES)?;
            canvas.stamp(tube, (middle.0 - 0.5 * size.0, middle.1 - 0.5 * size.1));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::cutaway::tests::straight;
    use crate::draw::{Curve, Image};

    #[test]
    fn a_small_tube_stands_where_it_is_to() {
        let chart = |insets: Vec<Inset>| Chart {
            curves: vec![Curve {
                points: vec![(0.0, 0.0), (1.0, 1.0)],
                ..Curve::default()
            }],
            insets,
            ..Chart::default()
        };
        let inset = Inset {
            surfaces: straight(|z| z).panels.remove(0).surfaces,
            at: (0.5, 0.5),
            shown: (0.25, 0.8),
            width: 0.3,
        };
        let image = |insets| Image::from_png(&chart(insets).png(600).unwrap()).unwrap();
        let (without, with) = (image(vec![]), image(vec![inset]));
        let changed: Vec<(usize, usize)> = (0..with.pixels.len())
            .filter(|&i| with.pixels[i] != without.pixels[i])
            .map(|i| (i % with.width, i / with.width))
            .collect();
        assert!(changed.len() > 2000, "{}", changed.len());
        let right = changed.iter().map(|c| c.0).max().unwrap();
        assert!(right < with.width * 6 / 10, "{right}");
    }
}
