//! Tubes with layers, fibres and residual stresses, from the case file to accepted states.

use plica::assembly::Point;
use plica::saved_state::SavedState;
use plica::study::{State, Study};
use plica::{case, case::InputFile};

/// Runs a case to its end.
fn run(text: &str) -> (Study, Vec<State>) {
    let plan = case::read(text, "case").unwrap();
    let mut study = Study::new(&plan).unwrap();
    let states: Vec<State> = study.by_ref().map(Result::unwrap).collect();
    (study, states)
}

/// Returns the current radius of a point in the middle of the tube, in D, and its angle.
fn place(study: &Study, state: &State, radius: f64) -> (f64, f64) {
    let tube = study.tube();
    let at = Point {
        z: 0.5 * tube.tube.length,
        radius,
        angle: 0.0,
    };
    let [_, x, y] = tube.sample(&state.load, &state.unknowns, at).position;
    (x.hypot(y), y.atan2(x))
}

#[test]
fn the_carotid_artery_has_the_radii_that_its_case_describes() {
    let text = include_str!("../../../cases/carotid.toml");
    let (study, states) = run(text);
    let inner = study.tube().tube.inner_radius();
    for (stage, expected) in [
        ("inflate", [1.06225501, 1.24248370]),
        ("to-mean-pressure", [1.18939766, 1.35261592]),
    ] {
        let state = states.iter().rfind(|state| state.stage == stage).unwrap();
        let [a, b] = [inner, 0.5].map(|radius| 2.2 * place(&study, state, radius).0);
        // Up to the deviation of the spline from a circle.
        assert!((a / expected[0] - 1.0).abs() < 2e-7, "{a}");
        assert!((b / expected[1] - 1.0).abs() < 2e-7, "{b}");
        assert!(text.contains(&format!("{:.8}", expected[0])));
    }
}

#[test]
fn an_artery_of_three_layers_has_the_radii_that_its_case_describes() {
    let text = include_str!("../../../cases/three-layer-artery.toml");
    let (study, states) = run(text);
    let inner = study.tube().tube.inner_radius();
    for (stage, expected) in [
        ("diastolic", [7.50876041, 8.31909222]),
        ("systolic", [7.78303495, 8.56287970]),
    ] {
        let state = states.iter().rfind(|state| state.stage == stage).unwrap();
        let [a, b] = [inner, 0.5].map(|radius| 14.0 * place(&study, state, radius).0);
        assert!((a / expected[0] - 1.0).abs() < 1e-6, "{a}");
        assert!((b / expected[1] - 1.0).abs() < 1e-6, "{b}");
        let printed = expected
            .iter()
            .all(|radius| text.contains(&format!("{radius:.8}")));
        assert!(printed, "{stage}");
    }
}

/// A short tube of two layers; `keys` are those of the outer one.
fn two_layers(keys: &str, rest: &str) -> String {
    format!(
        "[tube]\nlength = 0.2\n\
         [[layers]]\nname = 'inner'\nthickness = 0.02\nelements = 1\n\
         [[layers]]\nname = 'outer'\nthickness = 0.04\nelements = 2\n{keys}\n\
         [ends]\ncolon = 'sliding'\nileum = 'sliding'\n\
         [mesh]\ncontrol_points = {{ axial = 5, around = 24 }}\n{rest}"
    )
}

#[test]
fn a_tube_with_residual_stress_takes_its_own_shape_without_load() {
    let text = two_layers(
        "residual = { around = [0.9, 1.1] }",
        "[[stages]]\nsteps = 1\ndrive.ileum.displacement = 1e-3\n",
    );
    let (study, states) = run(&text);
    let first = &states[0];
    assert!(first.relative_residual < 1e-8 && first.energy > 0.0);
    // It bends: the outer layer is stretched inside and compressed outside.
    let stress = |radius: f64| {
        let at = Point {
            z: 0.1,
            radius,
            angle: 0.0,
        };
        let sample = study.tube().sample(&first.load, &first.unknowns, at);
        sample.wall_stresses()[2]
    };
    assert!(stress(0.461) > 0.0 && stress(0.499) < 0.0);
}

#[test]
fn a_muscle_in_one_layer_contracts_the_tube_less_than_in_all() {
    let narrowest = |layer: &str| {
        let muscle = format!(
            "[muscles.ring]\ndirection = 'circular'\nzone = [0.0, 0.2]\n{layer}\n\
             profile = {{ table = [[0.0, 1.0], [1.0, 1.0]] }}\n\
             [[stages]]\nsteps = 2\ndrive.ring.diameter_ratio = 0.8\n"
        );
        let (study, states) = run(&two_layers("", &muscle));
        place(&study, &states[2], 0.5).0
    };
    let [all, outer] = ["", "layer = 'outer'"].map(narrowest);
    assert!(all < 0.5 * 0.85, "{all}");
    assert!(outer > all + 0.01 && outer < 0.45, "{outer}");
}

#[test]
fn fibres_of_one_hand_turn_a_sliding_end_and_a_state_of_theirs_starts_a_run() {
    let fibres = |pair: bool| {
        format!("fibres = [{{ k1 = 1.0, k2 = 1.0, angle_degrees = 35.0, pair = {pair} }}]")
    };
    let stage = "[[stages]]\nsteps = 3\ndrive.inner-wall.pressure = 0.03\n";
    let turn = |pair: bool| {
        let (study, states) = run(&two_layers(&fibres(pair), stage));
        let tube = study.tube();
        let state = states.last().unwrap();
        let angle = |z: f64| {
            let at = Point {
                z,
                radius: 0.48,
                angle: 0.0,
            };
            let [_, x, y] = tube.sample(&state.load, &state.unknowns, at).position;
            y.atan2(x)
        };
        (angle(0.2) - angle(0.0), study)
    };
    assert!(turn(false).0.abs() > 1e-3);
    let (angle, study) = turn(true);
    assert!(angle.abs() < 1e-9, "{angle}");
    // The saved state has the layers of its mesh; three dimensions start from it.
    let saved = study.continuation().unwrap();
    let bytes = SavedState {
        stage: "a".into(),
        row: 3,
        along: 1.0,
        muscles: vec![],
        obstacles: vec![],
        patches: vec![],
        load: saved.load.clone(),
        layout: study.plan().layout(),
        u: saved.unknowns.clone(),
        arrays: [].into(),
    };
    let bytes = bytes.to_bytes().unwrap();
    let text = two_layers(
        &fibres(true),
        "[[stages]]\nsteps = 1\ndrive.inner-wall.pressure = 0.031\n[start]\nstate = 's'\n",
    );
    let text = format!("symmetry = 'none'\n{text}");
    let open = |_: InputFile<'_>| SavedState::from_bytes(&bytes).map(Into::into);
    let plan = case::read_with(&text, "case", &open).unwrap();
    let mut study = Study::new(&plan).unwrap();
    let first = study.next().unwrap().unwrap();
    assert!(
        first.relative_residual < 1e-7,
        "{}",
        first.relative_residual
    );
}
