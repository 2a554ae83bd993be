//! Muscles with active stress.

use super::VerificationError;
use super::layered_wall::{Layer, LayeredWall};
use super::layers::{ONE, artery_of, model, radii};
use super::report::Recorder;
use super::tube_model::{TubeModel, tight_settings};
use plica::activation::{Direction, Muscle, Profile};
use plica::equilibrium::TubeProblem;
use plica::material::LengthTension;
use plica::solve::{Path, State};
use plica::tube::Load;

/// Adds a muscle around one layer of a whole tube.
fn with_muscle(model: &mut TubeModel, layer: usize, [best, least]: [f64; 2]) {
    let even = Profile::Table(vec![(0.0, 1.0), (1.0, 1.0)]);
    let zone = [0.0, model.tube.length];
    let muscle = Muscle::new("media".into(), Direction::Circular, zone, even);
    let relation = LengthTension::Rachev { best, least };
    model.tube.muscles = vec![muscle.with_active_stress(relation, 0.0)];
    for (l, own) in model.tube.layers.iter_mut().enumerate() {
        if l != layer {
            own.idle_muscles = vec![0];
        }
    }
}

/// Solves for the states of a tube that is stretched and inflated, and then raises a tension.
fn constricted(
    model: &TubeModel,
    rings: usize,
    (stretch, p, tension): (f64, f64, f64),
    steps: usize,
) -> Result<(TubeProblem, [State<Load>; 2]), VerificationError> {
    let problem = model.problem(rings);
    let mut load = model.under_pressure([p, 0.0]);
    load.ends[1].displacement = (stretch - 1.0) * model.tube.length;
    let u = vec![0.0; problem.tube.unknowns()];
    let mut path = Path::begin(&problem, problem.tube.tube.rest(), u, tight_settings())?;
    let mut states = vec![];
    for tension in [0.0, tension] {
        load.muscles = vec![tension];
        path.begin_segment(load.clone());
        for n in 1..=steps {
            path.advance(n as f64 / steps as f64, &mut ())?;
        }
        states.push(path.state().clone());
    }
    let [relaxed, active] = [0, 1].map(|i| states[i].clone());
    Ok((problem, [relaxed, active]))
}

/// Records the radii of a carotid artery and of a ring of two layers whose muscle contracts under pressure.
pub fn constriction(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let passive = artery_of([0.71, 0.97, 1.10]);
    let mut model_of_artery = model(&passive, &[6, 4]);
    with_muscle(&mut model_of_artery, 0, [1.4, 0.8]);
    let mut active = passive.clone();
    active.layers[0].tone = Some([50.0, 1.4, 0.8]);
    let load = (passive.stretch, 13.33, 50.0);
    let (problem, [relaxed, contracted]) = constricted(&model_of_artery, 1, load, 16)?;
    for (state, wall, tension) in [(&relaxed, &passive, 0), (&contracted, &active, 50)] {
        recorder.case(format!(
            "carotid artery under 13.33 kPa, tension of the media driven to {tension} kPa"
        ))?;
        let one = wall.inflate(13.33, 8)?;
        let expected = ([one.radii[0], one.radii[2]], ONE);
        radii(recorder, 1e-7, (&problem, state), wall, expected);
    }
    // A coarser ring in all symmetries, with a muscle that is stretched beyond its best length first.
    let mut wall = LayeredWall {
        inner: 0.42,
        layers: vec![Layer::new(0.46, 0.4, 20.0), Layer::new(0.5, 0.2, 10.0)],
        stretch: 1.1,
    };
    let mut ring = model(&wall, &[2, 2]);
    ring.elements[1] = 24;
    with_muscle(&mut ring, 1, [1.1, 0.6]);
    wall.layers[1].tone = Some([0.2, 1.1, 0.6]);
    let one = wall.inflate(0.03, 8)?;
    let expected = [one.radii[0], one.radii[2]];
    for rings in [1, 6, 24] {
        let (problem, [_, state]) = constricted(&ring, rings, (1.1, 0.03, 0.2), 6)?;
        recorder.case(format!(
            "ring of two layers, {rings} rings, driven tension 0.2"
        ))?;
        // 24 splines around are not quite a circle.
        radii(recorder, 1e-4, (&problem, &state), &wall, (expected, ONE));
    }
    Ok(())
}
