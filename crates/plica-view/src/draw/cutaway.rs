//! Cutaways: tubes cut open and coloured by a field, above one colour bar.
//!
//! The z axis points to the right with the colon end on the left, x points up and y towards the viewer, who looks from the
//! front and a little above. All panels share the scale, the position along z and the colours.

use super::canvas::{Anchor, Canvas, INK, Pen};
use super::colour::{ColourMap, mix};
use super::colour_bar::draw_colour_bar;
use super::image::MIN_SIDE;
use super::range::{Range, ResolvedRange};
use super::render::render;
use super::text::{HALF_CAP, TEXT_SIZE, TITLE_SIZE, text_width, truncated};
use super::vec3::dot;
use super::view::View;
use super::{Compression, DrawError, Image, Surface};

/// Smallest margin for the names of the ends beside the tubes, in points.
const MIN_SIDE_MARGIN: f64 = 36.0;
/// Largest width of the name of an end, in points.
const MAX_NAME: f64 = 80.0;
/// Distance between the name of an end and the tube, and the edge of the picture, in points.
const GAP: f64 = 7.0;
/// Maximum height of a panel in points.
const MAX_HEIGHT: f64 = 190.0;
/// Smallest projected length of a unit along z for which the scale bar applies to all directions.
const MIN_PROJECTION: f64 = 0.98;
/// Opacity of translucent surfaces.
const OPACITY: f64 = 0.22;

/// One tube of a cutaway.
#[derive(Clone, Debug, Default)]
pub struct Panel {
    /// Text above the tube.
    pub label: String,
    /// Surfaces of the tube in units of D, see [`super::Opening::surfaces`].
    pub surfaces: Vec<Surface>,
    /// Translucent surfaces in front of the tube.
    pub translucent: Vec<Surface>,
}

impl Panel {
    /// Renders the tube, with the translucent surfaces in front.
    fn image(
        &self,
        view: &View,
        range: (f64, f64),
        map: ColourMap,
        samples: usize,
    ) -> Result<Image, DrawError> {
        let mut tube = render(&self.surfaces, view, range, map, samples)?;
        if !self.translucent.is_empty() {
            // Both images are the same where translucent surfaces are hidden.
            let all = [&self.surfaces[..], &self.translucent].concat();
            let all = render(&all, view, range, map, samples)?;
            for (pixel, translucent) in tube.pixels.iter_mut().zip(all.pixels) {
                *pixel = mix(*pixel, translucent, OPACITY);
            }
        }
        Ok(tube)
    }
}

/// Tubes cut open, one above the other. Labels use the markup of [`super::Chart`].
#[derive(Clone, Debug)]
pub struct Cutaway {
    /// Title above the picture; empty for none.
    pub title: String,
    /// Tubes from top to bottom.
    pub panels: Vec<Panel>,
    /// Name of the field; a common power of ten is appended in brackets.
    pub value_label: String,
    /// Rule for the ends of the colour bar.
    pub range: Range,
    /// Words after the extreme values beyond the ends of the colour bar; empty for those of the picture.
    pub extremes_of: &'static str,
    /// Colour map of the field.
    pub map: ColourMap,
    /// Direction towards the viewer in the coordinates of the tube; not along z.
    pub toward: [f64; 3],
    /// Points that determine the size of every panel instead of its surfaces, unless empty. They give all frames of an
    /// animation the same size.
    pub bounds: Vec<[f64; 3]>,
    /// Samples along each side of a pixel, 1 to 4: 2 give smooth edges, 3 are finer and take longer.
    pub samples: usize,
    /// Names of the ends on the left and on the right.
    pub ends: [String; 2],
    /// Length of the scale bar in units of D, and the text below it.
    pub scale_bar: (f64, String),
    /// Printed width in points.
    pub width_pt: f64,
}

impl Default for Cutaway {
    fn default() -> Self {
        Self {
            title: String::new(),
            panels: Vec::new(),
            value_label: String::new(),
            range: Range::Automatic,
            extremes_of: "",
            map: ColourMap::default(),
            toward: [0.42, 1.0, -0.35],
            bounds: Vec::new(),
            samples: 2,
            ends: ["colon", "ileum"].map(String::from),
            scale_bar: (1.0, "*D*".into()),
            width_pt: 510.0,
        }
    }
}

impl Cutaway {
    /// Returns the picture as a PNG file `width_px` pixels wide.
    ///
    /// # Errors
    /// [`DrawError::Empty`] without a finite point or value, [`DrawError::Grid`] for lists that do not match the grid,
    /// [`DrawError::Range`] for an invalid range, [`DrawError::Size`] for an image that is too small or too large, and
    /// [`DrawError::Triangles`] for too many triangles.
    pub fn png(&self, width_px: usize) -> Result<Vec<u8>, DrawError> {
        self.png_with(width_px, Compression::Small)
    }

    /// Returns the picture as a PNG file with the given compression.
    ///
    /// # Errors
    /// As [`Cutaway::png`].
    pub fn png_with(
        &self,
        width_px: usize,
        compression: Compression,
    ) -> Result<Vec<u8>, DrawError> {
        let image = self.image(width_px)?;
        image.to_png(self.width_pt * 25.4 / 72.0, compression)
    }

    /// Returns two opposite corners, on the page, of the bounding box of all panels; see [`Cutaway::bounds`].
    ///
    /// # Errors
    /// As [`Cutaway::png`].
    pub fn bounding_box(&self) -> Result<[[f64; 3]; 2], DrawError> {
        let [right, up, _] = View::axes(self.toward);
        let (left, width) = self.extent(self.panels.iter(), right)?;
        let (low, height) = self.extent(self.panels.iter(), up)?;
        let corner = |x: f64, y: f64| std::array::from_fn(|i| x * right[i] + y * up[i]);
        Ok([corner(left, low), corner(left + width, low + height)])
    }

    /// Resolves the colour range for the values of all panels.
    ///
    /// # Errors
    /// [`DrawError::Empty`] without a finite value, [`DrawError::Range`] for an invalid given range.
    pub fn colour_range(&self) -> Result<ResolvedRange, DrawError> {
        let surfaces = self.panels.iter().flat_map(|p| &p.surfaces);
        self.range
            .resolve(surfaces.flat_map(|s| &s.values).copied())
    }

    /// Returns the pixels per unit of D of a picture `width_px` pixels wide.
    ///
    /// # Errors
    /// [`DrawError::Empty`] without a finite point.
    pub fn pixels_per_unit(&self, width_px: usize) -> Result<f64, DrawError> {
        Ok(self.points_per_unit()? * width_px as f64 / self.width_pt)
    }

    /// Returns the names of the ends, shortened if they are long.
    fn end_names(&self) -> [String; 2] {
        let shortened = |name: &String| truncated(name, TEXT_SIZE, MAX_NAME);
        self.ends.each_ref().map(shortened)
    }

    /// Returns the margin beside the tubes, in points.
    fn side_margin(&self) -> f64 {
        let widths = self.end_names().map(|name| text_width(&name, TEXT_SIZE));
        MIN_SIDE_MARGIN.max(widths[0].max(widths[1]) + 2.0 * GAP)
    }

    /// Returns the printed points per unit of D; the maximum height limits the width of a short tube.
    fn points_per_unit(&self) -> Result<f64, DrawError> {
        let [right, up, _] = View::axes(self.toward);
        let (_, width) = self.extent(self.panels.iter(), right)?;
        let mut highest: f64 = 0.0;
        for panel in &self.panels {
            highest = highest.max(self.extent([panel].into_iter(), up)?.1);
        }
        Ok(((self.width_pt - 2.0 * self.side_margin()) / width).min(MAX_HEIGHT / highest))
    }

    /// Returns the picture as pixels.
    ///
    /// # Errors
    /// As [`Cutaway::png`].
    pub fn image(&self, width_px: usize) -> Result<Image, DrawError> {
        for surface in self.panels.iter().flat_map(|p| &p.surfaces) {
            surface.check()?;
        }
        let range = self.colour_range()?;
        let [right, up, toward] = View::axes(self.toward);
        let (left, width) = self.extent(self.panels.iter(), right)?;
        let per_unit = self.points_per_unit()?;
        // A short tube is centred.
        let inset = 0.5 * (self.width_pt - width * per_unit);

        let side = self.side_margin();
        let mut tops = Vec::new();
        let mut bottom = if self.title.is_empty() { 4.0 } else { 24.0 };
        for panel in &self.panels {
            let (low, height) = self.extent([panel].into_iter(), up)?;
            tops.push((bottom, low + height, height * per_unit));
            let label = if panel.label.is_empty() { 0.0 } else { 13.0 };
            bottom += label + height * per_unit + 10.0;
        }
        let mut canvas = Canvas::new(self.width_pt, bottom + 44.0, width_px)?;
        if !self.title.is_empty() {
            let title = truncated(
                &self.title,
                TITLE_SIZE,
                self.width_pt - 2.0 * self.side_margin(),
            );
            canvas.title((side, 13.0), &title, Anchor::Start);
        }
        let margin = 2.0; // points around a tube, for the line along its edge
        let pixels = canvas.pixels_per_point();
        let ends = (range.low, range.high);
        let tube = |(panel, &(_, high, height)): (&Panel, &(f64, f64, f64))| {
            let view = View {
                right,
                up,
                toward,
                corner: (left - margin / per_unit, high + margin / per_unit),
                scale: per_unit * pixels,
                // The minimum applies to a long thin tube.
                size: (
                    (((width * per_unit + 2.0 * margin) * pixels).ceil() as usize).max(MIN_SIDE),
                    (((height + 2.0 * margin) * pixels).ceil() as usize).max(MIN_SIDE),
                ),
            };
            panel.image(&view, ends, self.map, self.samples)
        };
        let tubes: Result<Vec<Image>, DrawError> =
            self.panels.iter().zip(&tops).map(tube).collect();
        for ((panel, (top, _, height)), tube) in self.panels.iter().zip(tops).zip(tubes?) {
            let mut top = top;
            if !panel.label.is_empty() {
                canvas.text((side, top + 8.0), &panel.label, Anchor::Start);
                top += 13.0;
            }
            canvas.overlay(tube, (inset - margin, top - margin));
            let middle = top + height / 2.0 + HALF_CAP;
            let [left, right] = self.end_names();
            canvas.text((inset - GAP, middle), &left, Anchor::End);
            canvas.text((self.width_pt - inset + GAP, middle), &right, Anchor::Start);
        }
        let (length, name) = &self.scale_bar;
        let length = length * per_unit * right[2];
        let (end, base) = (self.width_pt - side, bottom + 13.0);
        canvas.line((end - length, base), (end, base), Pen::new(INK, 1.2));
        canvas.text(
            (end - length / 2.0, base + 10.5), // In an oblique view the bar applies only to lengths along the tube.
            &if right[2] > MIN_PROJECTION {
                name.clone()
            } else {
                format!("{name}, along")
            },
            Anchor::Middle,
        );
        let (corner, limit) = ((side + 8.0, bottom + 6.0), end - length - 12.0);
        draw_colour_bar(
            &mut canvas,
            corner,
            limit,
            (range, self.extremes_of),
            self.map,
            &self.value_label,
        );
        canvas.rasterise()
    }

    /// Returns the start and the length of the interval that panels cover along a direction.
    pub(super) fn extent<'a>(
        &self,
        panels: impl Iterator<Item = &'a Panel>,
        direction: [f64; 3],
    ) -> Result<(f64, f64), DrawError> {
        let surfaces = panels.flat_map(|p| p.surfaces.iter().chain(&p.translucent));
        let points = surfaces.flat_map(|s| &s.points);
        let (low, high) = if self.bounds.is_empty() {
            ends(points.map(|&p| dot(p, direction)))
        } else {
            ends(self.bounds.iter().map(|&p| dot(p, direction)))
        };
        if high > low {
            Ok((low, high - low))
        } else {
            Err(DrawError::Empty { what: "cutaway" })
        }
    }
}

/// Returns the smallest and the largest finite value.
fn ends(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let finite = values.filter(|v| v.is_finite());
    finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| {
        (a.min(v), b.max(v))
    })
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::draw::{Opening, REAR_HALF};

    pub(in crate::draw) fn straight(values: impl Fn(f64) -> f64) -> Cutaway {
        let opening = Opening::uniform(REAR_HALF, [60, 30, 3]);
        let surfaces = opening.surfaces(|zeta, eta, xi| {
            let r = 0.44 + 0.06 * xi;
            ([r * eta.cos(), r * eta.sin(), 3.0 * zeta], values(zeta))
        });
        Cutaway {
            panels: vec![Panel {
                label: "straight".into(),
                surfaces,
                ..Panel::default()
            }],
            ..Cutaway::default()
        }
    }

    #[test]
    fn png_has_the_requested_width_and_shows_the_tube() {
        let image = Image::from_png(&straight(|z| z).png(600).unwrap()).unwrap();
        assert_eq!(image.width, 600);
        let inked = image.pixels.iter().filter(|&&p| p != [255; 3]).count();
        assert!(
            inked * 4 > image.pixels.len(),
            "{inked} of {}",
            image.pixels.len()
        );
    }

    #[test]
    fn pictures_with_common_bounds_have_the_same_size() {
        let mut picture = straight(|z| z);
        let bounds = picture.bounding_box().unwrap().to_vec();
        let range = picture.colour_range().unwrap();
        assert_eq!(picture.image(600).unwrap().height, {
            picture.bounds = bounds.clone();
            picture.image(600).unwrap().height
        });
        // A tube beyond the bounds is cut off, and its values do not change the colour bar.
        let mut larger = straight(|z| 2.0 * z);
        for point in &mut larger.panels[0].surfaces[0].points {
            point[0] *= 1.1;
        }
        let alone = larger.image(600).unwrap().height;
        (larger.bounds, larger.range) = (bounds, Range::Resolved(range));
        assert_eq!(larger.colour_range().unwrap(), range);
        let image = larger.image(600).unwrap();
        assert_eq!(image.height, picture.image(600).unwrap().height);
        assert_ne!(image.height, alone);
        assert_eq!(
            larger.pixels_per_unit(600).unwrap(),
            picture.pixels_per_unit(600).unwrap()
        );
    }

    #[test]
    fn translucent_surfaces_show_only_in_front_of_the_tube() {
        let pixels =
            |picture: &Cutaway| Image::from_png(&picture.png(600).unwrap()).unwrap().pixels;
        let mut picture = straight(|z| z);
        picture.toward = [0.0, 1.0, 0.0];
        let opening = |kept| Opening::uniform(kept, [60, 30, 3]);
        let wall = |zeta: f64, eta: f64, xi: f64| {
            let r = 0.44 + 0.06 * xi;
            ([r * eta.cos(), r * eta.sin(), 3.0 * zeta], zeta)
        };
        let plain = pixels(&picture);
        picture.panels[0].translucent = opening((0.0, std::f64::consts::PI)).surfaces(wall);
        let before = pixels(&picture);
        assert_eq!(before.len(), plain.len());
        let changed = before.iter().zip(&plain).filter(|(a, b)| a != b).count();
        assert!(changed * 4 > plain.len(), "{changed} of {}", plain.len());
        // Seen from the other side, the tube hides the translucent surfaces except for their rim.
        picture.toward = [0.0, -1.0, 0.0];
        let behind = pixels(&picture);
        picture.panels[0].translucent.clear();
        let changed = behind
            .iter()
            .zip(pixels(&picture))
            .filter(|(a, b)| **a != *b)
            .count();
        assert!(changed * 50 < plain.len(), "{changed} of {}", plain.len());
    }

    #[test]
    fn invalid_fields_and_ranges_are_errors() {
        assert!(matches!(
            straight(|_| f64::NAN).png(600),
            Err(DrawError::Empty { .. })
        ));
        assert!(matches!(
            Cutaway::default().png(600),
            Err(DrawError::Empty { .. })
        ));
        let upside_down = Cutaway {
            range: Range::Given(1.0, 0.0),
            ..straight(|z| z)
        };
        assert!(matches!(upside_down.png(600), Err(DrawError::Range { .. })));
    }
}
