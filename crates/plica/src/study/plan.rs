//! The plan of a study: the checked, dimensionless content of a case.

use super::{Following, Stage};
use crate::assembly::SplineTube;
use crate::equilibrium::TubeProblem;
use crate::saved_state::{Layout, SavedState, SavedStateError};
use crate::solve::Settings;
use crate::tube::{EndMotion, Load, Mesh, Pressure, Symmetry, Tube};
use std::fmt;

/// A checked, dimensionless study: lengths in D, stresses in E.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Title, one line.
    pub title: String,
    /// The tube; its load at rest is `tube.rest()`.
    pub tube: Tube,
    /// The mesh.
    pub mesh: Mesh,
    /// The symmetry around the axis.
    pub symmetry: Symmetry,
    /// True if the wall may touch itself but not pass through itself.
    pub contact: bool,
    /// Coefficient of friction of the wall with itself; 0 without contact.
    pub friction: f64,
    /// The saved state that the study starts from; none for a start at rest.
    pub start: Option<Start>,
    /// The buckling modes that give imperfections their shapes.
    pub modes: Vec<ModeShape>,
    /// The libraries of materials of the user that the case takes materials from.
    pub materials: Vec<MaterialFile>,
    /// The stages of load, in order.
    pub stages: Vec<Stage>,
    /// The branch that `plica follow` computes; none if the case has no table for it.
    pub following: Option<Following>,
    /// Settings of the solver.
    pub solver: Settings,
    /// Settings of the output.
    pub output: Output,
    /// The units of the case, for results in real units.
    pub units: Option<Units>,
    /// Names of the ends at z = 0 and z = L in tables and pictures.
    pub end_names: [String; 2],
}

/// A saved state that a study starts from.
#[derive(Clone, Debug, PartialEq)]
pub struct Start {
    /// Its file, as the case names it.
    pub file: String,
    /// Its load, in the order of the muscles of the plan's tube.
    pub load: Load,
    /// The state, on its own mesh.
    pub state: SavedState,
}

/// A buckling mode that gives an imperfection of the geometry its shape.
#[derive(Clone, Debug, PartialEq)]
pub struct ModeShape {
    /// Number of the imperfection in the case, from 1.
    pub imperfection: usize,
    /// The file of the mode, as the case names it.
    pub file: String,
    /// Content of the file: the mode and the state that it belongs to.
    pub state: SavedState,
}

/// A library of materials that a case names. Its materials are in the layers of the tube.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MaterialFile {
    /// The file, as the case names it.
    pub file: String,
    /// Its content.
    pub text: String,
}

/// Output of a run beside its history.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// True if pictures are drawn.
    pub pictures: bool,
    /// Write wall profiles for every n-th state and the last of each stage; 0 for none.
    pub profiles_every: usize,
    /// Save every n-th state and the last of each stage in full; 0 for none.
    pub states_every: usize,
    /// Test axisymmetric states against the circumferential modes 0 to this.
    pub stability_modes: usize,
    /// Points along the tube at which walls are sampled for profiles and pictures.
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
    /// Returns the power of ten of a metre.
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
    /// Returns the power of ten of a pascal.
    pub(crate) fn power(self) -> i32 {
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
    /// Returns the problem of the solver: the tube on its mesh, with contact if the plan has that.
    pub fn problem(&self) -> TubeProblem {
        let rings = self.mesh.rings(self.symmetry);
        let mut problem = TubeProblem::new(SplineTube::new(&self.tube, &self.mesh, rings));
        if self.contact {
            problem = problem.with_contact().with_friction(self.friction);
        }
        if self.drives_lumen() {
            problem = problem.with_driven_lumen();
        }
        problem
    }

    /// Returns whether the wall has friction on itself or on an obstacle.
    pub fn has_friction(&self) -> bool {
        let obstacles = self.tube.obstacles.iter();
        self.friction > 0.0 || obstacles.into_iter().any(|on| on.friction > 0.0)
    }

    /// Returns the names of ends that are not named otherwise.
    pub fn usual_end_names() -> [String; 2] {
        ["colon", "ileum"].map(String::from)
    }

    /// Returns the load of the first state.
    pub fn first_load(&self) -> Load {
        match &self.start {
            Some(start) => start.load.clone(),
            None => self.tube.rest(),
        }
    }

    /// Returns the load at which a stage begins, counted from 0.
    pub fn load_before(&self, stage: usize) -> Load {
        match stage.checked_sub(1) {
            Some(before) => self.stages[before].load.clone(),
            None => self.first_load(),
        }
    }

    /// Returns the time at a fraction of a stage, counted from 0; none in a study without times.
    pub fn time_at(&self, stage: usize, fraction: f64) -> Option<f64> {
        let durations = self.stages[..stage].iter().map(|stage| stage.duration);
        let before = durations.sum::<Option<f64>>()?;
        Some(before + fraction * self.stages[stage].duration?)
    }

    /// Returns the time of the first state; none in a study without times.
    pub fn first_time(&self) -> Option<f64> {
        self.stages.first()?.duration.map(|_| 0.0)
    }

    /// Returns whether a stage moves the zone of a muscle.
    pub fn shifts_muscle(&self, muscle: usize) -> bool {
        let first = self.first_load();
        let mut loads = self.stages.iter().flat_map(Stage::loads);
        first.shifts[muscle] != 0.0 || loads.any(|load| load.shifts[muscle] != 0.0)
    }

    /// Returns the number of steps of all stages.
    pub fn steps(&self) -> usize {
        self.stages.iter().map(|stage| stage.steps).sum()
    }

    /// Returns the layout of the unknowns of its states.
    pub fn layout(&self) -> Layout {
        Layout {
            length: self.tube.length,
            thickness: self.tube.thickness,
            mesh: self.mesh.clone(),
            rings: self.mesh.rings(self.symmetry),
        }
    }

    /// Checks that a saved state is one of this plan's tube on this plan's mesh.
    ///
    /// # Errors
    /// [`SavedStateError::Other`] with the difference.
    pub fn accepts(&self, state: &SavedState) -> Result<(), SavedStateError> {
        let muscles = self.tube.muscles.iter();
        let muscles: Vec<_> = muscles.map(|m| (m.name.clone(), m.target())).collect();
        let obstacles = self.tube.obstacles.iter();
        let obstacles: Vec<String> = obstacles.map(|obstacle| obstacle.name.clone()).collect();
        let patches = self.tube.patches.iter();
        let patches: Vec<String> = patches.map(|patch| patch.name.clone()).collect();
        state.check_layout(&self.layout(), &muscles, &obstacles, &patches)
    }

    /// Returns whether there is a pressure on a wall at the start or in any stage.
    pub fn has_pressures(&self) -> bool {
        let pressed = |load: &Load| load.pressures != [Pressure::default(); 2];
        self.loads().any(pressed) || self.drives_lumen()
    }

    /// Returns whether the volume of the lumen is driven at the start or in any stage.
    pub fn drives_lumen(&self) -> bool {
        self.loads().any(|load| load.lumen_volume.is_some())
    }

    /// Returns whether an end leaves its axis at the start or in any stage.
    pub fn has_sideways_ends(&self) -> bool {
        self.loads()
            .any(|load| load.ends.iter().any(EndMotion::is_sideways))
    }

    /// Returns the loads at the start, if it is not at rest, and at the ends of the stages.
    fn loads(&self) -> impl Iterator<Item = &Load> {
        let start = self.start.iter().map(|start| &start.load);
        start.chain(self.stages.iter().flat_map(Stage::loads))
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
