//! Creases of a wall that grows along its axis between sliding ends, its outer face held like that of a layer on a rigid base.
//!
//! The inner face is compressed along the axis by 1/θζ. The measure is its surface stretch s = λ₁² λ₂, which is 1/θζ² in plane
//! strain. A flat neo-Hookean surface is unstable below s = 0.2956 (Biot 1963: s³ + s² + 3s − 1 = 0; θζ = 1.839); a crease
//! has less energy than a flat surface below s = 1/2.4 (Hong, Zhao and Suo 2009: a strain of 0.354; θζ = 1.549).

use super::VerificationError;
use super::report::Recorder;
use super::tube_model::TubeModel;
use plica::activation::{Direction, Muscle, Profile};
use plica::assembly::SplineTube;
use plica::contact::{BIOT, ContactReport};
use plica::equilibrium::{TubeProblem, prolong};
use plica::solve::{Path, Settings};
use plica::tube::{Foundation, Integration, Load, Mesh, Region, SpringDirection};

const LENGTH: f64 = 0.12;
const THICKNESS: f64 = 0.06;

/// Largest growth of the path on which the wall creases, beyond that at which the flat surface is unstable.
const LARGEST: f64 = 1.84;

/// Step of the growth on the way back.
const STEP: f64 = 0.01;

/// A wall whose growth has a profile along the axis.
fn model(profile: &[(f64, f64)]) -> TubeModel {
    let mut model = TubeModel::new(LENGTH, THICKNESS, 0.499, [40, 60, 6]);
    let profile = Profile::Table(profile.to_vec());
    let zone = [0.0, LENGTH];
    let muscle = Muscle::new("axial".into(), Direction::Longitudinal, zone, profile);
    model.tube.muscles.push(muscle);
    model.tube.foundations.push(Foundation {
        region: Region {
            zone: [0.0, LENGTH],
            edge: 0.0,
            sector: None,
        },
        stiffness: 1000.0,
        direction: SpringDirection::Normal,
    });
    model
}

/// Returns the problem on a mesh, with contact. Each level halves the elements at the inner face in both directions.
fn problem(model: &TubeModel, level: usize) -> TubeProblem {
    let mesh = Mesh {
        axial: (40 << level) + 3,
        around: 60,
        thickness: [9, 14, 24][level],
        degree: 3,
        refinements: vec![],
        grading: [0.2, 0.1, 0.05][level],
        contact_range: 0.25,
        volumetric: Integration::Full,
        layers: vec![],
    };
    TubeProblem::new(SplineTube::new(&model.tube, &mesh, 1)).with_contact()
}

fn load(model: &TubeModel, growth: f64) -> Load {
    Load {
        muscles: vec![growth],
        ..model.tube.rest()
    }
}

fn report(
    problem: &TubeProblem,
    load: &Load,
    u: &[f64],
) -> Result<ContactReport, VerificationError> {
    let missing = || VerificationError::Solve("the problem has no contact".into());
    problem.contact_report(load, u).ok_or_else(missing)
}

/// Records the surface stretch at which a flat wall becomes unstable.
pub fn biot(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    recorder.case("wall that grows along a rigid base")?;
    let model = model(&[(0.0, 1.0), (1.0, 1.0)]);
    let problem = problem(&model, 1);
    let u = vec![0.0; problem.tube.unknowns()];
    let settings = Settings::default();
    let mut path = Path::begin(problem.clone(), model.tube.rest(), u, settings)?;
    let mut states = vec![];
    for (growth, steps) in [(1.71, 14), (1.72, 1)] {
        path.begin_segment(load(&model, growth));
        for step in 1..=steps {
            path.advance(f64::from(step) / f64::from(steps), &mut ())?;
        }
        states.push(path.state().u.clone());
    }
    // Newton's method does not go beyond the zero of an eigenvalue; the flat wall is extrapolated from two states before it.
    let flat = |growth: f64| -> Vec<f64> {
        let t = (growth - 1.71) / (1.72 - 1.71);
        let pairs = states[0].iter().zip(&states[1]);
        pairs.map(|(a, b)| a + t * (b - a)).collect()
    };
    let prescribed = problem.tube.prescribed_in_harmonic(0);
    let is_stable = |growth: f64| {
        let mut tangent = problem.ring_tangent(&load(&model, growth), &flat(growth), 0);
        tangent.constrain(&prescribed);
        tangent
            .factor()
            .is_ok_and(|factor| factor.negative_pivots() == 0)
    };
    let [mut low, mut high] = [1.71, 1.8];
    if !is_stable(low) || is_stable(high) {
        return Err(VerificationError::Solve("no state becomes unstable".into()));
    }
    for _ in 0..10 {
        let middle = f64::midpoint(low, high);
        match is_stable(middle) {
            true => low = middle,
            false => high = middle,
        }
    }
    let stretch = report(&problem, &load(&model, low), &flat(low))?.surfaces[1].stretch;
    recorder.relative(
        2e-2,
        "surface stretch s = λ₁² λ₂ at which the flat wall becomes unstable",
        stretch,
        (BIOT, "Biot (1963)"),
    );
    Ok(())
}

/// A crease on its way back.
struct Opening {
    /// Surface stretch of the flat wall at the growth at which the crease disappears.
    stretch: f64,
    /// A state with the crease, for the next mesh.
    creased: (f64, Vec<f64>),
}

/// Follows a creased state to smaller growth until the crease has disappeared; `kept` is the growth of the state that is returned.
/// The contact force vanishes linearly, which determines the growth there.
fn opening(
    model: &TubeModel,
    path: &mut Path<TubeProblem>,
    mut growth: f64,
    kept: f64,
) -> Result<Opening, VerificationError> {
    let (mut forces, mut flat) = (vec![], vec![]);
    let mut creased = None;
    while flat.len() < 2 {
        growth -= STEP;
        path.begin_segment(load(model, growth));
        path.advance(1.0, &mut ())?;
        let state = path.state();
        let contact = report(path.problem(), &state.load, &state.u)?;
        match contact.faces[1] {
            Some(face) => forces.push((growth, face.force)),
            None => flat.push((growth, contact.surfaces[1].stretch)),
        }
        if creased.is_none() && growth <= kept {
            creased = Some((growth, state.u.clone()));
        }
        if growth < 1.3 {
            return Err(VerificationError::Solve("the crease stays".into()));
        }
    }
    let lost = || VerificationError::Solve("there is no crease to follow".into());
    let [.., (a, f), (b, g)] = forces[..] else {
        return Err(lost());
    };
    let end = (b - g * (a - b) / (f - g)).max(flat[0].0);
    let [(open, s), (below, t)] = [flat[0], flat[1]];
    Ok(Opening {
        stretch: s + (end - open) * (s - t) / (open - below),
        creased: creased.ok_or_else(lost)?,
    })
}

/// Records the surface stretch at which a crease disappears, on three meshes and extrapolated.
pub fn creases(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    recorder.case("crease of a wall that grows along a rigid base, on its way back")?;
    // Less growth near the ends: a surface that creases there would meet its mirror image.
    let model = model(&[
        (0.0, 0.92),
        (0.25, 0.92),
        (0.5, 1.0),
        (0.75, 0.92),
        (1.0, 0.92),
    ]);
    // The flat wall creases in a snap, which halved steps do not avoid.
    let settings = Settings {
        relaxation_steps: 1000,
        max_step_halvings: 3,
        ..Settings::default()
    };
    let mut problem = problem(&model, 0);
    let u = vec![0.0; problem.tube.unknowns()];
    let mut path = Path::begin(problem.clone(), model.tube.rest(), u, settings.clone())?;
    path.begin_segment(load(&model, LARGEST));
    for step in 1..=20 {
        path.advance(f64::from(step) / 20.0, &mut ())?;
    }
    let mut found = vec![];
    let mut growth = LARGEST;
    for (level, kept) in [1.70, 1.61, 1.55].into_iter().enumerate() {
        recorder.check_cancelled()?;
        let Opening { stretch, creased } = opening(&model, &mut path, growth, kept)?;
        found.push(stretch);
        if level < 2 {
            let finer = self::problem(&model, level + 1);
            let u = prolong(&problem.tube, &finer.tube, &creased.1);
            growth = creased.0;
            path = Path::begin(finer.clone(), load(&model, growth), u, settings.clone())?;
            path.begin_segment(load(&model, growth));
            path.advance(1.0, &mut ())?;
            problem = finer;
        }
    }
    let [coarse, middle, fine] = [found[0], found[1], found[2]];
    let (first, second) = (middle - coarse, fine - middle);
    let limit = fine + second * second / (first - second);
    let hong = "Hong, Zhao and Suo (2009)";
    let h = THICKNESS / 80.0;
    let name = format!("surface stretch s at which it disappears, elements of {h:.5} D");
    recorder.relative(3e-2, name, fine, (1.0 / 2.4, hong));
    recorder.relative(
        1.5e-2,
        "the same, extrapolated from elements of h, h/2 and h/4",
        limit,
        (1.0 / 2.4, hong),
    );
    let growth = limit.powf(-0.5);
    recorder.relative(
        1e-2,
        "growth θζ in plane strain there",
        growth,
        (1.549, hong),
    );
    Ok(())
}
