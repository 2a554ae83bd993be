//! Curves of mechanical tests.

use super::{Homogeneous, Prescribed, Volume, homogeneous};
use crate::material::Material;

/// A mechanical test with one stretch that is driven.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MechanicalTest {
    /// Tension along the tube.
    UniaxialAlong,
    /// Tension around the tube.
    UniaxialAround,
    /// The same stretch along and around.
    Equibiaxial,
    /// Stretch along at constant length around.
    StripAlong,
    /// Stretch around at constant length along: inflation of a thin tube of constant length.
    StripAround,
}

impl MechanicalTest {
    /// All tests.
    pub const ALL: [Self; 5] = [
        Self::UniaxialAlong,
        Self::UniaxialAround,
        Self::Equibiaxial,
        Self::StripAlong,
        Self::StripAround,
    ];

    /// Returns its name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::UniaxialAlong => "uniaxial-along",
            Self::UniaxialAround => "uniaxial-around",
            Self::Equibiaxial => "equibiaxial",
            Self::StripAlong => "strip-along",
            Self::StripAround => "strip-around",
        }
    }

    /// Returns the direction of the driven stretch: 0 along, 2 around.
    pub fn direction(self) -> usize {
        match self {
            Self::UniaxialAlong | Self::StripAlong => 0,
            Self::UniaxialAround | Self::StripAround | Self::Equibiaxial => 2,
        }
    }

    /// Returns the prescribed stretches at a driven stretch.
    pub fn prescribed(self, stretch: f64) -> Prescribed {
        let (along, around) = match self {
            Self::UniaxialAlong => (Some(stretch), None),
            Self::UniaxialAround => (None, Some(stretch)),
            Self::Equibiaxial => (Some(stretch), Some(stretch)),
            Self::StripAlong => (Some(stretch), Some(1.0)),
            Self::StripAround => (Some(1.0), Some(stretch)),
        };
        Prescribed { along, around }
    }
}

/// Returns the states of a test at some stretches, up to the first that the law does not have.
pub fn curve(
    law: &Material,
    test: MechanicalTest,
    stretches: impl IntoIterator<Item = f64>,
    volume: Volume,
) -> Vec<Homogeneous> {
    let states = stretches.into_iter();
    let states = states.map(|stretch| homogeneous(law, test.prescribed(stretch), volume));
    states.map_while(|state| state).collect()
}
