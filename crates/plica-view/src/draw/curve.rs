//! The data of a chart: curves, markers and vertical lines.

use super::canvas::Pen;
use super::colour::{line_colour, mix};

/// Stroke of a curve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Stroke {
    /// A solid line.
    #[default]
    Solid,
    /// A thinner and paler line of the same colour, for the inner wall beside the outer one.
    Thin,
    /// A dashed line.
    Dashed,
}

/// A polyline through points in the given order; a point that is not finite interrupts it.
#[derive(Clone, Debug, Default)]
pub struct Curve {
    /// Name in the legend; a curve with an empty label is not listed.
    pub label: String,
    /// Points (x, y) in data units.
    pub points: Vec<(f64, f64)>,
    /// Number of the line colour, see [`line_colour`]: 0 is black.
    pub colour: usize,
    /// Stroke of the line.
    pub stroke: Stroke,
    /// Draws a dot at each point.
    pub dots: bool,
}

impl Curve {
    pub(super) fn pen(&self) -> Pen {
        let colour = line_colour(self.colour);
        match self.stroke {
            Stroke::Solid => Pen::new(colour, if self.dots { 1.1 } else { 1.5 }),
            Stroke::Thin => Pen::new(mix(colour, [255; 3], 0.3), 0.8),
            Stroke::Dashed => Pen {
                colour,
                width: 1.2,
                dash: (4.5, 2.5),
            },
        }
    }
}

/// A dot with a label, placed beside it where it covers the fewest lines.
#[derive(Clone, Debug, Default)]
pub struct Marker {
    /// Position (x, y) in data units.
    pub at: (f64, f64),
    /// Text beside the dot.
    pub label: String,
    /// Number of the line colour.
    pub colour: usize,
}

/// A vertical line across a chart with a label above the frame.
#[derive(Clone, Debug, Default)]
pub struct VerticalLine {
    /// Position along x, in data units.
    pub at: f64,
    /// Text above the frame.
    pub label: String,
}
