//! The case as written. Plain structs, one a table; nothing here is checked or scaled.

use crate::solve::Settings;
use crate::{solve, study};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A case file.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Spec {
    pub title: Option<String>,
    #[serde(default)]
    pub symmetry: Symmetry,
    pub units: Option<Units>,
    #[serde(default)]
    pub tube: Tube,
    #[serde(default)]
    pub material: Material,
    #[serde(default)]
    pub muscles: BTreeMap<String, Muscle>,
    #[serde(default)]
    pub ends: Ends,
    #[serde(default)]
    pub mesh: Mesh,
    pub start: Option<Start>,
    pub stages: Vec<Stage>,
    #[serde(default)]
    pub imperfections: Vec<Imperfection>,
    #[serde(default)]
    pub solver: Solver,
    #[serde(default)]
    pub output: Output,
}

#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Symmetry {
    #[default]
    Axisymmetric,
    Fold(usize),
    None,
}

#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Units {
    pub length: String,
    pub stress: String,
}

#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct Tube {
    pub diameter: f64,
    pub length: Option<f64>,
    pub thickness: Option<f64>,
}

#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Material {
    NeoHookean(NeoHookean),
}

#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct NeoHookean {
    pub youngs_modulus: f64,
    pub poisson_ratio: f64,
    pub volumetric: Volumetric,
}

#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Volumetric {
    #[default]
    Logarithmic,
    Quadratic,
}

#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Muscle {
    pub direction: Direction,
    pub zone: [f64; 2],
    #[serde(default)]
    pub profile: Profile,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Direction {
    Circular,
    Longitudinal,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Profile {
    #[default]
    RaisedCosine,
    HalfSine,
    SmoothBox(SmoothBox),
    Table(Vec<[f64; 2]>),
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SmoothBox {
    pub edge: f64,
}

#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct Ends {
    pub colon: Support,
    pub ileum: Support,
}

#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Support {
    #[default]
    Fixed,
    Sliding,
    Free,
}

#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct Mesh {
    pub control_points: ControlPoints,
    pub degree: usize,
    pub volumetric_integration: Integration,
    pub refine: Option<Vec<Refine>>,
}

#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Integration {
    #[default]
    Full,
    Reduced,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct ControlPoints {
    pub axial: usize,
    pub around: usize,
    pub thickness: usize,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Refine {
    pub zone: [f64; 2],
    #[serde(default = "Refine::usual_factor")]
    pub factor: f64,
}

#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Start {
    pub state: String,
}

#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Stage {
    pub name: Option<String>,
    #[serde(default = "Stage::usual_steps")]
    pub steps: usize,
    #[serde(default)]
    pub drive: BTreeMap<String, Drive>,
}

#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct Drive {
    pub diameter_ratio: Option<f64>,
    pub length_ratio: Option<f64>,
    pub displacement: Option<f64>,
    pub twist_degrees: Option<f64>,
    pub pressure: Option<f64>,
    pub dead_load: Option<f64>,
}

#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Imperfection {
    pub of: Part,
    pub amplitude: f64,
    pub direction: Option<Push>,
    pub shape: Shape,
}

#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Part {
    ColonEnd,
    IleumEnd,
    Geometry,
    Muscle(String),
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Push {
    Across,
    Axial,
}

#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Shape {
    Wave(Wave),
    Random(Random),
    Mode(String),
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Wave {
    pub mode: usize,
    #[serde(default)]
    pub phase_degrees: f64,
    pub axial: Option<Axial>,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Axial {
    Uniform,
    HalfSine,
    Zone([f64; 2]),
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Random {
    pub seed: u64,
    pub modes: Option<usize>,
    pub half_waves: Option<usize>,
}

#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct Solver {
    pub scheme: Scheme,
    pub tolerance: f64,
    pub newton_iterations: usize,
    pub relaxation_steps: usize,
    pub relaxation_damping: f64,
    pub max_step_halvings: usize,
    pub pseudo_time: Option<PseudoTime>,
}

#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Scheme {
    #[default]
    Static,
    Newmark,
    BackwardEuler,
}

#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct PseudoTime {
    pub damping: Option<f64>,
    pub ramp: usize,
    pub tolerance: f64,
    pub max_steps: usize,
    pub equilibrate: bool,
}

#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct Output {
    pub pictures: bool,
    pub profiles_every: usize,
    pub states_every: usize,
    pub stability_modes: usize,
    pub wall_points: usize,
}

impl Default for Tube {
    fn default() -> Self {
        Self {
            diameter: 1.0,
            length: None,
            thickness: None,
        }
    }
}

impl Default for Material {
    fn default() -> Self {
        Self::NeoHookean(NeoHookean::default())
    }
}

impl Default for NeoHookean {
    fn default() -> Self {
        Self {
            youngs_modulus: 1.0,
            poisson_ratio: 0.495,
            volumetric: Volumetric::default(),
        }
    }
}

impl Default for Mesh {
    fn default() -> Self {
        Self {
            control_points: ControlPoints::default(),
            degree: 3,
            volumetric_integration: Integration::default(),
            refine: None,
        }
    }
}

impl Default for ControlPoints {
    fn default() -> Self {
        Self {
            axial: 305,
            around: 60,
            thickness: 8,
        }
    }
}

impl Refine {
    pub fn usual_factor() -> f64 {
        3.0
    }
}

impl Stage {
    fn usual_steps() -> usize {
        20
    }
}

impl Random {
    pub fn usual_count() -> usize {
        4
    }
}

impl Default for Solver {
    fn default() -> Self {
        let usual = Settings::default();
        Self {
            scheme: Scheme::Static,
            tolerance: usual.tolerance,
            newton_iterations: usual.newton_iterations,
            relaxation_steps: usual.relaxation_steps,
            relaxation_damping: usual.relaxation_damping,
            max_step_halvings: usual.max_step_halvings,
            pseudo_time: None,
        }
    }
}

impl Default for PseudoTime {
    fn default() -> Self {
        let usual = solve::PseudoTime::default();
        Self {
            damping: None,
            ramp: usual.ramp,
            tolerance: usual.tolerance,
            max_steps: usual.max_steps,
            equilibrate: usual.equilibrate,
        }
    }
}

impl Default for Output {
    fn default() -> Self {
        let usual = study::Output::default();
        Self {
            pictures: usual.pictures,
            profiles_every: usual.profiles_every,
            states_every: usual.states_every,
            stability_modes: usual.stability_modes,
            wall_points: usual.wall_points,
        }
    }
}
