//! Findings of paths made up state by state.

use super::*;
use crate::study::MuscleRow;

/// A state at rest with a wide lumen.
fn rest() -> Row {
    Row {
        stage: "rest".into(),
        method: Method::Rest,
        shape: Shape::Straight,
        length_ratio: 1.0,
        diameter_ratio: 1.0,
        gap: 0.06,
        lumen: 0.8,
        in_equilibrium: true,
        ..Row::zero(&[], ["colon", "ileum"])
    }
}

/// Makes a path of rest and stages; a stage is a name with a change of the state for each step.
fn path(stages: &[(&str, Vec<Change>)]) -> Vec<Row> {
    let mut rows = vec![rest()];
    for (name, changes) in stages {
        for change in changes {
            let mut row = rows[rows.len() - 1].clone();
            (row.step, row.method) = (rows.len(), Method::Newton);
            row.stage = (*name).to_owned();
            change(&mut row);
            rows.push(row);
        }
    }
    rows
}

type Change = Box<dyn Fn(&mut Row)>;

fn change(change: impl Fn(&mut Row) + 'static) -> Change {
    Box::new(change)
}

/// Steps of Lmax/L with their energies.
fn relaxing(steps: &[(f64, f64)]) -> Vec<Change> {
    let step = |&(ratio, energy): &(f64, f64)| {
        change(move |row| (row.length_ratio, row.energy) = (ratio, energy))
    };
    steps.iter().map(step).collect()
}

fn findings(rows: &[Row]) -> Findings {
    Findings::of(rows, &Scale::of(None), Symmetry::Axisymmetric)
}

/// Returns the only line of a name.
fn line(findings: &Findings, name: &str) -> String {
    let lines = findings.lines();
    let mut found = lines.iter().filter(|(n, _)| n == name);
    let (_, words) = found.next().unwrap_or_else(|| panic!("no line {name}"));
    assert!(found.next().is_none(), "two lines {name}");
    words.clone()
}

#[test]
fn numbers_have_the_same_digits_in_both_notations() {
    for (value, expected) in [
        (0.0, "0"),
        (8.881449, "8.8814"),
        (-0.1, "-0.10000"),
        (0.0999, "9.9900e-2"),
        (1234.5678, "1234.6"),
        (12345.678, "1.2346e4"),
        (6.671364e-4, "6.6714e-4"),
    ] {
        assert_eq!(loads::number(value, 4), expected);
    }
}

#[test]
fn a_path_without_states_has_no_findings() {
    assert!(findings(&[]).lines().is_empty());
    assert_eq!(findings(&[rest()]).stages, []);
}

#[test]
fn the_end_of_a_falling_or_rising_energy_is_no_extreme() {
    for energies in [[4.0, 3.0, 2.0], [1.0, 2.0, 3.0]] {
        let steps = [1.1, 1.2, 1.3].into_iter().zip(energies);
        let rows = path(&[("relax", relaxing(&steps.collect::<Vec<_>>()))]);
        let rows = &rows[1..];
        assert_eq!(findings(rows).extremes, []);
    }
}

#[test]
fn a_minimum_and_a_maximum_inside_a_stage_are_found_with_their_load() {
    let steps = [(1.1, 4.0), (1.2, 3.0), (1.3, 3.5), (1.4, 3.2)];
    let rows = path(&[("relax", relaxing(&steps))]);
    let found = findings(&rows[1..]);
    let [minimum, maximum] = &found.extremes[..] else {
        panic!("{:?}", found.extremes)
    };
    assert_eq!(
        (minimum.at.state, minimum.is_minimum, minimum.energy),
        (2, true, 3.0)
    );
    assert_eq!(
        (maximum.at.state, maximum.is_minimum, maximum.energy),
        (3, false, 3.5)
    );
    assert_eq!(
        line(&found, "energy minimum"),
        "W = 3.000000 E D^3 at state 2 (relax, Lmax/L = 1.2000)"
    );
}

#[test]
fn waves_of_the_energy_that_come_from_the_mesh_are_no_extremes() {
    for (wave, expected) in [(1e-7, 0), (1e-5, 2)] {
        let steps = [(1.1, 1.0), (1.2, 1.0 + wave), (1.3, 1.0 - wave), (1.4, 2.0)];
        let rows = path(&[("relax", relaxing(&steps))]);
        assert_eq!(findings(&rows[1..]).extremes.len(), expected);
    }
}

#[test]
fn a_stage_that_turns_back_tells_how_far_it_went() {
    let there = [(1.1, 1.0), (1.3, 2.0), (1.2, 1.5)];
    let back = [(0.9, 0.8), (1.2, 1.5)];
    let found = findings(&path(&[
        ("there", relaxing(&there)),
        ("back", relaxing(&back)),
    ]));
    let [there, back] = ["stage there", "stage back"].map(|name| line(&found, name));
    assert!(
        there.starts_with("states 1 to 3, Lmax/L = 1.0000 to 1.2000 by way of 1.3000; at the end"),
        "{there}"
    );
    assert!(
        back.starts_with("states 4 to 5, Lmax/L = 1.2000 to 0.9000 and back; at the end"),
        "{back}"
    );
}

#[test]
fn a_minimum_survives_a_further_stage_and_a_kink_between_stages_is_none() {
    let steps = [(1.1, 4.0), (1.2, 3.0), (1.3, 5.0)];
    let back = [(1.2, 4.5), (1.1, 4.6)];
    let one = path(&[("relax", relaxing(&steps))]);
    let two = path(&[("relax", relaxing(&steps)), ("return", relaxing(&back))]);
    let minima = |rows: &[Row]| -> Vec<usize> {
        let found = findings(rows);
        found
            .energy_minima()
            .map(|minimum| minimum.at.state)
            .collect()
    };
    assert_eq!(minima(&one[1..]), [2]);
    // State 4 is the lowest of the second stage, where the energy has turned.
    assert_eq!(minima(&two[1..]), [2, 4]);
    let kink = path(&[
        ("contract", relaxing(&[(1.1, 4.0), (1.2, 1.0)])),
        ("relax", relaxing(&[(1.3, 2.0), (1.4, 3.0)])),
    ]);
    assert_eq!(minima(&kink[1..]), [0; 0]);
}

#[test]
fn differences_below_rounding_are_no_extremes() {
    let steps = [(1.1, 1.0), (1.2, 1.0 - 1e-12), (1.3, 1.0), (1.4, 2.0)];
    assert_eq!(
        findings(&path(&[("relax", relaxing(&steps))])[1..]).extremes,
        []
    );
}

#[test]
fn an_extreme_at_a_jump_is_called_so() {
    let mut rows = path(&[(
        "push",
        relaxing(&[(1.1, 1.0), (1.2, 3.0), (1.3, 2.0), (1.4, 4.0)]),
    )]);
    rows[3].method = Method::Relaxation;
    let found = findings(&rows[1..]);
    let at_jump: Vec<_> = found
        .extremes
        .iter()
        .map(|e| (e.at.state, e.is_at_jump))
        .collect();
    assert_eq!(at_jump, [(2, true), (3, true)]);
    assert_eq!(
        (found.jumps[0].to.state, found.jumps[0].energy),
        (3, [3.0, 2.0])
    );
    assert!(line(&found, "energy maximum").ends_with(", before a jump"));
    assert!(line(&found, "work").ends_with("1 step by relaxation"));
}

/// Contraction, relaxation into an invagination, return, and opening; `end` changes the last state.
fn cycle(end: impl Fn(&mut Row) + 'static) -> Vec<Row> {
    let invaginated = |row: &mut Row| {
        row.shape = Shape::Invaginated;
        (row.max_wall_angle_deg, row.overhang, row.side) = (120.0, 0.2, Side::Ileum);
    };
    path(&[
        (
            "contract",
            vec![change(|row| {
                (row.diameter_ratio, row.energy, row.shape) = (0.25, 3.0, Shape::V)
            })],
        ),
        (
            "relax",
            vec![
                change(|row| {
                    (row.length_ratio, row.shape, row.max_wall_angle_deg) =
                        (1.1, Shape::Square, 85.0)
                }),
                change(move |row| {
                    row.length_ratio = 1.2;
                    invaginated(row);
                }),
            ],
        ),
        (
            "return",
            vec![change(|row| (row.length_ratio, row.overhang) = (1.0, 0.3))],
        ),
        (
            "open",
            vec![change(move |row| {
                (row.diameter_ratio, row.energy, row.shape) = (1.0, 0.0, Shape::Straight);
                (row.max_wall_angle_deg, row.overhang, row.side) = (0.0, 0.0, Side::None);
                end(row);
            })],
        ),
    ])
}

#[test]
fn a_cycle_remembers_its_invagination_and_its_recovery() {
    let found = findings(&cycle(|_| {}));
    assert_eq!(
        line(&found, "wall is square"),
        "state 2 (relax, Lmax/L = 1.1000)"
    );
    assert_eq!(
        line(&found, "wall overhangs"),
        "states 3 to 4 (relax, Lmax/L = 1.2000, to return, Lmax/L = 1.0000)"
    );
    assert_eq!(
        line(&found, "invaginates"),
        "toward the ileum, at most by 0.300 D at state 4 (return, Lmax/L = 1.0000)"
    );
    assert_eq!(
        line(&found, "return"),
        "state 5 has the load of state 0 (rest) and is the same state: the tube has recovered"
    );
    assert_eq!(
        line(&found, "stage open"),
        "state 5, Dmin/D = 0.2500 to 1.0000; at the end W = 0 E D^3, straight"
    );
    let names: Vec<_> = found
        .stages
        .iter()
        .map(|stage| stage.name.as_str())
        .collect();
    assert_eq!(names, ["contract", "relax", "return", "open"]);
}

#[test]
fn invaginations_to_either_side_are_described_apart() {
    let invaginated = |side: Side, overhang: f64| {
        change(move |row| {
            row.shape = Shape::Invaginated;
            (row.max_wall_angle_deg, row.overhang, row.side) = (120.0, overhang, side);
        })
    };
    let straight = || {
        change(|row| {
            (row.shape, row.max_wall_angle_deg, row.overhang) = (Shape::V, 40.0, 0.0);
            row.side = Side::None;
        })
    };
    let found = findings(&path(&[(
        "pass",
        vec![
            invaginated(Side::Ileum, 0.1),
            invaginated(Side::Ileum, 0.2),
            straight(),
            invaginated(Side::Colon, 0.3),
        ],
    )]));
    let lines = found.lines();
    let at = lines
        .iter()
        .position(|line| line.0 == "invaginates")
        .unwrap();
    assert_eq!(
        lines[at].1,
        "states 1 to 2 (pass): toward the ileum, at most by 0.200 D at state 2 (pass)"
    );
    assert_eq!(
        lines[at + 1],
        (
            String::new(),
            "state 4 (pass): toward the colon, at most by 0.300 D at state 4 (pass)".into()
        )
    );
    assert_eq!(found.deepest.as_ref().unwrap().overhang, 0.3);
    // A state without a side is described with the others where all of them are on one side.
    let found = findings(&path(&[(
        "pass",
        vec![invaginated(Side::None, 0.1), invaginated(Side::Colon, 0.2)],
    )]));
    let expected = "toward the colon, at most by 0.200 D at state 2 (pass)";
    assert_eq!(line(&found, "invaginates"), expected);
    assert_eq!(found.invaginations.len(), 1);
}

#[test]
fn a_tube_that_does_not_recover_is_another_state_at_the_same_load() {
    for end in [
        (|row| row.energy = 1e-5) as fn(&mut Row),
        |row| row.shape = Shape::Invaginated,
        |row| row.outer_radius_min = 0.0011,
        |row| row.asymmetry = 0.0011,
    ] {
        let found = findings(&cycle(end));
        assert!(!found.returned.as_ref().unwrap().is_same);
        assert!(line(&found, "return").contains("but is another state"));
    }
    for end in [
        (|row| row.energy = 1e-6) as fn(&mut Row),
        |row| row.outer_radius_min = 0.0009,
        // The narrowest place of a straight tube is anywhere.
        |row| row.z_at_min = 2.0,
    ] {
        assert!(findings(&cycle(end)).returned.unwrap().is_same);
    }
}

#[test]
fn a_new_load_and_a_load_that_is_held_are_no_return() {
    let rows = path(&[("relax", relaxing(&[(1.1, 1.0), (1.1, 1.0)]))]);
    assert_eq!(findings(&rows).returned, None);
}

#[test]
fn a_wall_overhangs_by_its_angle_whatever_its_shape_is_called() {
    for (angle, overhang, expected) in [(90.0, 0.01, true), (89.9, 0.01, false), (90.0, 0.0, false)]
    {
        let mut rows = path(&[("pull", relaxing(&[(1.1, 1.0)]))]);
        rows[1].shape = Shape::Collapsed;
        (rows[1].max_wall_angle_deg, rows[1].overhang) = (angle, overhang);
        let found = findings(&rows);
        assert_eq!(
            !found.overhanging.is_empty(),
            expected,
            "{angle} {overhang}"
        );
        assert_eq!(line(&found, "invaginates"), "no");
    }
}

#[test]
fn scattered_states_are_listed_as_intervals_with_their_stage() {
    let mut rows = path(&[(
        "relax",
        relaxing(&[1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7, 1.8, 1.9].map(|x| (x, x))),
    )]);
    for i in [1, 2, 5] {
        rows[i].stability = "1:2".parse().unwrap();
    }
    let unstable = |rows: &[Row]| line(&findings(rows), "unstable");
    assert_eq!(
        unstable(&rows),
        "to circumferential mode 1 (tilts sideways): states 1 to 2 (relax, Lmax/L = 1.1000 to 1.2000); \
         state 5 (relax, Lmax/L = 1.5000)"
    );
    for i in [7, 9] {
        rows[i].stability = "1:2".parse().unwrap();
    }
    assert!(unstable(&rows).contains("5 states in 4 intervals, the first states 1 to 2 ("));
}

#[test]
fn only_a_mode_that_the_symmetry_suppresses_leads_away_from_the_path() {
    let mut rows = path(&[("relax", relaxing(&[(1.1, 1.0), (1.2, 2.0)]))]);
    rows[1].stability = "0:1".parse().unwrap();
    rows[2].stability = "0:1 2:2".parse().unwrap();
    let leaves = |symmetry| {
        let found = Findings::of(&rows, &Scale::of(None), symmetry);
        found.leaves.map(|departure| departure.at.state)
    };
    assert_eq!(leaves(Symmetry::Axisymmetric), Some(2));
    assert_eq!(leaves(Symmetry::Fold(3)), Some(2));
    assert_eq!(leaves(Symmetry::Fold(2)), None);
    assert_eq!(leaves(Symmetry::None), None);
}

#[test]
fn every_driven_quantity_is_named_where_it_changes() {
    for (change, words) in [
        (
            (|row| row.ends[0].displacement = -0.2) as fn(&mut Row),
            "colon end moved = 0 to -0.20000 D",
        ),
        (
            |row| row.ends[1].twist_deg = 40.0,
            "ileum end twisted = 0.00 to 40.00°",
        ),
        (
            |row| row.inner_pressure = Some(1e-3),
            "pressure inside = 0 to 1.0000e-3 E",
        ),
        (
            |row| row.outer_pressure = Some(1e-3),
            "pressure outside = 0 to 1.0000e-3 E",
        ),
        (
            |row| row.inner_dead_load = Some(1e-3),
            "dead load inside = 0 to 1.0000e-3 E",
        ),
        (
            |row| row.outer_dead_load = Some(1e-3),
            "dead load outside = 0 to 1.0000e-3 E",
        ),
        (|row| row.diameter_ratio = 0.5, "Dmin/D = 1.0000 to 0.5000"),
        (|_| {}, "no change of load"),
    ] {
        let rows = path(&[("drive", vec![super::tests::change(change)])]);
        let found = line(&findings(&rows), "stage drive");
        assert_eq!(
            found.split(';').next().unwrap(),
            format!("state 1, {words}")
        );
    }
}

#[test]
fn muscles_that_the_ratios_do_not_tell_apart_have_their_names() {
    let muscles = |targets: [f64; 2]| {
        let muscle = |(name, target): (&str, f64)| MuscleRow {
            name: name.into(),
            target,
            stretch: Some(target),
            shift: None,
            work: 0.0,
        };
        ["upper", "lower"]
            .into_iter()
            .zip(targets)
            .map(muscle)
            .collect::<Vec<_>>()
    };
    let mut rows = path(&[("squeeze", vec![change(|row| row.diameter_ratio = 0.5)])]);
    (rows[0].muscles, rows[1].muscles) = (muscles([1.0, 1.0]), muscles([0.5, 0.7]));
    assert!(
        line(&findings(&rows), "stage squeeze")
            .contains("upper = 1.0000 to 0.5000, lower = 1.0000 to 0.7000")
    );
    rows[1].muscles = muscles([0.5, 1.0]);
    assert!(line(&findings(&rows), "stage squeeze").contains("Dmin/D = 1.0000 to 0.5000;"));
}

#[test]
fn contact_with_an_obstacle_has_its_states_and_its_largest_force() {
    let touch = |force: f64, gap: f64| {
        change(move |row| {
            let mut rows = row.clone().with_obstacles(&["scope", "bolus"]);
            let area = if force > 0.0 { 0.2 } else { 0.0 };
            (rows.obstacles[0].force, rows.obstacles[0].area) = (force, area);
            (rows.obstacles[0].gap, rows.obstacles[1].gap) = (gap, 0.5);
            *row = rows;
        })
    };
    let contact = vec![
        touch(0.0, 0.1),
        touch(0.02, 1e-3),
        touch(0.04, -1e-4),
        touch(0.04, 1e-3),
    ];
    let mut rows = path(&[("press", contact)]);
    rows[0] = rows[0].clone().with_obstacles(&["scope", "bolus"]);
    for obstacle in &mut rows[0].obstacles {
        obstacle.gap = 0.5;
    }
    let found = findings(&rows);
    let touches = line(&found, "touches scope");
    assert!(touches.starts_with("states 2 to 4"), "{touches}");
    assert!(
        touches.contains("at most 4.000e-2 E D^2 at state 3"),
        "{touches}"
    );
    rows.last_mut().unwrap().obstacles[0].friction_work = Some(2e-3);
    let friction = line(&findings(&rows), "friction on scope");
    assert!(
        friction.starts_with("2.000e-3 E D^3 dissipated"),
        "{friction}"
    );
    let overlaps = line(&found, "overlaps scope");
    assert!(overlaps.starts_with("state 3"), "{overlaps}");
    assert_eq!(line(&found, "touches bolus"), "in no state");
    assert_eq!(found.unphysical_states(), 1);
}

#[test]
fn unphysical_states_are_listed_and_counted_once() {
    let mut rows = path(&[("relax", relaxing(&[(1.1, 1.0), (1.2, 2.0), (1.3, 3.0)]))]);
    (rows[1].gap, rows[1].lumen) = (0.0, -0.1);
    rows[3].in_equilibrium = false;
    let found = findings(&rows);
    assert_eq!(found.unphysical_states(), 2);
    assert!(line(&found, "wall crosses itself").starts_with("state 1 ("));
    assert!(line(&found, "lumen is closed").starts_with("state 1 ("));
    assert!(line(&found, "states").contains("not in equilibrium: state 3 ("));
}

#[test]
fn states_that_were_not_tested_are_not_called_stable() {
    let mut rows = path(&[("twist", relaxing(&[(1.1, 1.0), (1.2, 2.0)]))]);
    assert_eq!(line(&findings(&rows), "unstable"), "in no state");
    rows[2].stability = Stability::Unknown;
    let found = findings(&rows);
    assert_eq!(
        line(&found, "stability"),
        "not determined: state 2 (twist, Lmax/L = 1.2000)"
    );
    assert!(found.lines().iter().all(|(name, _)| name != "unstable"));
}

#[test]
fn the_largest_asymmetry_is_given_with_its_mode() {
    let mut rows = path(&[("tilt", relaxing(&[(1.1, 1.0), (1.2, 2.0)]))]);
    (rows[1].asymmetry, rows[1].asymmetry_mode) = (0.25, 1);
    (rows[2].asymmetry, rows[2].asymmetry_mode) = (1e-4, 2);
    assert_eq!(
        line(&findings(&rows), "asymmetry"),
        "at most 0.250 D, in circumferential mode 1 (tilts sideways), at state 1 (tilt, Lmax/L = 1.1000)"
    );
}

#[test]
fn the_asymmetry_of_the_first_state_is_no_result() {
    let mut rows = path(&[("tilt", relaxing(&[(1.1, 1.0), (1.2, 2.0)]))]);
    for row in &mut rows {
        (row.asymmetry, row.asymmetry_mode) = (3e-3, 1);
    }
    assert_eq!(
        line(&findings(&rows), "asymmetry"),
        "does not exceed the 3.0e-3 D of the first state"
    );
    rows[2].asymmetry = 0.25;
    let grown = line(&findings(&rows), "asymmetry");
    assert!(
        grown.starts_with("grows from 3.0e-3 D in the first state to at most 0.250 D"),
        "{grown}"
    );
}

#[test]
fn contact_is_reported_since_when_and_with_its_surface() {
    let steps = [
        (0.8, 5.0, 0.0),
        (0.41, 15.0, 0.0),
        (0.29, 21.0, 0.3),
        (0.3, 19.0, 0.2),
    ];
    let steps = steps.map(|(stretch, turn, area)| {
        change(move |row| {
            row.length_ratio += 0.1;
            row.contact.energy_share = Some(area / 100.0);
            let outer = &mut row.contact.walls[1];
            outer.surface_stretch = Some(stretch);
            outer.element_turn_deg = Some(turn);
            outer.area = Some(area);
            row.contact.walls[0].surface_stretch = Some(1.0);
        })
    });
    let mut rows = path(&[("relax", steps.into())]);
    rows[0] = rows[0].clone().with_contact();
    rows[0]
        .contact
        .walls
        .iter_mut()
        .for_each(|wall| wall.surface_stretch = Some(1.0));
    for row in &mut rows {
        *row = row.clone().with_contact();
    }
    let found = findings(&rows);
    let contact = found.contact.as_ref().unwrap();
    assert_eq!(contact.first.len(), 1);
    assert_eq!(
        (contact.first[0].wall.as_str(), contact.first[0].at.state),
        ("outer wall", 3)
    );
    let states = |intervals: &[Interval]| -> Vec<[usize; 2]> {
        let ends = |i: &Interval| [i.first.state, i.last.state];
        intervals.iter().map(ends).collect()
    };
    assert_eq!(states(&contact.crease), [[2, 4]]);
    assert_eq!(states(&contact.biot), [[3, 3]]);
    assert_eq!(states(&contact.unresolved), [[3, 3]]);
    assert_eq!(contact.smallest_stretch.at.state, 3);
    let touches = line(&found, "wall touches itself");
    assert!(
        touches.contains("the outer wall first at") && touches.contains("3.0e-3 W"),
        "{touches}"
    );
    let creases = line(&found, "surface creases");
    assert!(
        creases.contains("least 0.290 at the outer wall"),
        "{creases}"
    );
    let unresolved = line(&found, "crease finer than mesh");
    assert!(unresolved.contains("by up to 21°"), "{unresolved}");
    // Contact rules a crossing out.
    rows[4].gap = 0.0;
    let crosses = line(&findings(&rows), "wall crosses itself");
    assert!(!crosses.contains("no contact"), "{crosses}");
    assert_eq!(findings(&path(&[])).contact, None);
}
