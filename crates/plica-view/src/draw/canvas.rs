//! A page measured in points, and what is drawn on it: lines, areas, texts, pictures.
//!
//! A page becomes pixels by `paint`, lines and texts by `vector`; both draw the same marks in the same order.

use super::text::{Run, line};
use super::{DrawError, Image};

/// Lines end where they are farther from the corner, in points.
const FAR: f64 = 1e5;
/// Ink of axes and texts.
pub(super) const INK: [u8; 3] = [34, 34, 34];

/// A place on the page: points to the right of and below the top left corner.
pub(super) type Place = (f64, f64);

/// Where a text hangs on its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// A pen; `dash` is the length of stroke and gap, (0, 0) for a whole line.
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

/// A rectangle by its top left corner, width and height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rectangle {
    pub corner: Place,
    pub width: f64,
    pub height: f64,
}

/// What an area is bounded by.
#[derive(Clone, Debug)]
pub(super) enum Area {
    Disc { middle: Place, radius: f64 },
    Rectangle(Rectangle),
    Polygon(Vec<Place>),
}

/// Something on the page; lengths in points.
#[derive(Clone, Debug)]
pub(super) enum Mark {
    /// Two places at least, joined in their order.
    Line { places: Vec<Place>, pen: Pen },
    /// Filled, without an outline.
    Area { area: Area, colour: [u8; 3] },
    /// Runs from `start` on to the right, or upward.
    Text {
        runs: Vec<Run>,
        start: Place,
        upward: bool,
        colour: [u8; 3],
    },
    /// What follows shows only in here, up to the next of its kind.
    Clip(Option<Rectangle>),
}

/// A picture laid over everything drawn, its top left corner at a pixel of the page.
#[derive(Clone, Debug)]
pub(super) struct Stamp {
    pub picture: Image,
    pub at: [i64; 2],
}

/// A page being drawn.
pub(super) struct Canvas {
    /// Width and height in points.
    pub size: (f64, f64),
    /// Width and height in pixels.
    pub pixels: [usize; 2],
    pub marks: Vec<Mark>,
    pub stamps: Vec<Stamp>,
}

impl Canvas {
    /// A white page of `width` by `height` points that becomes `width_px` pixels wide.
    pub fn new(width: f64, height: f64, width_px: usize) -> Result<Self, DrawError> {
        Ok(Self {
            size: (width, height),
            pixels: Image::size(width_px as f64, height * width_px as f64 / width)?,
            marks: Vec::new(),
            stamps: Vec::new(),
        })
    }

    /// Pixels per point.
    pub fn pixels_per_point(&self) -> f64 {
        self.pixels[0] as f64 / self.size.0
    }

    pub fn line(&mut self, from: Place, to: Place, pen: Pen) {
        self.polyline(&[from, to], pen);
    }

    /// Joins the places in their order; one that is not finite, or absurdly far, breaks the line.
    pub fn polyline(&mut self, places: &[Place], pen: Pen) {
        let runs = places.split(|(x, y)| !(x.abs() < FAR && y.abs() < FAR));
        for run in runs.filter(|run| run.len() > 1) {
            let places = run.to_vec();
            self.marks.push(Mark::Line { places, pen });
        }
    }

    fn fill(&mut self, area: Area, colour: [u8; 3]) {
        let is_finite = match &area {
            Area::Disc { middle: (x, y), .. } => (x + y).is_finite(),
            Area::Rectangle(area) => (area.corner.0 + area.corner.1).is_finite(),
            Area::Polygon(corners) => corners.iter().all(|(x, y)| (x + y).is_finite()),
        };
        if is_finite {
            self.marks.push(Mark::Area { area, colour });
        }
    }

    /// A filled disc; a white rim lifts it off the lines beneath.
    pub fn disc(&mut self, middle: Place, radius: f64, colour: [u8; 3], rim: f64) {
        let disc = |radius| Area::Disc { middle, radius };
        if rim > 0.0 {
            self.fill(disc(radius + rim), [255; 3]);
        }
        self.fill(disc(radius), colour);
    }

    /// A filled rectangle without an outline.
    pub fn rectangle(&mut self, corner: Place, width: f64, height: f64, colour: [u8; 3]) {
        let rectangle = Rectangle {
            corner,
            width,
            height,
        };
        self.fill(Area::Rectangle(rectangle), colour);
    }

    /// A filled polygon without an outline.
    pub fn polygon(&mut self, corners: &[Place], colour: [u8; 3]) {
        self.fill(Area::Polygon(corners.to_vec()), colour);
    }

    /// What is drawn until [`Canvas::unclip`] shows only inside this rectangle.
    pub fn clip(&mut self, corner: Place, width: f64, height: f64) {
        self.marks.push(Mark::Clip(Some(Rectangle {
            corner,
            width,
            height,
        })));
    }

    pub fn unclip(&mut self) {
        self.marks.push(Mark::Clip(None));
    }

    /// Writes a label with its baseline at `place`; `size` in points.
    pub fn text(&mut self, (x, y): Place, label: &str, size: f64, anchor: Anchor, colour: [u8; 3]) {
        let (runs, width) = line(label, size);
        let before = match anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => width / 2.0,
            Anchor::End => width,
        };
        let start = (x - before, y);
        self.marks.push(Mark::Text {
            runs,
            start,
            upward: false,
            colour,
        });
    }

    /// Writes a label that reads upward, the middle of its baseline at `place`.
    pub fn text_upward(&mut self, (x, y): Place, label: &str, size: f64) {
        let (runs, width) = line(label, size);
        self.marks.push(Mark::Text {
            runs,
            start: (x, y + width / 2.0),
            upward: true,
            colour: INK,
        });
    }

    /// Lays a picture over everything drawn, its top left corner at the pixel nearest to `place`; its white is transparent.
    pub fn stamp(&mut self, picture: Image, (x, y): Place) {
        let at = [x, y].map(|v| (v * self.pixels_per_point()).round() as i64);
        self.stamps.push(Stamp { picture, at });
    }
}
