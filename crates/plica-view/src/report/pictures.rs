//! Standard pictures of a run.

use super::columns::WITH_TENSIONS;
use super::labels::{scale_bar, unit};
use super::manometry::Manometry;
use super::obstacles::obstacles;
use super::orientation::upward_angle;
use super::selection::{Abscissa, Selection};
use super::surfaces::{SurfaceOptions, tube_surfaces};
use super::walls::{Wall, walls};
use super::{Field, FieldScales};
use crate::draw::{
    Chart, Compression, Curve, Cutaway, DrawError, Marker, Panel, Range, ResolvedRange,
    VerticalLine,
};
use crate::sampled_tube::SampledTube;
use plica::run_directory::{Snapshot, Summary};
use plica::study::findings::Interval;
use plica::study::{Plan, Row, Scale};
use rayon::prelude::*;

/// Width of the pictures in pixels; small, because they are drawn while the user waits.
const WIDTH: usize = 1200;

/// Draws a run; returns file names and PNG data. The result is empty for a run without snapshots; a selected state without a
/// snapshot appears only in the energy.
///
/// - `energy.png`: strain energy along the path;
/// - `walls.png`: outer and inner wall at selected states;
/// - `tube.png`: the tube cut open at the same states, coloured by strain energy density;
/// - `manometry.png` and the table `manometry.csv`, if a wall touches itself: the force of contact along the tube.
///
/// # Errors
/// [`DrawError`] if a picture has no finite value.
pub fn pictures(plan: &Plan, summary: &Summary) -> Result<Vec<(String, Vec<u8>)>, DrawError> {
    if summary.snapshots().is_empty() || summary.rows().len() < 2 {
        return Ok(vec![]);
    }
    let tube = SampledTube::of(plan);
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
        || {
            let range = path_range(
                plan,
                &tube,
                (summary.rows(), summary.snapshots()),
                &selection.chosen,
            )?;
            cutaway(plan, &tube, &chosen, upwards, range)?.png_with(WIDTH, Compression::Fast)
        },
        || Ok([energy()?, walls(plan, &tube, &chosen).png(WIDTH)?]),
    );
    let [energy, walls] = plots?;
    let pictures = [
        ("energy.png", energy),
        ("walls.png", walls),
        ("tube.png", tube?),
    ];
    let mut pictures: Vec<(String, Vec<u8>)> =
        pictures.map(|(name, png)| (name.to_owned(), png)).into();
    if let Some(manometry) = Manometry::of(plan, summary) {
        let chart = manometry.chart(&selection).png(WIDTH)?;
        pictures.push(("manometry.png".into(), chart));
        pictures.push(("manometry.csv".into(), manometry.table().into_bytes()));
    }
    Ok(pictures)
}

/// Returns the label of the energy axis.
pub(super) fn energy_label(plan: &Plan) -> String {
    let scale = Scale::of(plan.units.as_ref());
    let name = match plan.tube.muscles.iter().all(|muscle| muscle.grows()) {
        true => "strain energy *W*",
        false => WITH_TENSIONS,
    };
    format!("{name} ({})", unit(&scale.energy_name))
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
                label: format!("minimum at {}", selection.abscissa.place(row)),
                colour: 2,
            })
            .collect(),
        vertical_lines: shapes.chain(stages).collect(),
        ..Chart::default()
    }
}

/// Returns the colour range of the strain energy density for the states that are saved, or all if none is, and for those shown.
fn path_range(
    plan: &Plan,
    tube: &SampledTube,
    (rows, snapshots): (&[Row], &[Option<Snapshot>]),
    shown: &[&Row],
) -> Result<ResolvedRange, DrawError> {
    let is_shown = |row: &Row| shown.iter().any(|one| one.step == row.step);
    let is_saved = |i: usize| {
        let ends_stage = rows
            .get(i + 1)
            .is_none_or(|next| next.stage != rows[i].stage);
        match plan.output.states_every {
            0 => true,
            every => ends_stage || rows[i].step.is_multiple_of(every),
        }
    };
    let scales = snapshots
        .par_iter()
        .enumerate()
        .filter_map(|(i, snapshot)| {
            let Snapshot { load, u } = snapshot.as_ref()?;
            (is_saved(i) || is_shown(&rows[i])).then(|| FieldScales::of(&tube.state(load, u)))
        });
    FieldScales::union(scales.collect::<Vec<_>>()).range(Field::EnergyDensity, plan, None)
}

/// Draws the tube cut open at the selected states, with the angle `upwards` pointing up.
fn cutaway(
    plan: &Plan,
    tube: &SampledTube,
    chosen: &[Wall<'_>],
    upwards: f64,
    range: ResolvedRange,
) -> Result<Cutaway, DrawError> {
    let (value_label, factor) = Field::EnergyDensity.label(plan);
    let look = SurfaceOptions {
        factor,
        ..SurfaceOptions::half(tube)
    };
    let panel = |look: &SurfaceOptions, state: &Wall<'_>| {
        let obstacles = obstacles(tube, state.load, upwards, Cutaway::default().toward);
        let mut surfaces = tube_surfaces(&tube.state(state.load, state.u), upwards, look);
        surfaces.extend(obstacles.solid);
        Panel {
            label: state.label.clone(),
            surfaces,
            translucent: obstacles.translucent,
        }
    };
    let picture = Cutaway {
        title: plan.title.clone(),
        value_label,
        scale_bar: scale_bar(&Scale::of(plan.units.as_ref())),
        range: Range::Resolved(range),
        extremes_of: "on the path",
        ends: plan.end_names.clone(),
        ..Cutaway::default()
    };
    let drawn = |look: &SurfaceOptions| Cutaway {
        panels: chosen.par_iter().map(|state| panel(look, state)).collect(),
        ..picture.clone()
    };
    let fine = look.fine(&drawn(&look.coarse(tube)), range, WIDTH)?;
    Ok(drawn(&fine))
}

/// Returns the label of a state.
fn label(selection: &Selection<'_>, scale: &Scale, row: &Row) -> String {
    let abscissa = selection.abscissa;
    let (label, value) = (abscissa.label(scale), abscissa.place(row));
    let shape = row.shape;
    // The unit follows the number.
    match (abscissa, label.rsplit_once(" (")) {
        (Abscissa::Step, _) => format!("{value} ({shape})"),
        (_, Some((name, unit))) => {
            format!("{name} = {value} {} ({shape})", unit.trim_end_matches(')'))
        }
        (_, None) => format!("{label} = {value} ({shape})"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;
    use crate::page::scene_of_states;
    use crate::report::render::{Appearance, ColourScale, Shown, cutaway as rendered};
    use plica::tube::Symmetry;

    #[test]
    fn a_field_has_one_range_and_one_maximum_in_every_picture_and_on_the_page() {
        for symmetry in [Symmetry::Axisymmetric, Symmetry::Fold(4)] {
            let plan = fixture::plan(symmetry);
            let tube = SampledTube::of(&plan);
            let states = [0, 1, 2].map(|number| fixture::state(&plan, number));
            let rows = [0, 1, 2].map(|step| Row {
                step,
                ..Row::zero(&[], ["colon", "ileum"])
            });
            let snapshot = |i: usize| {
                let (load, u) = (states[i].load.clone(), states[i].u.clone());
                Some(Snapshot { load, u })
            };
            let snapshots = [0, 1, 2].map(snapshot);
            let path = path_range(&plan, &tube, (&rows, &snapshots), &[&rows[2]]).unwrap();
            assert!(path.max > 0.0);

            let all = FieldScales::of_states(&plan, states.par_iter());
            let last: Shown = (states[2].clone(), rows[2].clone());
            let range_of = |width, cutaway, scale| {
                let look = Appearance {
                    width,
                    cutaway,
                    scale,
                    ..Appearance::default()
                };
                let picture = rendered(&plan, std::slice::from_ref(&last), &all, &look);
                picture.unwrap().colour_range().unwrap()
            };
            assert_eq!(range_of(600, 180.0, ColourScale::Path), path);
            assert_eq!(range_of(2000, 90.0, ColourScale::Path), path);
            // The scale of one state is the same on the page.
            let scene = scene_of_states(&plan, &states, &all);
            assert_eq!(
                scene.ends(Field::EnergyDensity),
                (path, range_of(900, 0.0, ColourScale::Shown))
            );
        }
    }

    #[test]
    fn states_are_named_by_number_and_loads_by_value() {
        let row = Row {
            step: 30,
            ..Row::zero(&[], ["colon", "ileum"])
        };
        let scale = Scale::of(None);
        let of = |abscissa| Selection {
            abscissa,
            rows: vec![],
            chosen: vec![],
        };
        assert!(label(&of(Abscissa::Step), &scale, &row).starts_with("state 30 ("));
        assert!(label(&of(Abscissa::LengthRatio), &scale, &row).contains("*L* = "));
        assert_eq!(Abscissa::Step.place(&row), "state 30");
    }
}
