//! Pictures of the lowest modes of a three-dimensional run.

use crate::draw::{
    Chart, ColourMap, Curve, Cutaway, DrawError, Opening, Panel, REAR_HALF, Range, Stroke, Surface,
};
use plica::assembly::{Point, SplineTube};
use plica::stability::{Eigenvalue, Spectra, Spectrum, StateWithModes};
use plica::study::Plan;
use plica::tube::Tube;

/// Width of the pictures in pixels.
const WIDTH: usize = 1800;
/// Amplitude of the drawn modes, in units of D.
const MODE_AMPLITUDE: f64 = 0.08;
/// Maximum number of modes drawn.
const MAX_MODES: usize = 3;

/// Draws the lowest eigenpairs; returns file names and PNG data.
///
/// - `stability.png`: the lowest eigenvalues of every state, if there are several states;
/// - `mode.png`: a state, and the tube displaced by each of its lowest modes.
///
/// # Errors
/// [`DrawError`] if there is nothing to draw.
pub fn mode_pictures(plan: &Plan, found: &Spectra) -> Result<Vec<(String, Vec<u8>)>, DrawError> {
    let mut pictures = vec![];
    if found.states.len() > 1 {
        let chart = eigenvalues(&found.states).png(WIDTH)?;
        pictures.push(("stability.png".to_owned(), chart));
    }
    if let Some(shown) = &found.shown {
        let cutaway = modes(plan, &found.states[shown.index], shown);
        pictures.push(("mode.png".to_owned(), cutaway.png(WIDTH)?));
    }
    Ok(pictures)
}

/// Plots the lowest eigenvalues of all states.
fn eigenvalues(states: &[Spectrum]) -> Chart {
    let x = |state: &Spectrum| state.row as f64;
    let (first, last) = (x(&states[0]), x(&states[states.len() - 1]));
    let mut curves = vec![Curve {
        points: vec![(first, 0.0), (last, 0.0)],
        stroke: Stroke::Thin,
        ..Curve::default()
    }];
    let count = states.iter().map(|state| state.lowest.len()).max();
    for number in 0..count.unwrap_or(0) {
        let at = |state: &Spectrum| Some((x(state), state.lowest.get(number)?.value));
        curves.push(Curve {
            label: format!("mode {}", number + 1),
            points: states.iter().filter_map(at).collect(),
            dots: true,
            colour: number + 1,
            ..Curve::default()
        });
    }
    Chart {
        x_label: "state".into(),
        y_label: "lowest eigenvalues *ν* (*E*/*D*^{2})".into(),
        curves,
        ..Chart::default()
    }
}

/// Draws the state, and the tube displaced by each mode.
fn modes(plan: &Plan, spectrum: &Spectrum, shown: &StateWithModes) -> Cutaway {
    let rings = plan.mesh.rings(plan.symmetry);
    let tube = SplineTube::new(&plan.tube, &plan.mesh, rings);
    let panel = |(number, (shape, eigenvalue)): (usize, (&Vec<f64>, &Eigenvalue))| Panel {
        label: format!(
            "mode {number}, *ν* = {:.2e} *E*/*D*^{{2}}, circumferential modes {} (drawn with amplitude {MODE_AMPLITUDE} *D*)",
            eigenvalue.value,
            eigenvalue.content()
        ),
        surfaces: surfaces(&tube, shown, Some(shape)),
        ..Panel::default()
    };
    let numbered = (1..).zip(shown.shapes.iter().zip(&spectrum.lowest));
    let state = Panel {
        label: format!(
            "state {}, *L*_{{max}}/*L* = {:.4}, *D*_{{min}}/*D* = {:.4}",
            spectrum.row,
            plan.tube.length_ratio(&spectrum.load),
            plan.tube.diameter_ratio(&spectrum.load)
        ),
        surfaces: surfaces(&tube, shown, None),
        ..Panel::default()
    };
    Cutaway {
        title: plan.title.clone(),
        panels: std::iter::once(state)
            .chain(numbered.take(MAX_MODES).map(panel))
            .collect(),
        value_label: "radial displacement of the mode".into(),
        range: Range::Given(-1.0, 1.0),
        ends: plan.end_names.clone(),
        map: ColourMap::Diverging,
        ..Cutaway::default()
    }
}

/// Returns the surfaces of the tube without its near half, displaced by a mode and coloured by the radial displacement
/// divided by the largest displacement.
fn surfaces(tube: &SplineTube, shown: &StateWithModes, shape: Option<&Vec<f64>>) -> Vec<Surface> {
    let along = tube.axial.elements();
    let opening = Opening::uniform(REAR_HALF, [2 * along + 1, 97, 9]);
    let moved = |u: &[f64], at: Point| {
        let sample = tube.sample(&shown.state.load, u, at);
        let displacement = [0, 1, 2].map(|i| sample.position[i] - sample.reference[i]);
        (sample.position, displacement)
    };
    let mut largest = 0.0_f64;
    if let Some(shape) = shape {
        for z in tube.axial.greville() {
            for ring in 0..tube.sector.rings {
                let (radius, angle) = (Tube::OUTER_RADIUS, tube.sector.ring_angle(ring));
                let (_, d) = moved(shape, Point { z, radius, angle });
                largest = largest.max(d[0].hypot(d[1]).hypot(d[2]));
            }
        }
    }
    opening.surfaces(|zeta, angle, xi| {
        let at = Point {
            z: tube.axial.position(zeta * along as f64),
            radius: tube.tube.inner_radius() + xi * tube.tube.thickness,
            angle,
        };
        let ([mut z, mut x, mut y], _) = moved(&shown.state.u, at);
        let mut value = 0.0;
        if let Some(shape) = shape {
            let (_, [dz, dx, dy]) = moved(shape, at);
            let scale = MODE_AMPLITUDE / largest;
            (z, x, y) = (z + scale * dz, x + scale * dx, y + scale * dy);
            let (sin, cos) = angle.sin_cos();
            value = ((dx * cos + dy * sin) / largest).clamp(-1.0, 1.0);
        }
        ([x, y, z], value)
    })
}
