//! Changes of a plan that forbid resuming a run.

use super::{Plan, Start};
use crate::saved_state::SavedState;
use crate::tube::Load;

/// Returns the changes between two plans that forbid to resume a run of the old plan with the new one, in words; none if it
/// can be resumed.
///
/// `progress` is the stage in which the run is and the completed fraction of that stage; none before the first stage. The
/// title, the solver, the output, the number of steps of the current stage and all later stages may change.
pub fn forbidden_changes(old: &Plan, new: &Plan, progress: Option<(usize, f64)>) -> Vec<String> {
    let mut changes = vec![];
    let mut require = |same: bool, what: String| {
        if !same {
            changes.push(what);
        }
    };
    require(old.tube == new.tube, "the tube".into());
    require(old.mesh == new.mesh, "the mesh".into());
    require(old.symmetry == new.symmetry, "the symmetry".into());
    require(old.contact == new.contact, "the contact".into());
    require(old.friction == new.friction, "the friction".into());
    require(old.units == new.units, "the units".into());
    require(
        old.end_names == new.end_names,
        "the names of the ends".into(),
    );
    // The name of the file may change.
    fn start(plan: &Plan) -> Option<(&Load, &SavedState)> {
        let start = plan.start.as_ref();
        start.map(|Start { load, state, .. }| (load, state))
    }
    let same_start = start(old) == start(new);
    let what = match (&old.start, &new.start) {
        (Some(_), Some(new)) => {
            format!("the state to start from (`{}` holds another)", new.file)
        }
        _ => "the start".into(),
    };
    require(same_start, what);
    // Stages depend on the start.
    let begun = progress
        .filter(|_| same_start)
        .map_or(0, |(stage, _)| stage + 1);
    for k in 0..begun {
        let is_done = progress.is_some_and(|(stage, reached)| k < stage || reached == 1.0);
        let steps = |plan: &Plan| {
            plan.stages
                .get(k)
                .map(|stage| stage.steps)
                .filter(|_| is_done)
        };
        let of = |plan: &Plan| {
            plan.stages.get(k).map(|stage| {
                (
                    stage.name.clone(),
                    stage.load.clone(),
                    stage.course.clone(),
                    stage.duration,
                )
            })
        };
        let name = &old.stages[k].name;
        let same = of(old) == of(new) && steps(old) == steps(new);
        require(same, format!("stage `{name}`, which has begun"));
    }
    changes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::{Stage, fixture};
    use crate::tube::Symmetry;

    #[test]
    fn completed_stages_must_stay_and_later_ones_may_change() {
        let mut old = fixture::plan(Symmetry::Axisymmetric);
        for name in ["a", "b", "c"] {
            old.stages.push(Stage::new(name.into(), old.tube.rest(), 4));
        }
        let change = |change: fn(&mut Plan)| {
            let mut new = old.clone();
            change(&mut new);
            forbidden_changes(&old, &new, Some((1, 0.5)))
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
        assert_eq!(change(|plan| plan.friction = 0.1), ["the friction"]);
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
