//! The solver's settings.

use super::super::problem::Problems;
use super::super::spec;
use crate::solve::{Integrator, PseudoTime, Scheme, Settings};

/// The settings that a case chooses.
pub(super) fn settings(solver: &spec::Solver, problems: &mut Problems) -> Settings {
    let scheme = match solver.scheme {
        spec::Scheme::Static => {
            if solver.pseudo_time.is_some() && problems.none_about(&["solver.scheme"]) {
                let rule = "has no meaning for the static scheme";
                let cure = "choose solver.scheme = \"newmark\" or \"dragged\", or leave it out";
                problems.key("solver.pseudo_time", rule, Some(cure.into()));
            }
            Scheme::Static
        }
        spec::Scheme::Newmark => pseudo_time(solver, Integrator::Newmark, 100.0),
        spec::Scheme::BackwardEuler => pseudo_time(solver, Integrator::BackwardEuler, 5.0),
    };
    Settings {
        scheme,
        tolerance: solver.tolerance,
        newton_iterations: solver.newton_iterations,
        relaxation_steps: solver.relaxation_steps,
        relaxation_damping: solver.relaxation_damping,
        max_step_halvings: solver.max_step_halvings,
    }
}

fn pseudo_time(solver: &spec::Solver, integrator: Integrator, usual_drag: f64) -> Scheme {
    let written = solver.pseudo_time.clone().unwrap_or_default();
    Scheme::PseudoTime(PseudoTime {
        integrator,
        damping: written.damping.unwrap_or(usual_drag),
        ramp: written.ramp,
        tolerance: written.tolerance,
        max_steps: written.max_steps,
        equilibrate: written.equilibrate,
    })
}
