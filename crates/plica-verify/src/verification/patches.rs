//! Patches that grow through the wall, and elastic foundations.

use super::VerificationError;
use super::layered_wall::{Layer, LayeredWall};
use super::layers::{ONE, model, radii};
use super::report::Recorder;
use super::tube_model::{TubeModel, energy, solve_from_rest};
use plica::tube::{Foundation, Patch, Region, SpringDirection, Tube};
use std::f64::consts::PI;

/// Returns the region of a whole tube.
fn everywhere(tube: &Tube) -> Region {
    Region {
        zone: [0.0, tube.length],
        edge: 0.0,
        sector: None,
    }
}

/// Records an inflated ring of two layers, one of which grows through the wall.
pub fn growth(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    for growing in [0, 1] {
        let layers = vec![Layer::new(0.46, 0.4, 20.0), Layer::new(0.5, 0.2, 10.0)];
        let mut wall = LayeredWall {
            inner: 0.42,
            layers,
            stretch: 1.1,
        };
        let mut model = model(&wall, &[4, 4]);
        wall.layers[growing].through = 1.5;
        let (p, steps) = (0.02, 8);
        let expected = wall.inflate(p, steps)?;
        model.tube.patches = vec![Patch {
            name: "grown".into(),
            region: everywhere(&model.tube),
            layers: vec![growing],
            stiffness: 1.0,
            muscles: vec![],
        }];
        let problem = model.problem(1);
        let mut load = model.under_pressure([p, 0.0]);
        load.ends[1].displacement = (wall.stretch - 1.0) * model.tube.length;
        load.patches = vec![1.5];
        let state = solve_from_rest(&problem, &load, steps)?;
        let name = ["inner", "outer"][growing];
        recorder.case(format!(
            "ring of two layers, the {name} one 1.5 times as thick, ℓ = 1.1, p = {p}"
        ))?;
        let expected = [expected.radii[0], expected.radii[2]];
        let ring = (&problem, &state);
        radii(recorder, 1e-8, ring, &wall, (expected, ONE));
    }
    Ok(())
}

/// Records an inflated ring on springs around it, and a tube on springs that is pulled.
pub fn foundation(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let on = |model: &mut TubeModel, stiffness: f64, direction: SpringDirection| {
        model.tube.foundations = vec![Foundation {
            region: everywhere(&model.tube),
            stiffness,
            direction,
        }];
    };
    // Where a ring keeps its length, springs in all directions are radial, too.
    for (direction, name, stretch) in [
        (SpringDirection::Normal, "normal springs", 1.2),
        (SpringDirection::All, "springs", 1.0),
    ] {
        let wall = LayeredWall {
            inner: 0.44,
            layers: vec![Layer::new(0.5, 0.4, 20.0)],
            stretch,
        };
        let (k, p, steps) = (0.5, 0.04, 8);
        let expected = wall.inflate_on(k, p, steps)?;
        let mut model = model(&wall, &[8]);
        on(&mut model, k, direction);
        let problem = model.problem(1);
        let mut load = model.under_pressure([p, 0.0]);
        load.ends[1].displacement = (wall.stretch - 1.0) * model.tube.length;
        let state = solve_from_rest(&problem, &load, steps)?;
        recorder.case(format!("ring on {name}, k = {k}, ℓ = {stretch}, p = {p}"))?;
        let expected = [expected.radii[0], expected.radii[1]];
        let ring = (&problem, &state);
        radii(recorder, 1e-8, ring, &wall, (expected, ONE));
    }
    // EA u″ = k P u with u(0) = 0 and u(L) = δ: the energy is ½ δ² √(EA k P) coth λL, P the circumference.
    let (length, thickness, k, pull) = (2.0, 0.02, 0.02, 1e-4);
    let mut model = TubeModel::new(length, thickness, 0.0, [24, 60, 2]);
    on(&mut model, k, SpringDirection::All);
    let problem = model.problem(1);
    let mut load = model.tube.rest();
    load.ends[1].displacement = pull;
    let state = solve_from_rest(&problem, &load, 1)?;
    let (area, around) = (PI * thickness * (1.0 - thickness), PI);
    let lambda = (k * around / area).sqrt();
    let expected = 0.5 * pull * pull * (area * k * around).sqrt() / (lambda * length).tanh();
    recorder.case(format!(
        "tube on springs, pulled at one end, H = {thickness}, k = {k}, ν = 0"
    ))?;
    let found = energy(&problem, &state);
    let bar = (expected, "bar on springs");
    recorder.relative(1e-3, "energy of wall and springs", found, bar);
    Ok(())
}
