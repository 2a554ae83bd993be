//! What is to be computed: the checked content of a case file.

use super::{NamedMode, SavedState};
use crate::solve::Settings;
use crate::tube::{Load, Mesh, Pressure, Symmetry, Tube};
use std::fmt;

/// A whole study, checked and dimensionless.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// One line of what it is, for titles.
    pub title: String,
    /// The tube, at rest at load `tube.rest()`.
    pub tube: Tube,
    /// The mesh laid over it.
    pub mesh: Mesh,
    /// What repeats around it.
    pub symmetry: Symmetry,
    /// Where the run begins, if not at rest.
    pub start: Option<Start>,
    /// The modes that imperfections of the tube have the shape of, as the case names them.
    pub modes: Vec<NamedMode>,
    /// Where the load goes, stage after stage.
    pub stages: Vec<Stage>,
    /// How states are found.
    pub solver: Settings,
    /// What is left behind.
    pub output: Output,
    /// The units of the case file, for results in real units.
    pub units: Option<Units>,
}

/// A saved state that a run begins from.
#[derive(Clone, Debug, PartialEq)]
pub struct Start {
    /// Its file, as the case names it.
    pub file: String,
    /// Its load on the muscles of this plan's tube.
    pub load: Load,
    /// The state, on its own mesh.
    pub state: SavedState,
}

/// A straight way through the loads.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// Its name in tables.
    pub name: String,
    /// The load at its end; it begins at the end of the stage before, the first at rest or at the start.
    pub load: Load,
    /// Equal steps from begin to end, at least one; each ends in an accepted state.
    pub steps: usize,
}

/// What a run leaves behind beside its history.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// Whether pictures are drawn.
    pub pictures: bool,
    /// Wall profiles are written for every n-th accepted state (and always for the last of a
    /// stage); 0 for none.
    pub profiles_every: usize,
    /// Accepted states are saved in full likewise.
    pub states_every: usize,
    /// Circumferential harmonics that an axisymmetric state is tested for: 0 to this.
    pub stability_modes: usize,
    /// Points along the tube at which a wall is sampled for profiles and pictures.
    pub wall_points: usize,
}

/// The units of a case, and the diameter and the modulus of its tube in them.
#[derive(Clone, Debug, PartialEq)]
pub struct Units {
    /// Unit of length.
    pub length: LengthUnit,
    /// Unit of stress.
    pub stress: StressUnit,
    /// The outer diameter in the unit of length.
    pub diameter: f64,
    /// Young's modulus in the unit of stress.
    pub youngs_modulus: f64,
}

/// A unit of length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LengthUnit {
    /// m
    Metre,
    /// cm
    Centimetre,
    /// mm
    Millimetre,
    /// µm, written `um`
    Micrometre,
}

/// A unit of stress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StressUnit {
    /// Pa
    Pascal,
    /// kPa
    Kilopascal,
    /// MPa
    Megapascal,
}

impl LengthUnit {
    /// The power of ten of a metre.
    pub(super) fn power(self) -> i32 {
        match self {
            Self::Metre => 0,
            Self::Centimetre => -2,
            Self::Millimetre => -3,
            Self::Micrometre => -6,
        }
    }
}

impl StressUnit {
    /// The power of ten of a pascal.
    pub(super) fn power(self) -> i32 {
        match self {
            Self::Pascal => 0,
            Self::Kilopascal => 3,
            Self::Megapascal => 6,
        }
    }
}

impl fmt::Display for LengthUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Metre => "m",
            Self::Centimetre => "cm",
            Self::Millimetre => "mm",
            Self::Micrometre => "um",
        })
    }
}

impl fmt::Display for StressUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Pascal => "Pa",
            Self::Kilopascal => "kPa",
            Self::Megapascal => "MPa",
        })
    }
}

impl Plan {
    /// Whether there is pressure on a wall at the start or in any stage.
    pub fn is_pressed(&self) -> bool {
        let start = self.start.iter().map(|start| &start.load);
        let mut loads = start.chain(self.stages.iter().map(|stage| &stage.load));
        loads.any(|load| load.pressures != [Pressure::default(); 2])
    }
}

impl Default for Output {
    fn default() -> Self {
        Self {
            pictures: true,
            profiles_every: 1,
            states_every: 1,
            stability_modes: 4,
            wall_points: 601,
        }
    }
}
