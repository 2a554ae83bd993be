//! Pictures of single states, and the whole path as one that moves.

use super::Field;
use super::columns::bar;
use super::opened::{ALONG, Look, looked_at};
use super::pictures::energy_label;
use super::upright::upright;
use crate::draw::{
    Chart, Curve, Cutaway, DrawError, Image, Marker, Panel, Range, Surface, VerticalLine, animation,
};
use plica::assembly::SplineTube;
use plica::saved_state::SavedState;
use plica::study::{Plan, Row, Scale};
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Samples along either side of a pixel of a single picture, for which there is time.
const FINEST: usize = 3;

/// Pieces along and points through the wall at which fields are looked at first: they may peak anywhere.
const COARSE: [usize; 2] = [ALONG, 13];

/// How states are shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Appearance {
    /// What they are coloured by.
    pub field: Field,
    /// Degrees of the wall that are taken away, 0 to 350.
    pub cutaway: f64,
    /// Whether those are shown as if of glass.
    pub see_through: bool,
    /// Direction of the viewer: (up, towards the viewer, along the tube).
    pub toward: [f64; 3],
    /// Ends of the colour bar, if not chosen from what is there.
    pub range: Option<[f64; 2]>,
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
            range: None,
            width: 1800,
        }
    }
}

/// A state with its row of the history.
pub type Shown = (SavedState, Row);

/// States, one below the other, under one colour bar.
///
/// # Errors
/// [`DrawError`] for sizes and ranges that are none.
pub fn render(plan: &Plan, states: &[Shown], look: &Appearance) -> Result<Vec<u8>, DrawError> {
    let tube = spline_tube(plan);
    let upwards = upright(states.iter().map(|(_, row)| row), &scale(plan));
    let coarse = coarse(&tube, plan, states, upwards, look);
    let (finest, range) = look_of(&tube, plan, look).fine(&coarse, look.width)?;
    let panels = states
        .par_iter()
        .map(|shown| panel(&tube, shown, upwards, &finest, look));
    let picture = Cutaway {
        panels: panels.collect(),
        samples: FINEST,
        range,
        ..coarse
    };
    picture.png(look.width)
}

/// The tube above its energy, state after state, as an animated PNG; `told` hears how many frames are done, and says
/// whether to go on.
///
/// # Errors
/// [`DrawError`] for sizes and ranges that are none; none and no bytes if it was not to go on.
pub fn animate(
    plan: &Plan,
    states: &[Shown],
    rows: &[Row],
    look: &Appearance,
    seconds: f64,
    told: &(dyn Fn(usize) -> bool + Sync),
) -> Result<Option<Vec<u8>>, DrawError> {
    let tube = spline_tube(plan);
    let upwards = upright(states.iter().map(|(_, row)| row), &scale(plan));
    // A coarse look at all states for the frame and the colours that they share; of each no more than these is kept.
    let looked = states.par_iter().map(|shown| {
        let state = coarse(&tube, plan, std::slice::from_ref(shown), upwards, look);
        let surfaces = state.panels.iter().flat_map(|panel| &panel.surfaces);
        let values: Vec<f64> = surfaces.flat_map(|s| &s.values).copied().collect();
        Ok((state.bounding_box()?, values))
    });
    let looked: Result<Vec<_>, DrawError> = looked.collect();
    let (rooms, values): (Vec<_>, Vec<_>) = looked?.into_iter().unzip();
    let seen = Surface {
        values: values.concat(),
        ..Surface::default()
    };
    let seen = Panel {
        surfaces: vec![seen],
        ..Panel::default()
    };
    let coarse = Cutaway {
        bounds: rooms.concat(),
        ..picture(plan, vec![seen], look)
    };
    let (finest, range) = look_of(&tube, plan, look).fine(&coarse, look.width)?;
    let done = AtomicUsize::new(0);
    let frame = |shown: &Shown| -> Result<Option<Image>, DrawError> {
        if !told(done.load(Ordering::Relaxed)) {
            return Ok(None);
        }
        let panel = panel(&tube, shown, upwards, &finest, look);
        let tube = Cutaway {
            bounds: coarse.bounds.clone(),
            range,
            ..picture(plan, vec![panel], look)
        };
        let tube = tube.image(look.width)?;
        let energy = energy(plan, rows, &shown.1).image(look.width)?;
        done.fetch_add(1, Ordering::Relaxed);
        Image::stacked(&[tube, energy]).map(Some)
    };
    // As many at a time as there are threads: a picture that moves is large before it is packed.
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

fn spline_tube(plan: &Plan) -> SplineTube {
    SplineTube::new(&plan.tube, &plan.mesh, plan.mesh.rings(plan.symmetry))
}

fn look_of(tube: &SplineTube, plan: &Plan, look: &Appearance) -> Look {
    Look {
        field: look.field,
        factor: look.field.label(plan).1,
        ..Look::half(tube).cut(look.cutaway)
    }
}

/// A coarse look at states.
fn coarse(
    tube: &SplineTube,
    plan: &Plan,
    states: &[Shown],
    upwards: f64,
    look: &Appearance,
) -> Cutaway {
    let coarse = look_of(tube, plan, look).coarse(tube, COARSE);
    let panels = states
        .par_iter()
        .map(|shown| panel(tube, shown, upwards, &coarse, look));
    picture(plan, panels.collect(), look)
}

fn panel(
    tube: &SplineTube,
    (state, row): &Shown,
    upwards: f64,
    look: &Look,
    shown: &Appearance,
) -> Panel {
    let surfaces = |look: &Look| looked_at(tube, &state.load, &state.u, upwards, look);
    let glass = look.taken_away().filter(|_| shown.see_through);
    Panel {
        label: label(row),
        surfaces: surfaces(look),
        translucent: glass.map(|look| surfaces(&look)).unwrap_or_default(),
    }
}

fn picture(plan: &Plan, panels: Vec<Panel>, look: &Appearance) -> Cutaway {
    Cutaway {
        title: plan.title.clone(),
        panels,
        value_label: look.field.label(plan).0,
        scale_bar: bar(&scale(plan)),
        toward: look.toward,
        range: range(look),
        map: look.field.map(),
        ..Cutaway::default()
    }
}

fn range(look: &Appearance) -> Range {
    match look.range {
        Some([low, high]) => Range::Given(low, high),
        None => look.field.range(),
    }
}

/// What a state is called.
fn label(row: &Row) -> String {
    format!(
        "state {}: *L*_{{max}}/*L* = {:.2}, *D*_{{min}}/*D* = {:.2} ({})",
        row.step, row.length_ratio, row.diameter_ratio, row.shape
    )
}

/// The energy of all states, one of them marked.
fn energy(plan: &Plan, rows: &[Row], at: &Row) -> Chart {
    let place = |row: &Row| (row.step as f64, row.energy);
    let begin = rows
        .windows(2)
        .filter(|pair| pair[0].stage != pair[1].stage);
    let vertical_lines = begin.map(|pair| VerticalLine {
        at: pair[0].step as f64,
        label: pair[1].stage.clone(),
    });
    let highest = rows.iter().map(|row| row.energy).fold(0.0, f64::max);
    Chart {
        x_label: "state".into(),
        y_label: energy_label(plan),
        curves: vec![Curve {
            points: rows.iter().map(place).collect(),
            colour: 1,
            ..Curve::default()
        }],
        markers: vec![Marker {
            at: place(at),
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
