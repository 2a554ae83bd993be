//! The settings of the solver.

use super::super::keys::{self, Scheme};
use super::super::problem::Problems;
use crate::solve::{self, Integrator, PseudoTime, Settings};

/// Returns the settings of the solver.
pub(super) fn settings(solver: &keys::Solver, problems: &mut Problems) -> Settings {
    let pseudo_time = |integrator, damping: f64| {
        let usual = PseudoTime::default();
        let written = solver.pseudo_time.as_ref();
        solve::Scheme::PseudoTime(written.map_or(
            PseudoTime {
                integrator,
                damping,
                ..usual
            },
            |written| PseudoTime {
                integrator,
                damping: written.damping.unwrap_or(damping),
                ramp: written.ramp,
                tolerance: written.tolerance,
                max_steps: written.max_steps,
                equilibrate: written.equilibrate,
            },
        ))
    };
    if matches!(solver.scheme, Scheme::Static)
        && solver.pseudo_time.is_some()
        && problems.are_sound(&["solver.scheme"])
    {
        let rule = "has no meaning for the static scheme";
        let help = "set solver.scheme = \"newmark\" or \"backward-euler\", or leave it out";
        problems.key("solver.pseudo_time", rule, help);
    }
    Settings {
        scheme: match solver.scheme {
            Scheme::Static => solve::Scheme::Static,
            Scheme::Newmark => pseudo_time(Integrator::Newmark, 100.0),
            Scheme::BackwardEuler => pseudo_time(Integrator::BackwardEuler, 5.0),
        },
        tolerance: solver.tolerance,
        newton_iterations: solver.newton_iterations,
        relaxation_steps: solver.relaxation_steps,
        relaxation_damping: solver.relaxation_damping,
        max_step_halvings: solver.max_step_halvings,
    }
}
