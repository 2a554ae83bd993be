//! Fields for the colours of a picture.

use crate::draw::{ColourMap, Range};
use plica::assembly::Sample;
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
}

/// Energy densities below this, in units of E, are rounding errors of a stress-free wall.
const ENERGY_ROUNDING: f64 = 1e-12;
/// Stresses, in units of E, and displacements, in units of D, below this are rounding errors.
const ROUNDING: f64 = 1e-12;

impl Field {
    /// All fields.
    pub const ALL: [Self; 9] = [
        Self::EnergyDensity,
        Self::VonMises,
        Self::Pressure,
        Self::VolumeChange,
        Self::LargestStretch,
        Self::SmallestStretch,
        Self::GrownAlong,
        Self::GrownAround,
        Self::Displacement,
    ];

    /// Returns the name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::EnergyDensity => "energy",
            Self::VonMises => "von-mises",
            Self::Pressure => "pressure",
            Self::VolumeChange => "det-fe",
            Self::LargestStretch => "largest-stretch",
            Self::SmallestStretch => "smallest-stretch",
            Self::GrownAlong => "theta-zeta",
            Self::GrownAround => "theta-eta",
            Self::Displacement => "displacement",
        }
    }

    /// Returns the colour map: diverging for a field of two signs.
    pub fn map(self) -> ColourMap {
        match self {
            Self::Pressure => ColourMap::Diverging,
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
    pub fn of(self, sample: &Sample) -> f64 {
        let s = sample.stress.0;
        match self {
            Self::EnergyDensity if sample.energy_density < ENERGY_ROUNDING => 0.0,
            Self::EnergyDensity => sample.energy_density,
            Self::VonMises => above_rounding(sample.von_mises()),
            Self::Pressure => above_rounding(-(s[0][0] + s[1][1] + s[2][2]) / 3.0),
            Self::VolumeChange => sample.jacobian,
            Self::LargestStretch => sample.stretches()[0].0,
            Self::SmallestStretch => sample.stretches()[2].0,
            Self::GrownAlong => sample.grown[0],
            Self::GrownAround => sample.grown[1],
            Self::Displacement => {
                let moved = [0, 1, 2].map(|i| sample.position[i] - sample.reference[i]);
                above_rounding(moved.iter().map(|x| x * x).sum::<f64>().sqrt())
            }
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
