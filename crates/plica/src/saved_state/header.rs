//! The JSON header in the file of a state.

use super::Layout;
use super::file::{BLANK, FORMAT};
use super::{Array, SavedState, SavedStateError};
use crate::activation::MuscleTarget;
use crate::spline::Refinement;
use crate::tube::{EndMotion, Load, Mesh, MeshLayer, Placement, Pressure};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The JSON header. The checksum comes first, so that no name chosen by a user can be mistaken for it.
#[derive(Debug, Deserialize, Serialize)]
pub(super) struct Header {
    format: u32,
    blake3: String,
    written_by: String,
    stage: String,
    row: usize,
    along: f64,
    load: LoadHeader,
    tube: TubeHeader,
    mesh: MeshHeader,
    rings: usize,
}

#[derive(Debug, Deserialize, Serialize)]
struct LoadHeader {
    muscles: Vec<MuscleHeader>,
    colon: EndHeader,
    ileum: EndHeader,
    #[serde(default, skip_serializing_if = "PressureHeader::is_none")]
    inner_wall: PressureHeader,
    #[serde(default, skip_serializing_if = "PressureHeader::is_none")]
    outer_wall: PressureHeader,
    /// Driven volume of the lumen over that at rest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    lumen_volume_ratio: Option<f64>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    obstacles: Vec<ObstacleHeader>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    patches: Vec<PatchHeader>,
}

#[derive(Debug, Deserialize, Serialize)]
struct ObstacleHeader {
    name: String,
    radius: f64,
    /// (z, x, y).
    position: [f64; 3],
}

#[derive(Debug, Deserialize, Serialize)]
struct PatchHeader {
    name: String,
    growth_through: f64,
}

#[derive(Debug, Deserialize, Serialize)]
struct MuscleHeader {
    name: String,
    direction: DirectionHeader,
    ratio: f64,
    /// Shift of its zone.
    #[serde(default, skip_serializing_if = "is_zero")]
    shift: f64,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
enum DirectionHeader {
    Circular,
    Longitudinal,
    /// Of a muscle with active stress, whose direction is no part of the load.
    ActiveStress,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
struct EndHeader {
    displacement: f64,
    twist_radians: f64,
    #[serde(default, skip_serializing_if = "is_none")]
    shift: [f64; 2],
    /// Rotation vector.
    #[serde(default, skip_serializing_if = "is_none")]
    tilt_radians: [f64; 2],
}

fn is_none(vector: &[f64; 2]) -> bool {
    *vector == [0.0; 2]
}

#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Serialize)]
struct PressureHeader {
    pressure: f64,
    dead_load: f64,
}

impl PressureHeader {
    fn is_none(&self) -> bool {
        *self == Self::default()
    }
}

#[derive(Debug, Deserialize, Serialize)]
struct TubeHeader {
    length: f64,
    thickness: f64,
}

#[derive(Debug, Deserialize, Serialize)]
struct MeshHeader {
    axial: usize,
    around: usize,
    thickness: usize,
    degree: usize,
    refine: Vec<RefineHeader>,
    #[serde(default = "uniform", skip_serializing_if = "is_uniform")]
    grading: f64,
    #[serde(default = "usual_range", skip_serializing_if = "is_usual_range")]
    contact_range: f64,
    /// Layers of the wall from the inside out; none for a wall of one layer.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    layers: Vec<LayerHeader>,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
struct LayerHeader {
    share: f64,
    elements: usize,
}

#[allow(clippy::trivially_copy_pass_by_ref)] // Serde passes references.
fn is_zero(shift: &f64) -> bool {
    *shift == 0.0
}

fn uniform() -> f64 {
    1.0
}

fn usual_range() -> f64 {
    0.25
}

#[allow(clippy::trivially_copy_pass_by_ref)] // Serde passes references.
fn is_uniform(grading: &f64) -> bool {
    *grading == uniform()
}

#[allow(clippy::trivially_copy_pass_by_ref)] // Serde passes references.
fn is_usual_range(range: &f64) -> bool {
    *range == usual_range()
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
struct RefineHeader {
    from: f64,
    to: f64,
    factor: f64,
}

impl SavedState {
    /// Returns the header, with a blank checksum.
    pub(super) fn header(&self) -> Header {
        let drives = self.load.muscles.iter().zip(&self.load.shifts);
        let muscle =
            |((name, target), (&ratio, &shift)): (&(String, MuscleTarget), (&f64, &f64))| {
                MuscleHeader {
                    name: name.clone(),
                    direction: match target {
                        MuscleTarget::DiameterRatio => DirectionHeader::Circular,
                        MuscleTarget::LengthRatio => DirectionHeader::Longitudinal,
                        MuscleTarget::Tension => DirectionHeader::ActiveStress,
                    },
                    ratio,
                    shift,
                }
            };
        let end = |motion: EndMotion| EndHeader {
            displacement: motion.displacement,
            twist_radians: motion.twist,
            shift: motion.shift,
            tilt_radians: motion.tilt,
        };
        let wall = |pressure: Pressure| PressureHeader {
            pressure: pressure.follower,
            dead_load: pressure.dead,
        };
        let obstacle = |(name, placement): (&String, &Placement)| ObstacleHeader {
            name: name.clone(),
            radius: placement.radius,
            position: placement.position,
        };
        let patch = |(name, &growth_through): (&String, &f64)| PatchHeader {
            name: name.clone(),
            growth_through,
        };
        let Layout {
            length,
            thickness,
            ref mesh,
            rings,
        } = self.layout;
        let refine = |r: &Refinement| RefineHeader {
            from: r.from,
            to: r.to,
            factor: r.factor,
        };
        let layer = |layer: &MeshLayer| LayerHeader {
            share: layer.share,
            elements: layer.elements,
        };
        Header {
            format: FORMAT,
            blake3: BLANK.to_owned(),
            written_by: concat!("plica ", env!("CARGO_PKG_VERSION")).to_owned(),
            stage: self.stage.clone(),
            row: self.row,
            along: self.along,
            load: LoadHeader {
                muscles: self.muscles.iter().zip(drives).map(muscle).collect(),
                colon: end(self.load.ends[0]),
                ileum: end(self.load.ends[1]),
                inner_wall: wall(self.load.pressures[0]),
                outer_wall: wall(self.load.pressures[1]),
                lumen_volume_ratio: self.load.lumen_volume,
                obstacles: self
                    .obstacles
                    .iter()
                    .zip(&self.load.obstacles)
                    .map(obstacle)
                    .collect(),
                patches: self
                    .patches
                    .iter()
                    .zip(&self.load.patches)
                    .map(patch)
                    .collect(),
            },
            tube: TubeHeader { length, thickness },
            mesh: MeshHeader {
                axial: mesh.axial,
                around: mesh.around,
                thickness: mesh.thickness,
                degree: mesh.degree,
                refine: mesh.refinements.iter().map(refine).collect(),
                grading: mesh.grading,
                contact_range: mesh.contact_range,
                layers: mesh.layers.iter().map(layer).collect(),
            },
            rings,
        }
    }

    /// Makes a state from a header and arrays, if they are consistent.
    pub(super) fn new(
        header: Header,
        u: Array,
        arrays: BTreeMap<String, Array>,
    ) -> Result<Self, SavedStateError> {
        let end = |end: EndHeader| EndMotion {
            displacement: end.displacement,
            twist: end.twist_radians,
            shift: end.shift,
            tilt: end.tilt_radians,
        };
        let wall = |wall: PressureHeader| Pressure {
            follower: wall.pressure,
            dead: wall.dead_load,
        };
        let refinement = |r: &RefineHeader| Refinement {
            from: r.from,
            to: r.to,
            factor: r.factor,
        };
        let layer = |layer: &LayerHeader| MeshLayer {
            share: layer.share,
            elements: layer.elements,
        };
        let layout = Layout {
            length: header.tube.length,
            thickness: header.tube.thickness,
            mesh: Mesh {
                axial: header.mesh.axial,
                around: header.mesh.around,
                thickness: header.mesh.thickness,
                degree: header.mesh.degree,
                refinements: header.mesh.refine.iter().map(refinement).collect(),
                grading: header.mesh.grading,
                contact_range: header.mesh.contact_range,
                volumetric: Default::default(),
                layers: header.mesh.layers.iter().map(layer).collect(),
            },
            rings: header.rings,
        };
        if let Some(fault) = layout.fault() {
            return Err(SavedStateError::Header(fault));
        }
        if u.shape != layout.shape() {
            let what = format!(
                "has shape {:?} and needs {:?} on its mesh",
                u.shape,
                layout.shape()
            );
            return Err(SavedStateError::Array {
                name: "u".into(),
                what,
            });
        }
        let muscles = header.load.muscles;
        let obstacles = header.load.obstacles;
        let patches = header.load.patches;
        let placement = |of: &ObstacleHeader| Placement {
            radius: of.radius,
            position: of.position,
        };
        let direction = |direction| match direction {
            DirectionHeader::Circular => MuscleTarget::DiameterRatio,
            DirectionHeader::Longitudinal => MuscleTarget::LengthRatio,
            DirectionHeader::ActiveStress => MuscleTarget::Tension,
        };
        Ok(Self {
            stage: header.stage,
            row: header.row,
            along: header.along,
            load: Load {
                muscles: muscles.iter().map(|m| m.ratio).collect(),
                shifts: muscles.iter().map(|m| m.shift).collect(),
                ends: [end(header.load.colon), end(header.load.ileum)],
                pressures: [wall(header.load.inner_wall), wall(header.load.outer_wall)],
                lumen_volume: header.load.lumen_volume_ratio,
                obstacles: obstacles.iter().map(placement).collect(),
                patches: patches.iter().map(|patch| patch.growth_through).collect(),
            },
            obstacles: obstacles
                .into_iter()
                .map(|obstacle| obstacle.name)
                .collect(),
            patches: patches.into_iter().map(|patch| patch.name).collect(),
            muscles: muscles
                .into_iter()
                .map(|m| (m.name, direction(m.direction)))
                .collect(),
            layout,
            u: u.values,
            arrays,
        })
    }
}
