//! A lumen whose volume is driven, and whose pressure is the result.

use plica::case;
use plica::equilibrium::TubeProblem;
use plica::study::{Findings, Plan, Row, Scale, State, Study};
use plica::tube::Symmetry;

/// A short tube that is held at both ends, on a coarse mesh; `rest` is the end of the case.
fn plan(symmetry: &str, rest: &str) -> Plan {
    let text = format!(
        "symmetry = {symmetry}\n[tube]\nlength = 0.8\nthickness = 0.1\n\
         [material.neo-hookean]\npoisson_ratio = 0.45\n\
         [mesh]\ncontrol_points = {{ axial = 8, around = 12, thickness = 4 }}\n\
         [solver]\ntolerance = 1e-10\n{rest}"
    );
    case::read(&text, "case").unwrap()
}

fn run(plan: &Plan) -> (Study, Vec<State>) {
    let mut study = Study::new(plan).unwrap();
    let states: Vec<State> = study.by_ref().map(Result::unwrap).collect();
    (study, states)
}

fn pressure(state: &State) -> f64 {
    state.load.pressures[0].follower
}

/// Returns the number of negative eigenvalues of circumferential mode 0 of a state of one ring, at a constant pressure.
fn negative_at_constant_pressure(problem: &TubeProblem, state: &State) -> usize {
    let mut load = state.load.clone();
    load.lumen_volume = None;
    let mut tangent = problem.ring_tangent(&load, &state.unknowns, 0);
    tangent.constrain(problem.tube.prescribed());
    tangent.factor().unwrap().negative_pivots()
}

const SYMMETRIES: [&str; 3] = ["'axisymmetric'", "{ fold = 2 }", "'none'"];

#[test]
fn a_driven_volume_has_the_states_of_the_pressure_that_holds_it_in_every_symmetry() {
    let mut first: Option<[f64; 2]> = None;
    for symmetry in SYMMETRIES {
        let stage = "[[stages]]\nsteps = 2\ndrive";
        let driven = plan(symmetry, &format!("{stage}.lumen.volume_ratio = 1.3"));
        let (study, states) = run(&driven);
        let last = states.last().unwrap();
        let tube = study.tube();
        let ratio = tube.lumen_volume(&last.unknowns) / tube.lumen_volume_at_rest();
        assert!((ratio - 1.3).abs() < 1e-11, "{symmetry}: {ratio}");
        assert_eq!(last.load.lumen_volume, Some(1.3));
        assert_eq!(last.lumen_pressure, Some(pressure(last)));
        assert!(last.relative_residual < 1e-9 && !last.stability.is_unstable());
        let solves: usize = states.iter().map(|state| state.linear_solves).sum();
        println!("{symmetry}: {} linear solves", solves);
        let p = pressure(last);
        let pressed = plan(symmetry, &format!("{stage}.inner-wall.pressure = {p:e}"));
        let (_, same) = run(&pressed);
        let same = same.last().unwrap();
        let apart = last.unknowns.iter().zip(&same.unknowns);
        let apart = apart.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        println!("{symmetry}: p = {p:e}, apart {apart:e}");
        assert!(apart < 1e-8, "{apart:e}");
        // The same in every symmetry.
        let [p_first, w_first] = *first.get_or_insert([p, last.energy]);
        assert!((p / p_first - 1.0).abs() < 1e-8, "{p} {p_first}");
        assert!((last.energy / w_first - 1.0).abs() < 1e-8);
    }
}

#[test]
fn a_balloon_passes_its_pressure_maximum_and_is_stable_at_a_held_volume() {
    let mut pressures: Vec<Vec<f64>> = vec![];
    for symmetry in [SYMMETRIES[0], "{ fold = 4 }"] {
        let stages = "[[stages]]\nsteps = 8\ndrive.lumen.volume_ratio = 9.0";
        let (study, states) = run(&plan(symmetry, stages));
        let p: Vec<f64> = states.iter().map(pressure).collect();
        println!("{symmetry}: {p:?}");
        let most = p.iter().copied().fold(0.0, f64::max);
        let at = p.iter().position(|p| *p == most).unwrap();
        assert!(0 < at && at + 2 < p.len(), "{p:?}");
        assert!(p[p.len() - 1] < 0.95 * most);
        let mode_0 = |state: &State| {
            let mut modes = state.stability.unstable_modes();
            modes.any(|mode| mode == plica::equilibrium::UnstableMode::Circumferential(0))
        };
        assert!(states.iter().all(|state| !mode_0(state)));
        if symmetry == SYMMETRIES[0] {
            for (i, state) in states
                .iter()
                .enumerate()
                .filter(|(i, _)| i.abs_diff(at) > 1)
            {
                let negative = negative_at_constant_pressure(study.problem(), state);
                assert_eq!(negative, usize::from(i > at), "state {i}");
            }
        }
        pressures.push(p);
    }
    for (a, b) in pressures[0].iter().zip(&pressures[1]) {
        assert!((a - b).abs() < 1e-8 * pressures[0][2], "{a} {b}");
    }
}

/// Three stages: a pressure, a volume from there, and the pressure again.
const SWITCHED: &str = "[[stages]]\nsteps = 2\ndrive.inner-wall.pressure = 0.03\n\
                        [[stages]]\nsteps = 3\ndrive.lumen.volume_ratio = 2.0\n\
                        [[stages]]\nsteps = 2\ndrive.ileum.displacement = 0.05\n\
                        [[stages]]\nsteps = 2\ndrive.inner-wall.pressure = 0.02\n";

#[test]
fn pressure_and_volume_take_over_from_each_other_and_a_study_resumes_to_the_bit() {
    let plan = plan("'axisymmetric'", SWITCHED);
    let mut study = Study::new(&plan).unwrap();
    let (mut states, mut continuations) = (vec![], vec![]);
    while let Some(state) = study.next() {
        states.push(state.unwrap());
        continuations.push(study.continuation().unwrap());
    }
    let volumes: Vec<Option<f64>> = states.iter().map(|state| state.load.lumen_volume).collect();
    assert!(volumes[..3].iter().all(Option::is_none) && volumes[8..].iter().all(Option::is_none));
    // The volume goes on from that under the pressure, in equal steps, and is held while the end moves.
    let at_rest = study.tube().lumen_volume_at_rest();
    let begin = study.tube().lumen_volume(&states[2].unknowns) / at_rest;
    for (i, volume) in volumes[3..6].iter().enumerate() {
        let expected = begin + (2.0 - begin) * (i as f64 + 1.0) / 3.0;
        assert!((volume.unwrap() - expected).abs() < 1e-12);
    }
    assert_eq!(volumes[6..8], [Some(2.0); 2]);
    // The pressure goes on from the one that held the volume.
    let [from, middle] = [7, 8].map(|i| pressure(&states[i]));
    assert!((middle - 0.5 * (from + 0.02)).abs() < 1e-15 && from != 0.02);
    assert_eq!(pressure(&states[9]), 0.02);
    for number in [1, 2, 4, 7, 8] {
        let resumed = Study::resume(&plan, continuations[number].clone()).unwrap();
        for (state, expected) in resumed.zip(&states[number + 1..]) {
            let state = state.unwrap();
            assert!(state.unknowns == expected.unknowns, "after state {number}");
            assert_eq!(state.load, expected.load);
            assert_eq!(state.work, expected.work);
        }
    }
}

#[test]
fn the_work_of_the_pressure_is_stored_in_the_wall() {
    let gap = |steps: usize| {
        let rest = format!("[[stages]]\nsteps = {steps}\ndrive.lumen.volume_ratio = 3.0");
        let (_, states) = run(&plan("'axisymmetric'", &rest));
        let mut rows: Vec<Row> = vec![];
        for state in &states {
            rows.push(Row::new(state, &Scale::of(None), true, rows.last()));
        }
        let last = rows.last().unwrap();
        let work = last.inner_wall_work.unwrap();
        assert!((work - last.energy - last.released_energy).abs() < 1e-12 * work);
        (last.released_energy / work).abs()
    };
    let [coarse, fine] = [6, 12].map(gap);
    println!("{coarse:e} {fine:e}");
    assert!(coarse < 2e-2 && fine < coarse / 3.5, "{coarse} {fine}");
}

#[test]
fn the_balloon_has_the_pressure_maximum_that_its_case_describes() {
    let text = include_str!("../../../cases/balloon.toml");
    let [pressure, volume] = [0.0432, 3.12];
    assert!(text.contains(&format!("{pressure} E at {volume} times the volume")));
    let mesh = "{ axial = 40, around = 60, thickness = 6 }";
    assert!(text.contains(mesh));
    let coarse = text.replace(mesh, "{ axial = 20, around = 24, thickness = 5 }");
    let (_, states) = run(&case::read(&coarse, "balloon").unwrap());
    let scale = Scale::of(None);
    let rows: Vec<Row> = states
        .iter()
        .map(|state| Row::new(state, &scale, true, None))
        .collect();
    let findings = Findings::of(&rows, &scale, Symmetry::Axisymmetric);
    let [maximum] = &findings.pressure_extremes[..] else {
        panic!("{:?}", findings.pressure_extremes)
    };
    assert!(maximum.is_maximum && (maximum.pressure / pressure - 1.0).abs() < 0.01);
    let ratio = maximum.volume / rows[0].lumen_volume;
    assert!((ratio / volume - 1.0).abs() < 0.05, "{ratio}");
    let line = findings
        .lines()
        .into_iter()
        .find(|(name, _)| name == "pressure maximum");
    assert!(line.unwrap().1.contains("E at a volume of"));
}
