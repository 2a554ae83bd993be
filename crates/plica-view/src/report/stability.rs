//! Pictures of a stability analysis.

use crate::draw::{
    Chart, ColourMap, Compression, Curve, Cutaway, DrawError, Image, Marker, Opening, Panel,
    REAR_HALF, Range, Stroke, Surface, VerticalLine,
};
use plica::assembly::{Point, SplineTube};
use plica::equilibrium::mode_effect;
use plica::stability::{Mode, PathStability, Quantity, StabilityChange, TestedState, Transition};
use plica::study::Plan;
use plica::tube::Tube;
use std::cell::RefCell;
use std::collections::HashMap;

/// Maximum number of states with a dot each.
const MAX_DOTS: usize = 25;
/// Width of the pictures in pixels.
const WIDTH: usize = 1800;
/// Printed width of the charts in points.
const COLUMN: f64 = 300.0;
/// Printed width of a page in points.
const PAGE: f64 = 510.0;
/// Amplitude of the drawn modes, in units of D.
const MODE_AMPLITUDE: f64 = 0.08;
/// Range of the drawn eigenvalues, relative to those at the beginning of a stage.
const RANGE: [f64; 2] = [-0.8, 1.6];

/// Draws the result of a stability analysis; returns file names and PNG data.
///
/// - `stability.png`: the lowest eigenvalue of each circumferential mode along every stage in which one changes sign;
/// - `mode.png`: the first unstable mode, if any.
///
/// # Errors
/// [`DrawError`] if there is nothing to draw.
pub fn stability_pictures(
    plan: &Plan,
    found: &PathStability,
) -> Result<Vec<(String, Vec<u8>)>, DrawError> {
    let mut pictures = vec![("stability.png".to_owned(), eigenvalues(plan, found)?)];
    let first = found.changes.iter().find(|change| change.mode.is_some());
    if let Some((change, mode)) = first.and_then(|c| Some((c, c.mode.as_ref()?))) {
        pictures.push(("mode.png".to_owned(), first_mode(plan, change, mode)?));
    }
    Ok(pictures)
}

/// Plots the stages with a change of stability, or else the last stage, one below the other.
fn eigenvalues(plan: &Plan, found: &PathStability) -> Result<Vec<u8>, DrawError> {
    let changes = |name: &str| found.changes.iter().any(|change| change.stage == name);
    let mut stages: Vec<&str> = plan
        .stages
        .iter()
        .map(|stage| stage.name.as_str())
        .collect();
    stages.retain(|name| changes(name));
    if stages.is_empty() {
        stages.extend(found.states.last().map(|state| state.stage.as_str()));
    }
    let image = |stage| chart(plan, found, stage).image(WIDTH);
    let images = stages
        .into_iter()
        .map(image)
        .collect::<Result<Vec<_>, _>>()?;
    Image::stacked(&images)?.to_png(COLUMN * 25.4 / 72.0, Compression::LineArt)
}

/// Plots the lowest eigenvalue of each circumferential mode along a stage.
fn chart(plan: &Plan, found: &PathStability, stage: &str) -> Chart {
    let inside: Vec<usize> = (0..found.states.len())
        .filter(|&i| found.states[i].stage == stage)
        .collect();
    let (Some(&first), Some(&last)) = (inside.first(), inside.last()) else {
        return Chart::default();
    };
    // A stage begins with the last state of the previous one.
    let states = &found.states[first.saturating_sub(1)..=last];
    let [begin, end] = [&states[0], &states[states.len() - 1]];
    let quantity = Quantity::between(&plan.tube, &begin.load, &end.load);
    let x = |state: &TestedState| quantity.of(&plan.tube, &state.load);
    let changes: Vec<&StabilityChange> =
        found.changes.iter().filter(|c| c.stage == stage).collect();

    let ends = [x(begin).min(x(end)), x(begin).max(x(end))];
    let mut curves = vec![Curve {
        points: ends.map(|x| (x, 0.0)).to_vec(),
        stroke: Stroke::Thin,
        ..Curve::default()
    }];
    let (mut low, mut high) = (0.0_f64, 1.0_f64);
    for n in 0..=found.highest {
        let unit = begin.modes[n].lowest.abs();
        let mut points = vec![];
        for pair in states.windows(2) {
            points.push((x(&pair[0]), pair[0].modes[n].lowest / unit));
            if changes
                .iter()
                .any(|change| is_snap_between(change, [x(&pair[0]), x(&pair[1])]))
            {
                points.push((f64::NAN, f64::NAN));
            }
        }
        points.push((x(end), end.modes[n].lowest / unit));
        for (_, y) in points.iter().filter(|point| point.1.is_finite()) {
            (low, high) = (low.min(*y), high.max(*y));
        }
        curves.push(Curve {
            label: name(n),
            // Dots show the states as long as there are few.
            dots: points.len() <= MAX_DOTS,
            points,
            colour: n + 1,
            ..Curve::default()
        });
    }
    let (low, high) = (low.max(RANGE[0]), high.min(RANGE[1]));
    let margin = 0.06 * (high - low);
    // Only the first eigenvalue of a mode is drawn.
    let marked: Vec<&&StabilityChange> = changes
        .iter()
        .filter(|c| c.negative.contains(&0) && c.transition == Transition::Smooth)
        .collect();
    Chart {
        x_label: label(quantity, plan),
        y_label: "lowest eigenvalue *λ*/*λ*_{begin}".into(),
        curves,
        markers: marked
            .iter()
            .map(|change| Marker {
                at: (change.critical, 0.0),
                label: String::new(),
                colour: change.harmonic + 1,
            })
            .collect(),
        vertical_lines: marked
            .iter()
            .map(|change| VerticalLine {
                at: change.critical,
                label: change.quantity.format(change.critical, 4),
            })
            .collect(),
        x_range: Some((ends[0], ends[1])),
        y_range: Some((low - margin, high + margin)),
        width_pt: COLUMN,
        ..Chart::default()
    }
}

fn is_snap_between(change: &StabilityChange, [from, to]: [f64; 2]) -> bool {
    let inside = |x: f64| (from.min(to)..=from.max(to)).contains(&x);
    change.transition == Transition::Snap && change.between.iter().all(|&x| inside(x))
}

/// Returns the name of a circumferential mode in the legend.
fn name(harmonic: usize) -> String {
    match harmonic {
        0 => "*n* = 0 (round)".into(),
        1 => "1 (sideways)".into(),
        2 => "2 (oval)".into(),
        n => format!("{n}"),
    }
}

/// Returns the label of an axis.
fn label(quantity: Quantity, plan: &Plan) -> String {
    let moved = |end: usize| format!("displacement of the {} end/*D*", plan.end_names[end]);
    match quantity {
        Quantity::LengthRatio => "*L*_{max}/*L*".into(),
        Quantity::DiameterRatio => "*D*_{min}/*D*".into(),
        Quantity::ColonDisplacement => moved(0),
        Quantity::IleumDisplacement => moved(1),
        Quantity::LumenVolume => "*V*/*V*_{0} of the lumen".into(),
        Quantity::Pressure(wall) => format!("*p*/*E* {}", ["inside", "outside"][wall]),
        Quantity::DeadLoad(wall) => format!("dead load/*E* {}", ["inside", "outside"][wall]),
        Quantity::Muscle(_)
        | Quantity::Radius(_)
        | Quantity::Position(..)
        | Quantity::Growth(_)
        | Quantity::Tension(_)
        | Quantity::Shift(_) => quantity.name(&plan.tube),
    }
}

/// Draws the tube at the critical state and displaced by the mode, open and closed, above the amplitudes of the mode.
fn first_mode(plan: &Plan, change: &StabilityChange, mode: &Mode) -> Result<Vec<u8>, DrawError> {
    let tube = SplineTube::new(&plan.tube, &plan.mesh, 1);
    let meridian = Meridian::new(&tube, mode);
    let at = format!(
        "{} = {}",
        label(change.quantity, plan),
        change.quantity.format(change.critical, 4)
    );
    let n = mode.harmonic;
    let panel = |label: String, opening: &Opening, amplitude: f64| Panel {
        label,
        surfaces: meridian.surfaces(opening, amplitude),
        ..Panel::default()
    };
    let along = 2 * tube.axial.elements() + 1;
    let (half, closed) = (
        Opening::uniform(REAR_HALF, [along, 121, 9]),
        Opening::uniform((0.0, std::f64::consts::TAU), [along, 241, 5]),
    );
    let cutaway = Cutaway {
        title: plan.title.clone(),
        panels: vec![
            panel(
                format!("{at}, where it loses stability to circumferential mode {n}"),
                &half,
                0.0,
            ),
            panel(
                format!(
                    "it {} (drawn with amplitude {MODE_AMPLITUDE} *D*)",
                    mode_effect(n)
                ),
                &half,
                MODE_AMPLITUDE,
            ),
            panel("the same from outside".into(), &closed, MODE_AMPLITUDE),
        ],
        value_label: "radial displacement of the mode".into(),
        range: Range::Given(-1.0, 1.0),
        ends: plan.end_names.clone(),
        map: ColourMap::Diverging,
        width_pt: PAGE,
        ..Cutaway::default()
    };
    let images = [cutaway.image(WIDTH)?, meridian.amplitudes().image(WIDTH)?];
    Image::stacked(&images)?.to_png(PAGE * 25.4 / 72.0, Compression::Small)
}

/// A state and its mode on one meridian, which determine all others.
struct Meridian<'a> {
    tube: &'a SplineTube,
    mode: &'a Mode,
    /// Largest radial amplitude at the outer wall.
    radial: f64,
    /// Largest displacement anywhere on the outer wall.
    largest: f64,
    known: RefCell<HashMap<[u64; 2], Sampled>>,
}

/// Position (z, r) of a point at angle zero, and the amplitudes (z, r, θ) of the mode there.
type Sampled = ([f64; 2], [f64; 3]);

impl<'a> Meridian<'a> {
    fn new(tube: &'a SplineTube, mode: &'a Mode) -> Self {
        let mut meridian = Self {
            tube,
            mode,
            radial: 0.0,
            largest: 0.0,
            known: RefCell::default(),
        };
        for z in tube.axial.positions(4 * tube.axial.elements() + 1) {
            let (_, amplitude) = meridian.sample(z, Tube::OUTER_RADIUS);
            meridian.radial = meridian.radial.max(amplitude[1].abs());
            let size = amplitude.iter().fold(0.0, |size: f64, a| size.hypot(*a));
            meridian.largest = meridian.largest.max(size);
        }
        meridian
    }

    fn sample(&self, z: f64, radius: f64) -> Sampled {
        let at = Point {
            z,
            radius,
            angle: 0.0,
        };
        let at_point = |u| self.tube.sample(&self.mode.state.load, u, at);
        let (state, mode) = (at_point(&self.mode.state.u), at_point(&self.mode.shape));
        let amplitude = [0, 1, 2].map(|i| mode.position[i] - mode.reference[i]);
        ([state.position[0], state.position[1]], amplitude)
    }

    /// Returns the surfaces of the tube, coloured by the radial displacement of the mode, relative to the larger of its
    /// maximum and a tenth of the largest displacement.
    fn surfaces(&self, opening: &Opening, amplitude: f64) -> Vec<Surface> {
        let (along, n) = (self.tube.axial.elements(), self.mode.harmonic as f64);
        let scale = amplitude / self.largest;
        opening.surfaces(|zeta, angle, xi| {
            let key = [zeta.to_bits(), xi.to_bits()];
            let ([z, r], mode) = *self.known.borrow_mut().entry(key).or_insert_with(|| {
                let inner = self.tube.tube.inner_radius();
                self.sample(
                    self.tube.axial.position(zeta * along as f64),
                    inner + xi * self.tube.tube.thickness,
                )
            });
            let (sin, cos) = if n == 0.0 {
                (-1.0, 1.0)
            } else {
                (n * angle).sin_cos()
            };
            let [dz, dr, dt] = [mode[0] * cos, mode[1] * cos, -mode[2] * sin];
            let (z, r, t) = (z + scale * dz, r + scale * dr, scale * dt);
            let (sin, cos) = angle.sin_cos();
            let value = if amplitude == 0.0 {
                0.0
            } else {
                (dr / self.radial.max(0.1 * self.largest)).clamp(-1.0, 1.0)
            };
            ([r * cos - t * sin, r * sin + t * cos, z], value)
        })
    }

    /// Plots the amplitudes of the mode along the outer wall.
    fn amplitudes(&self) -> Chart {
        let z = self
            .tube
            .axial
            .positions(4 * self.tube.axial.elements() + 1);
        let samples: Vec<Sampled> = z
            .iter()
            .map(|&z| self.sample(z, Tube::OUTER_RADIUS))
            .collect();
        let curve = |i: usize, label: &str, colour| Curve {
            label: label.into(),
            points: z
                .iter()
                .zip(&samples)
                .map(|(&z, p)| (z, p.1[i] / self.largest))
                .collect(),
            colour,
            ..Curve::default()
        };
        let n = self.mode.harmonic;
        let waves = match n {
            0 => ["", ""].map(str::to_owned),
            1 => ["cos *φ*", "−sin *φ*"].map(|wave| format!(" (times {wave})")),
            n => [
                format!(" (times cos {n}*φ*)"),
                format!(" (times −sin {n}*φ*)"),
            ],
        };
        Chart {
            x_label: "*z*/*D* of the outer wall at rest".into(),
            y_label: "amplitude of the mode".into(),
            curves: vec![
                curve(0, &format!("axial{}", waves[0]), 3),
                curve(1, &format!("radial{}", waves[0]), 2),
                curve(2, &format!("circumferential{}", waves[1]), 1),
            ],
            x_range: Some((0.0, self.tube.tube.length)),
            proportion: 0.3,
            width_pt: PAGE,
            ..Chart::default()
        }
    }
}
