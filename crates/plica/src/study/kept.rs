//! What of a plan must stay while a run is left.

use super::{Plan, SavedState, Start};
use crate::tube::Load;

/// What keeps a run that was begun by one plan, and has come so far into a stage, from going on by another, in words; nothing if it can
/// go on. The title, the solver, the outputs, the number of steps of the stage it is in and all later stages may change.
pub fn kept(old: &Plan, new: &Plan, within: Option<(usize, f64)>) -> Vec<String> {
    let mut other = vec![];
    let mut hold = |same: bool, what: String| {
        if !same {
            other.push(what);
        }
    };
    hold(old.tube == new.tube, "the tube".into());
    hold(old.mesh == new.mesh, "the mesh".into());
    hold(old.symmetry == new.symmetry, "the symmetry".into());
    hold(old.units == new.units, "the units".into());
    // Wherever it lies.
    fn start(plan: &Plan) -> Option<(&Load, &SavedState)> {
        let start = plan.start.as_ref();
        start.map(|Start { load, state, .. }| (load, state))
    }
    let same_start = start(old) == start(new);
    let what = match (&old.start, &new.start) {
        (Some(_), Some(new)) => {
            format!("the state that it starts from (`{}` is another)", new.file)
        }
        _ => "the start".into(),
    };
    hold(same_start, what);
    // Stages go on from the start.
    let begun = within
        .filter(|_| same_start)
        .map_or(0, |(stage, _)| stage + 1);
    for k in 0..begun {
        let is_done = within.is_some_and(|(stage, reached)| k < stage || reached == 1.0);
        let steps = |plan: &Plan| {
            plan.stages
                .get(k)
                .map(|stage| stage.steps)
                .filter(|_| is_done)
        };
        let of = |plan: &Plan| {
            plan.stages
                .get(k)
                .map(|stage| (stage.name.clone(), stage.load.clone()))
        };
        let name = &old.stages[k].name;
        let same = of(old) == of(new) && steps(old) == steps(new);
        hold(same, format!("stage `{name}`, which has begun"));
    }
    other
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::{Stage, fixture};
    use crate::tube::Symmetry;

    #[test]
    fn what_is_behind_must_stay_and_what_is_ahead_may_change() {
        let mut old = fixture::plan(Symmetry::Axisymmetric);
        for name in ["a", "b", "c"] {
            old.stages.push(Stage {
                name: name.into(),
                load: old.tube.rest(),
                steps: 4,
            });
        }
        let change = |change: fn(&mut Plan)| {
            let mut new = old.clone();
            change(&mut new);
            kept(&old, &new, Some((1, 0.5)))
        };
        assert!(change(|_| {}).is_empty());
        assert!(change(|plan| plan.title = "another".into()).is_empty());
        assert!(change(|plan| plan.solver.max_step_halvings = 2).is_empty());
        assert!(change(|plan| plan.output.states_every = 7).is_empty());
        assert!(change(|plan| plan.stages[1].steps = 9).is_empty());
        assert!(change(|plan| plan.stages[2].load.ends[0].twist = 1.0).is_empty());
        assert!(change(|plan| plan.stages.truncate(2)).is_empty());
        assert_eq!(change(|plan| plan.tube.length = 2.0), ["the tube"]);
        assert_eq!(change(|plan| plan.mesh.axial = 9), ["the mesh"]);
        assert_eq!(
            change(|plan| plan.symmetry = Symmetry::Fold(2)),
            ["the symmetry"]
        );
        let begun = change(|plan| {
            plan.start = Some(Start {
                file: "state-3".into(),
                load: plan.tube.rest(),
                state: fixture::state(plan, 3),
            });
        });
        assert_eq!(begun, ["the start"]);
        let ended = change(|plan| plan.stages[1].load.ends[0].twist = 1.0);
        assert_eq!(ended, ["stage `b`, which has begun"]);
        assert_eq!(change(|plan| plan.stages.truncate(1)).len(), 1);
        assert_eq!(change(|plan| plan.stages[0].steps = 9).len(), 1);
    }
}
