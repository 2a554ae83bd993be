//! Pictures of tubes for print: charts, wall profiles and shaded cut-aways, as PNG bytes.
//!
//! | file | what it draws |
//! |---|---|
//! | [`chart`] | curves against axes: energy paths, wall profiles |
//! | [`cutaway`] | opened tubes, coloured by a field, over one colour bar |
//! | `frame`, `notes` | a chart's frame; its legend, rules and markers |
//! | [`inset`] | small tubes inside a chart |
//! | [`Range`] | which values the colours of a field span |
//! | `colour_bar` | the bar beneath the cut-aways |
//! | [`section`] | the surfaces of a tube cut open along its axis, from any wall mapping |
//! | [`Surface`] | a grid of points that carries a field |
//! | [`raster`] | shaded surfaces on a page, strip by strip |
//! | `scene`, `samples` | their triangles; which of them lies before the others, sample by sample |
//! | `pixels` | the pixels that samples make, and the line at edges |
//! | `light`, `lit` | how bright a point of a surface is; how bright a sample |
//! | [`colour`] | two even maps for fields, Okabe and Ito's palette for lines |
//! | `ticks` | round numbers for axes |
//! | [`label`] | `*z*/*D*`, `*L*_{max}`, `10^{−3}`; the same as HTML and as plain text |
//! | `canvas` | a page measured in points, and the marks on it |
//! | `text`, `letters` | a label set in runs; their glyphs, from the fonts that come along |
//! | `paint`, `vector` | a page as pixels, and as SVG |
//! | [`image`] | pixels, and PNG in and out |
//! | `animation` | pictures that follow each other |
//!
//! Every picture is plain data with a `png(width_px)` method; nothing here reads a file, prints, or knows a model.
//! Lengths on a page are points (1/72 inch), so that texts of 8 and 9 points come out as such in a journal's column.
//!
//! ```
//! # use plica::draw::{Chart, Curve};
//! let chart = Chart {
//!     x_label: "*L*_{max}/*L*".into(),
//!     y_label: "*W*/(*E* *D*^{3})".into(),
//!     curves: vec![Curve { points: vec![(1.0, 3.0e-3), (1.13, 6.7e-4)], dots: true, ..Curve::default() }],
//!     ..Chart::default()
//! };
//! assert!(chart.png(900).is_ok());
//! ```

mod animation;
mod canvas;
pub mod chart;
pub mod colour;
mod colour_bar;
pub mod cutaway;
mod frame;
pub mod image;
pub mod inset;
pub mod label;
mod letters;
mod light;
mod lit;
mod notes;
mod paint;
mod pixels;
mod range;
pub mod raster;
mod samples;
mod scene;
pub mod section;
mod surface;
mod text;
mod ticks;
mod vector;

pub use animation::{REST, animation};
pub use chart::{Chart, Curve, Marker, Rule, Stroke};
pub use colour::Map;
pub use cutaway::{Cutaway, Panel};
pub use image::{Image, Packing};
pub use inset::Inset;
pub use letters::boxes;
pub use range::{Range, Spanned};
pub use section::{HALF, Opening, evenly};
pub use surface::{Sides, Surface};
pub use ticks::short;

/// Why a picture could not be drawn.
#[derive(Debug, thiserror::Error)]
pub enum DrawError {
    /// There is no finite number to draw.
    #[error("nothing to draw: {what} holds no finite value")]
    Empty {
        /// The part of the picture that is empty.
        what: &'static str,
    },
    /// A surface's lists do not fill its grid.
    #[error("surface of {columns} x {rows} needs {} points and values: got {points} and {values}", columns * rows)]
    Grid {
        /// Points along a row.
        columns: usize,
        /// Number of rows.
        rows: usize,
        /// Points given.
        points: usize,
        /// Values given.
        values: usize,
    },
    /// A range that is empty, reversed or not finite.
    #[error("range {low} to {high}: both ends must be finite, the first below the second")]
    Range {
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
    },
    /// A picture too small or too large to draw.
    #[error(
        "picture of {width:.0} x {height:.0} pixels: both sides must lie between {} and {}",
        image::MIN_SIDE,
        image::MAX_SIDE
    )]
    Size {
        /// Width in pixels.
        width: f64,
        /// Height in pixels.
        height: f64,
    },
    /// More triangles than can be told apart.
    #[error("surfaces of {triangles} triangles, more than can be told apart")]
    Triangles {
        /// How many there are.
        triangles: usize,
    },
    /// The drawing library refused.
    #[error("drawing failed: {0}")]
    Backend(String),
}
