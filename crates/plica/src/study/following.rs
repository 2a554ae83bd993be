//! The branch of equilibria of a plan: its parameter, its range, and what is located on it.

use crate::tube::Load;

/// A branch of equilibria under one parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Following {
    /// The parameter, as the case names it.
    pub of: String,
    /// The stage at whose end the branch begins, counted from 0.
    pub after: usize,
    /// Values of the parameter at the ends of its range, in the units of the case.
    pub range: [f64; 2],
    /// Loads with these values. Of other numbers they have those of the end of the stage.
    pub loads: [Load; 2],
    /// Events that are located.
    pub events: Vec<Event>,
    /// Modes to whose branches it switches.
    pub switches: Vec<Switch>,
    /// Longest step, as a fraction of the range.
    pub longest_step: f64,
    /// Largest number of points of a branch.
    pub points: usize,
    /// Columns of the history against which diagrams are drawn.
    pub plot: Vec<String>,
}

/// The name of the parameter among the columns whose values are located.
pub const PARAMETER: &str = "parameter";

/// An event on a branch.
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// An extreme value of the parameter.
    Fold,
    /// A change of the number of negative eigenvalues of a circumferential mode.
    Modes,
    /// The wall touches itself, or ceases to.
    Contact,
    /// An extreme value of the energy.
    Energy,
    /// A column of the history takes a value.
    Column(String, f64),
}

/// A switch to the branch of a mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Switch {
    /// The circumferential mode.
    pub mode: usize,
    /// Its amplitude at the first point, in D.
    pub amplitude: f64,
}

impl Following {
    /// Returns the value of the parameter in a load, with the largest difference of its numbers from those of the loads of
    /// the branch at that value.
    pub fn parameter_of(&self, load: &Load) -> (f64, f64) {
        let [from, to] = self.loads.each_ref().map(numbers);
        let at = numbers(load);
        let (mut product, mut square) = (0.0, 0.0);
        for i in 0..at.len() {
            let way = to[i] - from[i];
            product += way * (at[i] - from[i]);
            square += way * way;
        }
        let t = product / square;
        let apart = |i: usize| (at[i] - from[i] - t * (to[i] - from[i])).abs();
        let apart = (0..at.len()).map(apart).fold(0.0, f64::max);
        let [a, b] = self.range;
        (a + t * (b - a), apart)
    }
}

/// Returns the numbers of a load, without the volume of the lumen, which is another way to drive the pressure in it.
fn numbers(load: &Load) -> Vec<f64> {
    let mut all = [&load.muscles[..], &load.shifts, &load.patches].concat();
    for end in &load.ends {
        all.extend([end.displacement, end.twist]);
        all.extend(end.shift.iter().chain(&end.tilt));
    }
    for pressure in &load.pressures {
        all.extend([pressure.follower, pressure.dead]);
    }
    for placement in &load.obstacles {
        all.push(placement.radius);
        all.extend(placement.position);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::super::fixture;
    use super::*;

    #[test]
    fn the_parameter_of_a_load_is_its_place_between_the_two_loads() {
        let rest = fixture::short().rest();
        let moved = |x: f64| {
            let mut load = rest.clone();
            load.ends[1].displacement = x;
            load
        };
        let following = Following {
            of: "ileum.displacement".into(),
            after: 0,
            range: [10.0, 20.0],
            loads: [moved(0.1), moved(0.2)],
            events: vec![],
            switches: vec![],
            longest_step: 0.04,
            points: 100,
            plot: vec![],
        };
        let (parameter, apart) = following.parameter_of(&moved(0.13));
        assert!((parameter - 13.0).abs() < 1e-12 && apart < 1e-15);
        let mut other = moved(0.13);
        other.pressures[1].follower = 0.5;
        assert_eq!(following.parameter_of(&other).1, 0.5);
    }
}
