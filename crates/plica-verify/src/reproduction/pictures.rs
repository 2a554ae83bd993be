//! Pictures in the style of the paper.

use super::ReproductionError;
use super::runs::CompletedRun;
use plica::measure::{Face, Rotation, Wall};
use plica::study::Row;
use plica_view::draw::{Chart, Curve, Cutaway, Inset, Panel, Stroke};
use plica_view::report::open_tube_surfaces;

/// Width of pictures, in pixels.
const WIDTH: usize = 1000;

/// Returns the tube cut open at a state, for [`tubes`].
pub fn panel(
    ran: &CompletedRun,
    row: &Row,
    label: impl Into<String>,
) -> Result<Panel, ReproductionError> {
    let state = ran.state(row)?;
    let upwards = row.asymmetry_angle_deg.to_radians();
    Ok(Panel {
        label: label.into(),
        surfaces: open_tube_surfaces(ran.tube(), &state.load, &state.u, upwards),
        ..Panel::default()
    })
}

/// Draws tubes cut open, one below the other, coloured by strain energy density.
pub fn tubes(panels: Vec<Panel>) -> Result<Vec<u8>, ReproductionError> {
    let picture = Cutaway {
        panels,
        value_label: "strain energy density *w*/*E*".into(),
        ..Cutaway::default()
    };
    Ok(picture.png(WIDTH)?)
}

/// Position of a small tube in a chart, as fractions of the frame.
pub type Place = (f64, f64);

/// Plots strain energy against Lmax/L, with small tubes at some states.
pub fn energies(
    curves: Vec<Curve>,
    ran: &CompletedRun,
    shown: &[(&Row, Place)],
    vertical_lines: Vec<plica_view::draw::VerticalLine>,
) -> Result<Vec<u8>, ReproductionError> {
    let inset = |&(row, place): &(&Row, Place)| -> Result<Inset, ReproductionError> {
        let Panel { surfaces, .. } = panel(ran, row, "")?;
        Ok(Inset {
            surfaces,
            at: (row.length_ratio, row.energy),
            centre: place,
            width: 0.27,
        })
    };
    let insets: Result<Vec<Inset>, ReproductionError> = shown.iter().map(inset).collect();
    let highest = curves.iter().flat_map(|curve| &curve.points).map(|p| p.1);
    let highest = highest.fold(0.0, f64::max);
    let chart = Chart {
        x_label: "*L*_{max}/*L*".into(),
        y_label: "strain energy *W*/(*E* *D*^{3})".into(),
        curves,
        vertical_lines,
        insets: insets?,
        y_range: Some((0.0, 1.15 * highest)),
        proportion: 0.6,
        width_pt: 480.0,
        ..Chart::default()
    };
    Ok(chart.png(WIDTH)?)
}

/// A wall in a picture of outlines.
pub struct Outline {
    /// The wall.
    pub wall: Wall,
    /// Label in the legend, or empty.
    pub label: String,
    /// Number of its colour.
    pub colour: usize,
    /// Stroke.
    pub stroke: Stroke,
}

/// Draws walls over each other, and centres of rotation.
pub fn outlines(
    outlines: Vec<Outline>,
    centres: &[Rotation],
) -> Result<Vec<u8>, ReproductionError> {
    let curves: Vec<Curve> = outlines
        .into_iter()
        .map(|outline| Curve {
            label: outline.label,
            points: outline.wall.points,
            colour: outline.colour,
            stroke: outline.stroke,
            ..Curve::default()
        })
        .collect();
    let points = || curves.iter().flat_map(|curve| &curve.points);
    let (left, right) = points().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), p| {
        (a.min(p.0), b.max(p.0))
    });
    let lowest = points().map(|p| p.1).fold(0.0, f64::min);
    let highest = points().map(|p| p.1).fold(0.5, f64::max);
    let marker = |rotation: &Rotation| plica_view::draw::Marker {
        at: rotation.centre,
        label: "centre of rotation".into(),
        colour: 0,
    };
    let chart = Chart {
        x_label: "*z*/*D*".into(),
        y_label: "*r*/*D*".into(),
        markers: centres.iter().map(marker).collect(),
        equal_aspect: true,
        x_range: Some((left, right)),
        y_range: Some((lowest, highest + 0.06)),
        width_pt: 480.0,
        curves,
        ..Chart::default()
    };
    Ok(chart.png(WIDTH)?)
}

/// Returns the outer wall at the angle of the largest asymmetry.
pub fn outer(ran: &CompletedRun, row: &Row) -> Result<Wall, ReproductionError> {
    ran.wall(row, Face::Outer, row.asymmetry_angle_deg.to_radians())
}

/// Draws a chart of curves.
pub fn chart(
    x_label: &str,
    y_label: &str,
    curves: Vec<Curve>,
) -> Result<Vec<u8>, ReproductionError> {
    let chart = Chart {
        x_label: x_label.into(),
        y_label: y_label.into(),
        curves,
        width_pt: 400.0,
        ..Chart::default()
    };
    Ok(chart.png(WIDTH)?)
}
