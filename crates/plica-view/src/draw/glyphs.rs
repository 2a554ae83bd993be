//! Glyphs of a text: selection, positions and outlines. This is the only file that uses HarfRust.
//!
//! The fonts DejaVu Sans and DejaVu Sans Oblique are compiled in, so a picture looks the same on every machine.

use harfrust::font::glyph::outline::{DrawMemory, DrawOptions, PathElement};
use harfrust::{Buffer, Direction, Font, GlyphId, ShapeOptions, ShaperFont, shape};
use std::sync::LazyLock;
use unicode_bidi::BidiInfo;

static UPRIGHT: LazyLock<Option<Font>> = LazyLock::new(|| Font::new(dejavu::sans::regular(), 0));
static OBLIQUE: LazyLock<Option<Font>> = LazyLock::new(|| Font::new(dejavu::sans::oblique(), 0));

/// Glyphs of one font on a baseline that runs from 0 to the right. Lengths are relative to the font size; up is positive.
#[derive(Clone, Debug, Default)]
pub(super) struct GlyphRun {
    glyphs: Vec<Glyph>,
    italic: bool,
    /// Advance width: distance to the start of the next run.
    pub width: f64,
}

/// Index of a glyph in the font, and the position of its origin.
#[derive(Clone, Debug)]
struct Glyph {
    number: u32,
    at: (f64, f64),
}

/// Segment of an outline; the last point is its end, the points before it are control points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Segment {
    Start([f64; 2]),
    Line([f64; 2]),
    Quadratic([[f64; 2]; 2]),
    Cubic([[f64; 2]; 3]),
    Close,
}

/// Returns a font and the number of its units per font size.
fn font(italic: bool) -> Option<(&'static Font, f64)> {
    let font = if italic { &OBLIQUE } else { &UPRIGHT };
    let font = font.as_ref()?;
    Some((font, f64::from(font.units_per_em().max(1))))
}

/// Returns the characters of a text that the fonts lack, each once. They are drawn as boxes.
pub fn missing_glyphs(text: &str) -> Vec<char> {
    let mut missing = vec![];
    for character in text.chars() {
        let run = GlyphRun::shape(&character.to_string(), false);
        if run.glyphs.iter().any(|glyph| glyph.number == 0) && !missing.contains(&character) {
            missing.push(character);
        }
    }
    missing
}

impl GlyphRun {
    /// Selects and positions the glyphs of a text, with kerning and combining accents.
    pub fn shape(text: &str, italic: bool) -> Self {
        let mut run = Self {
            italic,
            ..Self::default()
        };
        let Some((font, units_per_size)) = font(italic) else {
            return run;
        };
        // Right-to-left text may contain left-to-right parts such as numbers and names.
        let bidi = BidiInfo::new(text, None);
        for paragraph in &bidi.paragraphs {
            let (levels, parts) = bidi.visual_runs(paragraph, paragraph.range.clone());
            for part in parts {
                let right_to_left = levels[part.start].is_rtl();
                run.append(&text[part], right_to_left, font, units_per_size);
            }
        }
        run
    }

    /// Appends a part with a single reading direction.
    fn append(&mut self, part: &str, right_to_left: bool, font: &Font, units_per_size: f64) {
        let mut buffer = Buffer::new();
        buffer.push_str(part);
        buffer.set_direction(if right_to_left {
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
                .map(|units| f64::from(units) / units_per_size);
            self.glyphs.push(Glyph {
                number: info.glyph_id,
                at: (self.width + across, up),
            });
            self.width += advance;
        }
    }

    /// Returns the outlines of all glyphs, one after the other.
    pub fn outlines(&self) -> Vec<Segment> {
        let Some((font, units_per_size)) = font(self.italic) else {
            return vec![];
        };
        let glyphs = font.outline_glyphs();
        let (mut outlines, mut path) = (vec![], Vec::new());
        for Glyph { number, at } in &self.glyphs {
            path.clear();
            let drawn = glyphs
                .get(GlyphId::new(*number))
                .map(|outline| outline.draw(&DrawOptions::new(), DrawMemory::Scratch, &mut path));
            if !matches!(drawn, Some(Ok(_))) {
                continue;
            }
            let position = |x: f32, y: f32| {
                [
                    at.0 + f64::from(x) / units_per_size,
                    at.1 + f64::from(y) / units_per_size,
                ]
            };
            outlines.extend(path.iter().map(|element| match *element {
                PathElement::MoveTo { x, y } => Segment::Start(position(x, y)),
                PathElement::LineTo { x, y } => Segment::Line(position(x, y)),
                PathElement::QuadTo { cx0, cy0, x, y } => {
                    Segment::Quadratic([position(cx0, cy0), position(x, y)])
                }
                PathElement::CurveTo {
                    cx0,
                    cy0,
                    cx1,
                    cy1,
                    x,
                    y,
                } => Segment::Cubic([position(cx0, cy0), position(cx1, cy1), position(x, y)]),
                PathElement::Close => Segment::Close,
            }));
        }
        outlines
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fonts_are_available() {
        for italic in [false, true] {
            let (font, units_per_size) = font(italic).unwrap();
            assert!(font.num_glyphs() > 5000 && units_per_size == 2048.0);
        }
    }

    #[test]
    fn shaping_kerns_and_orders_glyphs() {
        let width = |text| GlyphRun::shape(text, false).width;
        assert!((width("aa") - 2.0 * width("a")).abs() < 1e-12);
        assert!(width(" ") > 0.2);
        // DejaVu kerns this pair.
        assert!(width("AV") < width("A") + width("V") - 0.03);
        // Numbers in a right-to-left text keep their direction.
        let numbers = |text| {
            let run = GlyphRun::shape(text, false);
            run.glyphs.iter().map(|g| g.number).collect::<Vec<_>>()
        };
        let (mixed, plain) = (numbers("אב 123"), numbers("123"));
        assert_eq!(mixed[..3], plain[..]);
        assert_eq!(mixed[4..], [numbers("ב"), numbers("א")].concat());
        // A combining accent has no width.
        assert!((width("e\u{301}") - width("e")).abs() < 1e-12);
    }

    #[test]
    fn characters_without_a_glyph_are_reported() {
        assert_eq!(missing_glyphs("Süße, ελιά, мышца, אב, e\u{301} ∂W/∂u"), []);
        assert_eq!(missing_glyphs("腸重積, 腸"), ['腸', '重', '積']);
    }

    #[test]
    fn glyphs_have_outlines() {
        let outlines = GlyphRun::shape("l l", false).outlines();
        let starts = |edge: &&Segment| matches!(edge, Segment::Start(_));
        assert_eq!(outlines.iter().filter(starts).count(), 2);
        // Each l is a vertical bar from the baseline to above the capitals.
        let corners: Vec<[f64; 2]> = outlines
            .iter()
            .filter_map(|edge| match edge {
                Segment::Start(at) | Segment::Line(at) => Some(*at),
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
        assert!(ends(0).1 > GlyphRun::shape("l ", false).width);
    }
}
