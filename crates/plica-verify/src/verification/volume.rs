//! Tubes inflated by the volume of their lumen, past a maximum of the pressure.

use super::VerificationError;
use super::layered_wall::{Layer, LayeredWall};
use super::layers::model;
use super::report::Recorder;
use super::row::Tolerance;
use super::tube_model::{TubeModel, tight_settings};
use plica::equilibrium::TubeProblem;
use plica::solve::{Path, State};
use plica::tube::Load;

/// Volumes over that at rest, on both sides of the maximum of the pressure.
const VOLUMES: [f64; 4] = [1.3, 1.6, 2.4, 3.2];

/// Returns a wall whose active tension vanishes as it widens, so that the pressure in it has a maximum.
pub(super) fn wall() -> LayeredWall {
    let mut layer = Layer::new(0.5, 0.4, 20.0);
    layer.tone = Some([0.5, 1.3, 0.6]);
    LayeredWall {
        inner: 0.44,
        layers: vec![layer],
        stretch: 1.0,
    }
}

/// Returns the states of a tube at the volumes.
fn states(
    model: &TubeModel,
    rings: usize,
    volumes: &[f64],
) -> Result<(TubeProblem, Vec<State<Load>>), VerificationError> {
    let problem = model.problem(rings).with_driven_lumen();
    let (rest, u) = (model.tube.rest(), vec![0.0; problem.tube.unknowns()]);
    let mut path = Path::begin(problem.clone(), rest.clone(), u, tight_settings())?;
    // The active tension narrows the tube without load.
    path.begin_segment(rest.clone());
    path.advance(1.0, &mut ())?;
    let mut found = vec![];
    for &volume in volumes {
        path.begin_segment(Load {
            lumen_volume: Some(volume),
            ..rest.clone()
        });
        for n in 1..=3 {
            path.advance(f64::from(n) / 3.0, &mut ())?;
        }
        found.push(path.state().clone());
    }
    Ok((problem, found))
}

/// Returns the number of negative eigenvalues of circumferential mode 0 of a state of one ring.
fn negative(problem: &TubeProblem, load: &Load, u: &[f64]) -> f64 {
    let mut tangent = problem.ring_tangent(load, u, 0);
    tangent.constrain(problem.tube.prescribed());
    let factor = tangent.factor();
    factor.map_or(1.0, |factor| factor.negative_pivots() as f64)
}

/// Records pressures and stability of a ring at driven volumes.
pub fn ring(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let wall = wall();
    let (problem, states) = states(&model(&wall, &[8]), 1, &VOLUMES)?;
    let inner = problem.tube.tube.inner_radius();
    let one = |volume: f64| wall.pressure_at(inner * volume.sqrt());
    for (i, (state, volume)) in states.iter().zip(VOLUMES).enumerate() {
        recorder.case(format!("active ring, V = {volume} of that at rest"))?;
        let p = state.load.pressures[0].follower;
        let source = "one-dimensional solution";
        recorder.relative(1e-6, "p that holds V", p, (one(volume)?, source));
        let error =
            problem.tube.lumen_volume(&state.u) / problem.tube.lumen_volume_at_rest() - volume;
        recorder.zero(1e-10, "V", error, "driven value");
        let held = negative(&problem, &state.load, &state.u);
        let name = "negative eigenvalues at a held volume";
        recorder.row(name, held, (0.0, "stable"), Tolerance::Absolute(0.0));
        let mut load = state.load.clone();
        load.lumen_volume = None;
        let beyond = if i < 2 { 0.0 } else { 1.0 };
        let found = negative(&problem, &load, &state.u);
        let expected = (beyond, "none before the maximum, one after it");
        let name = "negative eigenvalues at a constant pressure";
        recorder.row(name, found, expected, Tolerance::Absolute(0.0));
    }
    Ok(())
}

/// Records pressures at driven volumes in all symmetries.
pub fn symmetries(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let wall = wall();
    let mut model = model(&wall, &[3]);
    model.elements[1] = 24;
    // At the last one the tube has left the axisymmetric states, if it can: its softening side widens alone.
    let volumes = &VOLUMES[..3];
    let pressures = |rings: usize| -> Result<Vec<f64>, VerificationError> {
        let (_, states) = states(&model, rings, volumes)?;
        let pressure = |state: &State<Load>| state.load.pressures[0].follower;
        Ok(states.iter().map(pressure).collect())
    };
    let one = pressures(1)?;
    for rings in [6, 24] {
        for ((p, expected), volume) in pressures(rings)?.into_iter().zip(&one).zip(volumes) {
            recorder.case(format!(
                "active tube of {rings} rings, V = {volume} of that at rest"
            ))?;
            recorder.relative(1e-8, "p that holds V", p, (*expected, "one ring"));
        }
    }
    Ok(())
}
