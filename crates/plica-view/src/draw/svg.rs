//! SVG output of a page, in which text stays text. This is the only file that uses the svg crate.

use super::DrawError;
use super::canvas::{Area, Canvas, Overlay, Pen, Position, Primitive, Rectangle};
use super::text::Run;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use svg::node::Text;
use svg::node::element::{self, ClipPath, Element, Group};
use svg::{Document, Node};

/// Font families. Text is laid out for the first one and stretched to its widths where another one is used.
const FONTS: &str = "DejaVu Sans, Verdana, Helvetica, Arial, sans-serif";

impl Canvas {
    /// Returns the page as an SVG file with lengths in points. Overlays are multiplied with the primitives below, which makes
    /// their white transparent as in the rasterised page.
    pub fn to_svg(&self) -> Result<String, DrawError> {
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
        // The primitives between two clips form a group.
        let mut group = Group::new();
        for primitive in &self.primitives {
            match primitive {
                Primitive::Line { points, pen } => group.append(line(points, *pen)),
                Primitive::Area { area, colour } => {
                    let mut area = filled(area);
                    area.assign("fill", ink(*colour));
                    group.append(area);
                }
                Primitive::Text {
                    runs,
                    start,
                    upward,
                    colour,
                } => group.append(text(runs, *start, *upward).set("fill", ink(*colour))),
                Primitive::Clip(within) => {
                    page.append(std::mem::replace(&mut group, Group::new()));
                    if let Some(within) = within {
                        // The name contains the rectangle, so it is unique even with several charts in one document.
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
        for overlay in &self.overlays {
            page.append(embedded(overlay, self.pixels_per_point())?);
        }
        Ok(format!("{page}\n"))
    }
}

/// Formats a length to a hundredth of a point.
fn length(points: f64) -> String {
    let text = format!("{points:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn ink([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Returns the path data of a polyline.
fn path_data(points: &[Position]) -> String {
    let mut path = String::new();
    for (i, (x, y)) in points.iter().enumerate() {
        let command = if i == 0 { "M" } else { " L" };
        path += &format!("{command}{} {}", length(*x), length(*y));
    }
    path
}

fn line(points: &[Position], pen: Pen) -> Element {
    let mut line = Element::new("path");
    line.assign("d", path_data(points));
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
        Area::Polygon(corners) => element::Path::new()
            .set("d", path_data(corners) + "Z")
            .into(),
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

/// Returns the runs of a label, each at its own position and with its own width.
fn text(runs: &[Run], (x, y): Position, upward: bool) -> Group {
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
        text.append(Text::new(hard_spaces(&run.text)));
        label.append(text);
    }
    label
}

/// Replaces leading and trailing spaces by non-breaking ones, which every viewer preserves.
fn hard_spaces(text: &str) -> String {
    let inner = text.trim_matches(' ');
    let before = text.len() - text.trim_start_matches(' ').len();
    let after = text.len() - before - inner.len();
    let hard = |count: usize| "\u{a0}".repeat(count);
    hard(before) + inner + &hard(after)
}

fn embedded(overlay: &Overlay, per_point: f64) -> Result<element::Image, DrawError> {
    let points = |pixels: f64| format!("{:.4}", pixels / per_point);
    let [x, y] = overlay.at.map(|v| points(v as f64));
    let png = STANDARD.encode(overlay.image.to_png(1.0, super::Compression::Small)?);
    Ok(element::Image::new()
        .set("x", x)
        .set("y", y)
        .set("width", points(overlay.image.width as f64))
        .set("height", points(overlay.image.height as f64))
        .set("style", "mix-blend-mode:multiply")
        .set("href", format!("data:image/png;base64,{png}")))
}

#[cfg(test)]
mod tests {
    use super::hard_spaces;

    #[test]
    fn leading_and_trailing_spaces_become_non_breaking() {
        assert_eq!(hard_spaces(" a b  "), "\u{a0}a b\u{a0}\u{a0}");
        assert_eq!(hard_spaces("  "), "\u{a0}\u{a0}");
        assert_eq!(hard_spaces(""), "");
    }
}
