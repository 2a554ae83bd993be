//! Limit points of what a stage drives.

use super::{Plan, Scale};
use crate::activation::Direction;
use crate::tube::Load;
use std::fmt;

/// An extreme value of one driven quantity along a path: no equilibrium beyond it is connected with the states before.
#[derive(Clone, Debug, PartialEq)]
pub struct LimitPoint {
    /// The quantity as the `drive` table of a case names it, such as `inner-wall.pressure`.
    pub quantity: String,
    /// Extrapolated value, in the unit of the case.
    pub value: f64,
    /// The unit; empty for a ratio.
    pub unit: String,
    /// True for a maximum, false for a minimum.
    pub is_maximum: bool,
}

impl LimitPoint {
    /// Returns the limit points of all quantities that change from the last good load to the load at the limit point.
    pub(super) fn between(plan: &Plan, last: &Load, limit: &Load) -> Vec<Self> {
        let [last, limit] = [last, limit].map(|load| quantities(plan, load));
        let pairs = last.into_iter().zip(limit);
        let changed = pairs.filter(|((_, last, _), (_, limit, _))| last != limit);
        changed
            .map(|((_, last, _), (quantity, value, unit))| Self {
                is_maximum: value > last,
                quantity,
                value,
                unit,
            })
            .collect()
    }
}

/// Returns the names, values and units of everything that a stage can drive.
fn quantities(plan: &Plan, load: &Load) -> Vec<(String, f64, String)> {
    let scale = Scale::of(plan.units.as_ref());
    let mut all = vec![];
    for (muscle, ratio) in plan.tube.muscles.iter().zip(&load.muscles) {
        let target = match muscle.direction {
            Direction::Circular => "diameter_ratio",
            Direction::Longitudinal => "length_ratio",
        };
        all.push((format!("{}.{target}", muscle.name), *ratio, String::new()));
    }
    for (end, motion) in plan.end_names.iter().zip(&load.ends) {
        let displacement = scale.length * motion.displacement;
        let (twist, degrees) = (motion.twist.to_degrees(), "degrees".to_owned());
        all.push((
            format!("{end}.displacement"),
            displacement,
            scale.length_name.clone(),
        ));
        all.push((format!("{end}.twist_degrees"), twist, degrees));
    }
    for (wall, pressure) in ["inner-wall", "outer-wall"].iter().zip(&load.pressures) {
        let [follower, dead] = [pressure.follower, pressure.dead].map(|p| scale.stress * p);
        all.push((
            format!("{wall}.pressure"),
            follower,
            scale.stress_name.clone(),
        ));
        all.push((format!("{wall}.dead_load"), dead, scale.stress_name.clone()));
    }
    all
}

impl fmt::Display for LimitPoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let extreme = if self.is_maximum {
            "maximum"
        } else {
            "minimum"
        };
        let (quantity, value) = (&self.quantity, significant(self.value));
        write!(f, "{quantity} has a {extreme} near {value}")?;
        match self.unit.as_str() {
            "" => Ok(()),
            unit => write!(f, " {unit}"),
        }
    }
}

/// Rounds to three digits.
fn significant(x: f64) -> f64 {
    format!("{x:.2e}").parse().unwrap_or(x)
}
