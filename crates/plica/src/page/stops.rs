//! Which states of several runs are shown together.

use crate::study::SavedState;
use std::collections::BTreeMap;

/// How near states count as equally near, in what loads vary by: then the one as far along its path is taken.
const ALIKE: f64 = 1e-9;

/// A stop of the slider: of every run the number of a drawn state, and how far its load is from that of the first named, in
/// what loads vary by.
pub type Stop = Vec<(usize, f64)>;

/// A load by the names of its parts; what has no name here is at rest.
type Parts = BTreeMap<String, f64>;

/// The states of the run that has most, and of each other run those under the nearest load, as far as both vary; where nothing
/// varies in both, as far along their paths. And which run has most.
pub fn stops(runs: &[Vec<&SavedState>]) -> (usize, Vec<Stop>) {
    let loads: Vec<Vec<Parts>> = (runs.iter())
        .map(|states| states.iter().map(|state| parts(state)).collect())
        .collect();
    let all = sizes(loads.iter().flatten());
    // The first of those that have most.
    let most = |&a: &usize, &b: &usize| runs[a].len().cmp(&runs[b].len()).then(b.cmp(&a));
    let leader = (0..runs.len()).max_by(most).unwrap_or(0);
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

fn parts(state: &SavedState) -> Parts {
    let load = &state.load;
    let names = state
        .muscles
        .iter()
        .map(|(name, _)| format!("muscle {name}"));
    // Of a muscle at rest, 1 as well, and so nothing.
    let muscles = names.zip(load.muscles.iter().map(|target| target - 1.0));
    let ends = ["colon", "ileum"].into_iter().zip(&load.ends);
    let ends = ends.flat_map(|(name, end)| {
        [
            (format!("displacement {name}"), end.displacement),
            (format!("twist {name}"), end.twist),
        ]
    });
    let walls = ["inner", "outer"].into_iter().zip(&load.pressures);
    let walls = walls.flat_map(|(name, pressure)| {
        [
            (format!("pressure {name}"), pressure.follower),
            (format!("dead {name}"), pressure.dead),
        ]
    });
    muscles.chain(ends).chain(walls).collect()
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
    use crate::activation::Direction;
    use crate::study::Layout;
    use crate::tube::{EndMotion, Load, Mesh, Pressure};

    fn state(muscle: f64, dead: f64) -> SavedState {
        let mesh = Mesh {
            axial: 6,
            around: 12,
            thickness: 4,
            degree: 3,
            refinements: vec![],
            volumetric: Default::default(),
        };
        SavedState {
            stage: String::new(),
            row: 0,
            along: 0.0,
            muscles: vec![("circular".into(), Direction::Circular)],
            load: Load {
                muscles: vec![muscle],
                ends: [EndMotion::default(); 2],
                pressures: [
                    Pressure::default(),
                    Pressure {
                        follower: 0.0,
                        dead,
                    },
                ],
            },
            layout: Layout {
                length: 1.0,
                thickness: 0.1,
                mesh,
                rings: 1,
            },
            u: vec![],
            arrays: Default::default(),
        }
    }

    /// The states of the second run that go with those of the first.
    fn pairs(a: &[SavedState], b: &[SavedState]) -> Vec<usize> {
        let (leader, stops) = stops(&[a.iter().collect(), b.iter().collect()]);
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
        let (_, stops) = stops(&[a.iter().collect(), b.iter().collect()]);
        assert!(stops[4][1].1 > 0.5);
    }
}
