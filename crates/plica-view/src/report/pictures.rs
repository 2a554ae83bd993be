//! The pictures of a run.

use super::columns::{bar, unit};
use super::opened::{Look, looked_at};
use super::upright::upright;
use super::walls::{Wall, walls};
use super::{Field, Story};
use crate::draw::{Chart, Compression, Curve, Cutaway, DrawError, Marker, Panel, VerticalLine};
use plica::assembly::SplineTube;
use plica::measure::Shape;
use plica::run_directory::{Snapshot, Summary};
use plica::study::{Plan, Row, Scale};
use rayon::prelude::*;

/// Width of the pictures of a run, in pixels: a first look, for which somebody waits.
const WIDTH: usize = 1200;

/// Pieces along and points through the wall at which its energy is looked at first: it peaks at the faces.
const COARSE: [usize; 2] = [160, 5];

/// Draws a run: names of files and their PNG bytes. Nothing if the run kept no snapshots; of a chosen state without one no more
/// than its energy.
///
/// - `energy.png`: strain energy along the path;
/// - `walls.png`: outer and inner wall at chosen states;
/// - `tube.png`: the tube cut open at the same states, coloured by strain energy density.
pub fn pictures(plan: &Plan, summary: &Summary) -> Result<Vec<(String, Vec<u8>)>, DrawError> {
    if summary.snapshots().is_empty() || summary.rows().len() < 2 {
        return Ok(vec![]);
    }
    let rings = plan.mesh.rings(plan.symmetry);
    let tube = SplineTube::new(&plan.tube, &plan.mesh, rings);
    let story = Story::of(summary);
    let scale = Scale::of(plan.units.as_ref());
    let state = |row: &&Row| {
        let Snapshot { load, u } = summary.snapshots()[row.step].as_ref()?;
        let label = label(&story, &scale, row);
        Some(Wall { label, load, u })
    };
    let chosen: Vec<Wall<'_>> = story.chosen.iter().filter_map(state).collect();
    let upwards = upright(story.chosen.iter().copied(), &scale);
    let energy = || energy(plan, summary, &story).png(WIDTH);
    if chosen.is_empty() {
        return Ok(vec![("energy.png".to_owned(), energy()?)]);
    }
    // The tube takes longest: whoever is done with the plots helps.
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

/// What the axis of energies is called.
pub(super) fn energy_label(plan: &Plan) -> String {
    let scale = Scale::of(plan.units.as_ref());
    format!("strain energy *W* ({})", unit(&scale.energy_name))
}

/// Strain energy against what changes along the path.
fn energy(plan: &Plan, summary: &Summary, story: &Story<'_>) -> Chart {
    let x = |row: &Row| story.abscissa.of(row);
    let within = |row: &&Row| story.rows.iter().any(|r| r.step == row.step);
    let minimum = summary.findings().energy_minimum().filter(within);
    let rule = |shape: Shape, label: &str| {
        let row = story.rows.iter().find(|row| row.shape == shape)?;
        Some(VerticalLine {
            at: x(row),
            label: label.to_owned(),
        })
    };
    Chart {
        x_label: story.abscissa.label(&Scale::of(plan.units.as_ref())),
        y_label: energy_label(plan),
        curves: vec![Curve {
            points: story.rows.iter().map(|row| (x(row), row.energy)).collect(),
            dots: true,
            colour: 1,
            ..Curve::default()
        }],
        markers: minimum
            .map(|row| Marker {
                at: (x(row), row.energy),
                label: format!("minimum at {}", story.abscissa.told(row)),
                colour: 2,
            })
            .into_iter()
            .collect(),
        vertical_lines: rule(Shape::Square, "square")
            .into_iter()
            .chain(rule(Shape::Invaginated, "overhang"))
            .collect(),
        ..Chart::default()
    }
}

/// The tube cut open at the chosen states, along the plane of an angle, which points up.
fn cutaway(
    plan: &Plan,
    tube: &SplineTube,
    chosen: &[Wall<'_>],
    upwards: f64,
) -> Result<Cutaway, DrawError> {
    let (value_label, factor) = Field::EnergyDensity.label(plan);
    let look = Look {
        factor,
        ..Look::half(tube)
    };
    let panel = |look: &Look, state: &Wall<'_>| Panel {
        label: state.label.clone(),
        surfaces: looked_at(tube, state.load, state.u, upwards, look),
        ..Panel::default()
    };
    let picture = Cutaway {
        title: plan.title.clone(),
        value_label,
        scale_bar: bar(&Scale::of(plan.units.as_ref())),
        ..Cutaway::default()
    };
    let seen = |look: &Look| Cutaway {
        panels: chosen.par_iter().map(|state| panel(look, state)).collect(),
        ..picture.clone()
    };
    let (fine, range) = look.fine(&seen(&look.coarse(tube, COARSE)), WIDTH)?;
    Ok(Cutaway {
        range,
        ..seen(&fine)
    })
}

/// What a state is called in a legend.
fn label(story: &Story<'_>, scale: &Scale, row: &Row) -> String {
    let (label, value) = (story.abscissa.label(scale), story.abscissa.told(row));
    // The unit stands behind the number here.
    match label.rsplit_once(" (") {
        Some((name, unit)) => format!(
            "{name} = {value} {} ({})",
            unit.trim_end_matches(')'),
            row.shape
        ),
        None => format!("{label} = {value} ({})", row.shape),
    }
}
