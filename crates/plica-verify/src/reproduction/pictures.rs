//! Pictures in the manner of the paper's.

use super::Trouble;
use super::runs::Ran;
use plica::measure::{Face, Rotation, Wall};
use plica::study::Row;
use plica_view::draw::{Chart, Curve, Cutaway, Inset, Panel, Stroke};
use plica_view::report::open_tube_surfaces;

/// Width of pictures, in pixels.
const WIDTH: usize = 1000;

/// A tube cut open at a state, for a [`tubes`] picture.
pub fn panel(ran: &Ran, row: &Row, label: impl Into<String>) -> Result<Panel, Trouble> {
    let state = ran.state(row)?;
    let upwards = row.asymmetry_angle_deg.to_radians();
    Ok(Panel {
        label: label.into(),
        surfaces: open_tube_surfaces(ran.tube(), &state.load, &state.u, upwards),
        ..Panel::default()
    })
}

/// Tubes cut open, one below the other, coloured by strain energy density.
pub fn tubes(panels: Vec<Panel>) -> Result<Vec<u8>, Trouble> {
    let picture = Cutaway {
        panels,
        value_label: "strain energy density *w*/*E*".into(),
        ..Cutaway::default()
    };
    Ok(picture.png(WIDTH)?)
}

/// Where small tubes stand in a chart of energies: parts of the frame.
pub type Shown = (f64, f64);

/// Strain energy against Lmax/L, with small tubes at states.
pub fn energies(
    curves: Vec<Curve>,
    ran: &Ran,
    shown: &[(&Row, Shown)],
    rules: Vec<plica_view::draw::VerticalLine>,
) -> Result<Vec<u8>, Trouble> {
    let inset = |&(row, shown): &(&Row, Shown)| -> Result<Inset, Trouble> {
        let Panel { surfaces, .. } = panel(ran, row, "")?;
        Ok(Inset {
            surfaces,
            at: (row.length_ratio, row.energy),
            centre: shown,
            width: 0.27,
        })
    };
    let insets: Result<Vec<Inset>, Trouble> = shown.iter().map(inset).collect();
    let highest = curves.iter().flat_map(|curve| &curve.points).map(|p| p.1);
    let highest = highest.fold(0.0, f64::max);
    let chart = Chart {
        x_label: "*L*_{max}/*L*".into(),
        y_label: "strain energy *W*/(*E* *D*^{3})".into(),
        curves,
        vertical_lines: rules,
        insets: insets?,
        y_range: Some((0.0, 1.15 * highest)),
        proportion: 0.6,
        width_pt: 480.0,
        ..Chart::default()
    };
    Ok(chart.png(WIDTH)?)
}

/// A line of an outline: the wall, its name, a colour.
pub struct Outline {
    /// The wall.
    pub wall: Wall,
    /// What it is called; nothing for a wall that goes with the one before.
    pub label: String,
    /// Number of its colour.
    pub colour: usize,
    /// How it is stroked.
    pub stroke: Stroke,
}

/// Outer walls over each other, and centres of rotation.
pub fn outlines(outlines: Vec<Outline>, centres: &[Rotation]) -> Result<Vec<u8>, Trouble> {
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

/// The outer wall of an axisymmetric state; of another, that at its crest.
pub fn outer(ran: &Ran, row: &Row) -> Result<Wall, Trouble> {
    ran.wall(row, Face::Outer, row.asymmetry_angle_deg.to_radians())
}

/// A chart of curves, for what has no likeness in the paper.
pub fn chart(x_label: &str, y_label: &str, curves: Vec<Curve>) -> Result<Vec<u8>, Trouble> {
    let chart = Chart {
        x_label: x_label.into(),
        y_label: y_label.into(),
        curves,
        width_pt: 400.0,
        ..Chart::default()
    };
    Ok(chart.png(WIDTH)?)
}
