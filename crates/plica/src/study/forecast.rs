//! What a study will take, without running it.

use super::Plan;
use crate::assembly::SplineTube;
use crate::solve::Scheme;
use crate::tube::Mesh;
use std::time::Instant;

/// The size and the cost of a study.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forecast {
    /// Unknowns of the whole tube.
    pub unknowns: usize,
    /// Elements of the whole tube.
    pub elements: usize,
    /// Unknowns of the sector that is solved for.
    pub unknowns_solved: usize,
    /// Peak memory.
    pub memory_bytes: u64,
    /// Wall time on this machine, roughly: it is measured on a piece of the tube, and how many
    /// solves a path needs is only known on the way.
    pub seconds_estimate: f64,
}

/// Linear solves per state on a smooth branch, and once in a while through a snap.
const SOLVES_PER_STATE: f64 = 10.0;
/// Memory of the program itself and its pictures.
const PROGRAM_BYTES: u64 = 80 << 20;
/// Elements along the piece of tube on which the speed is measured.
const PIECE: usize = 16;

/// Memory of a matrix above which its factorisation is not timed but counted.
const TIMED_BYTES: f64 = 2e8;
/// What the dense kernels then are taken to do.
const FLOPS_PER_SECOND: f64 = 2e10;

/// Forecasts a study.
pub fn forecast(plan: &Plan) -> Forecast {
    let mesh = &plan.mesh;
    let unknowns = 3 * mesh.axial * mesh.around * mesh.thickness;
    let rings = mesh.rings(plan.symmetry);
    let unknowns_solved = unknowns / mesh.around * rings;
    let solves = match &plan.solver.scheme {
        Scheme::Static => SOLVES_PER_STATE,
        Scheme::PseudoTime(scheme) => 3.0 * (scheme.ramp as f64 + 0.2 * scheme.hold as f64),
    };
    let states: usize = plan.stages.iter().map(|stage| stage.steps).sum();
    let seconds_estimate = states as f64 * solves * seconds_per_solve(plan, rings);
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
    let row = (3 * mesh.thickness * mesh.rings(plan.symmetry)) as u64;
    let matrix = 8 * mesh.axial as u64 * (mesh.degree as u64 + 1) * row * row;
    let states: usize = plan.stages.iter().map(|stage| stage.steps).sum();
    let kept = 8 * (1 + states as u64) * mesh.axial as u64 * row;
    // Tangent, its factor, the factor of the state, the drag matrix, the slabs before their sum.
    PROGRAM_BYTES + kept + 5 * matrix + (512 << 20).min(matrix)
}

/// Times one assembly and factorisation of a short piece of the tube with the same cross-section.
fn seconds_per_solve(plan: &Plan, rings: usize) -> f64 {
    let (mesh, p) = (&plan.mesh, plan.mesh.degree);
    let whole = mesh.axial - p;
    let piece = PIECE.min(whole);
    // A cross-section of many rings is timed by fewer: assembly grows with the rings, a
    // factorisation with their cube.
    let timed = if rings > 4 * (p + 1) { p + 1 } else { rings };
    let around = if timed == rings {
        mesh.around
    } else {
        timed * mesh.around.div_ceil(timed)
    };
    let more = rings as f64 / timed as f64;
    // Not worth timing, or not worth the memory: a round number of flops a second.
    let row = (3 * mesh.thickness * timed) as f64;
    if 8.0 * (piece + p) as f64 * (p + 1) as f64 * row * row > TIMED_BYTES {
        let row = (3 * mesh.thickness * rings) as f64;
        return mesh.axial as f64 * row.powi(3) * (p * (p + 2)) as f64 / FLOPS_PER_SECOND;
    }
    let short = Mesh {
        axial: piece + p,
        around,
        refinements: vec![],
        ..mesh.clone()
    };
    let tube = SplineTube::new(&plan.tube, &short, timed);
    let (load, u) = (plan.tube.rest(), vec![0.0; tube.unknowns()]);
    let mut seconds = f64::INFINITY;
    for _ in 0..3 {
        let start = Instant::now();
        let mut tangent = tube.tangent(&load, &u);
        let assembly = start.elapsed().as_secs_f64();
        tangent.constrain(tube.given());
        let start = Instant::now();
        let _ = tangent.factor();
        let factor = start.elapsed().as_secs_f64();
        seconds = seconds.min(assembly * more * more.min(2.0) + factor * more.powi(3));
    }
    seconds * whole as f64 / piece as f64
}
