//! Standard pictures of a run.

use super::Field;
use super::labels::{scale_bar, unit};
use super::orientation::upward_angle;
use super::selection::{Abscissa, Selection};
use super::surfaces::{SurfaceOptions, tube_surfaces};
use super::walls::{Wall, walls};
use crate::draw::{Chart, Compression, Curve, Cutaway, DrawError, Marker, Panel, VerticalLine};
use plica::assembly::SplineTube;
use plica::run_directory::{Snapshot, Summary};
use plica::study::findings::Interval;
use plica::study::{Plan, Row, Scale};
use rayon::prelude::*;

/// Width of the pictures in pixels; small, because they are drawn while the user waits.
const WIDTH: usize = 1200;

/// Intervals along the tube and points through the wall of the first sampling of the energy density, which peaks at the faces.
const COARSE: [usize; 2] = [160, 5];

/// Draws a run; returns file names and PNG data. The result is empty for a run without snapshots; a selected state without a
/// snapshot appears only in the energy.
///
/// - `energy.png`: strain energy along the path;
/// - `walls.png`: outer and inner wall at selected states;
/// - `tube.png`: the tube cut open at the same states, coloured by strain energy density.
///
/// # Errors
/// [`DrawError`] if a picture has no finite value.
pub fn pictures(plan: &Plan, summary: &Summary) -> Result<Vec<(String, Vec<u8>)>, DrawError> {
    if summary.snapshots().is_empty() || summary.rows().len() < 2 {
        return Ok(vec![]);
    }
    let rings = plan.mesh.rings(plan.symmetry);
    let tube = SplineTube::new(&plan.tube, &plan.mesh, rings);
    let selection = Selection::of(summary);
    let scale = Scale::of(plan.units.as_ref());
    let state = |row: &&Row| {
        let Snapshot { load, u } = summary.snapshots()[row.step].as_ref()?;
        let label = label(&selection, &scale, row);
        Some(Wall { label, load, u })
    };
    let chosen: Vec<Wall<'_>> = selection.chosen.iter().filter_map(state).collect();
    let upwards = upward_angle(selection.chosen.iter().copied(), &scale);
    let energy = || energy(plan, summary, &selection).png(WIDTH);
    if chosen.is_empty() {
        return Ok(vec![("energy.png".to_owned(), energy()?)]);
    }
    // The tube takes longest; rayon moves idle threads to it.
    let (tube, plots) = rayon::join(
        || cutaway(plan, &tube, &chosen, upwards)?.png_with(WIDTH, Compression::Fast),
        || Ok([energy()?, walls(plan, &tube, &chosen).png(WIDTH)?]),
    );
    let [energy, walls] = plots?;
    let pictures = [
        ("energy.png", energy),
        ("walls.png", walls),
        ("tube.png", tube?),
    ];
    Ok(pictures.map(|(name, png)| (name.to_owned(), png)).into())
}

/// Returns the label of the energy axis.
pub(super) fn energy_label(plan: &Plan) -> String {
    let scale = Scale::of(plan.units.as_ref());
    format!("strain energy *W* ({})", unit(&scale.energy_name))
}

/// Plots the strain energy along the path.
fn energy(plan: &Plan, summary: &Summary, selection: &Selection<'_>) -> Chart {
    let x = |row: &Row| selection.abscissa.of(row);
    let shown = |state: usize| selection.rows.iter().find(|row| row.step == state);
    let findings = summary.findings();
    let minima = findings
        .energy_minima()
        .filter_map(|minimum| shown(minimum.at.state));
    let line = |interval: &Interval, label: &str| {
        Some(VerticalLine {
            at: x(shown(interval.first.state)?),
            label: label.to_owned(),
        })
    };
    let shapes = [
        (findings.square.first(), "square"),
        (findings.overhanging.first(), "overhang"),
    ];
    let shapes = shapes
        .into_iter()
        .filter_map(|(first, label)| line(first?, label));
    // Over the whole path, starts of the stages.
    let is_whole = selection.abscissa == Abscissa::Step;
    let stages = findings.stages.iter().filter(|_| is_whole);
    let stages = stages.filter_map(|stage| {
        Some(VerticalLine {
            at: x(shown(stage.states[0])?),
            label: stage.name.clone(),
        })
    });
    Chart {
        x_label: selection.abscissa.label(&Scale::of(plan.units.as_ref())),
        y_label: energy_label(plan),
        curves: vec![Curve {
            points: selection
                .rows
                .iter()
                .map(|row| (x(row), row.energy))
                .collect(),
            dots: true,
            colour: 1,
            ..Curve::default()
        }],
        markers: minima
            .map(|row| Marker {
                at: (x(row), row.energy),
                label: format!("minimum at {}", selection.abscissa.format(row)),
                colour: 2,
            })
            .collect(),
        vertical_lines: shapes.chain(stages).collect(),
        ..Chart::default()
    }
}

/// Draws the tube cut open at the selected states, with the angle `upwards` pointing up.
fn cutaway(
    plan: &Plan,
    tube: &SplineTube,
    chosen: &[Wall<'_>],
    upwards: f64,
) -> Result<Cutaway, DrawError> {
    let (value_label, factor) = Field::EnergyDensity.label(plan);
    let look = SurfaceOptions {
        factor,
        ..SurfaceOptions::half(tube)
    };
    let panel = |look: &SurfaceOptions, state: &Wall<'_>| Panel {
        label: state.label.clone(),
        surfaces: tube_surfaces(tube, state.load, state.u, upwards, look),
        ..Panel::default()
    };
    let picture = Cutaway {
        title: plan.title.clone(),
        value_label,
        scale_bar: scale_bar(&Scale::of(plan.units.as_ref())),
        ..Cutaway::default()
    };
    let drawn = |look: &SurfaceOptions| Cutaway {
        panels: chosen.par_iter().map(|state| panel(look, state)).collect(),
        ..picture.clone()
    };
    let (fine, range) = look.fine(&drawn(&look.coarse(tube, COARSE)), WIDTH)?;
    Ok(Cutaway {
        range,
        ..drawn(&fine)
    })
}

/// Returns the label of a state.
fn label(selection: &Selection<'_>, scale: &Scale, row: &Row) -> String {
    let (label, value) = (
        selection.abscissa.label(scale),
        selection.abscissa.format(row),
    );
    // The unit follows the number.
    match label.rsplit_once(" (") {
        Some((name, unit)) => format!(
            "{name} = {value} {} ({})",
            unit.trim_end_matches(')'),
            row.shape
        ),
        None => format!("{label} = {value} ({})", row.shape),
    }
}
