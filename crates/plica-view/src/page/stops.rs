//! Which states of several runs are shown together.

use plica::saved_state::SavedState;
use plica::study::{Row, Scale};
use std::collections::BTreeMap;

/// How near states count as equally near, in what loads vary by: then the one as far along its path is taken.
const ALIKE: f64 = 1e-9;

/// A stop of the slider: of every run the number of a drawn state, and how far its load is from that of the first named, in
/// what loads vary by.
pub type Stop = Vec<(usize, f64)>;

/// A load by the names of its parts; what has no name here is at rest.
pub type Parts = BTreeMap<String, f64>;

/// The states of the run that has most, and of each other run those under the nearest load, as far as both vary; where nothing
/// varies in both, as far along their paths. And which run has most. Runs are given by the loads of their states.
pub fn stops(loads: &[Vec<Parts>]) -> (usize, Vec<Stop>) {
    let all = sizes(loads.iter().flatten());
    // The first of those that have most.
    let most = |&a: &usize, &b: &usize| loads[a].len().cmp(&loads[b].len()).then(b.cmp(&a));
    let leader = (0..loads.len()).max_by(most).unwrap_or(0);
    let varied: Vec<Parts> = loads.iter().map(|loads| sizes(loads.iter())).collect();
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
            let near = (0..others.len()).filter(|&i| off(i) <= least + ALIKE);
            let best = near.min_by(|a, b| late(a).total_cmp(&late(b))).unwrap_or(0);
            (best, apart(&loads[leader][k], &others[best], &all))
        };
        loads.iter().enumerate().map(nearest).collect()
    };
    (leader, (0..loads[leader].len()).map(stop).collect())
}

/// The load of a saved state.
pub fn of_state(state: &SavedState) -> Parts {
    let load = &state.load;
    let names = state
        .muscles
        .iter()
        .map(|(name, _)| format!("muscle {name}"));
    // Of a muscle at rest, 1 as well, and so nothing.
    let muscles = names.zip(load.muscles.iter().map(|target| target - 1.0));
    let [inner, outer] = load.pressures;
    let pressures = [inner.follower, outer.follower, inner.dead, outer.dead];
    let [colon, ileum] = load.ends;
    let ends = [
        colon.displacement,
        ileum.displacement,
        colon.twist,
        ileum.twist,
    ];
    muscles.chain(outside(ends, pressures)).collect()
}

/// The load of a row of the history in the tables' units, as far as it tells it: not of every muscle.
pub fn of_row(row: &Row, scale: &Scale) -> Parts {
    let ends = [
        row.colon_displacement / scale.length,
        row.ileum_displacement / scale.length,
        row.colon_twist_deg.to_radians(),
        row.ileum_twist_deg.to_radians(),
    ];
    let pressures = [
        row.inner_pressure,
        row.outer_pressure,
        row.inner_dead_load,
        row.outer_dead_load,
    ];
    let pressures = pressures.map(|p| p.unwrap_or(0.0) / scale.stress);
    outside(ends, pressures).collect()
}

/// What is done to a tube from outside: displacement and twist of its ends; pressures that follow the inner and the outer wall,
/// and dead ones.
fn outside(ends: [f64; 4], pressures: [f64; 4]) -> impl Iterator<Item = (String, f64)> {
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

/// By how much each part varies.
fn sizes<'a>(loads: impl Iterator<Item = &'a Parts>) -> Parts {
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
    use plica::activation::Direction;
    use plica::tube::Symmetry;

    fn state(muscle: f64, dead: f64) -> SavedState {
        let mut state = fixture::state(&fixture::plan(Symmetry::Axisymmetric), 0);
        state.muscles = vec![("circular".into(), Direction::Circular)];
        state.load.muscles = vec![muscle];
        state.load.pressures[1].dead = dead;
        state
    }

    fn both(a: &[SavedState], b: &[SavedState]) -> (usize, Vec<Stop>) {
        stops(&[a, b].map(|run| run.iter().map(of_state).collect::<Vec<Parts>>()))
    }

    /// The states of the second run that go with those of the first.
    fn pairs(a: &[SavedState], b: &[SavedState]) -> Vec<usize> {
        let (leader, stops) = both(a, b);
        assert_eq!(leader, 0);
        stops.iter().map(|stop| stop[1].0).collect()
    }

    #[test]
    fn like_loads_meet_whatever_their_numbers() {
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
    fn a_path_that_goes_back_meets_the_half_it_is_in() {
        let there_and_back = [1.0, 0.5, 0.2, 0.5, 1.0].map(|x| state(x, 0.0));
        assert_eq!(pairs(&there_and_back, &there_and_back), [0, 1, 2, 3, 4]);
    }

    #[test]
    fn loads_with_nothing_in_common_go_side_by_side() {
        let a = [1.0, 0.8, 0.6, 0.4, 0.2].map(|x| state(x, 0.0));
        let b = [0.0, 1e-3, 2e-3].map(|x| state(1.0, x));
        assert_eq!(pairs(&a, &b), [0, 0, 1, 1, 2]);
        let (_, stops) = both(&a, &b);
        assert!(stops[4][1].1 > 0.5);
    }
}
