//! The driven quantity of a stage, in which critical values are expressed.

use crate::tube::{Load, Tube};

/// Rounding error of a sum of muscle targets.
const ROUNDING: f64 = 1e-12;

/// Names of the walls under pressure.
const WALLS: [&str; 2] = ["inside", "outside"];

/// A quantity that measures the load along a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Lmax/L.
    LengthRatio,
    /// Dmin/D.
    DiameterRatio,
    /// Displacement of the colon end, in D.
    ColonDisplacement,
    /// Displacement of the ileum end, in D.
    IleumDisplacement,
    /// Target of one muscle, if several change and their combination does not.
    Muscle(usize),
    /// Tension of a muscle with active stress, in E.
    Tension(usize),
    /// Shift of the zone of a muscle, in D.
    Shift(usize),
    /// Volume of the lumen over that at rest.
    LumenVolume,
    /// Follower pressure on the inner (0) or the outer (1) wall, in E.
    Pressure(usize),
    /// Dead load on the inner (0) or the outer (1) wall, in E.
    DeadLoad(usize),
    /// Radius of an obstacle, in D.
    Radius(usize),
    /// A component, (z, x, y), of the position of an obstacle, in D.
    Position(usize, usize),
    /// Growth through the wall of a patch.
    Growth(usize),
}

impl Quantity {
    /// Returns the quantity that changes most between two loads.
    pub fn between(tube: &Tube, from: &Load, to: &Load) -> Self {
        // The pressure in a driven lumen is a result.
        let [from, to] = match [from, to].iter().all(|load| load.lumen_volume.is_some()) {
            true => [from, to].map(|load| load.clone().without_multiplier()),
            false => [from, to].map(Load::clone),
        };
        let (from, to) = (&from, &to);
        let most = |quantities: &mut dyn Iterator<Item = Self>| {
            let change = |q: Self| (q.of(tube, to) - q.of(tube, from)).abs();
            quantities
                .map(|q| (q, change(q)))
                .reduce(|a, b| if b.1 > a.1 { b } else { a })
        };
        let named = [
            Self::LengthRatio,
            Self::DiameterRatio,
            Self::IleumDisplacement,
            Self::ColonDisplacement,
            Self::LumenVolume,
            Self::Pressure(0),
            Self::Pressure(1),
            Self::DeadLoad(0),
            Self::DeadLoad(1),
        ];
        let obstacles = 0..tube.obstacles.len();
        let of_obstacle = |i: usize| {
            let position = (0..3).map(move |k| Self::Position(i, k));
            std::iter::once(Self::Radius(i)).chain(position)
        };
        let patches = (0..tube.patches.len()).map(Self::Growth);
        let shifts = (0..tube.muscles.len()).map(Self::Shift);
        let tensions = (0..tube.muscles.len()).filter(|m| !tube.muscles[*m].grows());
        let others = obstacles.flat_map(of_obstacle).chain(patches).chain(shifts);
        let others = others.chain(tensions.map(Self::Tension));
        match most(&mut named.into_iter().chain(others)) {
            Some((quantity, change)) if change > ROUNDING => quantity,
            _ => most(&mut (0..tube.muscles.len()).map(Self::Muscle))
                .map_or(Self::LengthRatio, |(quantity, _)| quantity),
        }
    }

    /// Returns its value under a load.
    pub fn of(self, tube: &Tube, load: &Load) -> f64 {
        match self {
            Self::LengthRatio => tube.length_ratio(load),
            Self::DiameterRatio => tube.diameter_ratio(load),
            Self::ColonDisplacement => load.ends[0].displacement,
            Self::IleumDisplacement => load.ends[1].displacement,
            Self::Muscle(m) | Self::Tension(m) => load.muscles[m],
            Self::Shift(m) => load.shifts[m],
            Self::LumenVolume => load.lumen_volume.unwrap_or(1.0),
            Self::Pressure(wall) => load.pressures[wall].follower,
            Self::DeadLoad(wall) => load.pressures[wall].dead,
            Self::Radius(i) => load.obstacles[i].radius,
            Self::Position(i, k) => load.obstacles[i].position[k],
            Self::Growth(i) => load.patches[i],
        }
    }

    /// Returns its name in tables.
    pub fn name(self, tube: &Tube) -> String {
        match self {
            Self::LengthRatio => "Lmax/L".into(),
            Self::DiameterRatio => "Dmin/D".into(),
            Self::ColonDisplacement => "colon displacement/D".into(),
            Self::IleumDisplacement => "ileum displacement/D".into(),
            Self::Muscle(m) => format!("ratio of {}", tube.muscles[m].name),
            Self::Tension(m) => format!("tension of {}/E", tube.muscles[m].name),
            Self::Shift(m) => format!("shift of {}/D", tube.muscles[m].name),
            Self::LumenVolume => "volume/volume at rest".into(),
            Self::Pressure(wall) => format!("pressure {}/E", WALLS[wall]),
            Self::DeadLoad(wall) => format!("dead load {}/E", WALLS[wall]),
            Self::Radius(i) => format!("radius of {}/D", tube.obstacles[i].name),
            Self::Growth(i) => format!("growth of {}", tube.patches[i].name),
            Self::Position(i, k) => {
                format!("{} of {}/D", ["z", "x", "y"][k], tube.obstacles[i].name)
            }
        }
    }

    /// Returns whether it is a pressure or a tension, whose tolerance is relative.
    pub fn is_pressure(self) -> bool {
        matches!(
            self,
            Self::Pressure(_) | Self::DeadLoad(_) | Self::Tension(_)
        )
    }

    /// Formats a value for tables.
    pub fn format(self, value: f64, digits: usize) -> String {
        if self.is_pressure() {
            format!("{value:.digits$e}")
        } else {
            format!("{value:.digits$}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::activation::{Direction, Muscle, Profile};
    use crate::material::{Material, NeoHookean};
    use crate::tube::{Support, WallLayer};

    #[test]
    fn the_driven_quantity_is_the_one_that_changes_most() {
        let muscle = |name: &str, direction| {
            Muscle::new(name.into(), direction, [0.5, 1.0], Profile::RaisedCosine)
        };
        let tube = Tube {
            length: 3.0,
            thickness: 0.06,
            layers: vec![WallLayer::of(Material::NeoHookean(NeoHookean::new(
                1.0, 0.495,
            )))],
            muscles: vec![
                muscle("ring", Direction::Circular),
                muscle("a", Direction::Longitudinal),
                Muscle {
                    zone: [1.0, 1.5],
                    ..muscle("b", Direction::Longitudinal)
                },
            ],
            imperfections: vec![],
            obstacles: vec![],
            ends: [Support::Fixed; 2],
            patches: vec![],
            foundations: vec![],
        };
        let to = |muscles: [f64; 3], moved: f64| {
            let mut load = tube.rest();
            (load.muscles, load.ends[1].displacement) = (muscles.to_vec(), moved);
            Quantity::between(&tube, &tube.rest(), &load)
        };
        assert_eq!(to([0.5, 1.0, 1.0], 0.0), Quantity::DiameterRatio);
        assert_eq!(to([1.0, 1.1, 1.2], 0.0), Quantity::LengthRatio);
        assert_eq!(to([1.0, 1.0, 1.0], -0.2), Quantity::IleumDisplacement);
        let mut load = tube.rest();
        load.pressures[1].follower = 1e-5;
        let pressure = Quantity::between(&tube, &tube.rest(), &load);
        assert_eq!(pressure, Quantity::Pressure(1));
        assert_eq!(pressure.name(&tube), "pressure outside/E");
        assert_eq!(pressure.format(1.234e-5, 2), "1.23e-5");
        let dead = Quantity::DeadLoad(0);
        assert!(
            dead.is_pressure() && pressure.is_pressure() && !Quantity::LengthRatio.is_pressure()
        );
        assert_eq!(dead.name(&tube), "dead load inside/E");
        assert_eq!(Quantity::LengthRatio.format(1.25, 3), "1.250");
        // The sum of both targets is constant.
        assert_eq!(to([1.0, 1.5, 0.5], 0.0), Quantity::Muscle(1));
        let load = Load {
            muscles: vec![1.0, 1.5, 0.5],
            ..tube.rest()
        };
        let mut moved = load.clone();
        moved.shifts[2] = 0.1;
        assert_eq!(Quantity::between(&tube, &load, &moved), Quantity::Shift(2));
        assert_eq!(Quantity::Muscle(1).of(&tube, &load), 1.5);
        assert_eq!(Quantity::Muscle(1).name(&tube), "ratio of a");
    }
}
