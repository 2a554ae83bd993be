//! Fields for the colours of a picture.

use crate::draw::{ColourMap, Range};
use crate::sampled_tube::FieldSample;
use plica::study::{Plan, Scale};

/// A scalar field on the wall.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Field {
    /// Strain energy density w, per volume after growth.
    #[default]
    EnergyDensity,
    /// Von Mises stress.
    VonMises,
    /// Mean pressure −tr σ/3.
    Pressure,
    /// Cauchy stress along the circles of the wall.
    HoopStress,
    /// Cauchy stress along the meridians of the wall.
    AxialStress,
    /// Cauchy stress through the wall.
    RadialStress,
    /// Elastic volume ratio det Fe.
    VolumeChange,
    /// Largest principal stretch of Fe.
    LargestStretch,
    /// Smallest principal stretch of Fe.
    SmallestStretch,
    /// Longitudinal growth stretch θζ.
    GrownAlong,
    /// Circumferential growth stretch θη.
    GrownAround,
    /// Magnitude of the displacement from the stress-free state.
    Displacement,
    /// Factor of patches on the energy of the law.
    StiffnessFactor,
    /// Sum of the tensions of muscles with active stress.
    Tension,
    /// Magnitude of the force of foundations on the outer wall, per area at rest; zero inside it.
    FoundationForce,
    /// Pressure of contact on the faces of the wall; zero inside it.
    ContactPressure,
}

/// Energy densities below this, in units of E, are rounding errors of a stress-free wall.
const ENERGY_ROUNDING: f64 = 1e-12;
/// Stresses, in units of E, and displacements, in units of D, below this are rounding errors.
const ROUNDING: f64 = 1e-12;

impl Field {
    /// All fields.
    pub const ALL: [Self; 16] = [
        Self::EnergyDensity,
        Self::VonMises,
        Self::Pressure,
        Self::HoopStress,
        Self::AxialStress,
        Self::RadialStress,
        Self::VolumeChange,
        Self::LargestStretch,
        Self::SmallestStretch,
        Self::GrownAlong,
        Self::GrownAround,
        Self::Displacement,
        Self::StiffnessFactor,
        Self::Tension,
        Self::FoundationForce,
        Self::ContactPressure,
    ];

    /// Returns the fields of a plan: all, without those of what the plan does not have.
    pub fn of_plan(plan: &Plan) -> Vec<Self> {
        let exists = |field: &Self| match field {
            Self::StiffnessFactor => {
                let patches = plan.tube.patches.iter();
                patches
                    .map(|patch| patch.stiffness)
                    .any(|factor| factor != 1.0)
            }
            Self::Tension => plan.tube.muscles.iter().any(|muscle| !muscle.grows()),
            Self::FoundationForce => !plan.tube.foundations.is_empty(),
            Self::ContactPressure => plan.contact,
            _ => true,
        };
        Self::ALL.into_iter().filter(exists).collect()
    }

    /// Returns the name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::EnergyDensity => "energy",
            Self::VonMises => "von-mises",
            Self::Pressure => "pressure",
            Self::HoopStress => "hoop-stress",
            Self::AxialStress => "axial-stress",
            Self::RadialStress => "radial-stress",
            Self::VolumeChange => "det-fe",
            Self::LargestStretch => "largest-stretch",
            Self::SmallestStretch => "smallest-stretch",
            Self::GrownAlong => "theta-zeta",
            Self::GrownAround => "theta-eta",
            Self::Displacement => "displacement",
            Self::StiffnessFactor => "stiffness-factor",
            Self::Tension => "tension",
            Self::FoundationForce => "foundation-force",
            Self::ContactPressure => "contact-pressure",
        }
    }

    /// Returns the colour map: diverging for a field of two signs.
    pub fn map(self) -> ColourMap {
        match self {
            Self::Pressure | Self::HoopStress | Self::AxialStress | Self::RadialStress => {
                ColourMap::Diverging
            }
            _ => ColourMap::default(),
        }
    }

    /// Returns the default rule for the colour range.
    pub fn range(self) -> Range {
        match self.map() {
            ColourMap::Diverging => Range::Symmetric,
            _ => Range::Automatic,
        }
    }

    /// Returns the dimensionless value at a point.
    pub(crate) fn of(self, sample: &FieldSample) -> f64 {
        let s = sample.stress.0;
        match self {
            Self::EnergyDensity if sample.energy_density < ENERGY_ROUNDING => 0.0,
            Self::EnergyDensity => sample.energy_density,
            Self::VonMises => above_rounding(sample.von_mises()),
            Self::Pressure => above_rounding(-(s[0][0] + s[1][1] + s[2][2]) / 3.0),
            Self::AxialStress => above_rounding(sample.wall_stresses()[0]),
            Self::RadialStress => above_rounding(sample.wall_stresses()[1]),
            Self::HoopStress => above_rounding(sample.wall_stresses()[2]),
            Self::VolumeChange => sample.jacobian,
            Self::LargestStretch => sample.stretches()[0].0,
            Self::SmallestStretch => sample.stretches()[2].0,
            Self::GrownAlong => sample.grown[0],
            Self::GrownAround => sample.grown[1],
            Self::Displacement => {
                let moved = [0, 1, 2].map(|i| sample.position[i] - sample.reference[i]);
                above_rounding(moved.iter().map(|x| x * x).sum::<f64>().sqrt())
            }
            Self::StiffnessFactor => sample.stiffness,
            Self::Tension => sample.tension,
            Self::FoundationForce => {
                let square: f64 = sample.foundation.iter().map(|x| x * x).sum();
                above_rounding(square.sqrt())
            }
            Self::ContactPressure => sample.contact_pressure,
        }
    }

    /// Returns the label of the colour bar with the unit, and the factor from dimensionless values to this unit.
    pub fn label(self, plan: &Plan) -> (String, f64) {
        let scale = Scale::of(plan.units.as_ref());
        let bare = plan.units.is_none();
        let stress = |name: &str, letter: &str| {
            if bare {
                (format!("{name} {letter}/*E*"), 1.0)
            } else {
                (
                    format!("{name} {letter} ({})", scale.stress_name),
                    scale.stress,
                )
            }
        };
        let plain = |name: &str| (name.to_owned(), 1.0);
        match self {
            Self::EnergyDensity => stress("strain energy density", "*w*"),
            Self::VonMises => stress("von Mises stress", "*σ*_{v}"),
            Self::Pressure => stress("pressure in the wall", "*p*"),
            Self::HoopStress => stress("hoop stress", "*σ*_{η}"),
            Self::AxialStress => stress("axial stress", "*σ*_{ζ}"),
            Self::RadialStress => stress("radial stress", "*σ*_{ξ}"),
            Self::ContactPressure => stress("pressure of contact", "*p*_{c}"),
            Self::StiffnessFactor => plain("stiffness factor of patches"),
            Self::Tension => stress("tension of muscles", "*T*"),
            Self::FoundationForce => stress("force of foundations per area", "*f*"),
            Self::VolumeChange => plain("elastic volume ratio det *F*_{e}"),
            Self::LargestStretch => plain("largest elastic stretch *λ*_{1}"),
            Self::SmallestStretch => plain("smallest elastic stretch *λ*_{3}"),
            Self::GrownAlong => plain("longitudinal growth stretch *θ*_{ζ}"),
            Self::GrownAround => plain("circumferential growth stretch *θ*_{η}"),
            Self::Displacement if bare => plain("displacement/*D*"),
            Self::Displacement => {
                let unit = scale.length_name.replace("um", "µm");
                (format!("displacement ({unit})"), scale.length)
            }
        }
    }
}

/// Replaces rounding errors by zero.
fn above_rounding(x: f64) -> f64 {
    if x.abs() < ROUNDING { 0.0 } else { x }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;
    use crate::sampled_tube::SampledState;
    use plica::assembly::{Point, SplineTube};
    use plica::tube::{Mesh, Symmetry};

    /// Returns the fields at a point of the wall, displaced by (axial, radial) functions of z and r.
    fn sample(at: f64, displacement: impl Fn(f64, f64) -> [f64; 2]) -> FieldSample {
        let mesh = Mesh {
            thickness: 20,
            around: 60,
            ..fixture::coarse()
        };
        let tube = SplineTube::new(&fixture::short(), &mesh, 1);
        let u = tube.control_values_from(|z, r, _| {
            let [axial, radial] = displacement(z, r);
            [axial, radial, 0.0]
        });
        let place = Point {
            z: 0.5,
            radius: at,
            angle: 0.3,
        };
        SampledState::without_contact(&tube, &tube.tube.rest(), &u).at(place)
    }

    #[test]
    fn stresses_of_an_inflated_cylinder_are_those_of_lame() {
        // E = 1, plane strain, inner pressure p; a and b are the inner and the outer radius.
        let (p, nu, a, b) = (1e-5, 0.3, 0.4, 0.5);
        let factor = p * a * a / (b * b - a * a);
        for r in [0.41_f64, 0.45, 0.49] {
            let sample = sample(r, |_, r| {
                let radial = (1.0 - 2.0 * nu) * r + b * b / r;
                [0.0, (1.0 + nu) * factor * radial]
            });
            let ratio = (b / r).powi(2);
            for (field, expected) in [
                (Field::RadialStress, factor * (1.0 - ratio)),
                (Field::HoopStress, factor * (1.0 + ratio)),
                (Field::AxialStress, factor * 2.0 * nu),
            ] {
                let found = field.of(&sample);
                let error = (found - expected).abs() / p;
                assert!(
                    error < 0.05,
                    "{field:?} at {r}: {found:e}, expected {expected:e}"
                );
            }
        }
    }

    #[test]
    fn stresses_along_the_wall_follow_a_wall_that_turns() {
        // A wall that becomes conical: its meridian is stretched by √(1 + m²) and not the axis.
        let slope = 0.5;
        let turned = sample(0.45, |z, _| [0.0, slope * (z - 0.5)]);
        let stretch = 1.0_f64 + slope * slope;
        let [along, through, around] = turned.wall_stresses();
        // μ (b − 1) + λ ln J over J, b = F Fᵀ; shear does not change the volume.
        let mu = 1.0 / (2.0 * 1.3);
        assert!((turned.jacobian - 1.0).abs() < 1e-3);
        assert!(around.abs() < 1e-3, "{around}");
        // The meridian (1, m) has a' b a = (F' a)², F = [[1, 0], [m, 1]], a = (1, m)/√(1 + m²).
        let fa = [
            (1.0 + slope * slope) / stretch.sqrt(),
            slope / stretch.sqrt(),
        ];
        let expected = mu * (fa[0] * fa[0] + fa[1] * fa[1] - 1.0);
        assert!((along / expected - 1.0).abs() < 1e-2, "{along} {expected}");
        // The normal (−m, 1) has (F' n)² = 1/(1 + m²).
        let expected = mu * (1.0 / stretch - 1.0);
        assert!(
            (through / expected - 1.0).abs() < 1e-2,
            "{through} {expected}"
        );
    }

    #[test]
    fn stresses_and_displacements_are_labelled_with_the_factor_of_their_unit() {
        use plica::study::{LengthUnit, StressUnit, Units};
        let mut plan = fixture::plan(Symmetry::Axisymmetric);
        plan.units = Some(Units {
            length: LengthUnit::Millimetre,
            stress: StressUnit::Kilopascal,
            diameter: 25.0,
            youngs_modulus: 20.0,
        });
        for field in Field::ALL {
            let (label, factor) = field.label(&plan);
            let (unit, expected) = match field {
                Field::Displacement => ("(mm)", 25.0),
                Field::EnergyDensity
                | Field::VonMises
                | Field::Pressure
                | Field::HoopStress
                | Field::AxialStress
                | Field::RadialStress
                | Field::Tension
                | Field::FoundationForce
                | Field::ContactPressure => ("(kPa)", 20.0),
                _ => ("", 1.0),
            };
            assert!(label.ends_with(unit) && factor == expected, "{label}");
        }
    }
}
