//! A page as SVG: lines that are lines, texts that are texts; the one file that names the svg crate.

use super::DrawError;
use super::canvas::{Area, Canvas, Mark, Pen, Place, Rectangle, Stamp};
use super::text::Run;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use svg::node::Text;
use svg::node::element::{self, ClipPath, Element, Group};
use svg::{Document, Node};

/// Fonts of texts: they are placed as in the first, and fitted to its widths where it is not there.
const FONTS: &str = "DejaVu Sans, Verdana, Helvetica, Arial, sans-serif";

impl Canvas {
    /// The page as lines and texts, in points; pictures laid over it multiply with what is beneath, so that their white is
    /// transparent here too.
    pub fn finish_svg(self) -> Result<String, DrawError> {
        let (width, height) = self.size;
        let mut page = Document::new()
            .set("width", format!("{width:.2}pt"))
            .set("height", format!("{height:.2}pt"))
            .set("viewBox", format!("0 0 {width:.2} {height:.2}"))
            .set("font-family", FONTS)
            .set("xml:space", "preserve")
            .set("style", "white-space:pre");
        let paper = element::Rectangle::new().set("fill", "#ffffff");
        page.append(paper.set("width", "100%").set("height", "100%"));
        // What is drawn between two clips is a group.
        let mut group = Group::new();
        for mark in &self.marks {
            match mark {
                Mark::Line { places, pen } => group.append(line(places, *pen)),
                Mark::Area { area, colour } => {
                    let mut area = filled(area);
                    area.assign("fill", ink(*colour));
                    group.append(area);
                }
                Mark::Text {
                    runs,
                    start,
                    upward,
                    colour,
                } => group.append(text(runs, *start, *upward).set("fill", ink(*colour))),
                Mark::Clip(within) => {
                    page.append(std::mem::replace(&mut group, Group::new()));
                    if let Some(within) = within {
                        // Of several charts in one document, equal names are equal rectangles.
                        let (x, y) = within.corner;
                        let id = [x, y, within.width, within.height].map(length).join("-");
                        let id = format!("clip-{id}");
                        group = group.set("clip-path", format!("url(#{id})"));
                        page.append(ClipPath::new().set("id", id).add(rectangle(within)));
                    }
                }
            }
        }
        page.append(group);
        for stamp in &self.stamps {
            page.append(picture(stamp, self.pixels_per_point())?);
        }
        Ok(format!("{page}\n"))
    }
}

/// A length to a hundredth of a point: finer than any printer.
fn length(points: f64) -> String {
    let text = format!("{points:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn ink([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// A path through places.
fn through(places: &[Place]) -> String {
    let mut path = String::new();
    for (i, (x, y)) in places.iter().enumerate() {
        let word = if i == 0 { "M" } else { " L" };
        path += &format!("{word}{} {}", length(*x), length(*y));
    }
    path
}

fn line(places: &[Place], pen: Pen) -> Element {
    let mut line = Element::new("path");
    line.assign("d", through(places));
    line.assign("fill", "none");
    line.assign("stroke", ink(pen.colour));
    line.assign("stroke-width", length(pen.width));
    line.assign("stroke-linejoin", "round");
    if pen.dash.0 > 0.0 && pen.dash.1 > 0.0 {
        line.assign(
            "stroke-dasharray",
            format!("{},{}", length(pen.dash.0), length(pen.dash.1)),
        );
    }
    line
}

fn filled(area: &Area) -> Element {
    match area {
        Area::Disc {
            middle: (x, y),
            radius,
        } => {
            let disc = element::Circle::new().set("r", length(*radius));
            disc.set("cx", length(*x)).set("cy", length(*y)).into()
        }
        Area::Rectangle(area) => rectangle(area).into(),
        Area::Polygon(corners) => element::Path::new().set("d", through(corners) + "Z").into(),
    }
}

fn rectangle(area: &Rectangle) -> element::Rectangle {
    let (x, y) = area.corner;
    element::Rectangle::new()
        .set("x", length(x))
        .set("y", length(y))
        .set("width", length(area.width))
        .set("height", length(area.height))
}

/// A label's runs, each at its own place and as wide as it is set.
fn text(runs: &[Run], (x, y): Place, upward: bool) -> Group {
    let turn = if upward { " rotate(-90)" } else { "" };
    let mut label = Group::new().set(
        "transform",
        format!("translate({},{}){turn}", length(x), length(y)),
    );
    for run in runs {
        let mut text = Element::new("text");
        text.assign("x", length(run.at.0));
        text.assign("y", length(run.at.1));
        text.assign("font-size", length(run.size));
        if run.width() > 0.0 {
            text.assign("textLength", length(run.width()));
            text.assign("lengthAdjust", "spacingAndGlyphs");
        }
        if run.italic {
            text.assign("font-style", "italic");
        }
        text.append(Text::new(kept(&run.text)));
        label.append(text);
    }
    label
}

/// A text whose spaces at its ends count everywhere: as such that do not break.
fn kept(text: &str) -> String {
    let inner = text.trim_matches(' ');
    let before = text.len() - text.trim_start_matches(' ').len();
    let after = text.len() - before - inner.len();
    let hard = |count: usize| "\u{a0}".repeat(count);
    hard(before) + inner + &hard(after)
}

fn picture(stamp: &Stamp, per_point: f64) -> Result<element::Image, DrawError> {
    let points = |pixels: f64| format!("{:.4}", pixels / per_point);
    let [x, y] = stamp.at.map(|v| points(v as f64));
    let png = STANDARD.encode(stamp.picture.to_png(1.0, super::Packing::Small)?);
    Ok(element::Image::new()
        .set("x", x)
        .set("y", y)
        .set("width", points(stamp.picture.width as f64))
        .set("height", points(stamp.picture.height as f64))
        .set("style", "mix-blend-mode:multiply")
        .set("href", format!("data:image/png;base64,{png}")))
}

#[cfg(test)]
mod tests {
    use super::kept;

    #[test]
    fn spaces_at_the_ends_are_kept() {
        assert_eq!(kept(" a b  "), "\u{a0}a b\u{a0}\u{a0}");
        assert_eq!(kept("  "), "\u{a0}\u{a0}");
        assert_eq!(kept(""), "");
    }
}
