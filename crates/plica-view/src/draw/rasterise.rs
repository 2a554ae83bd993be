//! Rasterisation of a page. This is the only file that uses tiny-skia.

use super::canvas::{Area, Canvas, Position, Primitive, Rectangle};
use super::glyphs::Segment;
use super::{DrawError, Image};
use tiny_skia::{
    Color, FillRule, LineJoin, Mask, Paint, Path, PathBuilder, Pixmap, Rect, Stroke, StrokeDash,
    Transform,
};

impl Canvas {
    /// Returns the page as pixels.
    pub fn rasterise(self) -> Result<Image, DrawError> {
        let [width, height] = self.pixels.map(|side| side as u32);
        let too_large = || DrawError::Backend(format!("no page of {width} x {height} pixels"));
        let mut page = Pixmap::new(width, height).ok_or_else(too_large)?;
        page.fill(Color::WHITE);
        let zoom = self.pixels_per_point() as f32;
        let on_page = Transform::from_scale(zoom, zoom);
        let mut clip: Option<Mask> = None;
        for primitive in &self.primitives {
            match primitive {
                Primitive::Line { points, pen } => {
                    let stroke = Stroke {
                        width: pen.width as f32,
                        line_join: LineJoin::Round,
                        dash: StrokeDash::new(vec![pen.dash.0 as f32, pen.dash.1 as f32], 0.0),
                        ..Stroke::default()
                    };
                    if let Some(path) = path_through(points, false) {
                        page.stroke_path(&path, &ink(pen.colour), &stroke, on_page, clip.as_ref());
                    }
                }
                Primitive::Area { area, colour } => {
                    let path = match area {
                        Area::Disc {
                            middle: (x, y),
                            radius,
                        } => PathBuilder::from_circle(*x as f32, *y as f32, *radius as f32),
                        Area::Rectangle(rectangle) => path_of(rectangle),
                        Area::Polygon(corners) => path_through(corners, true),
                    };
                    if let Some(path) = path {
                        page.fill_path(
                            &path,
                            &ink(*colour),
                            FillRule::Winding,
                            on_page,
                            clip.as_ref(),
                        );
                    }
                }
                Primitive::Text {
                    runs,
                    start,
                    upward,
                    colour,
                } => {
                    let mut path = PathBuilder::new();
                    for run in runs {
                        let at = |[x, y]: [f64; 2]| {
                            (
                                (run.at.0 + x * run.size) as f32,
                                (run.at.1 - y * run.size) as f32,
                            )
                        };
                        add_outlines(&mut path, &run.glyphs.outlines(), at);
                    }
                    let (x, y) = (start.0 as f32, start.1 as f32);
                    let turn = if *upward { -90.0 } else { 0.0 };
                    let placed = on_page.pre_translate(x, y).pre_rotate(turn);
                    if let Some(path) = path.finish() {
                        page.fill_path(
                            &path,
                            &ink(*colour),
                            FillRule::Winding,
                            placed,
                            clip.as_ref(),
                        );
                    }
                }
                Primitive::Clip(within) => {
                    clip = None;
                    if let Some(within) = within {
                        // An invalid rectangle clips everything.
                        let mut mask = Mask::new(width, height).ok_or_else(too_large)?;
                        if let Some(path) = path_of(within) {
                            mask.fill_path(&path, FillRule::Winding, true, on_page);
                        }
                        clip = Some(mask);
                    }
                }
            }
        }
        let pixels = page.data().chunks_exact(4);
        let mut image = Image {
            width: self.pixels[0],
            height: self.pixels[1],
            pixels: pixels.map(|p| [p[0], p[1], p[2]]).collect(),
        };
        for overlay in &self.overlays {
            image.multiply(&overlay.image, overlay.at[0], overlay.at[1]);
        }
        Ok(image)
    }
}

fn ink([r, g, b]: [u8; 3]) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color_rgba8(r, g, b, 255);
    paint
}

/// Returns the path through the given positions, or `None` for fewer than two.
fn path_through(points: &[Position], close: bool) -> Option<Path> {
    let mut path = PathBuilder::with_capacity(points.len() + 1, points.len());
    for (i, (x, y)) in points.iter().enumerate() {
        let (x, y) = (*x as f32, *y as f32);
        if i == 0 {
            path.move_to(x, y);
        } else {
            path.line_to(x, y);
        }
    }
    if close {
        path.close();
    }
    path.finish()
}

fn path_of(rectangle: &Rectangle) -> Option<Path> {
    let (x, y) = rectangle.corner;
    let [x, y, width, height] = [x, y, rectangle.width, rectangle.height].map(|v| v as f32);
    Rect::from_xywh(x, y, width, height).map(PathBuilder::from_rect)
}

/// Adds the outlines of glyphs to a path.
fn add_outlines(path: &mut PathBuilder, outlines: &[Segment], at: impl Fn([f64; 2]) -> (f32, f32)) {
    for segment in outlines {
        match *segment {
            Segment::Start(p) => {
                let (x, y) = at(p);
                path.move_to(x, y);
            }
            Segment::Line(p) => {
                let (x, y) = at(p);
                path.line_to(x, y);
            }
            Segment::Quadratic(points) => {
                let [(x1, y1), (x, y)] = points.map(&at);
                path.quad_to(x1, y1, x, y);
            }
            Segment::Cubic(points) => {
                let [(x1, y1), (x2, y2), (x, y)] = points.map(&at);
                path.cubic_to(x1, y1, x2, y2, x, y);
            }
            Segment::Close => path.close(),
        }
    }
}
