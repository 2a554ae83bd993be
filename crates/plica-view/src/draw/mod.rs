//! Pictures of tubes for print: charts and shaded cutaways, as PNG or SVG.
//!
//! A [`Chart`] shows curves against axes, a [`Cutaway`] shows tubes cut open and coloured by a field, and [`animation`]
//! turns images into an animated PNG. All of them are plain data; nothing here reads files or depends on a model.
//! Lengths on a page are points (1/72 inch), and text is 8 and 9 points in size.
//!
//! | files | content |
//! |---|---|
//! | `chart`, `curve`, `frame`, `annotations`, `inset` | charts: data, axes, legend and markers, small tubes |
//! | `cutaway`, `colour_bar` | tubes above a colour bar |
//! | `opening`, `surface` | surfaces of a tube cut open along its axis |
//! | `range`, `colour`, `ticks` | colour ranges, colour maps, round numbers |
//! | `view`, `render` | projection; rendering of surfaces in strips |
//! | `scene`, `depth_buffer`, `resolve` | triangles; nearest triangle per sample; samples to pixels |
//! | `light`, `interpolate`, `vec3` | illumination; its interpolation over triangles; vectors |
//! | `label`, `text`, `glyphs` | markup of labels; their layout; glyphs of the fonts |
//! | `canvas`, `rasterise`, `svg` | a page of primitives; its pixels; its SVG file |
//! | `image`, `animation` | pixels and PNG files; animated PNG files |
//!
//! ```
//! # use plica_view::draw::{Chart, Curve};
//! let chart = Chart {
//!     x_label: "*L*_{max}/*L*".into(),
//!     y_label: "*W*/(*E* *D*^{3})".into(),
//!     curves: vec![Curve { points: vec![(1.0, 3.0e-3), (1.13, 6.7e-4)], dots: true, ..Curve::default() }],
//!     ..Chart::default()
//! };
//! assert!(chart.png(900).is_ok());
//! ```

mod animation;
mod annotations;
mod canvas;
mod chart;
mod colour;
mod colour_bar;
mod curve;
mod cutaway;
mod depth_buffer;
mod frame;
mod glyphs;
mod image;
mod inset;
mod interpolate;
pub(crate) mod label;
mod light;
mod opening;
mod range;
mod rasterise;
mod render;
mod resolve;
mod scene;
mod surface;
mod svg;
mod text;
mod ticks;
pub(crate) mod vec3;
mod view;

pub use animation::{LAST_FRAME_FACTOR, animation};
pub use chart::Chart;
pub use colour::{ColourMap, line_colour};
pub use curve::{Curve, Marker, Stroke, VerticalLine};
pub use cutaway::{Cutaway, Panel};
pub use glyphs::missing_glyphs;
pub use image::{Compression, Image};
pub use inset::Inset;
pub(crate) use opening::linspace;
pub use opening::{Opening, REAR_HALF};
pub use range::{Range, ResolvedRange, Spread};
pub use surface::{Sides, Surface};
pub(crate) use ticks::format_number;

/// Errors of drawing.
#[derive(Debug, thiserror::Error)]
pub enum DrawError {
    /// A picture without a finite number.
    #[error("nothing to draw: the {what} has no finite value")]
    Empty {
        /// Kind of the picture.
        what: &'static str,
    },
    /// A surface with lists that do not match its grid.
    #[error("a surface of {columns} x {rows} needs {} points and values, not {points} and {values}", columns * rows)]
    Grid {
        /// Points along a row.
        columns: usize,
        /// Number of rows.
        rows: usize,
        /// Length of the list of points.
        points: usize,
        /// Length of the list of values.
        values: usize,
    },
    /// A range that is empty, reversed or not finite.
    #[error(
        "range {low} to {high}: both ends must be finite and the first smaller than the second"
    )]
    Range {
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
    },
    /// A picture too small or too large to draw.
    #[error(
        "picture of {width:.0} x {height:.0} pixels: width and height must be between {} and {}",
        image::MIN_SIDE,
        image::MAX_SIDE
    )]
    Size {
        /// Width in pixels.
        width: f64,
        /// Height in pixels.
        height: f64,
    },
    /// More triangles than the renderer supports.
    #[error("surfaces of {triangles} triangles: too many to render")]
    Triangles {
        /// Number of triangles.
        triangles: usize,
    },
    /// An error of a drawing library.
    #[error("drawing failed: {0}")]
    Backend(String),
}
