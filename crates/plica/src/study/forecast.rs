//! Forecast of the size and the cost of a study.

use super::{Plan, StudyError};
use crate::activation::{Muscle, MuscleTarget};
use crate::assembly::SplineTube;
use crate::equilibrium::{HarmonicTangent, TubeProblem};
use crate::material::Material;
use crate::solve::{Equilibrium, Scheme, Solver, Tangent};
use crate::tube::{Imperfection, Integration, Mesh, Part, Shape, Symmetry, Tube, WallLayer};
use std::ops::Range;
use std::time::Instant;

/// The size and the cost of a study.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forecast {
    /// Unknowns of the whole tube.
    pub unknowns: usize,
    /// Elements of the whole tube.
    pub elements: usize,
    /// Unknowns of the cyclic sector that is solved for.
    pub unknowns_solved: usize,
    /// Peak memory, in bytes.
    pub memory_bytes: u64,
    /// Rough wall time on this machine, in seconds: the time of a solve is measured on a piece of the tube, and the number of
    /// solves of the path is an estimate.
    pub seconds_estimate: f64,
}

/// Numbers of solves and of iterations of a path.
struct Effort {
    /// Linear solves per state.
    solves: f64,
    /// Conjugate-gradient iterations per solve with several rings.
    iterations: f64,
    /// Iterations for the test of the stability of a state with several rings.
    tested: f64,
}

/// An axisymmetric path.
const AXISYMMETRIC: Effort = Effort {
    solves: 10.0,
    iterations: 0.0,
    tested: 0.0,
};
/// States of several rings that are nearly round; on such paths 4.2 and 4.4 solves with 2 iterations each were counted.
const ROUND: Effort = Effort {
    solves: 4.5,
    iterations: 2.0,
    tested: 20.0,
};
/// States of several rings that have left the axisymmetric path. Under an outer pressure beyond the critical one, 32 solves with
/// 30 iterations each were counted, and ten times as many iterations where the wall nearly touches itself.
const NOT_ROUND: Effort = Effort {
    solves: 30.0,
    iterations: 80.0,
    tested: 600.0,
};
/// Growth stretch along the tube beyond which an imperfect tube tilts (Okino et al. 2025, at Lmax/L above 1.17).
const TILTING_STRETCH: f64 = 3.0;
/// Memory of the program itself and of its pictures.
const PROGRAM_BYTES: u64 = 80 << 20;
/// Tension with which the time of a solve is measured, in E.
const SMALL_TENSION: f64 = 1e-6;
/// Elements along the piece of the tube on which the time of a solve is measured.
const PIECE: usize = 16;

/// Forecasts the size and the cost of a study.
pub fn forecast(plan: &Plan) -> Forecast {
    let mesh = &plan.mesh;
    let unknowns = 3 * mesh.axial * mesh.around * mesh.thickness;
    let rings = mesh.rings(plan.symmetry);
    let unknowns_solved = unknowns / mesh.around * rings;
    let cost = Cost::measured(plan, rings);
    let seconds = |effort: Effort| {
        let solves = match &plan.solver.scheme {
            Scheme::Static => effort.solves,
            Scheme::PseudoTime(scheme) => {
                3.0 * (scheme.ramp as f64 + 0.2 * scheme.max_steps as f64)
            }
        };
        solves * cost.solve + (solves * effort.iterations + effort.tested) * cost.iteration
    };
    let states: usize = plan.stages.iter().map(|stage| stage.steps).sum();
    let seconds_estimate = if rings == 1 {
        states as f64 * seconds(AXISYMMETRIC)
    } else {
        let others = states_not_round(plan);
        (states - others) as f64 * seconds(ROUND) + others as f64 * seconds(NOT_ROUND)
    };
    Forecast {
        unknowns,
        elements: mesh.elements().iter().product(),
        unknowns_solved,
        memory_bytes: memory_bytes(plan),
        seconds_estimate,
    }
}

/// Forecasts the peak memory of a study.
pub fn memory_bytes(plan: &Plan) -> u64 {
    let mesh = &plan.mesh;
    let rings = mesh.rings(plan.symmetry) as u64;
    let row = 3 * mesh.thickness as u64 * rings;
    let banded = |row: u64| 8 * mesh.axial as u64 * (mesh.degree as u64 + 1) * row * row;
    let states: usize = plan.stages.iter().map(|stage| stage.steps).sum();
    let kept = if plan.output.pictures {
        1 + states as u64
    } else {
        1
    };
    let kept = 8 * kept * mesh.axial as u64 * row;
    if rings > 1 {
        // The tangent data at quadrature points, the blocks of all harmonics and their ingredients, the coupled low
        // harmonics, and vectors.
        let [along, _, through] = mesh.elements();
        let points = along * through * (mesh.degree + 1).pow(3) * mesh.rings(plan.symmetry);
        let points = (points as f64 * 1.1) as u64;
        let geometry = |imperfection: &Imperfection| imperfection.of == Part::Geometry;
        // Bytes of the stress-free shape in double precision, and of the tangent data in single precision: 10 numbers of
        // the neo-Hookean law, 46 of others.
        let shape = match plan.tube.imperfections.iter().any(geometry) {
            true => 48.0,
            false => 0.0,
        };
        let (layers, elements) = (&plan.tube.layers, mesh.elements_of_layers());
        let active = |layer: &WallLayer| {
            let muscles = plan.tube.muscles.iter().enumerate();
            let acts =
                |(m, muscle): &(usize, &Muscle)| !muscle.grows() && !layer.idle_muscles.contains(m);
            muscles.filter(acts).count()
        };
        // An active stress has the tangent data of any law, and an average of its own.
        let actives: usize = layers.iter().map(active).sum();
        let of_layer = |(layer, elements): (&WallLayer, Range<usize>)| {
            let data = match layer.material {
                Material::NeoHookean(_) => 40.0,
                _ => 184.0,
            };
            let data = data + 184.0 * active(layer) as f64;
            (data + shape) * elements.len() as f64 / through as f64
        };
        let at_point: f64 = layers.iter().zip(elements).map(of_layer).sum();
        // Each layer has an average of its own; with reduced integration, the volumetric parts have points and averages, too.
        let (at_point, averages) = match mesh.volumetric {
            Integration::Full => (at_point as u64, layers.len() as u64),
            Integration::Reduced => (2 * at_point as u64, 2 * layers.len() as u64),
        };
        let made_of = (1 + averages + actives as u64) * (mesh.degree as u64 + 1);
        let harmonics = (rings / 2 + made_of) * banded(row / rings);
        let low = 3 * banded(HarmonicTangent::low_row(rings as usize) as u64);
        let vectors = 40 * 8 * mesh.axial as u64 * row;
        return PROGRAM_BYTES + kept + at_point * points + harmonics + low + vectors;
    }
    let matrix = banded(row);
    // Tangent, its factor, the factor of the last state, the damping matrix, and the batches before their sum.
    PROGRAM_BYTES + kept + 5 * matrix + (512 << 20).min(matrix)
}

/// Returns the number of states at which a tube that is not perfectly axisymmetric has left the axisymmetric path.
fn states_not_round(plan: &Plan) -> usize {
    let states: usize = plan.stages.iter().map(|stage| stage.steps).sum();
    if plan.start.is_some() || plan.tube.has_sectors() || plan.has_sideways_ends() {
        return states;
    }
    let is_outline = |one: &Imperfection| matches!(one.shape, Shape::Outline(_));
    if plan.tube.imperfections.iter().all(is_outline) {
        return 0;
    }
    let (mut from, mut count) = (plan.first_load(), 0);
    for stage in &plan.stages {
        let is_beyond = |step: &usize| {
            let t = *step as f64 / stage.steps as f64;
            let load = stage.load_at(&from, t);
            let [inner, outer] = load.pressures.map(|wall| wall.follower + wall.dead);
            let muscles = plan.tube.muscles.iter().enumerate();
            let stretches = muscles.filter(|(_, m)| m.target() == MuscleTarget::LengthRatio);
            let mut stretches = stretches
                .map(|(m, muscle)| muscle.extreme_stretch(load.muscles[m], plan.tube.length));
            outer - inner > critical_pressure(plan)
                || stretches.any(|stretch| stretch > TILTING_STRETCH)
        };
        count += (1..=stage.steps).filter(is_beyond).count();
        from = stage.load.clone();
    }
    count
}

/// Returns the outer pressure, in E, at which a long incompressible tube buckles: (n² − 1)/9 · (H/R)³, with the smallest n ≥ 2
/// that the symmetry admits.
fn critical_pressure(plan: &Plan) -> f64 {
    let n = match plan.symmetry {
        Symmetry::Fold(m) => m.max(2) as f64,
        Symmetry::Axisymmetric | Symmetry::None => 2.0,
    };
    let thickness = plan.tube.thickness;
    let slenderness = thickness / (Tube::OUTER_RADIUS - 0.5 * thickness);
    (n * n - 1.0) / 9.0 * slenderness.powi(3)
}

/// Times on this machine, in seconds.
struct Cost {
    /// A linear solve: the tangent and its factors, or the preconditioner.
    solve: f64,
    /// An iteration of conjugate gradients; 0 with one ring.
    iteration: f64,
}

impl Cost {
    /// Measures the times on a short piece of the tube with the same cross-section.
    fn measured(plan: &Plan, rings: usize) -> Self {
        let (mesh, p) = (&plan.mesh, plan.mesh.degree);
        let whole = mesh.axial - p;
        let piece = PIECE.min(whole);
        let short = Mesh {
            axial: piece + p,
            refinements: vec![],
            grading: 1.0,
            contact_range: 0.25,
            ..mesh.clone()
        };
        let problem = TubeProblem::new(SplineTube::new(&plan.tube, &short, rings));
        let (mut load, u) = (plan.tube.rest(), problem.tube.initial_guess());
        let muscles = plan.tube.muscles.iter().zip(&mut load.muscles);
        for (_, tension) in muscles.filter(|(muscle, _)| !muscle.grows()) {
            *tension = SMALL_TENSION;
        }
        let mut least = [f64::INFINITY; 2];
        for _ in 0..3 {
            let start = Instant::now();
            let solver = problem.tangent(&load, &u).into_shifted(0.0);
            let tangent = start.elapsed().as_secs_f64();
            let Ok(solver) = solver else { continue };
            let mut b = vec![0.0; u.len()];
            b[problem.tube.unknowns() / 2] = 1.0;
            let start = Instant::now();
            let solved = solver.solve(&mut b, 1e-3, &());
            let solve = start.elapsed().as_secs_f64();
            let times = match solved {
                Ok(solved) if solved.iterations > 0 => [tangent, solve / solved.iterations as f64],
                _ => [tangent + solve, 0.0],
            };
            least = [0, 1].map(|i| least[i].min(times[i]));
        }
        let [solve, iteration] = least.map(|seconds| seconds * whole as f64 / piece as f64);
        Self { solve, iteration }
    }
}

/// Refuses a study that needs more than the free memory of the machine, where the system reports it (Linux).
///
/// # Errors
/// [`StudyError::OutOfMemory`].
pub fn check_memory(plan: &Plan) -> Result<(), StudyError> {
    let (needed, Some(available)) = (memory_bytes(plan), available_memory()) else {
        return Ok(());
    };
    if needed > available {
        let gib = |bytes: u64| bytes as f64 / (1_u64 << 30) as f64;
        return Err(StudyError::OutOfMemory {
            needed_gib: gib(needed),
            available_gib: gib(available),
        });
    }
    Ok(())
}

/// Returns the free memory in bytes, where the system reports it (Linux).
pub fn available_memory() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = text
        .lines()
        .find(|line| line.starts_with("MemAvailable:"))?;
    line.split_whitespace()
        .nth(1)?
        .parse::<u64>()
        .ok()
        .map(|kib| kib * 1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn not_round(lines: &str) -> usize {
        let text = format!(
            "symmetry = {{ fold = 3 }}\n[tube]\nlength = 2.0\nthickness = 0.05\n\
             [mesh]\ncontrol_points = {{ axial = 14, around = 36, thickness = 4 }}\n\
             [muscles.long]\ndirection = 'longitudinal'\nzone = [0.5, 1.0]\n\
             [[imperfections]]\nof = 'geometry'\namplitude = 1e-3\nshape = {{ wave = {{ mode = 3 }} }}\n{lines}"
        );
        states_not_round(&crate::case::read(&text, "case").unwrap())
    }

    #[test]
    fn states_beyond_the_critical_pressure_and_tilted_ones_are_forecast_as_not_round() {
        // Of ten equal steps to 8e-3, those above 8/9 (0.05/0.475)³ = 1.04e-3.
        let pressed = "[[stages]]\nsteps = 10\ndrive.outer-wall.pressure = 8e-3\n";
        assert_eq!(not_round(pressed), 9);
        let inflated = "[[stages]]\nsteps = 10\ndrive.inner-wall.pressure = 8e-3\n";
        assert_eq!(not_round(inflated), 0);
        // θ = 1 + (Lmax/L − 1) 2/0.25 passes 3 at Lmax/L = 1.25.
        let stretched = "[[stages]]\nsteps = 4\ndrive.long.length_ratio = 1.4\n";
        assert_eq!(not_round(stretched), 2);
    }
}
