//! What the keys of a case must fulfil together, and their scaling to lengths in D and stresses
//! in E. One file a table of the case.
//!
//! Rules about several keys are looked at only where nothing is wrong with the single ones they read, so that one slip gives one
//! message, and several slips are all told at once.

mod imperfections;
mod mesh;
mod muscles;
mod solver;
mod stages;
mod start;
mod tube;

use super::Open;
use super::problem::Problems;
use super::spec::{self, Spec};
use crate::study::{LengthUnit, Output, Plan, StressUnit, Units};

/// The plan that a case means. It is worth something only if no problems were found.
pub(super) fn plan(spec: &Spec, name: &str, open: &Open<'_>, problems: &mut Problems) -> Plan {
    let spec::Material::NeoHookean(law) = &spec.material;
    let units = spec.units.as_ref().map(|units| Units {
        length: match units.length.as_str() {
            "um" => LengthUnit::Micrometre,
            "mm" => LengthUnit::Millimetre,
            "cm" => LengthUnit::Centimetre,
            _ => LengthUnit::Metre,
        },
        stress: match units.stress.as_str() {
            "kPa" => StressUnit::Kilopascal,
            "MPa" => StressUnit::Megapascal,
            _ => StressUnit::Pascal,
        },
        diameter: spec.tube.diameter,
        youngs_modulus: law.youngs_modulus,
    });
    let mut tube = tube::tube(spec, problems);
    let (mesh, symmetry) = mesh::mesh(spec, &tube, problems);
    let start = start::start(spec, &tube, &mesh, symmetry, open, problems);
    let begin = start
        .as_ref()
        .map_or(tube.rest(), |start| start.load.clone());
    let stages = stages::stages(spec, &tube, &begin, problems);
    if start.is_some() == spec.start.is_some() {
        stages::check_whole(&tube, &begin, &stages, problems);
    }
    let run = (&mesh, symmetry);
    let (imperfections, modes) = imperfections::imperfections(spec, &tube, run, open, problems);
    tube.imperfections = imperfections;
    imperfections::check_stretches(&tube, &stages, problems);
    imperfections::check_wall(spec, &tube, run, problems);
    stages::check_planes(&tube, &stages, problems);
    let solver = solver::settings(&spec.solver, problems);
    let title = spec.title.clone().unwrap_or_else(|| name.to_owned());
    Plan {
        title: title.replace(char::is_control, " "),
        tube,
        mesh,
        symmetry,
        start,
        modes,
        stages,
        solver,
        output: Output {
            pictures: spec.output.pictures,
            profiles_every: spec.output.profiles_every,
            states_every: spec.output.states_every,
            stability_modes: spec.output.stability_modes,
            wall_points: spec.output.wall_points,
        },
        units,
    }
}

/// A stretch of the tube, in D, held against the rules for zones.
fn zone(key: &str, spec: &Spec, zone: [f64; 2], length: f64, problems: &mut Problems) -> [f64; 2] {
    let [from, to] = zone.map(|z| z / spec.tube.diameter);
    if !problems.none_about(&[key]) {
        return [from, to];
    }
    if from >= to {
        let cure = (from > to).then(|| format!("try [{}, {}]", zone[1], zone[0]));
        problems.value(key, "must be [from, to] with from below to", cure);
    } else if !problems.none_about(&["tube.length", "tube.diameter"]) {
        return [from, to];
    } else if from < 0.0 || to > length * (1.0 + ROUNDING) {
        let end = length * spec.tube.diameter;
        problems.value(key, format!("must lie within the tube, 0 to {end}"), None);
    } else if to - from < 1e-3 {
        problems.value(
            key,
            "must be at least a thousandth of the diameter long",
            None,
        );
    }
    [from, to.min(length)]
}

/// What scaling to D may do to a length.
const ROUNDING: f64 = 1e-12;
