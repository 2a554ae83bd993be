//! Muscles whose activity is a stress, from the case file to accepted states.

use plica::assembly::Point;
use plica::case;
use plica::measure::Shape;
use plica::study::{Plan, Row, RowReader, Scale, State, Study};

fn plan(text: &str) -> Plan {
    case::read(text, "case").unwrap_or_else(|error| panic!("{error}"))
}

fn states(plan: &Plan) -> Vec<State> {
    Study::new(plan).unwrap().map(Result::unwrap).collect()
}

/// A short tube in kPa with a ring that contracts by a stress, and one that contracts by growth.
fn tube(muscle: &str, rest: &str) -> String {
    format!(
        "units = {{ length = 'mm', stress = 'kPa' }}\n\
         material.neo-hookean = {{ youngs_modulus = 20.0, poisson_ratio = 0.45 }}\n\
         [tube]\ndiameter = 2.0\nlength = 4.0\nthickness = 0.2\n\
         [mesh]\nrefine = []\ncontrol_points = {{ axial = 19, around = 12, thickness = 4 }}\n\
         [output]\nstability_modes = 0\n[solver]\ntolerance = 1e-11\n\
         [muscles.ring]\ndirection = 'circular'\nzone = [1.0, 3.0]\n{muscle}\n\
         [muscles.growing]\ndirection = 'circular'\nzone = [0.5, 2.0]\n{rest}"
    )
}

const RACHEV: &str = "active_stress = { best_stretch = 1.1, least_stretch = 0.5 }";

#[test]
fn an_artery_constricts_to_the_radius_that_its_case_describes() {
    let text = include_str!("../../../cases/vasoconstriction.toml");
    let mut study = Study::new(&plan(text)).unwrap();
    let states: Vec<State> = study.by_ref().map(Result::unwrap).collect();
    let inner = study.tube().tube.inner_radius();
    for (stage, expected) in [
        ("inflate", ["1.18939766", "1.35261592"]),
        ("constrict", ["1.1096998", "1.2829386"]),
    ] {
        let state = states.iter().rfind(|state| state.stage == stage).unwrap();
        for (radius, expected) in [inner, 0.5].into_iter().zip(expected) {
            let at = Point {
                z: 0.4,
                radius,
                angle: 0.0,
            };
            let [_, x, y] = study
                .tube()
                .sample(&state.load, &state.unknowns, at)
                .position;
            let (found, exact) = (2.2 * x.hypot(y), expected.parse::<f64>().unwrap());
            assert!((found / exact - 1.0).abs() < 2e-7, "{stage}: {found}");
            assert!(text.contains(expected));
        }
    }
    // Each stage closes the balance of its work, with the error of the trapezoidal rule.
    let rows = rows(&plan(text), &states);
    for stage in ["inflate", "constrict"] {
        let last = rows.iter().rfind(|row| row.stage == stage).unwrap();
        let balance = last.released_energy.abs() / last.energy.abs();
        assert!(balance < 0.05, "{stage}: {balance}");
    }
}

fn rows(plan: &Plan, states: &[State]) -> Vec<Row> {
    let scale = Scale::of(plan.units.as_ref());
    let mut rows: Vec<Row> = vec![];
    for state in states {
        rows.push(Row::new(state, &scale, plan.has_pressures(), rows.last()));
    }
    rows
}

#[test]
fn the_work_of_a_tension_and_of_its_shift_is_the_gain_of_energy() {
    let error = |steps: usize, drive: &str| {
        let rest = format!("[[stages]]\nsteps = {steps}\n{drive}");
        let plan = plan(&tube(RACHEV, &rest));
        let rows = rows(&plan, &states(&plan));
        let last = rows.last().unwrap();
        let sizes = last.muscles.iter().map(|muscle| muscle.work.abs());
        (last.released_energy / sizes.fold(last.energy.abs(), f64::max)).abs()
    };
    for drive in [
        "drive.ring.tension = 5.0",
        "drive.ring = { tension = [[0.25, 4.0]], shift = 1.5 }\ndrive.growing.stretch = 0.8",
    ] {
        let (coarse, fine) = (error(8, drive), error(16, drive));
        // Of second order in the step.
        assert!(fine < 0.3 * coarse && fine < 0.02, "{coarse} {fine}");
    }
}

#[test]
fn a_tension_follows_a_list_over_time_and_a_run_with_it_resumes_to_the_bit() {
    let rest = "[[stages]]\nsteps = 4\nduration = 2.0\n\
         drive.ring.tension = [[0.5, 3.0], [1.5, 1.0]]\ndrive.growing.stretch = 0.8\n";
    let plan = plan(&tube(RACHEV, rest));
    let (mut study, mut all, mut continuations) = (Study::new(&plan).unwrap(), vec![], vec![]);
    while let Some(state) = study.next() {
        all.push(state.unwrap());
        continuations.push(study.continuation().unwrap());
    }
    let tensions = all.iter().map(|state| 20.0 * state.load.muscles[1]);
    for (tension, expected) in tensions.zip([0.0, 3.0, 2.0, 1.0, 1.0]) {
        assert!((tension - expected).abs() < 1e-12, "{tension} {expected}");
    }
    for number in [1, 2] {
        let resumed = Study::resume(&plan, continuations[number].clone()).unwrap();
        let rest: Vec<State> = resumed.map(Result::unwrap).collect();
        for (state, expected) in rest.iter().zip(&all[number + 1..]) {
            assert_eq!(state.unknowns, expected.unknowns, "after {number}");
            assert_eq!(state.work, expected.work, "after {number}");
        }
    }
    // The history has the tension in the unit of the case, and is read back.
    let rows = rows(&plan, &all);
    let header = rows[1].header();
    let column = |name: &str| header.iter().position(|column| column == name);
    let at = column("tension_ring").unwrap();
    assert!((rows[1].record()[at].parse::<f64>().unwrap() - 3.0).abs() < 1e-12);
    assert!(column("target_ring").is_none() && column("stretch_ring").is_none());
    assert!(column("target_growing").is_some() && column("stretch_growing").is_some());
    let reader = RowReader::new(header.iter().map(String::as_str)).unwrap();
    let record = rows[2].record();
    let read = reader.row(record.iter().map(String::as_str)).unwrap();
    assert_eq!(read.muscles, rows[2].muscles);
    // Dmin/D is that of the muscle that grows.
    assert!((rows[4].diameter_ratio - 0.8).abs() < 1e-12);
}

#[test]
fn a_stress_contracts_alike_in_all_symmetries() {
    let rest = "[[stages]]\nsteps = 3\ndrive.ring.tension = 4.0\n";
    let ring = states(&plan(&tube(RACHEV, rest))).pop().unwrap();
    for symmetry in ["{ fold = 2 }", "'none'"] {
        let text = format!("symmetry = {symmetry}\n{}", tube(RACHEV, rest));
        let state = states(&plan(&text)).pop().unwrap();
        assert!(
            (state.energy / ring.energy - 1.0).abs() < 1e-9,
            "{symmetry}"
        );
        let radius = |state: &State| state.measures.outer_radius_min;
        // Twelve splines around are not quite a circle.
        assert!((radius(&state) - radius(&ring)).abs() < 2e-3, "{symmetry}");
        // It narrows.
        assert!(radius(&state) < 0.48, "{}", radius(&state));
    }
}

#[test]
fn a_tube_that_a_tension_narrows_has_the_shapes_of_a_contraction() {
    let rest = "[[stages]]\nname = 'fill'\nsteps = 2\ndrive.inner-wall.pressure = 0.8\n\
         [[stages]]\nname = 'contract'\nsteps = 3\ndrive.ring.tension = 12.0\n\
         [[stages]]\nname = 'leave'\nsteps = 1\ndrive.ring.shift = 3.0\n";
    let states = states(&plan(&tube(RACHEV, rest)));
    let shape = |stage: &str| {
        let last = states.iter().rfind(|state| state.stage == stage);
        last.unwrap().measures.shape
    };
    assert_eq!(shape("fill"), Shape::Swollen);
    assert_eq!(shape("leave"), Shape::Swollen);
    let contracted = shape("contract");
    assert!([Shape::V, Shape::U].contains(&contracted), "{contracted}");
}
