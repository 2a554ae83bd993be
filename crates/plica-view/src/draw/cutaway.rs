//! Opened tubes, coloured by a field, over one colour bar.
//!
//! The tubes lie with z to the right and the colon end left, seen from the front and a little above; x points up and y
//! towards the viewer. All panels share scale, place along z and colours.

use super::canvas::{Anchor, Canvas, INK, Pen};
use super::colour::{Map, mix};
use super::image::MIN_SIDE;
use super::light::dot;
use super::range::Range;
use super::raster::{View, render};
use super::text::{CAPITAL, fitting};
use super::{DrawError, Image, Packing, Surface};

pub(super) const TITLE: f64 = 9.0;
pub(super) const TEXT: f64 = 8.0;
/// Room for "colon" and "ileum" beside the tubes.
pub(super) const SIDE: f64 = 36.0;
/// The height of a panel, at most, in points.
const TALLEST: f64 = 190.0;
/// Of lengths along the tube, what must be left on the page for the bar to stand for all.
const UPRIGHT: f64 = 0.98;
/// How much of its colour glass has.
const GLASS: f64 = 0.22;

/// One tube of the picture.
#[derive(Clone, Debug, Default)]
pub struct Panel {
    /// What stands above it.
    pub label: String,
    /// The tube, in units of D; see [`super::Opening::surfaces`].
    pub surfaces: Vec<Surface>,
    /// What of the tube is seen through, as if of glass.
    pub glass: Vec<Surface>,
}

impl Panel {
    /// The tube from a direction, what is of glass before it.
    fn seen(
        &self,
        view: &View,
        range: (f64, f64),
        map: Map,
        samples: usize,
    ) -> Result<Image, DrawError> {
        let mut tube = render(&self.surfaces, view, range, map, samples)?;
        if !self.glass.is_empty() {
            // Where glass is behind the rest, both pictures are the same.
            let all = [&self.surfaces[..], &self.glass].concat();
            let all = render(&all, view, range, map, samples)?;
            for (pixel, glass) in tube.pixels.iter_mut().zip(all.pixels) {
                *pixel = mix(*pixel, glass, GLASS);
            }
        }
        Ok(tube)
    }
}

/// Opened tubes, one above the other. Labels take the markup of [`super::Chart`].
#[derive(Clone, Debug)]
pub struct Cutaway {
    /// Line above everything; empty for none.
    pub title: String,
    /// The tubes, from the top.
    pub panels: Vec<Panel>,
    /// Name of the field; a common power of ten is added to it in brackets.
    pub value_label: String,
    /// Ends of the colour bar.
    pub range: Range,
    /// Colours of the field.
    pub map: Map,
    /// Direction of the viewer in the tube's coordinates; any but along z.
    pub toward: [f64; 3],
    /// Points that every panel makes room for, if there are any, instead of its own: those of all pictures of an animation, so that
    /// these are of one size.
    pub room: Vec<[f64; 3]>,
    /// Samples along either side of a pixel, 1 to 4: 2 are smooth, 3 are finer and take longer.
    pub samples: usize,
    /// Length of the bar that tells the scale, in units of D, and what stands beneath it.
    pub bar: (f64, String),
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
            map: Map::default(),
            toward: [0.42, 1.0, -0.35],
            room: Vec::new(),
            samples: 2,
            bar: (1.0, "*D*".into()),
            width_pt: 510.0,
        }
    }
}

impl Cutaway {
    /// The picture as the bytes of a PNG file of `width_px` pixels across.
    ///
    /// # Errors
    /// [`DrawError::Empty`] without a finite point or value, [`DrawError::Grid`] for a surface whose lists do not fill
    /// it, [`DrawError::Range`] for a given range that is none, [`DrawError::Size`] for an absurd size, [`DrawError::Triangles`] for too many.
    pub fn png(&self, width_px: usize) -> Result<Vec<u8>, DrawError> {
        self.packed(width_px, Packing::Small)
    }

    /// The same, packed in another way.
    ///
    /// # Errors
    /// As [`Cutaway::png`].
    pub fn packed(&self, width_px: usize, packing: Packing) -> Result<Vec<u8>, DrawError> {
        let image = self.image(width_px)?;
        image.to_png(self.width_pt * 25.4 / 72.0, packing)
    }

    /// Two points that make as much room as its panels take.
    ///
    /// # Errors
    /// As [`Cutaway::png`].
    pub fn room(&self) -> Result<[[f64; 3]; 2], DrawError> {
        let [right, up, _] = View::axes(self.toward);
        let (left, width) = self.extent(self.panels.iter(), right)?;
        let (low, height) = self.extent(self.panels.iter(), up)?;
        let corner = |x: f64, y: f64| std::array::from_fn(|i| x * right[i] + y * up[i]);
        Ok([corner(left, low), corner(left + width, low + height)])
    }

    /// Pixels to a unit of D in a picture so many pixels wide.
    ///
    /// # Errors
    /// [`DrawError::Empty`] without a finite point.
    pub fn pixels_per_unit(&self, width_px: usize) -> Result<f64, DrawError> {
        Ok(self.points_per_unit()? * width_px as f64 / self.width_pt)
    }

    /// Printed points to a unit of D: a short tube is as wide as its height lets it be.
    fn points_per_unit(&self) -> Result<f64, DrawError> {
        let [right, up, _] = View::axes(self.toward);
        let (_, width) = self.extent(self.panels.iter(), right)?;
        let mut tallest: f64 = 0.0;
        for panel in &self.panels {
            tallest = tallest.max(self.extent([panel].into_iter(), up)?.1);
        }
        Ok(((self.width_pt - 2.0 * SIDE) / width).min(TALLEST / tallest))
    }

    /// The picture as pixels.
    ///
    /// # Errors
    /// As [`Cutaway::png`].
    pub fn image(&self, width_px: usize) -> Result<Image, DrawError> {
        for surface in self.panels.iter().flat_map(|p| &p.surfaces) {
            surface.check()?;
        }
        let spanned = self.spanned()?;
        let [right, up, toward] = View::axes(self.toward);
        let (left, width) = self.extent(self.panels.iter(), right)?;
        let per_unit = self.points_per_unit()?;
        // A short tube stands in the middle.
        let inset = 0.5 * (self.width_pt - width * per_unit);

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
            let title = fitting(&self.title, TITLE, self.width_pt - 2.0 * SIDE);
            canvas.text((SIDE, 13.0), &title, TITLE, Anchor::Start, INK);
        }
        let margin = 2.0; // points around a tube, for the line at its edge
        let pixels = canvas.pixels_per_point();
        let range = (spanned.low, spanned.high);
        let tube = |(panel, &(_, high, height)): (&Panel, &(f64, f64, f64))| {
            let view = View {
                right,
                up,
                toward,
                corner: (left - margin / per_unit, high + margin / per_unit),
                scale: per_unit * pixels,
                // A long thin tube is a line.
                size: (
                    (((width * per_unit + 2.0 * margin) * pixels).ceil() as usize).max(MIN_SIDE),
                    (((height + 2.0 * margin) * pixels).ceil() as usize).max(MIN_SIDE),
                ),
            };
            panel.seen(&view, range, self.map, self.samples)
        };
        let tubes: Result<Vec<Image>, DrawError> =
            self.panels.iter().zip(&tops).map(tube).collect();
        for ((panel, (top, _, height)), tube) in self.panels.iter().zip(tops).zip(tubes?) {
            let mut top = top;
            if !panel.label.is_empty() {
                canvas.text((SIDE, top + 8.0), &panel.label, TEXT, Anchor::Start, INK);
                top += 13.0;
            }
            canvas.stamp(tube, (inset - margin, top - margin));
            let middle = top + height / 2.0 + TEXT * CAPITAL / 2.0;
            canvas.text((inset - 7.0, middle), "colon", TEXT, Anchor::End, INK);
            canvas.text(
                (self.width_pt - inset + 7.0, middle),
                "ileum",
                TEXT,
                Anchor::Start,
                INK,
            );
        }
        let (bar, name) = &self.bar;
        let diameter = bar * per_unit * right[2];
        let (end, base) = (self.width_pt - SIDE, bottom + 13.0);
        canvas.line((end - diameter, base), (end, base), Pen::new(INK, 1.2));
        canvas.text(
            (end - diameter / 2.0, base + 10.5),
            // Across the tube, and up, lengths come out otherwise where it is seen from an end.
            &if right[2] > UPRIGHT {
                name.clone()
            } else {
                format!("{name}, along")
            },
            TEXT,
            Anchor::Middle,
            INK,
        );
        self.draw_colour_bar(&mut canvas, bottom + 6.0, end - diameter - 12.0, spanned);
        canvas.finish()
    }

    /// Start and length of what the panels cover along a direction.
    pub(super) fn extent<'a>(
        &self,
        panels: impl Iterator<Item = &'a Panel>,
        direction: [f64; 3],
    ) -> Result<(f64, f64), DrawError> {
        let surfaces = panels.flat_map(|p| p.surfaces.iter().chain(&p.glass));
        let points = surfaces.flat_map(|s| &s.points);
        let (low, high) = if self.room.is_empty() {
            ends(points.map(|&p| dot(p, direction)))
        } else {
            ends(self.room.iter().map(|&p| dot(p, direction)))
        };
        if high > low {
            Ok((low, high - low))
        } else {
            Err(DrawError::Empty { what: "cut-away" })
        }
    }
}

/// Least and largest of the finite values.
pub(super) fn ends(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let finite = values.filter(|v| v.is_finite());
    finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| {
        (a.min(v), b.max(v))
    })
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::draw::{HALF, Opening};

    pub(in crate::draw) fn straight(values: impl Fn(f64) -> f64) -> Cutaway {
        let opening = Opening::evenly(HALF, [60, 30, 3]);
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
    fn a_tube_is_drawn_at_the_size_asked_for() {
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
    fn pictures_that_share_room_and_colours_are_of_one_size() {
        let mut picture = straight(|z| z);
        let room = picture.room().unwrap().to_vec();
        let found = picture.spanned().unwrap();
        assert_eq!(picture.image(600).unwrap().height, {
            picture.room = room.clone();
            picture.image(600).unwrap().height
        });
        // A tube that outgrows its room is cut off, and its values change no bar.
        let mut larger = straight(|z| 2.0 * z);
        for point in &mut larger.panels[0].surfaces[0].points {
            point[0] *= 1.1;
        }
        let alone = larger.image(600).unwrap().height;
        (larger.room, larger.range) = (room, Range::Found(found));
        assert_eq!(larger.spanned().unwrap(), found);
        let image = larger.image(600).unwrap();
        assert_eq!(image.height, picture.image(600).unwrap().height);
        assert_ne!(image.height, alone);
        assert_eq!(
            larger.pixels_per_unit(600).unwrap(),
            picture.pixels_per_unit(600).unwrap()
        );
    }

    #[test]
    fn glass_before_a_tube_tints_it_and_behind_it_is_not_seen() {
        let pixels =
            |picture: &Cutaway| Image::from_png(&picture.png(600).unwrap()).unwrap().pixels;
        let mut picture = straight(|z| z);
        picture.toward = [0.0, 1.0, 0.0];
        let opening = |kept| Opening::evenly(kept, [60, 30, 3]);
        let wall = |zeta: f64, eta: f64, xi: f64| {
            let r = 0.44 + 0.06 * xi;
            ([r * eta.cos(), r * eta.sin(), 3.0 * zeta], zeta)
        };
        let plain = pixels(&picture);
        picture.panels[0].glass = opening((0.0, std::f64::consts::PI)).surfaces(wall);
        let before = pixels(&picture);
        assert_eq!(before.len(), plain.len());
        let changed = before.iter().zip(&plain).filter(|(a, b)| a != b).count();
        assert!(changed * 4 > plain.len(), "{changed} of {}", plain.len());
        // From behind the glass is hidden by the tube, but for its rim.
        picture.toward = [0.0, -1.0, 0.0];
        let behind = pixels(&picture);
        picture.panels[0].glass.clear();
        let changed = behind
            .iter()
            .zip(pixels(&picture))
            .filter(|(a, b)| **a != *b)
            .count();
        assert!(changed * 50 < plain.len(), "{changed} of {}", plain.len());
    }

    #[test]
    fn bad_fields_are_errors() {
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
