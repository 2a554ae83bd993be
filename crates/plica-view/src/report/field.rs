//! Fields that a picture may be coloured by.

use crate::draw::{ColourMap, Range};
use plica::assembly::Sample;
use plica::study::{Plan, Scale};

/// A number at every point of the wall.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Field {
    /// Strain energy density w, per grown volume.
    #[default]
    EnergyDensity,
    /// Von Mises stress.
    VonMises,
    /// Mean pressure −tr σ/3.
    Pressure,
    /// Elastic change of volume, det Fe.
    VolumeChange,
    /// Largest principal stretch of Fe.
    LargestStretch,
    /// Smallest principal stretch of Fe.
    SmallestStretch,
    /// Grown over ungrown length along, θζ.
    GrownAlong,
    /// Grown over ungrown length around, θη.
    GrownAround,
    /// How far a point has moved from where it was at rest.
    Displacement,
}

/// Energy densities below this, in E, are what rounding leaves of a wall without stress.
const NOTHING: f64 = 1e-12;
/// Stresses, in E, and displacements, in D, below this are the same.
const ROUNDING: f64 = 1e-12;

impl Field {
    /// All of them.
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

    /// What it is asked for by.
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

    /// Its colours: those of two signs where the sign says what it is.
    pub fn map(self) -> ColourMap {
        match self {
            Self::Pressure => ColourMap::Diverging,
            _ => ColourMap::default(),
        }
    }

    /// What its colours span where nothing else is asked for.
    pub fn range(self) -> Range {
        match self.map() {
            ColourMap::Diverging => Range::Symmetric,
            _ => Range::Automatic,
        }
    }

    /// Its value at a point, dimensionless.
    pub fn of(self, sample: &Sample) -> f64 {
        let s = sample.stress.0;
        match self {
            Self::EnergyDensity if sample.energy_density < NOTHING => 0.0,
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

    /// What it is called beside a colour bar, with its unit, and by how much its values are to be multiplied.
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
            Self::VolumeChange => plain("elastic change of volume det *F*_{e}"),
            Self::LargestStretch => plain("largest elastic stretch *λ*_{1}"),
            Self::SmallestStretch => plain("smallest elastic stretch *λ*_{3}"),
            Self::GrownAlong => plain("grown length along *θ*_{ζ}"),
            Self::GrownAround => plain("grown length around *θ*_{η}"),
            Self::Displacement if bare => plain("displacement/*D*"),
            Self::Displacement => {
                let unit = scale.length_name.replace("um", "µm");
                (format!("displacement ({unit})"), scale.length)
            }
        }
    }
}

/// A number, or zero where it is what rounding leaves of a wall at rest.
fn above_rounding(x: f64) -> f64 {
    if x.abs() < ROUNDING { 0.0 } else { x }
}
