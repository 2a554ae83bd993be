//! A short balloon, followed in its pressure past the maximum.

use super::*;
use crate::stability::Harmonics;
use crate::study::Study;

/// A coarse balloon; `rest` is added to the case.
fn balloon(rest: &str) -> crate::study::Plan {
    let text = format!(
        "[tube]\nlength = 1.5\nthickness = 0.06\n\
         [mesh]\ncontrol_points = {{ axial = 16, around = 16, thickness = 4 }}\n\
         [output]\nstability_modes = 1\n{rest}"
    );
    crate::case::read(&text, "balloon").unwrap()
}

const FOLLOWED: &str = "[[stages]]\nsteps = 1\ndrive.inner-wall.pressure = 0.01\n\
    [continuation]\nof = 'inner-wall.pressure'\nbetween = [0.0, 0.05]\npoints = 60\nlongest_step = 0.1\n\
    locate = ['fold', 'modes', 'energy', 'lumen_volume = 4.0']\n";

fn follow(plan: &crate::study::Plan) -> (Follow, Branches) {
    let follow = Follow::new(plan).unwrap();
    let found = follow.run(&mut (), &mut |_| {}).unwrap();
    (follow, found)
}

#[test]
fn the_fold_of_a_balloon_is_the_pressure_maximum_of_its_path_in_the_volume() {
    let (_, found) = follow(&balloon(FOLLOWED));
    let fold = found.points.iter().find(|point| point.label == "LP1");
    let fold = fold.unwrap();
    assert!(matches!(fold.kind, PointKind::Fold(Some(curvature)) if curvature < 0.0));
    assert_eq!(fold.negative.each_ref().map(|negative| negative[0]), [0, 1]);
    // At the volume of the fold, and on both sides of it, by the path that drives the volume.
    let states = &found.branches[0].states;
    let at = |label: &str| {
        let mut states = states.iter();
        states.find(|state| state.label.as_deref() == Some(label))
    };
    let volume = at("LP1").unwrap().row.lumen_volume;
    let pressures = [0.97, 1.0, 1.03].map(|factor| {
        let driven = format!(
            "[[stages]]\nsteps = 6\ndrive.lumen.volume = {}\n",
            factor * volume
        );
        let states = Study::new(&balloon(&driven)).unwrap();
        states.last().unwrap().unwrap().lumen_pressure.unwrap()
    });
    let [before, maximum, after] = pressures;
    assert!((maximum - fold.parameter).abs() < 1e-8, "{maximum}");
    assert!(maximum - before.max(after) > 1e-6, "{pressures:?}");
    // The located value of a column.
    let event = at("EV1").unwrap();
    assert!((event.row.lumen_volume - 4.0).abs() < 1e-6);
}

#[test]
fn a_branch_has_two_parts_where_it_begins_inside_its_range() {
    let (_, found) = follow(&balloon(FOLLOWED));
    let [first, second] = &found.branches[..] else {
        panic!("{}", found.branches.len())
    };
    assert_eq!(
        (&first.end, &second.end),
        (&BranchEnd::Points, &BranchEnd::Range)
    );
    let ends = [first, second].map(|branch| branch.states.last().unwrap().parameter);
    assert!(ends[0] > 0.02 && ends[1] == 0.0, "{ends:?}");
    // No tube without load has energy.
    assert!(second.states.last().unwrap().row.energy.abs() < 1e-12);
    let header = &first.records()[0];
    assert_eq!(
        header[..4],
        ["arc_length", "parameter", "label", "negative_mode_0"]
    );
    assert!(
        !header
            .iter()
            .any(|name| name.starts_with("work_") || name == "step")
    );
    assert_eq!(first.records().len(), first.states.len() + 1);
}

#[test]
fn where_stability_to_a_mode_changes_its_eigenvalue_is_zero() {
    let (follow, found) = follow(&balloon(FOLLOWED));
    let changes = found.points.iter();
    let changes: Vec<&SpecialPoint> = changes
        .filter(|point| matches!(point.kind, PointKind::Mode(1, _)))
        .collect();
    assert!(!changes.is_empty());
    let harmonics = Harmonics::new(&follow.problem, 1);
    for point in changes {
        let state = &point.state;
        let pairs = harmonics.lowest(1, &state.load, &state.u, 1).unwrap();
        assert!(pairs[0].value.abs() < 1e-7, "{}", pairs[0].value);
        let [before, behind] = point.negative.each_ref().map(|negative| negative[1]);
        assert_eq!(before.abs_diff(behind), 1);
        let PointKind::Mode(_, rate) = point.kind else {
            unreachable!()
        };
        let states = &found.branches[point.branch - 1].states;
        let at = states
            .iter()
            .position(|state| state.label.as_ref() == Some(&point.label));
        let at = at.unwrap();
        let rises = states[at + 1].parameter > states[at - 1].parameter;
        assert_eq!(rate < 0.0, (behind > before) == rises, "{rate}");
        assert!(start_state(&follow, point, 0.01).is_some());
    }
}

#[test]
fn a_case_without_the_table_has_no_branch() {
    let plan = balloon("[[stages]]\ndrive.inner-wall.pressure = 0.01\n");
    assert!(matches!(Follow::new(&plan), Err(BranchError::NoBranch)));
}
