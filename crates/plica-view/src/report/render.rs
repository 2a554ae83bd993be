//! Pictures of single states, and animations of a path.

use super::labels::{scale_bar, state_label};
use super::obstacles::obstacles;
use super::orientation::upward_angle;
use super::pictures::energy_label;
use super::surfaces::{SurfaceOptions, tube_surfaces};
use super::{Field, FieldScales};
use crate::draw::{
    Chart, Curve, Cutaway, DrawError, Image, Marker, Panel, Range, ResolvedRange, VerticalLine,
    animation,
};
use crate::sampled_tube::SampledTube;
use plica::saved_state::SavedState;
use plica::study::{Plan, Row, Scale};
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Samples along each side of a pixel of a single picture.
const SAMPLES: usize = 3;

/// Appearance of states.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Appearance {
    /// Field of the colours.
    pub field: Field,
    /// Angle of the wall that is removed, in degrees from 0 to 350.
    pub cutaway: f64,
    /// Shows the removed part as translucent.
    pub see_through: bool,
    /// Direction towards the viewer: (up, to the front, along the tube).
    pub toward: [f64; 3],
    /// Ends of the colour bar.
    pub scale: ColourScale,
    /// Width in pixels.
    pub width: usize,
}

impl Default for Appearance {
    fn default() -> Self {
        Self {
            field: Field::default(),
            cutaway: 180.0,
            see_through: false,
            toward: Cutaway::default().toward,
            scale: ColourScale::Path,
            width: 1800,
        }
    }
}

/// States that determine the colour range of a picture, or its ends.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum ColourScale {
    /// All saved states of the run, so that a colour has the same meaning in every picture.
    #[default]
    Path,
    /// The states in the picture.
    Shown,
    /// The two given values.
    Given([f64; 2]),
}

/// A saved state and its row of the history.
pub type Shown = (SavedState, Row);

/// Draws states, one below the other, with one colour bar; returns PNG data. `path` contains the scales of the saved states of
/// the run.
///
/// # Errors
/// [`DrawError`] for an invalid size or range.
pub fn render(
    plan: &Plan,
    states: &[Shown],
    path: &FieldScales,
    look: &Appearance,
) -> Result<Vec<u8>, DrawError> {
    cutaway(plan, states, path, look)?.png(look.width)
}

pub(super) fn cutaway(
    plan: &Plan,
    states: &[Shown],
    path: &FieldScales,
    look: &Appearance,
) -> Result<Cutaway, DrawError> {
    let tube = SampledTube::of(plan);
    let upwards = upward_angle(states.iter().map(|(_, row)| row), &scale(plan));
    let range = range(plan, states, path, look)?;
    let coarse = coarse(&tube, plan, states, upwards, look);
    let finest = surface_options(&tube, plan, look).fine(&coarse, range, look.width)?;
    let panels = states
        .par_iter()
        .map(|shown| panel(&tube, shown, upwards, &finest, look));
    Ok(Cutaway {
        panels: panels.collect(),
        samples: SAMPLES,
        range: Range::Resolved(range),
        ..coarse
    })
}

/// Draws an animated PNG of the tube above its energy, one frame per state, each shown for `seconds`. `path` contains the scales
/// of the saved states of the run.
///
/// `proceed` receives the number of finished frames and returns false to cancel; the result is then `None`.
///
/// # Errors
/// [`DrawError`] for an invalid size or range.
pub fn animate(
    plan: &Plan,
    states: &[Shown],
    rows: &[Row],
    path: &FieldScales,
    look: &Appearance,
    seconds: f64,
    proceed: &(dyn Fn(usize) -> bool + Sync),
) -> Result<Option<Vec<u8>>, DrawError> {
    let tube = SampledTube::of(plan);
    let upwards = upward_angle(states.iter().map(|(_, row)| row), &scale(plan));
    // A coarse sampling of all states determines their common bounds.
    let bounds = states.par_iter().map(|shown| {
        let state = coarse(&tube, plan, std::slice::from_ref(shown), upwards, look);
        state.bounding_box()
    });
    let bounds: Result<Vec<[[f64; 3]; 2]>, DrawError> = bounds.collect();
    let coarse = Cutaway {
        bounds: bounds?.concat(),
        ..picture(plan, vec![Panel::default()], look)
    };
    let range = range(plan, states, path, look)?;
    let finest = surface_options(&tube, plan, look).fine(&coarse, range, look.width)?;
    let done = AtomicUsize::new(0);
    let frame = |shown: &Shown| -> Result<Option<Image>, DrawError> {
        if !proceed(done.load(Ordering::Relaxed)) {
            return Ok(None);
        }
        let panel = panel(&tube, shown, upwards, &finest, look);
        let tube = Cutaway {
            bounds: coarse.bounds.clone(),
            range: Range::Resolved(range),
            ..picture(plan, vec![panel], look)
        };
        let tube = tube.image(look.width)?;
        let energy = energy(plan, rows, &shown.1).image(look.width)?;
        done.fetch_add(1, Ordering::Relaxed);
        Image::stacked(&[tube, energy]).map(Some)
    };
    // One frame per thread at a time, because uncompressed frames are large.
    let batch = rayon::current_num_threads();
    let frames = states.chunks(batch).flat_map(|some| {
        let frames: Vec<_> = some.par_iter().map(frame).collect();
        frames
    });
    animation(states.len(), frames, seconds)
}

fn scale(plan: &Plan) -> Scale {
    Scale::of(plan.units.as_ref())
}

fn surface_options(tube: &SampledTube, plan: &Plan, look: &Appearance) -> SurfaceOptions {
    SurfaceOptions {
        field: look.field,
        factor: look.field.label(plan).1,
        ..SurfaceOptions::half(tube).cut(look.cutaway)
    }
}

/// Draws states with a coarse sampling.
fn coarse(
    tube: &SampledTube,
    plan: &Plan,
    states: &[Shown],
    upwards: f64,
    look: &Appearance,
) -> Cutaway {
    let coarse = surface_options(tube, plan, look).coarse(tube);
    let panels = states
        .par_iter()
        .map(|shown| panel(tube, shown, upwards, &coarse, look));
    picture(plan, panels.collect(), look)
}

fn panel(
    tube: &SampledTube,
    (state, row): &Shown,
    upwards: f64,
    look: &SurfaceOptions,
    shown: &Appearance,
) -> Panel {
    let sampled = tube.state(&state.load, &state.u);
    let surfaces = |look: &SurfaceOptions| tube_surfaces(&sampled, upwards, look);
    let removed = look.removed().filter(|_| shown.see_through);
    let removed = removed.map(|look| surfaces(&look)).unwrap_or_default();
    let obstacles = obstacles(tube, &state.load, upwards, shown.toward);
    Panel {
        label: state_label(row),
        surfaces: [surfaces(look), obstacles.solid].concat(),
        translucent: [removed, obstacles.translucent].concat(),
    }
}

fn picture(plan: &Plan, panels: Vec<Panel>, look: &Appearance) -> Cutaway {
    Cutaway {
        title: plan.title.clone(),
        panels,
        value_label: look.field.label(plan).0,
        scale_bar: scale_bar(&scale(plan)),
        toward: look.toward,
        map: look.field.map(),
        ends: plan.end_names.clone(),
        extremes_of: match look.scale {
            ColourScale::Shown => "",
            ColourScale::Path | ColourScale::Given(_) => "on the path",
        },
        ..Cutaway::default()
    }
}

/// Returns the colour range of the field of a picture.
fn range(
    plan: &Plan,
    states: &[Shown],
    path: &FieldScales,
    look: &Appearance,
) -> Result<ResolvedRange, DrawError> {
    let shown = || {
        let states = states.par_iter();
        FieldScales::of_states(plan, states.map(|(state, _)| state))
    };
    match look.scale {
        ColourScale::Path => path.range(look.field, plan, None),
        ColourScale::Shown => shown().range(look.field, plan, None),
        ColourScale::Given(ends) => path.range(look.field, plan, Some(ends)),
    }
}

/// Plots the energy of all states and marks one of them.
fn energy(plan: &Plan, rows: &[Row], at: &Row) -> Chart {
    let point = |row: &Row| (row.step as f64, row.energy);
    let starts = rows
        .windows(2)
        .filter(|pair| pair[0].stage != pair[1].stage);
    let vertical_lines = starts.map(|pair| VerticalLine {
        at: pair[0].step as f64,
        label: pair[1].stage.clone(),
    });
    let highest = rows.iter().map(|row| row.energy).fold(0.0, f64::max);
    Chart {
        x_label: "state".into(),
        y_label: energy_label(plan),
        curves: vec![Curve {
            points: rows.iter().map(point).collect(),
            colour: 1,
            ..Curve::default()
        }],
        markers: vec![Marker {
            at: point(at),
            label: String::new(),
            colour: 2,
        }],
        vertical_lines: vertical_lines.collect(),
        y_range: (highest > 0.0).then_some((0.0, 1.1 * highest)),
        proportion: 0.3,
        width_pt: Cutaway::default().width_pt,
        ..Chart::default()
    }
}
