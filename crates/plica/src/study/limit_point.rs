//! Limit points of what a stage drives.

use super::{Plan, Scale};
use crate::activation::MuscleTarget;
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
    let drives = load.muscles.iter().zip(&load.shifts);
    for (muscle, (ratio, shift)) in plan.tube.muscles.iter().zip(drives) {
        let target = muscle.target();
        let (value, unit) = match target {
            MuscleTarget::Tension => (scale.stress * ratio, scale.stress_name.clone()),
            _ => (*ratio, String::new()),
        };
        all.push((format!("{}.{}", muscle.name, target.name()), value, unit));
        let shift = scale.length * shift;
        all.push((
            format!("{}.shift", muscle.name),
            shift,
            scale.length_name.clone(),
        ));
    }
    for (end, motion) in plan.end_names.iter().zip(&load.ends) {
        let displacement = scale.length * motion.displacement;
        let (twist, degrees) = (motion.twist.to_degrees(), "degrees".to_owned());
        all.push((
            format!("{end}.displacement"),
            displacement,
            scale.length_name.clone(),
        ));
        all.push((format!("{end}.twist_degrees"), twist, degrees.clone()));
        for (k, axis) in ["x", "y"].iter().enumerate() {
            let shift = scale.length * motion.shift[k];
            all.push((
                format!("{axis} of {end}.shift"),
                shift,
                scale.length_name.clone(),
            ));
            let tilt = motion.tilt[k].to_degrees();
            all.push((
                format!("{axis} of {end}.tilt_degrees"),
                tilt,
                degrees.clone(),
            ));
        }
    }
    if let Some(ratio) = load.lumen_volume {
        all.push(("lumen.volume_ratio".into(), ratio, String::new()));
    }
    // The pressure in a driven lumen is a result.
    let load = load.clone().without_multiplier();
    for (wall, pressure) in ["inner-wall", "outer-wall"].iter().zip(&load.pressures) {
        let [follower, dead] = [pressure.follower, pressure.dead].map(|p| scale.stress * p);
        all.push((
            format!("{wall}.pressure"),
            follower,
            scale.stress_name.clone(),
        ));
        all.push((format!("{wall}.dead_load"), dead, scale.stress_name.clone()));
    }
    for (obstacle, placement) in plan.tube.obstacles.iter().zip(&load.obstacles) {
        let (name, unit) = (&obstacle.name, &scale.length_name);
        let radius = scale.length * placement.radius;
        all.push((format!("{name}.radius"), radius, unit.clone()));
        // From (z, x, y).
        for (axis, i) in ["x", "y", "z"].iter().zip([1, 2, 0]) {
            let x = scale.length * placement.position[i];
            all.push((format!("{axis} of {name}.position"), x, unit.clone()));
        }
    }
    for (patch, growth) in plan.tube.patches.iter().zip(&load.patches) {
        let name = format!("{}.growth_through", patch.name);
        all.push((name, *growth, String::new()));
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

#[cfg(test)]
mod tests {
    use super::super::fixture::plan;
    use super::*;
    use crate::activation::{Direction, Muscle, Profile};
    use crate::study::{LengthUnit, StressUnit, Units};
    use crate::tube::{EndMotion, Pressure, Symmetry};

    #[test]
    fn every_quantity_that_changes_has_its_limit_in_the_unit_of_the_case() {
        let mut plan = plan(Symmetry::Axisymmetric);
        let muscle = |name: &str, direction| {
            Muscle::new(name.into(), direction, [0.1, 0.8], Profile::RaisedCosine)
        };
        plan.tube.muscles = vec![
            muscle("ring", Direction::Circular),
            muscle("long", Direction::Longitudinal),
        ];
        plan.units = Some(Units {
            length: LengthUnit::Millimetre,
            stress: StressUnit::Kilopascal,
            diameter: 25.0,
            youngs_modulus: 20.0,
        });
        let load = |x: f64| Load {
            muscles: vec![1.0 - x, 1.0 + x],
            shifts: vec![0.0, -x],
            ends: [1.0, -2.0].map(|sign| EndMotion {
                displacement: sign * x,
                twist: sign * x.to_radians(),
                ..EndMotion::default()
            }),
            pressures: [3.0, -4.0].map(|sign| Pressure {
                follower: sign * x,
                dead: 10.0 * sign * x,
            }),
            lumen_volume: None,
            obstacles: vec![],
            patches: vec![],
        };
        let found = LimitPoint::between(&plan, &load(0.1), &load(0.2));
        let texts: Vec<String> = found.iter().map(LimitPoint::to_string).collect();
        let expected = [
            "ring.diameter_ratio has a minimum near 0.8",
            "long.length_ratio has a maximum near 1.2",
            "long.shift has a minimum near -5 mm",
            "colon.displacement has a maximum near 5 mm",
            "colon.twist_degrees has a maximum near 0.2 degrees",
            "ileum.displacement has a minimum near -10 mm",
            "ileum.twist_degrees has a minimum near -0.4 degrees",
            "inner-wall.pressure has a maximum near 12 kPa",
            "inner-wall.dead_load has a maximum near 120 kPa",
            "outer-wall.pressure has a minimum near -16 kPa",
            "outer-wall.dead_load has a minimum near -160 kPa",
        ];
        assert_eq!(texts, expected);
        let mut pressed = load(0.1);
        pressed.pressures[1].follower = 0.5;
        let found = LimitPoint::between(&plan, &load(0.1), &pressed);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].quantity, "outer-wall.pressure");
    }
}
