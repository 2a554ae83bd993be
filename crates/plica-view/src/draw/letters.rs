//! Letters: which glyphs a text is made of, where they stand and what they look like; the one file that names HarfRust.
//!
//! The fonts are DejaVu Sans, upright and oblique, and are part of the program: a picture looks the same on every machine.

use harfrust::font::glyph::outline::{DrawMemory, DrawOptions, PathElement};
use harfrust::{Buffer, Direction, Font, GlyphId, ShapeOptions, ShaperFont, shape};
use std::sync::LazyLock;
use unicode_bidi::BidiInfo;

static UPRIGHT: LazyLock<Option<Font>> = LazyLock::new(|| Font::new(dejavu::sans::regular(), 0));
static OBLIQUE: LazyLock<Option<Font>> = LazyLock::new(|| Font::new(dejavu::sans::oblique(), 0));

/// Letters of one kind set on their baseline, which runs from 0 to the right; lengths in text sizes, up is positive.
#[derive(Clone, Debug, Default)]
pub(super) struct Letters {
    glyphs: Vec<Glyph>,
    italic: bool,
    /// From their start to where the next ones start.
    pub width: f64,
}

/// A glyph by its number in the font, and where its corner stands.
#[derive(Clone, Debug)]
struct Glyph {
    number: u32,
    at: (f64, f64),
}

/// A piece of the edge of letters: where it leads, by way of which points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Edge {
    Start([f64; 2]),
    Line([f64; 2]),
    Quadratic([[f64; 2]; 2]),
    Cubic([[f64; 2]; 3]),
    Close,
}

/// The font, and how many of its units are one text size.
fn font(italic: bool) -> Option<(&'static Font, f64)> {
    let font = if italic { &OBLIQUE } else { &UPRIGHT };
    let font = font.as_ref()?;
    Some((font, f64::from(font.units_per_em().max(1))))
}

/// The characters of a text that the fonts have no letters for, each once: they are drawn as boxes.
pub fn boxes(text: &str) -> Vec<char> {
    let mut boxes = vec![];
    for character in text.chars() {
        let set = Letters::set(&character.to_string(), false);
        if set.glyphs.iter().any(|glyph| glyph.number == 0) && !boxes.contains(&character) {
            boxes.push(character);
        }
    }
    boxes
}

impl Letters {
    /// Sets a text: pairs are kerned, accents stand on their letters.
    pub fn set(text: &str, italic: bool) -> Self {
        let mut letters = Self {
            italic,
            ..Self::default()
        };
        let Some((font, per_size)) = font(italic) else {
            return letters;
        };
        // Parts that are read leftward stand between others that are not: numbers, names.
        let bidi = BidiInfo::new(text, None);
        for paragraph in &bidi.paragraphs {
            let (levels, parts) = bidi.visual_runs(paragraph, paragraph.range.clone());
            for part in parts {
                let leftward = levels[part.start].is_rtl();
                letters.extend(&text[part], leftward, font, per_size);
            }
        }
        letters
    }

    /// Sets a part that is read one way behind what stands there.
    fn extend(&mut self, part: &str, leftward: bool, font: &Font, per_size: f64) {
        let mut buffer = Buffer::new();
        buffer.push_str(part);
        buffer.set_direction(if leftward {
            Direction::RightToLeft
        } else {
            Direction::LeftToRight
        });
        buffer.guess_segment_properties();
        if shape(&ShaperFont::new(font), &mut buffer, ShapeOptions::new()).is_err() {
            return;
        }
        for (info, position) in buffer.glyph_infos().iter().zip(buffer.glyph_positions()) {
            let [across, up, advance] = [position.x_offset, position.y_offset, position.x_advance]
                .map(|units| f64::from(units) / per_size);
            self.glyphs.push(Glyph {
                number: info.glyph_id,
                at: (self.width + across, up),
            });
            self.width += advance;
        }
    }

    /// The edges of all letters, counter-clockwise around their ink or the other way, after each other.
    pub fn edges(&self) -> Vec<Edge> {
        let Some((font, per_size)) = font(self.italic) else {
            return vec![];
        };
        let outlines = font.outline_glyphs();
        let (mut edges, mut path) = (vec![], Vec::new());
        for Glyph { number, at } in &self.glyphs {
            path.clear();
            let drawn = outlines
                .get(GlyphId::new(*number))
                .map(|outline| outline.draw(&DrawOptions::new(), DrawMemory::Scratch, &mut path));
            if !matches!(drawn, Some(Ok(_))) {
                continue;
            }
            let place = |x: f32, y: f32| {
                [
                    at.0 + f64::from(x) / per_size,
                    at.1 + f64::from(y) / per_size,
                ]
            };
            edges.extend(path.iter().map(|element| match *element {
                PathElement::MoveTo { x, y } => Edge::Start(place(x, y)),
                PathElement::LineTo { x, y } => Edge::Line(place(x, y)),
                PathElement::QuadTo { cx0, cy0, x, y } => {
                    Edge::Quadratic([place(cx0, cy0), place(x, y)])
                }
                PathElement::CurveTo {
                    cx0,
                    cy0,
                    cx1,
                    cy1,
                    x,
                    y,
                } => Edge::Cubic([place(cx0, cy0), place(cx1, cy1), place(x, y)]),
                PathElement::Close => Edge::Close,
            }));
        }
        edges
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fonts_are_there() {
        for italic in [false, true] {
            let (font, per_size) = font(italic).unwrap();
            assert!(font.num_glyphs() > 5000 && per_size == 2048.0);
        }
    }

    #[test]
    fn letters_are_set() {
        let width = |text| Letters::set(text, false).width;
        assert!((width("aa") - 2.0 * width("a")).abs() < 1e-12);
        assert!(width(" ") > 0.2);
        // DejaVu kerns this pair.
        assert!(width("AV") < width("A") + width("V") - 0.03);
        // Numbers in a text that is read leftward are not turned around.
        let numbers = |text| {
            let letters = Letters::set(text, false);
            letters.glyphs.iter().map(|g| g.number).collect::<Vec<_>>()
        };
        let (mixed, plain) = (numbers("אב 123"), numbers("123"));
        assert_eq!(mixed[..3], plain[..]);
        assert_eq!(mixed[4..], [numbers("ב"), numbers("א")].concat());
        // An accent of its own takes no room.
        assert!((width("e\u{301}") - width("e")).abs() < 1e-12);
    }

    #[test]
    fn letters_that_are_not_there_are_told() {
        assert_eq!(boxes("Süße, ελιά, мышца, אב, e\u{301} ∂W/∂u"), []);
        assert_eq!(boxes("腸重積, 腸"), ['腸', '重', '積']);
    }

    #[test]
    fn letters_have_edges() {
        let edges = Letters::set("l l", false).edges();
        let starts = |edge: &&Edge| matches!(edge, Edge::Start(_));
        assert_eq!(edges.iter().filter(starts).count(), 2);
        // A bare stroke from the baseline to above the capitals, and another after the space.
        let corners: Vec<[f64; 2]> = edges
            .iter()
            .filter_map(|edge| match edge {
                Edge::Start(at) | Edge::Line(at) => Some(*at),
                _ => None,
            })
            .collect();
        let ends = |i: usize| {
            let along = corners.iter().map(|c| c[i]);
            along.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| {
                (a.min(v), b.max(v))
            })
        };
        assert_eq!(ends(1).0, 0.0);
        assert!((0.73..0.8).contains(&ends(1).1), "{:?}", ends(1));
        assert!(ends(0).1 > Letters::set("l ", false).width);
    }
}
