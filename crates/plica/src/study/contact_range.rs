//! The effect of the range of contact on a state.
//!
//! Contact acts at a distance of up to the range of its law. Energies and forces converge as the range goes to zero; how far
//! they are from that, a state with half the range shows.

use super::Plan;
use super::start::find;
use crate::equilibrium::TubeProblem;
use crate::monitor::Monitor;
use crate::solve::Settings;
use crate::tube::Load;
use serde::Serialize;

/// Largest number of relaxation steps in the search for the state with half the range.
const RELAXATION_STEPS: usize = 100;

/// A state with contact of half the range, compared with the state itself.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct HalfRange {
    /// Relative change of the strain energy W and of the contact force, that of the walls with themselves and on obstacles
    /// together; none if no equilibrium was found.
    pub changes: Option<RangeChanges>,
    /// Linear solves that it took.
    pub linear_solves: usize,
}

/// Relative changes with half the range of contact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RangeChanges {
    /// Of the strain energy W.
    pub energy: f64,
    /// Of the contact force.
    pub force: f64,
}

/// Brings a state of a plan that touches itself or an obstacle to equilibrium with half the range of contact. Returns none with
/// friction, which depends on the path, and if the monitor cancels.
pub fn half_range(
    plan: &Plan,
    load: &Load,
    u: &[f64],
    monitor: &mut dyn Monitor,
) -> Option<HalfRange> {
    let problem = plan.problem();
    // Friction depends on the path, and a driven volume needs its multiplier renewed.
    if problem.has_friction() || load.lumen_volume.is_some() {
        return None;
    }
    let mut half = plan.clone();
    half.mesh.contact_range *= 0.5;
    let settings = Settings {
        relaxation_steps: plan.solver.relaxation_steps.min(RELAXATION_STEPS),
        ..plan.solver.clone()
    };
    let with_half = half.problem();
    let found = find(&with_half, load, u, &settings, monitor);
    let solution = match found {
        Ok((solution, step)) => Some((solution, step.effort.linear_solves)),
        Err(error) if error.is_cancelled() => return None,
        Err(error) => {
            return Some(HalfRange {
                changes: None,
                linear_solves: error.step.effort.linear_solves,
            });
        }
    };
    let (found, linear_solves) = solution?;
    let [before, after] =
        [(&problem, u), (&with_half, &found[..])].map(|(p, u)| numbers(p, load, u));
    let changes = before.zip(after).map(|(before, after)| RangeChanges {
        energy: after[0] / before[0] - 1.0,
        force: after[1] / before[1] - 1.0,
    });
    Some(HalfRange {
        changes: changes.filter(|of| of.energy.is_finite() && of.force.is_finite()),
        linear_solves,
    })
}

/// Returns the strain energy and the contact force of a state; none if an element is inverted.
fn numbers(problem: &TubeProblem, load: &Load, u: &[f64]) -> Option<[f64; 2]> {
    let energy = problem.forces_on_tube(load, u).ok()?.energy;
    let report = problem.contact_report(load, u);
    let faces = report
        .iter()
        .flat_map(|report| report.faces.iter().flatten());
    let of_faces: f64 = faces.map(|face| face.force).sum();
    let obstacles = problem.obstacle_contacts(load, u);
    let of_obstacles: f64 = obstacles.iter().map(|contact| contact.force).sum();
    Some([energy, of_faces + of_obstacles])
}
