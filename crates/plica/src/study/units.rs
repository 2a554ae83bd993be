//! Real units, at the border only.

use super::{Quantity, Units};

/// Factors from the dimensionless numbers inside to those of a table, and their names.
#[derive(Clone, Debug, PartialEq)]
pub struct Scale {
    /// Length: D in the unit of the case.
    pub length: f64,
    /// Energy: E·D³ in joules times a power of ten.
    pub energy: f64,
    /// Stress: E in the unit of the case.
    pub stress: f64,
    /// Force: E·D² in newtons times a power of ten.
    pub force: f64,
    /// Moment: E·D³ in newton metres times a power of ten.
    pub moment: f64,
    /// Name of the unit of length.
    pub length_name: String,
    /// Name of the unit of energy.
    pub energy_name: String,
    /// Name of the unit of stress.
    pub stress_name: String,
    /// Name of the unit of area.
    pub area_name: String,
    /// Name of the unit of volume.
    pub volume_name: String,
    /// Name of the unit of force.
    pub force_name: String,
    /// Name of the unit of moment.
    pub moment_name: String,
}

impl Scale {
    /// Returns the scale of a case with units, or the dimensionless scale.
    pub fn of(units: Option<&Units>) -> Self {
        let Some(units) = units else {
            return Self {
                length: 1.0,
                energy: 1.0,
                stress: 1.0,
                force: 1.0,
                moment: 1.0,
                length_name: "D".into(),
                energy_name: "E D^3".into(),
                stress_name: "E".into(),
                area_name: "D^2".into(),
                volume_name: "D^3".into(),
                force_name: "E D^2".into(),
                moment_name: "E D^3".into(),
            };
        };
        // The powers of ten of a newton and of a joule, which is a newton metre.
        let (stress, length) = (units.stress.power(), units.length.power());
        let (force, work) = (stress + 2 * length, stress + 3 * length);
        let [(of_force, newton), (of_work, joule)] = [force, work].map(prefix);
        let size = |cubed: i32, power: i32| {
            units.youngs_modulus * units.diameter.powi(cubed) * 10_f64.powi(power)
        };
        Self {
            length: units.diameter,
            energy: size(3, work - of_work),
            stress: units.youngs_modulus,
            force: size(2, force - of_force),
            moment: size(3, work - of_work),
            length_name: units.length.to_string(),
            energy_name: format!("{joule}J"),
            stress_name: units.stress.to_string(),
            area_name: format!("{}^2", units.length),
            volume_name: format!("{}^3", units.length),
            force_name: format!("{newton}N"),
            moment_name: format!("{joule}N m"),
        }
    }

    /// Returns the factor of volumes, D³.
    pub(super) fn volume(&self) -> f64 {
        self.length.powi(3)
    }
}

/// Returns the power of ten of the nearest prefix, and its letter.
fn prefix(power: i32) -> (i32, &'static str) {
    match power {
        -18..=-13 => (-15, "f"),
        -12..=-10 => (-12, "p"),
        -9..=-7 => (-9, "n"),
        -6..=-4 => (-6, "u"),
        -3..=-1 => (-3, "m"),
        _ => (0, ""),
    }
}

impl Scale {
    /// Returns the factor from the dimensionless numbers inside to those of a table.
    pub fn factor(&self, quantity: Quantity) -> f64 {
        match quantity {
            Quantity::Length => self.length,
            Quantity::Area => self.length * self.length,
            Quantity::Volume => self.volume(),
            Quantity::Force => self.force,
            Quantity::Moment => self.moment,
            Quantity::Stress => self.stress,
            Quantity::Energy => self.energy,
            Quantity::Text | Quantity::Count | Quantity::Ratio => 1.0,
            Quantity::Degrees | Quantity::Seconds | Quantity::Time => 1.0,
        }
    }

    /// Returns the name of the unit of a quantity; none for numbers without unit.
    pub fn unit(&self, quantity: Quantity) -> Option<&str> {
        match quantity {
            Quantity::Length => Some(&self.length_name),
            Quantity::Area => Some(&self.area_name),
            Quantity::Volume => Some(&self.volume_name),
            Quantity::Force => Some(&self.force_name),
            Quantity::Moment => Some(&self.moment_name),
            Quantity::Stress => Some(&self.stress_name),
            Quantity::Energy => Some(&self.energy_name),
            Quantity::Degrees => Some("°"),
            Quantity::Seconds => Some("s"),
            Quantity::Text | Quantity::Count | Quantity::Ratio | Quantity::Time => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::{LengthUnit, StressUnit};

    #[test]
    fn kilopascals_and_millimetres_are_microjoules() {
        let units = Units {
            length: LengthUnit::Millimetre,
            stress: StressUnit::Kilopascal,
            diameter: 25.0,
            youngs_modulus: 20.0,
        };
        let scale = Scale::of(Some(&units));
        // 20e3 Pa · (25e-3 m)³ = 0.3125 J
        assert!((scale.energy - 0.3125e6).abs() < 1e-6);
        assert_eq!(scale.energy_name, "uJ");
        let metres = Units {
            length: LengthUnit::Centimetre,
            stress: StressUnit::Pascal,
            ..units
        };
        // 20 Pa · (0.25 m)³ = 0.3125 J
        let scale = Scale::of(Some(&metres));
        assert!((scale.energy - 0.3125e6).abs() < 1e-6 && scale.energy_name == "uJ");
    }

    #[test]
    fn energies_and_forces_have_the_prefix_of_their_units() {
        use crate::study::LengthUnit::{Centimetre, Metre, Micrometre, Millimetre};
        use crate::study::StressUnit::{Kilopascal, Megapascal, Pascal};
        for (length, stress, energy, force, joule, newton) in [
            (Metre, Megapascal, 1e6, 1e6, "J", "N"),
            (Centimetre, Megapascal, 1.0, 100.0, "J", "N"),
            (Millimetre, Megapascal, 1.0, 1.0, "mJ", "N"),
            (Millimetre, Pascal, 1.0, 1.0, "nJ", "uN"),
            (Micrometre, Megapascal, 1.0, 1.0, "pJ", "uN"),
            (Micrometre, Kilopascal, 1.0, 1.0, "fJ", "nN"),
        ] {
            let scale = Scale::of(Some(&Units {
                length,
                stress,
                diameter: 1.0,
                youngs_modulus: 1.0,
            }));
            let place = format!("{length} {stress}");
            assert!(
                (scale.energy / energy - 1.0).abs() < 1e-12,
                "{place}: {}",
                scale.energy
            );
            assert!(
                (scale.force / force - 1.0).abs() < 1e-12,
                "{place}: {}",
                scale.force
            );
            assert_eq!(
                (scale.energy_name.as_str(), scale.force_name.as_str()),
                (joule, newton),
                "{place}"
            );
        }
    }
}
