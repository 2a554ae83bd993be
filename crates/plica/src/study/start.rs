//! The first state of a study that starts from a saved state, and tubes that their imperfections turn inside out.

use super::{Plan, Start};
use crate::assembly::{Inverted, SplineTube};
use crate::equilibrium::{TubeProblem, prolong};
use crate::monitor::Monitor;
use crate::saved_state::Layout;
use crate::solve::{
    Effort, Equilibrium, Failure, Method, PathError, Settings, Solution, Step, newton, relaxation,
};
use crate::tube::{Load, Mesh, Symmetry, Tube};

/// Transfers a saved state to the mesh of a problem and brings it to equilibrium.
pub(super) fn equilibrate(
    plan: &Plan,
    problem: &TubeProblem,
    start: &Start,
    monitor: &mut dyn Monitor,
) -> Result<(Vec<f64>, Step), PathError<Inverted>> {
    let u = transferred(plan, problem, start);
    find(problem, &start.load, &u, &plan.solver, monitor)
}

/// Finds an equilibrium from a displacement near it, by Newton's method or by relaxation.
pub(super) fn find(
    problem: &TubeProblem,
    load: &Load,
    u: &[f64],
    settings: &Settings,
    monitor: &mut dyn Monitor,
) -> Result<(Vec<f64>, Step), PathError<Inverted>> {
    let mut effort = Effort::default();
    let mut attempts = vec![];
    for method in [Method::Newton, Method::Relaxation] {
        let (u, effort) = (u.to_vec(), &mut effort);
        let found = match method {
            Method::Newton => newton(problem, load, u, settings, effort, monitor),
            _ => relaxation(problem, load, u, settings, effort, monitor),
        };
        let failed = match found {
            Ok(solution) => return Ok(step(method, solution, *effort)),
            Err(failed) => failed,
        };
        effort.linear_solves += failed.linear_solves();
        let is_cancelled = matches!(failed, Failure::Cancelled);
        attempts.push((method, failed));
        if is_cancelled {
            break;
        }
    }
    Err(PathError {
        attempts,
        limit_point: None,
        step: Step {
            method: Method::Relaxation,
            effort,
            damping_work: 0.0,
        },
    })
}

/// Returns a saved state on the mesh of a problem, before it is brought to equilibrium.
pub(super) fn transferred(plan: &Plan, problem: &TubeProblem, start: &Start) -> Vec<f64> {
    let Layout { mesh, rings, .. } = &start.state.layout;
    let from = SplineTube::new(&perfect(&plan.tube), mesh, *rings);
    let mut u = prolong(&from, &problem.tube, &start.state.u);
    problem.apply_prescribed(&start.load, &mut u);
    u
}

/// Returns the unknowns and the step of a solution.
fn step(method: Method, solution: Solution, effort: Effort) -> (Vec<f64>, Step) {
    let step = Step {
        method,
        effort,
        damping_work: solution.damping_work,
    };
    (solution.u, step)
}

/// Returns an element that the imperfections of a tube turn inside out, if there is one.
pub fn inverted_by_imperfections(tube: &Tube, mesh: &Mesh, symmetry: Symmetry) -> Option<Inverted> {
    let perfect = SplineTube::new(&perfect(tube), mesh, mesh.rings(symmetry));
    perfect.check_imperfections(&tube.imperfections).err()
}

/// Returns the volume of the lumen of a tube at rest, in D³.
pub fn lumen_volume_at_rest(tube: &Tube, mesh: &Mesh, symmetry: Symmetry) -> f64 {
    SplineTube::new(tube, mesh, mesh.rings(symmetry)).lumen_volume_at_rest()
}

/// Returns a tube without its imperfections.
fn perfect(tube: &Tube) -> Tube {
    Tube {
        imperfections: vec![],
        obstacles: vec![],
        ..tube.clone()
    }
}
