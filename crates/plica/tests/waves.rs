//! Zones of muscles that travel and repeat, and targets over time.

use plica::study::{Plan, State, Study};

/// Returns a plan of a short tube on a uniform mesh, with the given muscles and stages.
fn plan(rest: &str) -> Plan {
    let text = format!(
        "[tube]\nlength = 2.0\nthickness = 0.1\n[mesh]\nrefine = []\n\
         control_points = {{ axial = 23, around = 12, thickness = 4 }}\n\
         [output]\nstability_modes = 0\n[solver]\ntolerance = 1e-11\n{rest}"
    );
    plica::case::read(&text, "waves").unwrap_or_else(|error| panic!("{error}"))
}

fn states(plan: &Plan) -> Vec<State> {
    Study::new(plan).unwrap().map(Result::unwrap).collect()
}

fn energies(plan: &Plan) -> Vec<f64> {
    states(plan).iter().map(|state| state.energy).collect()
}

fn assert_close(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance * b.abs(), "{a} and {b}");
}

#[test]
fn a_zone_that_was_shifted_acts_as_one_that_was_there() {
    let muscles = |ring: &str, long: &str| {
        format!(
            "[muscles.ring]\ndirection = 'circular'\nzone = {ring}\n\
             [muscles.long]\ndirection = 'longitudinal'\nzone = {long}\n"
        )
    };
    let moved = plan(&format!(
        "{}[[stages]]\nsteps = 4\ndrive.ring = {{ stretch = 0.7, shift = 1.0 }}\n\
         drive.long = {{ stretch = 1.3, shift = 1.2 }}\n",
        muscles("[-0.5, 0.25]", "[-0.4, 0.1]")
    ));
    let placed = plan(&format!(
        "{}[[stages]]\nsteps = 4\ndrive.ring.diameter_ratio = 0.7\ndrive.long.stretch = 1.3\n",
        muscles("[0.5, 1.25]", "[0.8, 1.3]")
    ));
    let [moved, placed] = [states(&moved), states(&placed)].map(|mut states| states.pop().unwrap());
    assert_close(moved.energy, placed.energy, 1e-10);
    assert_close(moved.length_ratio(), placed.length_ratio(), 1e-12);
    assert_eq!(moved.muscles[1].shift, Some(1.0));
    assert_eq!(placed.muscles[1].shift, None);
    // The grown length is that of the target: half the zone of 0.5 on average, over a length of 2.
    assert_close(moved.length_ratio(), 1.0 + 0.3 * 0.25 / 2.0, 1e-12);
}

#[test]
fn a_train_of_waves_is_the_same_after_a_period() {
    let plan = plan(
        "[muscles.ring]\ndirection = 'circular'\nzone = [0.1, 0.5]\nrepeat = 0.7\n\
         [[stages]]\nsteps = 2\ndrive.ring.stretch = 0.8\n\
         [[stages]]\nsteps = 6\ndrive.ring.shift = 1.4\n",
    );
    let energies = energies(&plan);
    assert_close(energies[5], energies[2], 1e-9);
    assert_close(energies[8], energies[2], 1e-9);
    assert!((energies[4] / energies[2] - 1.0).abs() > 1e-3);
}

#[test]
fn the_wave_of_the_oesophagus_keeps_its_shape_and_leaves_the_tube_at_rest() {
    let text = include_str!("../../../cases/oesophagus.toml");
    let mut plan = plica::case::read(text, "oesophagus").unwrap();
    (plan.mesh.axial, plan.mesh.thickness) = (60, 4);
    (plan.contact, plan.output.stability_modes) = (false, 0);
    plan.stages[1].steps = 20;
    let states = states(&plan);
    let energy = |shift: f64| {
        let shift = shift / 20.0;
        let at = |state: &&State| (state.muscles[1].shift.unwrap() - shift).abs() < 1e-9;
        states.iter().rev().find(at).unwrap().energy
    };
    for shift in [64.0, 72.0, 80.0, 88.0, 96.0] {
        assert_close(energy(shift), energy(80.0), 1e-3);
    }
    let last = states.last().unwrap();
    assert!(last.energy.abs() < 1e-12 && last.time == Some(9.0));
}

#[test]
fn a_lag_to_either_side_gives_mirror_images() {
    let text = include_str!("../../../cases/phase-lag.toml");
    let mut plan = plica::case::read(text, "phase-lag").unwrap();
    (plan.mesh.axial, plan.mesh.thickness) = (90, 4);
    (plan.contact, plan.output.stability_modes) = (false, 0);
    plan.stages[2].steps = 16;
    let states = states(&plan);
    let overhang = |lag: usize| states[20 + lag].measures.overhang;
    let side = |lag: usize| states[20 + lag].measures.side;
    assert_eq!(overhang(8), 0.0);
    for lag in [2, 4, 6] {
        assert_close(overhang(8 + lag), overhang(8 - lag), 1e-4);
        assert!(overhang(8 - lag) > 1e-3 && side(8 - lag) != side(8 + lag));
    }
    assert!(overhang(6) > 2.0 * overhang(4));
}

/// A wave that rises and falls while it travels.
fn wave() -> Plan {
    plan(
        "[muscles.ring]\ndirection = 'circular'\nzone = [-0.5, 0.25]\n\
         [[stages]]\nsteps = 5\nduration = 4.0\n\
         drive.ring = { stretch = [[1.0, 0.8], [2.5, 0.7]], shift = 1.0 }\n\
         [[stages]]\nsteps = 2\nduration = 2.0\ndrive.ring.stretch = 1.0\n",
    )
}

#[test]
fn a_target_follows_its_points_in_time() {
    let plan = wave();
    let states = states(&plan);
    let times: Vec<f64> = states.iter().map(|state| state.time.unwrap()).collect();
    let expected = [0.0, 0.8, 1.6, 2.4, 3.2, 4.0, 5.0, 6.0];
    for (time, expected) in times.iter().zip(expected) {
        assert_close(*time, expected, 1e-15);
    }
    let targets = states.iter().map(|state| state.load.muscles[0]);
    let expected = [1.0, 0.84, 0.76, 0.8 - 0.1 * 1.4 / 1.5, 0.7, 0.7, 0.85, 1.0];
    for (target, expected) in targets.zip(expected) {
        assert_close(target, expected, 1e-14);
    }
    for (state, n) in states[..6].iter().zip(0..) {
        assert!((state.load.shifts[0] - 0.2 * f64::from(n)).abs() < 1e-15);
    }
    // The energy of a state depends on its load alone.
    let direct = self::plan(
        "[muscles.ring]\ndirection = 'circular'\nzone = [-0.5, 0.25]\n\
         [[stages]]\nsteps = 3\ndrive.ring = { stretch = 0.7, shift = 0.8 }\n",
    );
    assert_close(states[4].energy, energies(&direct)[3], 1e-9);
}

#[test]
fn a_wave_is_resumed_to_the_bit() {
    let plan = wave();
    let mut whole = Study::new(&plan).unwrap();
    let (mut all, mut continuations) = (vec![], vec![]);
    while let Some(state) = whole.next() {
        all.push(state.unwrap());
        continuations.push(whole.continuation().unwrap());
    }
    for number in 0..all.len() {
        let resumed = Study::resume(&plan, continuations[number].clone()).unwrap();
        let rest: Vec<State> = resumed.map(Result::unwrap).collect();
        assert_eq!(rest.len(), all.len() - number - 1);
        for (state, expected) in rest.iter().zip(&all[number + 1..]) {
            assert_eq!(state.unknowns, expected.unknowns, "after {number}");
            assert_eq!(state.time, expected.time);
        }
    }
}

#[test]
fn the_work_of_a_travelling_wave_is_its_gain_of_energy() {
    let plan = |steps: usize| {
        plan(&format!(
            "[muscles.ring]\ndirection = 'circular'\nzone = [-0.5, 0.25]\n\
             [[stages]]\nsteps = {steps}\n\
             drive.ring = {{ stretch = [[0.5, 0.7], [1.0, 0.9]], shift = 1.1 }}\n"
        ))
    };
    let error = |steps| {
        let states = states(&plan(steps));
        let work: f64 = states.iter().map(|state| state.work.muscles[0]).sum();
        (work / states.last().unwrap().energy - 1.0).abs()
    };
    let (coarse, fine) = (error(16), error(32));
    // Of second order in the step.
    assert!(fine < 0.3 * coarse && fine < 0.06, "{coarse} {fine}");
}

#[test]
fn positions_motions_of_ends_and_volumes_follow_lists() {
    // In one stage with a list, and in two stages: the same states.
    let base = "[tube]\nlength = 1.5\nthickness = 0.1\n[output]\nstability_modes = 0\n\
        [solver]\ntolerance = 1e-11\n";
    let bolus = "[mesh]\nrefine = []\ncontrol_points = { axial = 19, around = 12, thickness = 4 }\n\
        [ends]\nileum = 'sliding'\n[[obstacles]]\nname = 'bolus'\n\
        shape.ball = { radius = 0.37, position = [0.0, 0.0, 0.75] }\n\
        [[stages]]\nsteps = 2\ndrive.bolus.radius = 0.42\n";
    let balloon = "[mesh]\nrefine = []\ncontrol_points = { axial = 9, around = 12, thickness = 4 }\n\
        [ends]\ncolon = 'sliding'\nileum = 'sliding'\n";
    let bent = "symmetry = 'none'\n[mesh]\nrefine = []\n\
        control_points = { axial = 9, around = 12, thickness = 4 }\n";
    for (text, list, [first, second]) in [
        (
            bolus,
            "bolus.position = [[0.5, 0.0, 0.0, 0.9], [1.0, 0.0, 0.0, 0.8]]",
            [
                "bolus.position = [0.0, 0.0, 0.9]",
                "bolus.position = [0.0, 0.0, 0.8]",
            ],
        ),
        (
            balloon,
            "lumen.volume_ratio = [[0.5, 1.3], [1.0, 1.2]]",
            ["lumen.volume_ratio = 1.3", "lumen.volume_ratio = 1.2"],
        ),
        (
            bent,
            "ileum = { offset = [[0.5, 0.02, 0.0]], tilt_degrees = [[0.5, 0.0, 3.0], [1.0, 0.0, 0.0]] }",
            [
                "ileum = { offset = [0.02, 0.0], tilt_degrees = [0.0, 3.0] }",
                "ileum.tilt_degrees = [0.0, 0.0]",
            ],
        ),
    ] {
        let stage =
            |steps: usize, drive: &str| format!("[[stages]]\nsteps = {steps}\ndrive.{drive}\n");
        let [listed, staged] = [
            stage(4, list),
            format!("{}{}", stage(2, first), stage(2, second)),
        ]
        .map(|stages| {
            let symmetry = text
                .lines()
                .next()
                .filter(|line| line.starts_with("symmetry"));
            let rest = symmetry.map_or(text, |line| &text[line.len()..]);
            let text = format!("{}\n{base}{rest}\n{stages}", symmetry.unwrap_or_default());
            energies(&plica::case::read(&text, "lists").unwrap_or_else(|error| panic!("{error}")))
        });
        assert_eq!(listed.len(), staged.len());
        assert!(listed.iter().any(|energy| *energy > 1e-7), "{list}");
        for (a, b) in listed.iter().zip(&staged) {
            assert!(
                (a - b).abs() <= 1e-9 * b.abs() + 1e-16,
                "{list}: {listed:?} {staged:?}"
            );
        }
    }
}
