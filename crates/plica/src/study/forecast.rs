//! Forecast of the size and the cost of a study.

use super::{Plan, StudyError};
use crate::assembly::SplineTube;
use crate::equilibrium::{HarmonicTangent, TubeProblem};
use crate::solve::{Equilibrium, Scheme, Solver, Tangent};
use crate::tube::{Imperfection, Integration, Mesh, Part};
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
/// A path of several rings without imperfections, whose states stay round.
const ROUND: Effort = Effort {
    solves: 6.0,
    iterations: 5.0,
    tested: 60.0,
};
/// A path of several rings that is not round, as of the runs of which `docs/performance.md` lists the numbers.
const NOT_ROUND: Effort = Effort {
    solves: 20.0,
    iterations: 25.0,
    tested: 150.0,
};
/// Memory of the program itself and of its pictures.
const PROGRAM_BYTES: u64 = 80 << 20;
/// Elements along the piece of the tube on which the time of a solve is measured.
const PIECE: usize = 16;

/// Forecasts the size and the cost of a study.
pub fn forecast(plan: &Plan) -> Forecast {
    let mesh = &plan.mesh;
    let unknowns = 3 * mesh.axial * mesh.around * mesh.thickness;
    let rings = mesh.rings(plan.symmetry);
    let unknowns_solved = unknowns / mesh.around * rings;
    let is_round = plan.tube.imperfections.is_empty() && plan.start.is_none();
    let effort = match (rings, is_round) {
        (1, _) => AXISYMMETRIC,
        (_, true) => ROUND,
        (_, false) => NOT_ROUND,
    };
    let solves = match &plan.solver.scheme {
        Scheme::Static => effort.solves,
        Scheme::PseudoTime(scheme) => 3.0 * (scheme.ramp as f64 + 0.2 * scheme.max_steps as f64),
    };
    let states: usize = plan.stages.iter().map(|stage| stage.steps).sum();
    let cost = Cost::measured(plan, rings);
    let iterations = solves * effort.iterations + effort.tested;
    let per_state = solves * cost.solve + iterations * cost.iteration;
    let seconds_estimate = states as f64 * per_state;
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
        // Bytes of the tangent data in single precision, and of the stress-free shape in double precision.
        let at_point = match plan.tube.imperfections.iter().any(geometry) {
            true => 40 + 48,
            false => 40,
        };
        // With reduced integration, the volumetric part has points and an average of its own.
        let (at_point, averages) = match mesh.volumetric {
            Integration::Full => (at_point, 1),
            Integration::Reduced => (2 * at_point, 2),
        };
        let made_of = (1 + averages) * (mesh.degree as u64 + 1);
        let harmonics = (rings / 2 + made_of) * banded(row / rings);
        let low = 3 * banded(HarmonicTangent::low_row(rings as usize) as u64);
        let vectors = 40 * 8 * mesh.axial as u64 * row;
        return PROGRAM_BYTES + kept + at_point * points + harmonics + low + vectors;
    }
    let matrix = banded(row);
    // Tangent, its factor, the factor of the last state, the damping matrix, and the batches before their sum.
    PROGRAM_BYTES + kept + 5 * matrix + (512 << 20).min(matrix)
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
            ..mesh.clone()
        };
        let problem = TubeProblem::new(SplineTube::new(&plan.tube, &short, rings));
        let (load, u) = (plan.tube.rest(), problem.tube.initial_guess());
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
fn available_memory() -> Option<u64> {
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
