//! A study in memory: its states, cancellation, resumption and loss.

use plica::monitor::Monitor;
use plica::study::{Ending, Plan, State, Study, StudyError};
use std::cell::Cell;
use std::fmt::Display;

/// Returns the main case on a coarse mesh, with a few steps before and after the snap.
fn plan() -> Plan {
    let text = include_str!("../../../cases/invagination.toml");
    let mut plan = plica::case::read(text, "invagination").unwrap();
    (plan.mesh.axial, plan.mesh.around, plan.mesh.thickness) = (40, 12, 4);
    (plan.stages[0].steps, plan.stages[1].steps) = (3, 5);
    plan.output.stability_modes = 1;
    plan
}

/// Returns the numbers of a state that do not depend on the clock.
fn numbers(state: &State) -> (usize, Vec<u64>) {
    let floats = [
        state.energy,
        state.relative_residual,
        state.measures.overhang,
        state.damping_work(),
    ];
    let bits = floats.iter().chain(&state.unknowns).map(|x| x.to_bits());
    (state.number, bits.collect())
}

#[test]
fn a_study_resumed_from_memory_gives_the_same_states_to_the_bit() {
    let plan = plan();
    let mut whole = Study::new(&plan).unwrap();
    let (mut states, mut continuations) = (vec![], vec![]);
    while let Some(state) = whole.next() {
        states.push(numbers(&state.unwrap()));
        continuations.push(whole.continuation().unwrap());
    }
    assert_eq!(states.len(), 9);
    assert_eq!(whole.ending(), Some(&Ending::Complete));
    for number in [0, 2, 3, 6, 8] {
        let resumed = Study::resume(&plan, continuations[number].clone()).unwrap();
        let rest: Vec<_> = resumed.map(|state| numbers(&state.unwrap())).collect();
        assert_eq!(rest, states[number + 1..], "after state {number}");
    }
}

#[test]
fn a_continuation_of_another_plan_is_refused() {
    let plan = plan();
    let mut study = Study::new(&plan).unwrap();
    let states = study.by_ref().take(5).filter(Result::is_ok).count();
    assert_eq!(states, 5);
    let continuation = study.continuation().unwrap();
    let mut shorter = plan.clone();
    shorter.stages.truncate(1);
    let refused = Study::resume(&shorter, continuation);
    assert!(matches!(refused, Err(StudyError::Resume(_))));
}

/// Cancels after a number of reports.
struct Limit {
    reports: Cell<usize>,
    limit: usize,
}

impl Monitor for Limit {
    fn working(&mut self, _: &dyn Display, fraction: f64) {
        assert!((0.0..=1.0).contains(&fraction), "{fraction}");
        self.reports.set(self.reports.get() + 1);
    }
    fn is_cancelled(&self) -> bool {
        self.reports.get() >= self.limit
    }
}

#[test]
fn a_cancelled_study_ends_without_an_error() {
    let mut study = Study::new(&plan()).unwrap();
    let mut monitor = Limit {
        reports: Cell::new(0),
        limit: 12,
    };
    let mut count = 0;
    while let Some(state) = study.next_state(&mut monitor) {
        state.unwrap();
        count += 1;
    }
    assert!((2..9).contains(&count), "{count}");
    assert_eq!(study.ending(), Some(&Ending::Stopped));
    assert!(study.continuation().is_none());
    assert!(study.next().is_none());
}

#[test]
fn a_lost_tube_is_one_error_after_its_last_state() {
    let mut plan = plan();
    // Too few iterations for any step, and no shorter steps.
    plan.solver.newton_iterations = 1;
    plan.solver.relaxation_steps = 1;
    plan.solver.max_step_halvings = 0;
    let items: Vec<_> = Study::new(&plan).unwrap().collect();
    let (last, before) = items.split_last().unwrap();
    assert!(before.iter().all(Result::is_ok) && !before.is_empty());
    let Err(StudyError::Lost(lost)) = last else {
        panic!("{last:?}");
    };
    assert!(!lost.error.attempts.is_empty());
    assert!(lost.to_string().contains("stage `contract`"), "{lost}");
}
