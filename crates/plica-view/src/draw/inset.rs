//! Small tubes inside a chart, each connected by a line to a point of a curve.

use super::canvas::{Canvas, Pen};
use super::cutaway::{Cutaway, Panel};
use super::frame::Frame;
use super::render::render;
use super::view::View;
use super::{DrawError, Surface};

/// A small tube inside a chart, coloured like those of a [`Cutaway`]. All insets of a chart share one colour range.
#[derive(Clone, Debug, Default)]
pub struct Inset {
    /// Surfaces of the tube in units of D, see [`super::Opening::surfaces`].
    pub surfaces: Vec<Surface>,
    /// Point that the tube belongs to, in data units.
    pub at: (f64, f64),
    /// Centre of the tube as fractions of the frame, from the left and from the bottom.
    pub centre: (f64, f64),
    /// Width of the tube as a fraction of that of the frame.
    pub width: f64,
}

/// Samples along each side of a pixel.
const SAMPLES: usize = 3;

pub(super) fn draw_insets(
    insets: &[Inset],
    canvas: &mut Canvas,
    frame: &Frame,
) -> Result<(), DrawError> {
    if insets.is_empty() {
        return Ok(());
    }
    let panel = |inset: &Inset| Panel {
        surfaces: inset.surfaces.clone(),
        ..Panel::default()
    };
    let all = Cutaway {
        panels: insets.iter().map(panel).collect(),
        ..Cutaway::default()
    };
    let range = all.colour_range()?;
    let [right, up, toward] = View::axes(all.toward);
    let pixels = canvas.pixels_per_point();
    for (inset, panel) in insets.iter().zip(&all.panels) {
        let (left, width) = all.extent([panel].into_iter(), right)?;
        let (low, height) = all.extent([panel].into_iter(), up)?;
        let per_unit = inset.width * frame.width / width;
        let size = (width * per_unit, height * per_unit);
        let middle = (
            frame.left + inset.centre.0 * frame.width,
            frame.bottom() - inset.centre.1 * frame.height,
        );
        // From the point to the nearest position on the edge of the bounding box of the tube.
        let from = frame.position(inset.at);
        let nearest =
            |x: f64, middle: f64, size: f64| x.clamp(middle - 0.5 * size, middle + 0.5 * size);
        let to = (
            nearest(from.0, middle.0, size.0),
            nearest(from.1, middle.1, size.1),
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
        let tube = render(
            &panel.surfaces,
            &view,
            (range.low, range.high),
            all.map,
            SAMPLES,
        )?;
        canvas.overlay(tube, (middle.0 - 0.5 * size.0, middle.1 - 0.5 * size.1));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::cutaway::tests::straight;
    use crate::draw::{Chart, Curve, Image};

    #[test]
    fn an_inset_changes_pixels_only_around_its_centre() {
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
            centre: (0.25, 0.8),
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
