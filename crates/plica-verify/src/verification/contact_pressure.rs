//! Contact pressure along a tube: the patch test, and the line contact of Hertz.

use super::VerificationError;
use super::report::Recorder;
use super::tube_model::{TubeModel, tight_settings};
use plica::activation::Direction;
use plica::assembly::{Barrier, Point, SplineTube};
use plica::equilibrium::TubeProblem;
use plica::material::Law;
use plica::solve::{Path, State};
use plica::spline::Refinement;
use plica::tube::{Integration, Load, Mesh, Obstacle, ObstacleShape, Placement};
use std::f64::consts::PI;

/// Stiffness of the barrier.
const STIFFNESS: f64 = 0.1;

/// Returns a tube with an obstacle, on a mesh with small elements in a zone along it and at its inner face.
fn problem(model: &TubeModel, refinement: Refinement, grading: f64, range: f64) -> TubeProblem {
    let p = model.degree;
    let [along, around, through] = model.elements;
    let mesh = Mesh {
        axial: along + p,
        around,
        thickness: through + p,
        degree: p,
        refinements: vec![refinement],
        grading,
        contact_range: 0.25,
        volumetric: Integration::Full,
        layers: vec![],
    };
    let barrier = Barrier {
        range,
        stiffness: STIFFNESS,
    };
    TubeProblem::new(SplineTube::new(&model.tube, &mesh, 1).with_barrier(barrier))
}

/// Adds an obstacle of a radius, its centre on the axis in the middle of the tube.
fn add(model: &mut TubeModel, shape: ObstacleShape, radius: f64) {
    model.tube.obstacles.push(Obstacle {
        name: "obstacle".into(),
        shape,
        rest: centred(model, radius),
        friction: 0.0,
    });
}

fn centred(model: &TubeModel, radius: f64) -> Placement {
    Placement {
        radius,
        position: [0.5 * model.tube.length, 0.0, 0.0],
    }
}

/// Returns the radial Cauchy stress at a place of the wall at rest, positive in compression.
fn pressure(problem: &TubeProblem, state: &State<Load>, z: f64, radius: f64) -> f64 {
    let at = Point {
        z,
        radius,
        angle: 0.0,
    };
    let Fe = problem.tube.sample(&state.load, &state.u, at).elastic;
    let material = &problem.tube.tube.layers[0].material;
    let sigma = material.stress(&Fe).times(Fe.transpose());
    -sigma.0[1][1] / Fe.determinant()
}

/// Records the contact pressure of a tube that grows evenly into a sheath, on a mesh whose elements differ in length by a
/// factor of 8: it is constant.
pub fn patch_test(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let mut model =
        TubeModel::new(1.0, 0.06, 0.495, [30, 60, 3]).with_uniform_muscle(Direction::Circular);
    add(&mut model, ObstacleShape::Sheath, 0.55);
    let zone = Refinement {
        from: 0.3,
        to: 0.5,
        factor: 8.0,
    };
    const RANGE: f64 = 1e-3;
    let problem = problem(&model, zone, 1.0, RANGE);
    let load = Load {
        muscles: vec![1.2],
        ..model.tube.rest()
    };
    let state = super::tube_model::solve_from_rest(&problem, &load, 10)?;
    let outer = plica::tube::Tube::OUTER_RADIUS;
    let pressures: Vec<f64> = (0..=100)
        .map(|i| pressure(&problem, &state, 0.01 * f64::from(i), outer))
        .collect();
    let most = pressures.iter().copied().fold(f64::MIN, f64::max);
    let least = pressures.iter().copied().fold(f64::MAX, f64::min);
    recorder.case("tube in a sheath, elements of two lengths")?;
    let exact = super::contact::pressure_in_sheath(RANGE)?;
    let source = "one-dimensional solution with the gap";
    recorder.relative(1e-4, "contact pressure", most, (exact, source));
    let spread = most / least - 1.0;
    recorder.zero(
        1e-8,
        "spread of the contact pressure",
        spread,
        "uniform state",
    );
    Ok(())
}

/// Records the pressure of a rigid ball that widens inside a thick tube. Where it touches, the wall is locally a half-space
/// in plane strain under a cylinder of the ball's radius R. By Hertz (Johnson 1985, Eqs. 4.43 to 4.45), with the force P per
/// length and E* = E/(1 − ν²), the half-width is a = √(4 P R/(π E*)) and the pressure 2 P/(π a) √(1 − x²/a²).
pub fn hertz(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    const NU: f64 = 0.3;
    const INNER: f64 = 0.25;
    let mut model = TubeModel::new(1.0, INNER, NU, [117, 60, 17]);
    add(&mut model, ObstacleShape::Ball, 0.2499);
    let zone = Refinement {
        from: 0.475,
        to: 0.525,
        factor: 20.0,
    };
    let problem = problem(&model, zone, 0.01, 3.4e-6);
    let u = vec![0.0; problem.tube.unknowns()];
    let mut path = Path::begin(&problem, model.tube.rest(), u, tight_settings())?;
    for radius in [0.2504, 0.2508] {
        path.begin_segment(Load {
            obstacles: vec![centred(&model, radius)],
            ..model.tube.rest()
        });
        path.advance(0.5, &mut ())?;
        path.advance(1.0, &mut ())?;
        let state = path.state();
        let contact = problem
            .tube
            .obstacle_contacts(&state.load, &state.u)
            .remove(0);
        let per_length = contact.force / (2.0 * PI * INNER);
        let modulus = 1.0 / (1.0 - NU * NU);
        let half_width = (4.0 * per_length * radius / (PI * modulus)).sqrt();
        let peak = 2.0 * per_length / (PI * half_width);
        let at = |x: f64| pressure(&problem, state, 0.5 + x * half_width, INNER);
        recorder.case(format!("ball of radius {radius} in a thick tube"))?;
        let hertz = "Hertz, small strains";
        recorder.relative(1.5e-2, "largest pressure", at(0.0), (peak, hertz));
        for x in [0.4_f64, 0.8] {
            let expected = (1.0 - x * x).sqrt();
            let name = format!("pressure at {x} of the half-width over the largest one");
            recorder.relative(1.5e-2, name, at(x) / at(0.0), (expected, hertz));
        }
        let outside = at(1.3) / at(0.0);
        recorder.zero(
            1e-2,
            "pressure beside the contact over the largest one",
            outside,
            hertz,
        );
    }
    Ok(())
}
