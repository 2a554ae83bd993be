//! A page measured in points, and the primitives on it: lines, areas, text and images.
//!
//! `rasterise` turns a page into pixels and `svg` into an SVG file; both draw the same primitives in the same order.

use super::text::{Run, TEXT_SIZE, TITLE_SIZE, layout};
use super::{DrawError, Image};

/// Largest coordinate of a line, in points; lines are interrupted beyond it.
const MAX_COORDINATE: f64 = 1e5;
/// Colour of axes and text.
pub(super) const INK: [u8; 3] = [34, 34, 34];

/// A position on the page: points to the right of and below the top left corner.
pub(super) type Position = (f64, f64);

/// Part of a text that is aligned with its position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// Colour, width and dash pattern of a line; `dash` is the length of dash and gap, (0, 0) for a solid line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pen {
    pub colour: [u8; 3],
    pub width: f64,
    pub dash: (f64, f64),
}

impl Pen {
    pub fn new(colour: [u8; 3], width: f64) -> Self {
        Self {
            colour,
            width,
            dash: (0.0, 0.0),
        }
    }
}

/// A rectangle given by its top left corner, width and height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rectangle {
    pub corner: Position,
    pub width: f64,
    pub height: f64,
}

/// Shape of a filled area.
#[derive(Clone, Debug)]
pub(super) enum Area {
    Disc { middle: Position, radius: f64 },
    Rectangle(Rectangle),
    Polygon(Vec<Position>),
}

/// An item on the page; lengths in points.
#[derive(Clone, Debug)]
pub(super) enum Primitive {
    /// A polyline through at least two positions.
    Line { points: Vec<Position>, pen: Pen },
    /// A filled area without an outline.
    Area { area: Area, colour: [u8; 3] },
    /// Runs of text from `start` to the right, or upwards.
    Text {
        runs: Vec<Run>,
        start: Position,
        upward: bool,
        colour: [u8; 3],
    },
    /// Clips the following primitives to a rectangle, until the next primitive of this kind.
    Clip(Option<Rectangle>),
}

/// An image on top of all primitives; `at` is the pixel of the page at its top left corner.
#[derive(Clone, Debug)]
pub(super) struct Overlay {
    pub image: Image,
    pub at: [i64; 2],
}

/// A page under construction.
pub(super) struct Canvas {
    /// Width and height in points.
    pub size: (f64, f64),
    /// Width and height in pixels.
    pub pixels: [usize; 2],
    pub primitives: Vec<Primitive>,
    pub overlays: Vec<Overlay>,
}

impl Canvas {
    /// Creates a white page of `width` by `height` points that is rasterised to a width of `width_px` pixels.
    pub fn new(width: f64, height: f64, width_px: usize) -> Result<Self, DrawError> {
        Ok(Self {
            size: (width, height),
            pixels: Image::size(width_px as f64, height * width_px as f64 / width)?,
            primitives: Vec::new(),
            overlays: Vec::new(),
        })
    }

    /// Pixels per point.
    pub fn pixels_per_point(&self) -> f64 {
        self.pixels[0] as f64 / self.size.0
    }

    pub fn line(&mut self, from: Position, to: Position, pen: Pen) {
        self.polyline(&[from, to], pen);
    }

    /// Draws a polyline; a position that is not finite, or far off the page, interrupts it.
    pub fn polyline(&mut self, points: &[Position], pen: Pen) {
        let runs = points.split(|(x, y)| !(x.abs() < MAX_COORDINATE && y.abs() < MAX_COORDINATE));
        for run in runs.filter(|run| run.len() > 1) {
            let points = run.to_vec();
            self.primitives.push(Primitive::Line { points, pen });
        }
    }

    fn fill(&mut self, area: Area, colour: [u8; 3]) {
        let is_finite = match &area {
            Area::Disc { middle: (x, y), .. } => (x + y).is_finite(),
            Area::Rectangle(area) => (area.corner.0 + area.corner.1).is_finite(),
            Area::Polygon(corners) => corners.iter().all(|(x, y)| (x + y).is_finite()),
        };
        if is_finite {
            self.primitives.push(Primitive::Area { area, colour });
        }
    }

    /// Draws a filled disc with a white rim of the given width.
    pub fn disc(&mut self, middle: Position, radius: f64, colour: [u8; 3], rim: f64) {
        let disc = |radius| Area::Disc { middle, radius };
        if rim > 0.0 {
            self.fill(disc(radius + rim), [255; 3]);
        }
        self.fill(disc(radius), colour);
    }

    /// Draws a filled rectangle without an outline.
    pub fn rectangle(&mut self, corner: Position, width: f64, height: f64, colour: [u8; 3]) {
        let rectangle = Rectangle {
            corner,
            width,
            height,
        };
        self.fill(Area::Rectangle(rectangle), colour);
    }

    /// Draws a filled polygon without an outline.
    pub fn polygon(&mut self, corners: &[Position], colour: [u8; 3]) {
        self.fill(Area::Polygon(corners.to_vec()), colour);
    }

    /// Clips everything drawn until [`Canvas::unclip`] to a rectangle.
    pub fn clip(&mut self, corner: Position, width: f64, height: f64) {
        self.primitives.push(Primitive::Clip(Some(Rectangle {
            corner,
            width,
            height,
        })));
    }

    pub fn unclip(&mut self) {
        self.primitives.push(Primitive::Clip(None));
    }

    /// Draws a label in ordinary text, with its baseline at a position.
    pub fn text(&mut self, position: Position, label: &str, anchor: Anchor) {
        self.text_with(position, label, TEXT_SIZE, anchor, INK);
    }

    /// Draws a title, with its baseline at a position.
    pub fn title(&mut self, position: Position, label: &str, anchor: Anchor) {
        self.text_with(position, label, TITLE_SIZE, anchor, INK);
    }

    /// Draws a label in a font size in points and a colour.
    pub fn text_with(
        &mut self,
        (x, y): Position,
        label: &str,
        size: f64,
        anchor: Anchor,
        colour: [u8; 3],
    ) {
        let (runs, width) = layout(label, size);
        let before = match anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => width / 2.0,
            Anchor::End => width,
        };
        let start = (x - before, y);
        self.primitives.push(Primitive::Text {
            runs,
            start,
            upward: false,
            colour,
        });
    }

    /// Draws a title that reads upwards, with the middle of its baseline at a position.
    pub fn title_upward(&mut self, (x, y): Position, label: &str) {
        let (runs, width) = layout(label, TITLE_SIZE);
        self.primitives.push(Primitive::Text {
            runs,
            start: (x, y + width / 2.0),
            upward: true,
            colour: INK,
        });
    }

    /// Places an image over everything drawn, its top left corner at the pixel nearest to a position; its white is transparent.
    pub fn overlay(&mut self, image: Image, (x, y): Position) {
        let at = [x, y].map(|v| (v * self.pixels_per_point()).round() as i64);
        self.overlays.push(Overlay { image, at });
    }
}
