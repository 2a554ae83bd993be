//! Lines and texts on a page measured in points; the one file that names kuva.
//!
//! kuva draws at twice the size asked for and the mean of each square is kept, since its thick strokes are smoothed
//! across but not down. Its own axes are not used: they know neither equal aspect nor slanted letters.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use kuva::RasterBackend;
use kuva::backend::svg::SvgBackend;
use kuva::render::color::Color;
use kuva::render::render::{PathData, Primitive, Scene, TextAnchor, TextSpan};

use rayon::prelude::*;

use super::dashes::dashes;
use super::inked::{Block, Patch, blocks};
use super::label::{Level, Piece, pieces};
use super::{DrawError, Image};

/// How much finer than asked kuva draws.
const FINER: usize = 2;
/// Farther from the corner, in points, nothing is drawn.
const FAR: f64 = 1e5;
/// So many widths of texts are remembered.
const MOST_KNOWN: usize = 4_000;
/// Fonts of texts that stay texts; they are measured in the first.
const FONTS: &str = "DejaVu Sans, Verdana, Helvetica, Arial, sans-serif";
/// Page height of a capital letter, in text sizes.
pub(super) const CAPITAL: f64 = 0.73;
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

/// A page being drawn.
pub(super) struct Canvas {
    /// Width in points.
    pub width: f64,
    /// kuva's pixels per point.
    zoom: f64,
    scene: Scene,
    /// Where each element of the scene leaves ink; nowhere in particular what only says how others are drawn.
    inked: Vec<Vec<Patch>>,
    stamps: Vec<(Image, i64, i64)>,
    /// Pages that lie on their left side, and the middle of each.
    upward: Vec<(Canvas, Place)>,
    clips: usize,
    /// Width and height in final pixels.
    pixels: [usize; 2],
}

impl Canvas {
    /// A white page of `width` by `height` points that becomes `width_px` pixels wide.
    pub fn new(width: f64, height: f64, width_px: usize) -> Result<Self, DrawError> {
        let pixels = Image::size(width_px as f64, height * width_px as f64 / width)?;
        let scene = Scene::new((pixels[0] * FINER) as f64, (pixels[1] * FINER) as f64);
        let zoom = (FINER * width_px) as f64 / width;
        Ok(Self {
            width,
            zoom,
            scene,
            inked: Vec::new(),
            stamps: Vec::new(),
            upward: Vec::new(),
            clips: 0,
            pixels,
        })
    }

    /// Adds an element that leaves ink on these patches; without any it says how others are drawn.
    fn add(&mut self, element: Primitive, patches: impl IntoIterator<Item = Patch>) {
        self.scene.add(element);
        self.inked.push(patches.into_iter().collect());
    }

    /// Final pixels per point.
    pub fn pixels_per_point(&self) -> f64 {
        self.zoom / FINER as f64
    }

    pub fn line(&mut self, from: Place, to: Place, pen: Pen) {
        self.polyline(&[from, to], pen);
    }

    /// Joins the places in their order; one that is not finite, or absurdly far, breaks the line.
    pub fn polyline(&mut self, places: &[Place], pen: Pen) {
        for run in places.split(|(x, y)| !(x.abs() < FAR && y.abs() < FAR)) {
            if pen.dash.0 <= 0.0 || pen.dash.1 <= 0.0 {
                self.stroke(run, pen);
                continue;
            }
            for dash in dashes(run, pen.dash) {
                self.stroke(&dash, pen);
            }
        }
    }

    fn stroke(&mut self, run: &[Place], pen: Pen) {
        let points = run
            .iter()
            .map(|&(x, y)| (x * self.zoom, y * self.zoom))
            .collect();
        let stroke_width = pen.width * self.zoom;
        let line = Primitive::PolyLine {
            points,
            stroke: ink(pen.colour),
            stroke_width,
            stroke_dasharray: None,
        };
        let pieces = run.windows(2);
        self.add(
            line,
            pieces.filter_map(|ends| Patch::around(ends.iter().copied(), pen.width)),
        );
    }

    /// A filled disc; a white rim lifts it off the lines beneath.
    pub fn disc(&mut self, (x, y): Place, radius: f64, colour: [u8; 3], rim: f64) {
        let patch = Patch::around([(x, y)], radius + rim);
        for (r, c) in [(radius + rim, [255; 3]), (radius, colour)] {
            let (cx, cy, r) = (x * self.zoom, y * self.zoom, r * self.zoom);
            let (fill, none) = (ink(c), None);
            let disc = Primitive::Circle {
                cx,
                cy,
                r,
                fill,
                fill_opacity: none,
                stroke: None,
                stroke_width: none,
            };
            self.add(disc, patch);
        }
    }

    /// A filled rectangle without an outline.
    pub fn rectangle(&mut self, (x, y): Place, width: f64, height: f64, colour: [u8; 3]) {
        let patch = Patch::around([(x, y), (x + width, y + height)], 0.0);
        let (x, y, width, height) = (
            x * self.zoom,
            y * self.zoom,
            width * self.zoom,
            height * self.zoom,
        );
        let fill = ink(colour);
        let rectangle = Primitive::Rect {
            x,
            y,
            width,
            height,
            fill,
            stroke: None,
            stroke_width: None,
            opacity: None,
        };
        self.add(rectangle, patch);
    }

    /// A filled polygon without an outline.
    pub fn polygon(&mut self, corners: &[Place], colour: [u8; 3]) {
        let mut d = String::new();
        for (i, (x, y)) in corners.iter().enumerate() {
            let word = if i == 0 { 'M' } else { 'L' };
            d += &format!("{word} {:.3} {:.3} ", x * self.zoom, y * self.zoom);
        }
        d.push('Z');
        let (fill, stroke, stroke_width) = (Some(ink(colour)), Color::None, 0.0);
        let polygon = Primitive::Path(Box::new(PathData {
            d,
            fill,
            stroke,
            stroke_width,
            opacity: None,
            stroke_dasharray: None,
        }));
        self.add(polygon, Patch::around(corners.iter().copied(), 0.0));
    }

    /// What is drawn until [`Canvas::unclip`] shows only inside this rectangle.
    pub fn clip(&mut self, (x, y): Place, width: f64, height: f64) {
        let (x, y, width, height) = (
            x * self.zoom,
            y * self.zoom,
            width * self.zoom,
            height * self.zoom,
        );
        let id = format!("clip-{}", self.clips);
        let clip = Primitive::ClipStart {
            x,
            y,
            width,
            height,
            id,
        };
        self.add(clip, None);
        self.clips += 1;
    }

    pub fn unclip(&mut self) {
        self.add(Primitive::ClipEnd, None);
    }

    /// Writes a label with its baseline at `place`; `size` in points.
    pub fn text(&mut self, (x, y): Place, label: &str, size: f64, anchor: Anchor, colour: [u8; 3]) {
        let pieces = pieces(label);
        let widths: Vec<f64> = pieces
            .iter()
            .map(|p| piece_width(p, size * self.zoom))
            .collect();
        let total: f64 = widths.iter().sum();
        let mut pen = x * self.zoom;
        match anchor {
            Anchor::Start => {}
            Anchor::Middle => pen -= total / 2.0,
            Anchor::End => pen -= total,
        }
        for (piece, width) in pieces.iter().zip(widths) {
            let drop = piece.level.drop() * size;
            let text = written(
                piece,
                (pen, (y + drop) * self.zoom),
                size * self.zoom,
                colour,
            );
            let (left, right) = (pen / self.zoom, (pen + width) / self.zoom);
            // Ascenders and descenders, and italics that lean out.
            self.add(text, Patch::around([(left, y - size), (right, y)], size));
            pen += width;
        }
    }

    /// Writes a label that reads upward, its middle at `place` and its baseline `CAPITAL / 2` to the right of it.
    pub fn text_upward(&mut self, (x, y): Place, label: &str, size: f64) -> Result<(), DrawError> {
        let (width, height) = (self.text_width(label, size) + size, size * 2.0);
        let mut slip = Canvas::new(
            width,
            height,
            (width * self.pixels_per_point()).ceil() as usize,
        )?;
        slip.text(
            (width / 2.0, size * (1.0 + CAPITAL / 2.0)),
            label,
            size,
            Anchor::Middle,
            INK,
        );
        self.upward.push((slip, (x, y)));
        Ok(())
    }

    /// Lays a picture of final pixels over everything drawn, its top left corner at `place`; its white is transparent.
    pub fn stamp(&mut self, picture: Image, (x, y): Place) {
        let pixel = |v: f64| (v * self.pixels_per_point()).round() as i64;
        self.stamps.push((picture, pixel(x), pixel(y)));
    }

    /// Width of a label in points.
    pub fn text_width(&self, label: &str, size: f64) -> f64 {
        pieces(label)
            .iter()
            .map(|p| piece_width(p, size * self.zoom))
            .sum::<f64>()
            / self.zoom
    }

    /// A label, or as much of its beginning as fits into a width, in points.
    pub fn fitting(&self, label: &str, size: f64, width: f64) -> String {
        if self.text_width(label, size) <= width {
            return label.to_owned();
        }
        let letters: Vec<char> = label.chars().collect();
        let cut = |count: usize| letters[..count].iter().collect::<String>() + "…";
        let fits = |count: &usize| self.text_width(&cut(*count), size) <= width;
        let counts: Vec<usize> = (0..letters.len()).collect();
        cut(counts.partition_point(fits).saturating_sub(1))
    }

    /// The page as pixels.
    pub fn finish(mut self) -> Result<Image, DrawError> {
        for (slip, (x, y)) in std::mem::take(&mut self.upward) {
            let (width, height) = slip.size();
            let turned = slip.finish()?.turned_left();
            self.stamp(turned, (x - height / 2.0, y - width / 2.0));
        }
        // Most of a page is bare or not kuva's, and what is costs by the area.
        let per_point = self.pixels_per_point();
        let blocks = blocks(self.inked.iter().flatten(), self.pixels, per_point);
        let painted = |block: &Block| Ok(self.part(block, per_point)?.reduced(FINER));
        let painted: Vec<Image> = blocks
            .par_iter()
            .map(painted)
            .collect::<Result<_, DrawError>>()?;
        let [width, height] = self.pixels;
        let mut page = Image::white(width as f64, height as f64)?;
        for (block, image) in blocks.iter().zip(&painted) {
            page.stamp(image, block.columns.start as i64, block.rows.start as i64);
        }
        for (picture, x, y) in &self.stamps {
            page.stamp(picture, *x, *y);
        }
        Ok(page)
    }

    /// A block of the page, painted in kuva's pixels.
    fn part(&self, block: &Block, per_point: f64) -> Result<Image, DrawError> {
        let [columns, rows] = [&block.columns, &block.rows];
        let mut part = Scene::new((FINER * columns.len()) as f64, (FINER * rows.len()) as f64);
        part.add(Primitive::GroupStart {
            transform: Some(format!(
                "translate(-{},-{})",
                FINER * columns.start,
                FINER * rows.start
            )),
            title: None,
            extra_attrs: None,
        });
        for (element, patches) in self.scene.elements.iter().zip(&self.inked) {
            if patches.is_empty() || patches.iter().any(|patch| block.meets(patch, per_point)) {
                let mut element = element.clone();
                if let Primitive::RichText { y, .. } = &mut element {
                    // As kuva does, which rounds the other way above the block.
                    *y = y.floor();
                }
                part.add(element);
            }
        }
        part.add(Primitive::GroupEnd);
        rendered(&part)
    }

    /// The page as lines and texts, in points; pictures laid over it multiply with what is beneath, so that their white is
    /// transparent here too.
    pub fn finish_svg(mut self) -> Result<String, DrawError> {
        let (width, height) = self.size();
        self.scene.font_family = Some(FONTS.into());
        let mut page = format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" width="{width:.2}pt" height="{height:.2}pt" viewBox="0 0 {:.2} {:.2}" xml:space="preserve" style="white-space:pre">"#,
            self.scene.width, self.scene.height
        );
        page += r##"<rect width="100%" height="100%" fill="#ffffff"/>"##;
        page += &lines(&self.scene);
        for (mut slip, (x, y)) in self.upward {
            slip.scene.font_family = Some(FONTS.into());
            slip.scene.background_color = None;
            let (x, y) = (x * self.zoom, y * self.zoom);
            let (w, h) = (slip.scene.width / 2.0, slip.scene.height / 2.0);
            page += &format!(
                r#"<g transform="translate({:.2},{:.2}) rotate(-90)">{}</g>"#,
                x - h,
                y + w,
                lines(&slip.scene)
            );
        }
        for (picture, x, y) in &self.stamps {
            let finer = |n: i64| n * FINER as i64;
            page += &format!(
                r#"<image x="{}" y="{}" width="{}" height="{}" style="mix-blend-mode:multiply" href="data:image/png;base64,{}"/>"#,
                finer(*x),
                finer(*y),
                FINER * picture.width,
                FINER * picture.height,
                STANDARD.encode(picture.to_png(1.0)?)
            );
        }
        page += "</svg>\n";
        Ok(page)
    }

    /// Width and height in points.
    fn size(&self) -> (f64, f64) {
        (self.scene.width / self.zoom, self.scene.height / self.zoom)
    }
}

/// A scene as SVG.
fn lines(scene: &Scene) -> String {
    SvgBackend::new().render_scene(scene)
}

fn ink([r, g, b]: [u8; 3]) -> Color {
    Color::Rgb(r, g, b)
}

fn rendered(scene: &Scene) -> Result<Image, DrawError> {
    let bytes = RasterBackend::new()
        .with_scale(1.0)
        .render_scene(scene)
        .map_err(DrawError::Backend)?;
    Image::from_png(&bytes)
}

fn written(piece: &Piece, (x, y): Place, size: f64, colour: [u8; 3]) -> Primitive {
    // In an SVG, spaces at the ends of a piece would not count.
    let inner = piece.text.trim_matches(' ');
    let before = piece.text.len() - piece.text.trim_start_matches(' ').len();
    let after = (piece.text.len() - before).saturating_sub(inner.len());
    let hard = |count: usize| "\u{a0}".repeat(count);
    let text = hard(before) + inner + &hard(after);
    let span = TextSpan {
        text,
        bold: false,
        italic: piece.italic,
        underline: false,
        code: false,
        math: false,
    };
    let size = text_size(piece, size) as u32;
    Primitive::RichText {
        x,
        y,
        spans: vec![span],
        size,
        anchor: TextAnchor::Start,
        color: Some(ink(colour)),
    }
}

/// Whole pixels, as kuva has it.
fn text_size(piece: &Piece, size: f64) -> f64 {
    (size * piece.level.size()).round()
}

/// Advance of a run in kuva's pixels: what it adds between two bars, because kuva keeps its measures to itself. Letters grow
/// with their size, so a run is measured once.
fn piece_width(piece: &Piece, size: f64) -> f64 {
    static KNOWN: Mutex<BTreeMap<(String, bool), Option<f64>>> = Mutex::new(BTreeMap::new());
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    if known.len() > MOST_KNOWN {
        known.clear();
    }
    let mut between = |text: &str| {
        let key = (text.to_string(), piece.italic);
        *known.entry(key).or_insert_with(|| {
            between_bars(&Piece {
                text: format!("|{text}|"),
                level: Level::Line,
                ..piece.clone()
            })
        })
    };
    let ems = match (between(&piece.text), between("")) {
        (Some(with), Some(without)) => (with - without).max(0.0),
        _ => 0.6 * piece.text.chars().count() as f64,
    };
    ems * text_size(piece, size)
}

/// From the first to the last dark column of a run, in text sizes.
fn between_bars(piece: &Piece) -> Option<f64> {
    const LARGE: f64 = 96.0;
    let width = LARGE * (piece.text.chars().count() as f64 + 2.0);
    let mut scene = Scene::new(width, LARGE);
    scene.add(written(piece, (LARGE / 2.0, LARGE * 0.7), LARGE, [0; 3]));
    let image = rendered(&scene).ok()?;
    let pixels = image.pixels.iter().enumerate();
    let (first, last) = pixels
        .filter(|(_, p)| p[0] < 128)
        .map(|(i, _)| i % image.width)
        .fold((usize::MAX, 0), |(a, b), column| {
            (a.min(column), b.max(column))
        });
    Some(last.checked_sub(first)? as f64 / LARGE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_label_is_cut_where_it_fits() {
        let canvas = Canvas::new(100.0, 50.0, 400).unwrap();
        assert_eq!(canvas.fitting("short", 10.0, 90.0), "short");
        let long = "a title that goes on and on, and on";
        let cut = canvas.fitting(long, 10.0, 90.0);
        assert!(cut.ends_with('…') && long.starts_with(cut.trim_end_matches('…')));
        let width = canvas.text_width(&cut, 10.0);
        assert!((75.0..=90.0).contains(&width), "{width}");
        assert_eq!(canvas.fitting(long, 10.0, 0.0), "…");
    }

    #[test]
    fn text_width_counts_spaces_and_levels() {
        let canvas = Canvas::new(100.0, 50.0, 400).unwrap();
        let width = |label| canvas.text_width(label, 10.0);
        assert!((width("a b") - width("a") - width("b") - width(" ")).abs() < 0.5);
        assert!(width(" ") > 2.0);
        assert!(width("x_{max}") < width("xmax"));
    }

    #[test]
    fn a_page_in_blocks_is_the_page_in_one() {
        let mut canvas = Canvas::new(300.0, 200.0, 900).unwrap();
        let pen = Pen {
            dash: (3.0, 2.0),
            ..Pen::new([20, 90, 160], 1.3)
        };
        let wave: Vec<Place> = (0..200)
            .map(|i| {
                (
                    30.0 + f64::from(i),
                    100.0 + 60.0 * (0.05 * f64::from(i)).sin(),
                )
            })
            .collect();
        canvas.clip((20.0, 20.0), 250.0, 110.0);
        canvas.polyline(&wave, pen);
        canvas.line((25.0, 25.0), (280.0, 190.0), Pen::new([200, 0, 0], 0.7));
        canvas.unclip();
        canvas.disc((150.0, 60.3), 4.0, [0, 120, 0], 1.0);
        canvas.rectangle((200.2, 15.7), 40.0, 9.0, [240, 200, 90]);
        canvas.polygon(&[(10.0, 150.0), (60.0, 195.0), (12.0, 190.0)], [9, 90, 9]);
        // Across the cells of the page, at many heights.
        for k in 0..12 {
            let place = (5.0 + 2.1 * f64::from(k), 12.3 + 15.7 * f64::from(k));
            canvas.text(
                place,
                "(*invaginated*, W_{max} = 10^{-4} gjpqy)",
                9.0,
                Anchor::Start,
                INK,
            );
        }
        let whole = Block {
            columns: 0..canvas.pixels[0],
            rows: 0..canvas.pixels[1],
        };
        let whole = canvas.part(&whole, canvas.pixels_per_point()).unwrap();
        let (whole, page) = (whole.reduced(FINER), canvas.finish().unwrap());
        assert_eq!((whole.width, whole.height), (page.width, page.height));
        let apart = |(a, b): (&[u8; 3], &[u8; 3])| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) > 1);
        let off = whole
            .pixels
            .iter()
            .zip(&page.pixels)
            .filter(|&pair| apart(pair));
        assert_eq!(off.count(), 0);
    }
}
