//! Positions of the slider: states of several runs under similar loads.

use plica::saved_state::SavedState;
use plica::study::{Row, Scale};
use std::collections::BTreeMap;

/// Difference of distances below which two states are equally close; the one at the same fraction of its path is chosen.
const TOLERANCE: f64 = 1e-9;

/// A position of the slider: for every run the index of a drawn state, and the distance of its load from that of the leading
/// run, relative to the variation of the loads.
pub type Stop = Vec<(usize, f64)>;

/// Components of a load by name; missing components are zero.
pub type Parts = BTreeMap<String, f64>;

/// Returns the index of the leading run, which has the most states, and the positions of the slider: each state of the leading
/// run with the state of every other run under the nearest load, compared by the components that vary in both. Without
/// such components, states at the same fraction of their paths are matched. `loads` holds the loads of all states by run.
pub fn stops(loads: &[Vec<Parts>]) -> (usize, Vec<Stop>) {
    let all = variations(loads.iter().flatten());
    // The first of the runs with the most states.
    let most = |&a: &usize, &b: &usize| loads[a].len().cmp(&loads[b].len()).then(b.cmp(&a));
    let leader = (0..loads.len()).max_by(most).unwrap_or(0);
    let varied: Vec<Parts> = loads.iter().map(|loads| variations(loads.iter())).collect();
    let common: Vec<Parts> = varied
        .iter()
        .map(|own| {
            let both = |(name, _): &(&String, &f64)| {
                own.contains_key(*name) && varied[leader].contains_key(*name)
            };
            let both = all.iter().filter(both);
            both.map(|(name, size)| (name.clone(), *size)).collect()
        })
        .collect();
    let along = |k: usize, states: usize| k as f64 / (states.max(2) - 1) as f64;
    let stop = |k: usize| -> Stop {
        let nearest = |(run, others): (usize, &Vec<Parts>)| {
            if run == leader {
                return (k, 0.0);
            }
            let off = |i: usize| apart(&loads[leader][k], &others[i], &common[run]);
            let least = (0..others.len()).map(off).fold(f64::INFINITY, f64::min);
            let place = along(k, loads[leader].len());
            let late = |&i: &usize| (along(i, others.len()) - place).abs();
            let near = (0..others.len()).filter(|&i| off(i) <= least + TOLERANCE);
            let best = near.min_by(|a, b| late(a).total_cmp(&late(b))).unwrap_or(0);
            (best, apart(&loads[leader][k], &others[best], &all))
        };
        loads.iter().enumerate().map(nearest).collect()
    };
    (leader, (0..loads[leader].len()).map(stop).collect())
}

/// Returns the load of a saved state.
pub fn of_state(state: &SavedState) -> Parts {
    let load = &state.load;
    let names = state
        .muscles
        .iter()
        .map(|(name, _)| format!("muscle {name}"));
    let targets = state.muscles.iter().zip(&load.muscles);
    let muscles = names.zip(targets.map(|((_, target), value)| value - target.at_rest()));
    let names = state
        .muscles
        .iter()
        .map(|(name, _)| format!("shift {name}"));
    let shifts = names.zip(load.shifts.iter().copied());
    let shifts = shifts.filter(|(_, shift)| *shift != 0.0);
    let [inner, outer] = load.pressures;
    let pressures = [inner.follower, outer.follower, inner.dead, outer.dead];
    let [colon, ileum] = load.ends;
    let ends = [
        colon.displacement,
        ileum.displacement,
        colon.twist,
        ileum.twist,
    ];
    let muscles = muscles.chain(shifts);
    muscles.chain(external(ends, pressures)).collect()
}

/// Returns the load of a row of the history, which does not contain all muscles.
pub fn of_row(row: &Row, scale: &Scale) -> Parts {
    let ends = [
        row.ends[0].displacement / scale.length,
        row.ends[1].displacement / scale.length,
        row.ends[0].twist_deg.to_radians(),
        row.ends[1].twist_deg.to_radians(),
    ];
    let pressures = [
        row.inner_pressure,
        row.outer_pressure,
        row.inner_dead_load,
        row.outer_dead_load,
    ];
    let pressures = pressures.map(|p| p.unwrap_or(0.0) / scale.stress);
    external(ends, pressures).collect()
}

/// Names the components of the external load: displacements and twists of the ends, follower pressures, dead loads.
fn external(ends: [f64; 4], pressures: [f64; 4]) -> impl Iterator<Item = (String, f64)> {
    let names = [
        "displacement colon",
        "displacement ileum",
        "twist colon",
        "twist ileum",
        "pressure inner",
        "pressure outer",
        "dead inner",
        "dead outer",
    ];
    let values = ends.into_iter().chain(pressures);
    names.map(String::from).into_iter().zip(values)
}

/// Returns the variation of every component that varies.
fn variations<'a>(loads: impl Iterator<Item = &'a Parts>) -> Parts {
    let mut ends: BTreeMap<&String, [f64; 2]> = BTreeMap::new();
    for (name, &x) in loads.flatten() {
        let [low, high] = ends.entry(name).or_insert([x, x]);
        (*low, *high) = (low.min(x), high.max(x));
    }
    let varied = ends
        .into_iter()
        .map(|(name, [low, high])| (name.clone(), high - low));
    varied.filter(|(_, size)| *size > 0.0).collect()
}

fn apart(a: &Parts, b: &Parts, sizes: &Parts) -> f64 {
    let of = |load: &Parts, name: &String| load.get(name).copied().unwrap_or(0.0);
    let off = |(name, size): (&String, &f64)| (of(a, name) - of(b, name)).abs() / size;
    sizes.iter().map(off).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;
    use plica::activation::MuscleTarget;
    use plica::tube::Symmetry;

    fn state(muscle: f64, dead: f64) -> SavedState {
        let mut state = fixture::state(&fixture::plan(Symmetry::Axisymmetric), 0);
        state.muscles = vec![("circular".into(), MuscleTarget::DiameterRatio)];
        state.load.muscles = vec![muscle];
        state.load.pressures[1].dead = dead;
        state
    }

    fn both(a: &[SavedState], b: &[SavedState]) -> (usize, Vec<Stop>) {
        stops(&[a, b].map(|run| run.iter().map(of_state).collect::<Vec<Parts>>()))
    }

    /// Returns the states of the second run that are matched with those of the first.
    fn pairs(a: &[SavedState], b: &[SavedState]) -> Vec<usize> {
        let (leader, stops) = both(a, b);
        assert_eq!(leader, 0);
        stops.iter().map(|stop| stop[1].0).collect()
    }

    #[test]
    fn states_are_matched_by_load() {
        let a = [1.0, 0.8, 0.6, 0.4, 0.2].map(|x| state(x, 0.0));
        let b = [1.0, 0.6, 0.2].map(|x| state(x, 0.0));
        assert_eq!(pairs(&a, &b), [0, 0, 1, 1, 2]);
        let dead = [0.0, 2e-3, 4e-3, 6e-3].map(|x| state(1.0, x));
        assert_eq!(
            pairs(&dead, &[dead[0].clone(), dead[3].clone(), dead[2].clone()]),
            [0, 0, 2, 1]
        );
    }

    #[test]
    fn a_path_back_is_matched_with_itself() {
        let there_and_back = [1.0, 0.5, 0.2, 0.5, 1.0].map(|x| state(x, 0.0));
        assert_eq!(pairs(&there_and_back, &there_and_back), [0, 1, 2, 3, 4]);
    }

    #[test]
    fn loads_without_common_components_are_matched_by_fraction() {
        let a = [1.0, 0.8, 0.6, 0.4, 0.2].map(|x| state(x, 0.0));
        let b = [0.0, 1e-3, 2e-3].map(|x| state(1.0, x));
        assert_eq!(pairs(&a, &b), [0, 0, 1, 1, 2]);
        let (_, stops) = both(&a, &b);
        assert!(stops[4][1].1 > 0.5);
    }
}
