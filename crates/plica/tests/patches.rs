//! Patches, sectors of muscles and foundations in studies.

use plica::case;
use plica::study::{Row, Scale, State, Study};

fn states(text: &str) -> Vec<State> {
    let plan = case::read(text, "patches").unwrap();
    Study::new(&plan)
        .unwrap()
        .map(|state| state.unwrap())
        .collect()
}

fn rows(text: &str) -> Vec<Row> {
    let mut rows: Vec<Row> = vec![];
    for state in states(text) {
        let row = Row::new(&state, &Scale::of(None), false, rows.last());
        rows.push(row);
    }
    rows
}

/// A band that grows and stiffens the wall, on springs, while a muscle contracts.
fn band(steps: usize) -> String {
    format!(
        "tube = {{ length = 1.5, thickness = 0.1 }}\n\
         mesh = {{ control_points = {{ axial = 14, around = 12, thickness = 4 }}, refine = [] }}\n\
         solver.tolerance = 1e-9\n\
         output.stability_modes = 2\n\
         muscles.ring = {{ direction = 'circular', zone = [0.3, 1.2] }}\n\
         [[patches]]\nname = 'scar'\nzone = [0.2, 1.0]\nstiffness = 2.0\nmuscles = {{ ring = 0.5 }}\n\
         [[foundations]]\nstiffness = 0.3\n\
         [[stages]]\nsteps = {steps}\ndrive.scar.growth_through = 1.4\ndrive.ring.diameter_ratio = 0.8\n"
    )
}

#[test]
fn the_energy_balance_closes_with_a_patch_that_grows_on_a_foundation() {
    let gap = |steps: usize| {
        let rows = rows(&band(steps));
        let last = rows.last().unwrap();
        let foundation = last.foundation_energy.unwrap();
        let parts = [last.patches[0].work, last.muscles[0].work, foundation];
        let all: f64 = parts.iter().map(|x| x.abs()).sum();
        assert!(parts.iter().all(|x| x.abs() > 1e-3 * all), "{parts:?}");
        let sum = last.patches[0].work + last.muscles[0].work;
        let ends: f64 = last.ends.iter().map(|end| end.work).sum();
        let gained = last.energy + foundation - rows[0].energy;
        assert!((sum + ends - gained - last.released_energy).abs() < 1e-12 * all);
        assert!((last.patches[0].growth_through - 1.4).abs() < 1e-12);
        (last.released_energy / all).abs()
    };
    let [coarse, fine] = [3, 6].map(gap);
    println!("{coarse:e} {fine:e}");
    assert!(coarse < 2e-2 && fine < coarse / 3.5, "{coarse} {fine}");
}

/// A tube with a patch and a muscle in sectors, and a mesentery.
fn sectors(symmetry: &str, repeat: usize) -> String {
    let sector =
        |width: usize| format!("sector = {{ width_degrees = {width}, repeat = {repeat} }}");
    format!(
        "symmetry = {symmetry}\n\
         tube = {{ length = 1.5, thickness = 0.1 }}\n\
         mesh = {{ control_points = {{ axial = 8, around = 12, thickness = 4 }}, refine = [] }}\n\
         output.stability_modes = 0\n\
         [muscles.ring]\ndirection = 'circular'\nzone = [0.3, 1.2]\n{}\n\
         [[patches]]\nname = 'scar'\nzone = [0.2, 1.0]\nstiffness = 2.0\n{}\n\
         [[foundations]]\nstiffness = 0.1\ndirection = 'normal'\n{}\n\
         [[stages]]\nsteps = 1\ndrive.scar.growth_through = 1.05\ndrive.ring.diameter_ratio = 0.9\n",
        sector(90),
        sector(60),
        sector(50),
    )
}

#[test]
fn a_fold_has_the_path_of_the_whole_tube() {
    let [whole, fold] = [("'none'", 2), ("{ fold = 2 }", 1)]
        .map(|(symmetry, repeat)| states(&sectors(symmetry, repeat)).pop().unwrap());
    for state in [&whole, &fold] {
        assert!(state.relative_residual < 1e-8 && state.measures.asymmetry.amplitude > 1e-3);
    }
    let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-6, "{a} {b}");
    near(whole.energy, fold.energy);
    near(
        whole.foundation_energy.unwrap(),
        fold.foundation_energy.unwrap(),
    );
    near(whole.measures.lumen, fold.measures.lumen);
}

#[test]
fn the_sides_of_a_tube_whose_muscle_has_a_sector_differ() {
    let text = "symmetry = 'none'\n\
        tube = { length = 1.5, thickness = 0.1 }\n\
        mesh = { control_points = { axial = 8, around = 12, thickness = 4 }, refine = [] }\n\
        [muscles.ring]\ndirection = 'circular'\nzone = [0.3, 1.2]\n\
        sector = { centre_degrees = 90, width_degrees = 180 }\n\
        [output]\nstability_modes = 0\n[[stages]]\nsteps = 1\ndrive.ring.diameter_ratio = 0.8\n";
    let state = states(text).pop().unwrap();
    assert!(state.relative_residual < 1e-7);
    let plan = case::read(text, "sector").unwrap();
    let study = Study::new(&plan).unwrap();
    let at = |degrees: f64| {
        let point = plica::assembly::Point {
            z: 0.75,
            radius: 0.45,
            angle: degrees.to_radians(),
        };
        study.tube().sample(&state.load, &state.unknowns, point)
    };
    let [active, passive, left, right] = [90.0, 270.0, 0.0, 180.0].map(at);
    assert!((active.grown[1] - 0.8).abs() < 1e-12 && passive.grown[1] == 1.0);
    // The mirror images of the two sides.
    let [a, b] = [left, right].map(|side| side.position);
    assert!((a[0] - b[0]).abs() < 1e-7 && (a[1] + b[1]).abs() < 1e-7 && (a[2] - b[2]).abs() < 1e-7);
    // The active side is drawn flat.
    let inwards = |sample: &plica::assembly::Sample| {
        sample.reference[2].abs() - (sample.position[2] - 0.0).abs()
    };
    assert!(
        inwards(&active) > 2.0 * inwards(&passive).abs(),
        "{active:?}"
    );
}

/// Returns the last row of a case of the workspace on a small mesh, with some of its values changed.
fn small(text: &str, changes: &[(&str, &str)]) -> Row {
    let points = "{ axial = 16, around = 12, thickness = 4 }";
    let all = [
        ("mesh.control_points", points),
        ("output.stability_modes", "0"),
    ];
    let changes: Vec<(&str, &str)> = all.iter().chain(changes).copied().collect();
    rows(&case::edited(text, &changes).unwrap()).pop().unwrap()
}

#[test]
fn cases_with_sectors_lean_to_the_side_that_their_comments_name() {
    let contract = [
        ("stages[1].steps", "1"),
        ("stages[1].drive.circular.diameter_ratio", "0.8"),
    ];
    let half = small(
        include_str!("../../../cases/half-circumference.toml"),
        &contract,
    );
    assert!(half.residual < 1e-6 && half.asymmetry > 0.02, "{half:?}");
    assert_eq!(half.asymmetry_mode, 1);
    assert!(
        (half.asymmetry_angle_deg.abs() - 180.0).abs() < 1e-3,
        "{half:?}"
    );

    let hung = small(include_str!("../../../cases/mesentery.toml"), &contract);
    assert!(hung.residual < 1e-6 && hung.asymmetry > 0.02, "{hung:?}");
    let springs = hung.foundation_energy.unwrap();
    assert!(
        springs > 0.1 * hung.energy && springs < hung.energy,
        "{hung:?}"
    );

    let grow = [
        ("stages[1].steps", "1"),
        ("stages[1].drive.polyp.growth_through", "1.2"),
        ("stages[2].steps", "1"),
        ("stages[2].drive.circular.diameter_ratio", "0.95"),
    ];
    let polyp = small(include_str!("../../../cases/lead-point.toml"), &grow);
    assert!(polyp.residual < 1e-6 && polyp.patches[0].growth_through == 1.2);
    assert!(
        polyp.patches[0].work > 0.0 && polyp.lumen < 0.87,
        "{polyp:?}"
    );
}
