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
    /// Name of the unit of length.
    pub length_name: String,
    /// Name of the unit of energy.
    pub energy_name: String,
    /// Name of the unit of stress.
    pub stress_name: String,
}

impl Scale {
    /// Returns the scale of a case with units, or the dimensionless scale.
    pub fn of(units: Option<&Units>) -> Self {
        let Some(units) = units else {
            return Self {
                length: 1.0,
                energy: 1.0,
                stress: 1.0,
                length_name: "D".into(),
                energy_name: "E D^3".into(),
                stress_name: "E".into(),
            };
        };
        // The power of ten of a joule: pascals times cubic metres.
        let power = units.stress.power() + 3 * units.length.power();
        let (named, energy_name) = match power {
            -18..=-13 => (-15, "fJ"),
            -12..=-10 => (-12, "pJ"),
            -9..=-7 => (-9, "nJ"),
            -6..=-4 => (-6, "uJ"),
            -3..=-1 => (-3, "mJ"),
            _ => (0, "J"),
        };
        Self {
            length: units.diameter,
            energy: units.youngs_modulus * units.diameter.powi(3) * 10_f64.powi(power - named),
            stress: units.youngs_modulus,
            length_name: units.length.to_string(),
            energy_name: energy_name.into(),
            stress_name: units.stress.to_string(),
        }
    }
}

impl Scale {
    /// Returns the factor from the dimensionless numbers inside to those of a table.
    pub fn factor(&self, quantity: Quantity) -> f64 {
        match quantity {
            Quantity::Length => self.length,
            Quantity::Stress => self.stress,
            Quantity::Energy => self.energy,
            Quantity::Text | Quantity::Count | Quantity::Ratio => 1.0,
            Quantity::Degrees | Quantity::Seconds => 1.0,
        }
    }

    /// Returns the name of the unit of a quantity; none for numbers without unit.
    pub fn unit(&self, quantity: Quantity) -> Option<&str> {
        match quantity {
            Quantity::Length => Some(&self.length_name),
            Quantity::Stress => Some(&self.stress_name),
            Quantity::Energy => Some(&self.energy_name),
            Quantity::Degrees => Some("°"),
            Quantity::Seconds => Some("s"),
            Quantity::Text | Quantity::Count | Quantity::Ratio => None,
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
}
