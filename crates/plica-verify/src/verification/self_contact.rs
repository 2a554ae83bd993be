//! Contact of the wall with itself: a ring that flattens under pressure, and a fold of one ring and of many.

use super::VerificationError;
use super::report::Recorder;
use super::tube_model::{TubeModel, tight_settings};
use plica::assembly::{Barrier, Point, SplineTube};
use plica::contact::FaceContact;
use plica::equilibrium::TubeProblem;
use plica::solve::Path;
use plica::tube::{Axial, Imperfection, Load, Part, Shape, Wave};

/// Pressure p R³/EI at which opposite walls of an inextensible ring touch (Flaherty, Keller and Rubinow 1972; the elastica
/// solved independently).
const TOUCH: f64 = 5.24689;

/// Returns the problem with contact of a range, in D.
fn touching(problem: &TubeProblem, range: f64) -> TubeProblem {
    let barrier = Barrier {
        range,
        ..*problem.tube.barrier()
    };
    TubeProblem::new((*problem.tube).clone().with_barrier(barrier)).with_contact()
}

/// Returns p R³/EI at which opposite walls of a ring with a thickness, in D, come within the range of contact.
fn touching_pressure(thickness: f64) -> Result<f64, VerificationError> {
    let middle = 0.5 - 0.5 * thickness;
    let (poisson_ratio, range) = (0.3, 1e-4);
    let mut model = TubeModel::new(0.05, thickness, poisson_ratio, [1, 96, 1]);
    model.tube.imperfections.push(Imperfection {
        of: Part::Geometry,
        amplitude: 2e-4,
        shape: Shape::Wave(Wave::new(2, 0.0, Axial::Uniform)),
    });
    // A sector of half the ring.
    let problem = touching(&model.problem(48), range);
    let bending = thickness.powi(3) / 12.0 / (1.0 - poisson_ratio * poisson_ratio);
    // The pressure acts on the outer circle.
    let unit = bending / (0.5 * middle * middle);
    let start = problem.tube.initial_guess();
    let mut path = Path::begin(&problem, model.tube.rest(), start, tight_settings())?;
    let mut advance = |pressure: f64, steps: usize| -> Result<f64, VerificationError> {
        path.begin_segment(model.under_pressure([0.0, pressure * unit]));
        for n in 1..=steps {
            path.advance(n as f64 / steps as f64, &mut ())?;
        }
        let state = path.state();
        let at = Point {
            z: 0.5 * model.tube.length,
            radius: model.tube.inner_radius(),
            angle: 0.5 * std::f64::consts::PI,
        };
        let sample = problem.tube.sample(&state.load, &state.u, at);
        Ok(2.0 * sample.position[2] - range)
    };
    for (pressure, steps) in [(2.8, 2), (3.2, 8)] {
        advance(pressure, steps)?;
    }
    let mut p = [4.6, 4.9];
    let mut gap = [advance(p[0], 7)?, advance(p[1], 1)?];
    for _ in 0..8 {
        let next = p[1] - gap[1] * (p[1] - p[0]) / (gap[1] - gap[0]);
        (p, gap) = ([p[1], next], [gap[1], advance(next, 1)?]);
        if gap[1].abs() < 1e-7 {
            break;
        }
    }
    Ok(p[1])
}

/// Records the pressure at which opposite walls of a thin ring touch.
pub fn flat_ring(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    recorder.case("ring that flattens under outer pressure")?;
    let [thick, thin] = [0.01, 0.005].map(touching_pressure);
    let (thick, thin) = (thick?, thin?);
    recorder.relative(
        2e-3,
        "p R³/EI at which opposite walls touch, extrapolated to no thickness from H = 0.01 and 0.005 D",
        2.0 * thin - thick,
        (TOUCH, "elastica"),
    );
    Ok(())
}

/// A fold that touches: its state, and the strain energy and contact of the outer wall on the whole tube.
struct Fold {
    load: Load,
    u: Vec<f64>,
    energy: f64,
    contact: FaceContact,
}

/// Records a fold that touches itself on sectors of several rings against that of one ring.
pub fn symmetries(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let text = include_str!("../../../../cases/invagination.toml");
    let plan = plica::case::read(text, "fold");
    let mut plan = plan.map_err(|error| VerificationError::Solve(error.to_string()))?;
    (plan.mesh.axial, plan.mesh.around, plan.mesh.thickness) = (70, 32, 4);
    let problem = |rings: usize| {
        let tube = SplineTube::new(&plan.tube, &plan.mesh, rings);
        touching(&TubeProblem::new(tube), 0.03)
    };
    let fold =
        |problem: &TubeProblem, path: &Path<TubeProblem>| -> Result<Fold, VerificationError> {
            let (load, u) = (path.state().load.clone(), path.state().u.clone());
            let report = problem.contact_report(&load, &u);
            let contact = report.and_then(|report| report.faces[0]);
            Ok(Fold {
                energy: problem.tube.forces(&load, &u)?.energy,
                contact: contact
                    .ok_or_else(|| VerificationError::Solve("the fold touches nowhere".into()))?,
                load,
                u,
            })
        };
    let ring = problem(1);
    let rest = vec![0.0; ring.tube.unknowns()];
    let mut path = Path::begin(ring.clone(), plan.tube.rest(), rest, tight_settings())?;
    let mut load = plan.tube.rest();
    for (muscle, target, steps) in [(0, 0.25, 5), (1, 1.45, 15)] {
        load.muscles[muscle] = target;
        path.begin_segment(load.clone());
        for step in 1..=steps {
            path.advance(f64::from(step) / f64::from(steps), &mut ())?;
        }
    }
    let one = fold(&ring, &path)?;
    for rings in [4, 32] {
        recorder.case(format!(
            "fold that touches itself, {rings} of 32 control rings"
        ))?;
        let problem = problem(rings);
        let of_ring = one.u.iter().flat_map(|x| std::iter::repeat_n(*x, rings));
        let start = of_ring.collect();
        let mut path = Path::begin(problem.clone(), one.load.clone(), start, tight_settings())?;
        path.begin_segment(one.load.clone());
        path.advance(1.0, &mut ())?;
        let found = fold(&problem, &path)?;
        let source = "one control ring";
        recorder.relative(1e-8, "W", found.energy, (one.energy, source));
        let (own, of_ring) = (found.contact, one.contact);
        recorder.relative(1e-3, "contact force", own.force, (of_ring.force, source));
        recorder.relative(1e-3, "smallest gap", own.gap, (of_ring.gap, source));
    }
    Ok(())
}
