//! Tests of the whole way from a text to a plan, or to its problems.

mod declarations;
mod materials;
mod mistakes;
mod rules;

use super::key::visit;
use super::*;
use crate::material::{LengthTension, Tone};
use crate::saved_state::{Array, Layout, SavedState};
use crate::tube;
use std::path::{Path, PathBuf};

/// A library of materials of a user.
const MATERIALS: &str = "
[carotid-media-hgo-2000]
material.yeoh = { c1 = 2.0, bulk = 512.0 }
[soft]
stress = 'Pa'
material.fung = { c = 500.0, along = 1.0, around = 1.5, bulk = 64000.0 }
fibres = [{ k1 = 2000.0, k2 = 0.5, angle_degrees = 30.0 }]
";

/// A valid case with a table of every kind. Its diameter and its modulus are powers of two.
const RICH: &str = r#"
title = "rich"
symmetry = { fold = 2 }
[units]
length = "mm"
stress = "kPa"
[tube]
diameter = 16.0
length = 80.0
thickness = 1.0
[material.neo-hookean]
youngs_modulus = 64.0
poisson_ratio = 0.4
volumetric = "quadratic"
[[layers]]
name = "inner"
thickness = 0.5
elements = 1
[[layers]]
name = "media"
thickness = 0.5
elements = 1
material = { yeoh = { c1 = 4.0, c2 = 2.0, c3 = 1.0, bulk = 512.0 } }
fibres = [{ k1 = 8.0, k2 = 0.5, angle_degrees = 30.0, dispersion = 0.125 }]
residual = { around = [0.875, 1.125] }
tone = { tension = 2.0, best_stretch = 1.5, least_stretch = 0.75 }
[muscles.ring]
direction = "circular"
zone = [56.0, 72.0]
profile = "half-sine"
layer = "media"
[muscles.next]
direction = "circular"
zone = [72.0, 76.0]
repeat = 8.0
profile = { smooth-box = { edge = 0.25 } }
[muscles.long]
direction = "longitudinal"
zone = [56.0, 72.0]
profile = { table = [[0.0, 0.0], [0.5, 1.0], [1.0, 0.0]] }
[muscles.taenia]
direction = "longitudinal"
zone = [8.0, 24.0]
active_stress = { angle_degrees = 80.0, best_stretch = 1.25, least_stretch = 0.5 }
[ends]
colon = "fixed"
ileum = "sliding"
[mesh]
control_points = { axial = 40, around = 24 }
degree = 3
volumetric_integration = "reduced"
refine = [{ zone = [64.0, 68.0], factor = 2.0 }]
[[stages]]
name = "both"
steps = 3
drive.ring.diameter_ratio = 0.8
drive.long.length_ratio = 1.1
drive.ileum.displacement = -2.0
drive.colon.twist_degrees = 10
[[stages]]
drive.inner-wall.pressure = 0.5
drive.outer-wall.dead_load = 0.25
drive.next = { diameter_ratio = 0.9, shift = 1.0 }
drive.taenia.tension = 16.0
drive.scar.growth_through = 1.5
drive.bolus = { position = [0.0, 0.0, 4.0], radius = 3.0 }
[[obstacles]]
name = "bolus"
shape = { ball = { radius = 4.0, position = [0.0, 0.0, -8.0] } }
[[obstacles]]
name = "scope"
shape = { rod = { radius = 2.0, length = 16.0, position = [0.5, 0.0, 90.0] } }
[[obstacles]]
name = "sleeve"
shape = { sheath = { radius = 10.0, position = [0.0, 0.25, 0.0] } }
[[obstacles]]
name = "spine"
shape = { plate = { position = [0.0, -16.0, 0.0], normal = [0.0, 3.0, 4.0] } }
[[patches]]
name = "scar"
zone = [16.0, 32.0]
edge = 4.0
layer = "media"
stiffness = 2.0
muscles = { ring = 0.25 }
sector = { width_degrees = 40.0, repeat = 2 }
[[foundations]]
zone = [8.0, 72.0]
edge = 2.0
stiffness = 0.5
direction = "normal"
tension_only = true
[[imperfections]]
of = "colon-end"
direction = "axial"
amplitude = 0.01
shape = { wave = { mode = 2, phase_degrees = 20 } }
[[imperfections]]
of = { muscle = "ring" }
amplitude = 0.1
shape = { random = { seed = 7, modes = 4, half_waves = 2 } }
[[imperfections]]
of = "geometry"
amplitude = 0.01
shape = { wave = { mode = 4, axial = { zone = [16.0, 32.0] } } }
[solver]
scheme = "newmark"
tolerance = 1e-7
newton_iterations = 20
relaxation_steps = 100
relaxation_damping = 2.0
max_step_halvings = 6
pseudo_time = { damping = 50.0, ramp = 5, tolerance = 1e-6, max_steps = 1000, equilibrate = false }
[output]
pictures = false
profiles_every = 2
states_every = 2
stability_modes = 2
wall_points = 101
"#;

/// The folder of the workspace.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The case files of the workspace, by their names, but those that start from a state of another run.
fn cases() -> Vec<(String, String)> {
    let files = std::fs::read_dir(root().join("cases")).unwrap();
    let paths = files.map(|entry| entry.unwrap().path());
    let case = |path: PathBuf| {
        let name = path.file_stem()?.to_str()?.to_owned();
        let is_case = path.extension()? == "toml";
        let case = is_case.then(|| (name, std::fs::read_to_string(&path).unwrap()));
        case.filter(|(_, text)| !text.contains("start.state"))
    };
    paths.filter_map(case).collect()
}

/// Reads a text that must have problems.
fn problems(text: &str) -> Vec<Problem> {
    let error = read(text, "case").expect_err(text);
    error.problems
}

/// A saved state of the usual tube at rest, and an oval mode of it, in a file.
fn state() -> SavedState {
    let layout = Layout {
        length: 3.0,
        thickness: 0.06,
        mesh: tube::Mesh {
            axial: 4,
            around: 8,
            thickness: 4,
            degree: 3,
            refinements: vec![],
            grading: 1.0,
            contact_range: 0.25,
            volumetric: tube::Integration::Full,
            layers: vec![],
        },
        rings: 1,
    };
    let array = |shape: Vec<usize>, value| Array {
        values: vec![value; shape.iter().product()],
        shape,
    };
    SavedState {
        stage: "rest".into(),
        row: 0,
        along: 0.0,
        obstacles: vec![],
        patches: vec![],
        muscles: vec![],
        load: tube::Load {
            muscles: vec![],
            shifts: vec![],
            ends: Default::default(),
            pressures: Default::default(),
            lumen_volume: None,
            obstacles: vec![],
            patches: vec![],
        },
        u: vec![0.0; layout.unknowns()],
        layout,
        arrays: [
            ("mode".to_owned(), array(vec![4, 4, 3], 1.0)),
            ("harmonic".to_owned(), array(vec![], 2.0)),
        ]
        .into(),
    }
}

#[test]
fn the_cases_of_the_workspace_are_valid_and_describe_the_same_tube() {
    let cases = cases();
    let plan = |name: &str| {
        let (_, text) = cases.iter().find(|(own, _)| own == name).unwrap();
        read(text, name).unwrap()
    };
    for (name, text) in &cases {
        read(text, name).unwrap_or_else(|error| panic!("{name}: {error}"));
    }
    let (main, mm) = (plan("invagination"), plan("millimetres"));
    assert_eq!((&main.tube, &main.mesh), (&mm.tube, &mm.mesh));
    assert_eq!(main.stages, mm.stages);
    assert_eq!(mm.units.unwrap().diameter, 25.0);
    assert_eq!(main.tube, plan("paper-scheme").tube);
    let starter = read(STARTER, "starter").unwrap();
    assert_eq!((main.tube, main.mesh), (starter.tube, starter.mesh));
}

#[test]
fn the_commented_keys_of_the_starter_are_valid() {
    let mut count = 0;
    let lines = STARTER.lines().map(|line| match line.strip_prefix("# ") {
        Some(key) if key.starts_with('[') || key.contains(" = ") => {
            count += 1;
            key
        }
        _ => line,
    });
    let text: Vec<&str> = lines.collect();
    let plan = read(&text.join("\n"), "starter").unwrap();
    assert!(plan.units.is_some() && count == 4);
}

#[test]
fn the_plan_has_the_values_of_the_text() {
    let text = "symmetry = { fold = 4 }\n\
        [tube]\ndiameter = 2.0\nlength = 5.0\n\
        [ends]\nileum = 'sliding'\n\
        [muscles.m]\ndirection = 'longitudinal'\nzone = [1.0, 4.0]\n\
        profile = { smooth-box = { edge = 0.25 } }\n\
        [[stages]]\ndrive.m.length_ratio = 1.25\ndrive.colon.twist_degrees = 180\n\
        [[stages]]\nname = 'push'\nsteps = 3\ndrive.ileum.displacement = -0.5\n\
        [solver]\nscheme = 'backward-euler'\n";
    let plan = read(text, "named").unwrap();
    assert_eq!((plan.title.as_str(), plan.tube.length), ("named", 2.5));
    assert_eq!(
        (plan.tube.thickness, plan.tube.muscles[0].zone),
        (0.06, [0.5, 2.0])
    );
    assert_eq!(plan.mesh.rings(plan.symmetry), 15);
    // Elements end at the kinks of the profile.
    let edges: Vec<f64> = plan.mesh.refinements.iter().map(|r| r.to).collect();
    assert_eq!(edges, [0.875, 1.625, 2.0]);

    let names: Vec<&str> = plan.stages.iter().map(|s| s.name.as_str()).collect();
    assert_eq!((names, plan.stages[1].steps), (vec!["stage-1", "push"], 3));
    // Targets that a stage does not name stay as they are.
    let load = &plan.stages[1].load;
    assert_eq!(
        (load.muscles[0], load.ends[0].twist),
        (1.25, std::f64::consts::PI)
    );
    assert_eq!(load.ends[1].displacement, -0.25);
    let crate::solve::Scheme::PseudoTime(scheme) = plan.solver.scheme else {
        panic!("{:?}", plan.solver.scheme)
    };
    assert_eq!(scheme.integrator, crate::solve::Integrator::BackwardEuler);
    assert_eq!(
        (scheme.damping, scheme.ramp, scheme.equilibrate),
        (5.0, 10, true)
    );
}

#[test]
fn the_plan_is_dimensionless() {
    let plan = read(RICH, "rich").unwrap();
    assert_eq!((plan.tube.length, plan.tube.thickness), (5.0, 0.0625));
    assert_eq!(plan.tube.muscles[2].zone, [3.5, 4.5]);
    let [first, second] = &plan.stages[..] else {
        panic!("{:?}", plan.stages)
    };
    assert_eq!(first.load.ends[1].displacement, -0.125);
    assert_eq!(first.load.ends[0].twist, 10_f64.to_radians());
    let [inner, outer] = second.load.pressures;
    assert_eq!((inner.follower, outer.dead), (0.5 / 64.0, 0.25 / 64.0));
    assert_eq!((inner.dead, outer.follower), (0.0, 0.0));
    // Positions are (z, x, y).
    let [bolus, scope, _, spine] = &plan.tube.obstacles[..] else {
        panic!("{:?}", plan.tube.obstacles)
    };
    let placement = |radius, position| tube::Placement { radius, position };
    assert_eq!(bolus.rest, placement(0.25, [-0.5, 0.0, 0.0]));
    assert_eq!(
        second.load.obstacles[0],
        placement(3.0 / 16.0, [0.25, 0.0, 0.0])
    );
    assert_eq!(scope.rest, placement(0.125, [5.625, 0.03125, 0.0]));
    assert_eq!(scope.shape, tube::ObstacleShape::Rod { half_length: 0.5 });
    let normal = [0.8, 0.0, 0.6];
    assert_eq!(spine.shape, tube::ObstacleShape::Plate { normal });
    let [patch, foundation] = [plan.tube.patches[0].region, plan.tube.foundations[0].region];
    assert_eq!((patch.zone, patch.edge), ([1.0, 2.0], 0.25));
    assert_eq!((foundation.zone, foundation.edge), ([0.5, 4.5], 0.125));
    assert_eq!(plan.tube.patches[0].muscles, [1.0, 1.0, 0.25, 1.0]);
    let taenia = &plan.tube.muscles[3];
    let relation = LengthTension::Rachev {
        best: 1.25,
        least: 0.5,
    };
    let tone = Tone::new(1.0, relation, 80_f64.to_radians());
    assert_eq!(taenia.active_stress, Some(tone));
    assert_eq!((first.load.muscles[3], second.load.muscles[3]), (0.0, 0.25));
    assert_eq!(second.load.patches, [1.5]);
    // 0.5 kPa/mm of a diameter of 16 mm and a modulus of 64 kPa.
    assert_eq!(plan.tube.foundations[0].stiffness, 0.125);
    let [end, muscle, geometry] = &plan.tube.imperfections[..] else {
        panic!("{:?}", plan.tube.imperfections)
    };
    // Lengths are in the diameter, shares of an activity are not.
    let amplitudes = [end, muscle, geometry].map(|imperfection| imperfection.amplitude);
    assert_eq!(amplitudes, [0.01 / 16.0, 0.1, 0.01 / 16.0]);
    let [end, geometry] = [end, geometry].map(|imperfection| imperfection.shape.waves()[0]);
    assert_eq!((end.harmonic, end.phase), (2, 20_f64.to_radians()));
    assert_eq!(end.axial, tube::Axial::Uniform);
    assert_eq!(geometry.axial, tube::Axial::Zone([1.0, 2.0]));
    let last = plan.mesh.refinements.last().unwrap();
    assert_eq!((last.from, last.to, last.factor), (4.0, 4.25, 2.0));
}

#[test]
fn the_reference_page_is_up_to_date() {
    let page = root().join("docs/case-file.md");
    if std::env::var_os("PLICA_BLESS").is_some() {
        std::fs::write(&page, reference()).unwrap();
    }
    let written = std::fs::read_to_string(page).unwrap_or_default();
    assert!(
        written == reference(),
        "docs/case-file.md is out of date; PLICA_BLESS=1 cargo test rewrites it"
    );
}
