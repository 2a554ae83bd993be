//! Checks the rules between keys, and makes a case dimensionless: lengths in D, stresses in E. One
//! file for each table of the case.
//!
//! A rule between keys is checked only where nothing is wrong with the keys themselves, so that one
//! mistake gives one message.

mod contact;
mod continuation;
mod imperfections;
pub(super) mod law;
mod layers;
mod lumen;
mod material;
mod mesh;
mod muscles;
mod named_materials;
mod obstacles;
mod outline;
mod patches;
mod region;
mod residual;
mod sideways;
mod solver;
mod stages;
mod start;
mod targets;
mod tube;
mod zone;

use super::files::OpenInput;
use super::keys::Case;
use super::problem::Problems;
use crate::study::{Output, Plan, Units};

/// Returns the plan of a case. It is valid only if no problems were found.
pub(super) fn plan(case: &Case, name: &str, open: &OpenInput<'_>, problems: &mut Problems) -> Plan {
    let mut case = case.clone();
    let materials = named_materials::look_up(&mut case, open, problems);
    let case = &case;
    let mut tube = tube::tube(case, problems);
    let (mesh, symmetry) = mesh::mesh(case, &tube, problems);
    tube.obstacles = obstacles::obstacles(case, problems);
    let start = start::start(case, &tube, &mesh, symmetry, open, problems);
    let begin = start
        .as_ref()
        .map_or(tube.rest(), |start| start.load.clone());
    let run = (&mesh, symmetry);
    let (mut imperfections, modes) = imperfections::imperfections(case, &tube, run, open, problems);
    imperfections.extend(outline::outline(case, &tube, problems));
    tube.imperfections = imperfections;
    let volume_at_rest = lumen::volume_at_rest(case, &tube, run, problems);
    let stages = stages::stages(case, &tube, &begin, volume_at_rest, problems);
    if start.is_some() == case.start.is_some() {
        stages::check_all(&tube, &begin, &stages, problems);
    }
    imperfections::check_stretches(&tube, &stages, problems);
    patches::check_stretches(&tube, &stages, problems);
    imperfections::check_wall(case, &tube, run, problems);
    stages::check_end_planes(&tube, &stages, problems);
    lumen::check_ends(&stages, problems);
    sideways::check(symmetry, &stages, problems);
    contact::check(case, symmetry, &tube, &stages, problems);
    obstacles::check(case, &tube, run, (&begin, &stages), problems);
    let following = continuation::following(case, &tube, symmetry, (&begin, &stages), problems);
    let title = case.title.clone().unwrap_or_else(|| name.to_owned());
    let output = &case.output;
    let plan = Plan {
        title: title.replace(char::is_control, " "),
        tube,
        mesh,
        symmetry,
        contact: case.contact,
        friction: case.friction,
        start,
        modes,
        materials,
        stages,
        following,
        solver: solver::settings(&case.solver, problems),
        output: Output {
            pictures: output.pictures,
            profiles_every: output.profiles_every,
            states_every: output.states_every,
            stability_modes: output.stability_modes,
            wall_points: output.wall_points,
        },
        end_names: muscles::end_names(case, problems),
        units: case.units.as_ref().map(|units| Units {
            length: units.length,
            stress: units.stress,
            diameter: case.tube.diameter,
            youngs_modulus: material::youngs_modulus(case),
        }),
    };
    continuation::check_columns(&plan, problems);
    plan
}
