//! Saved states: a state with its load and the layout of its unknowns, and its file format.
//!
//! The file is safetensors with a checksum (`file`); a JSON header describes the state (`header`). The file also
//! has knots and control points (`geometry`), which are not read back.

mod file;
mod geometry;
mod header;
mod layout;
mod mode;

pub use layout::Layout;

use crate::activation::MuscleTarget;
use crate::tube::{Load, Mesh};
use file::FORMAT;
use std::collections::BTreeMap;
use std::io::Error;

/// An accepted state in full: its load, the layout of its unknowns, and the unknowns.
#[derive(Clone, Debug, PartialEq)]
pub struct SavedState {
    /// Name of its stage; `rest` for the tube at rest.
    pub stage: String,
    /// Number of its row in `history.csv`.
    pub row: usize,
    /// Completed fraction of its stage, 0 to 1.
    pub along: f64,
    /// Name and direction of each muscle, in the order of the load.
    pub muscles: Vec<(String, MuscleTarget)>,
    /// Name of each obstacle, in the order of the load.
    pub obstacles: Vec<String>,
    /// Name of each patch, in the order of the load.
    pub patches: Vec<String>,
    /// Its load.
    pub load: Load,
    /// Layout of its unknowns.
    pub layout: Layout,
    /// Unknowns of the cyclic sector, in D.
    pub u: Vec<f64>,
    /// Further arrays, by name; not `u`.
    pub arrays: BTreeMap<String, Array>,
}

/// Name of the array of the history of friction.
pub(crate) const FRICTION: &str = "friction";

impl SavedState {
    /// Returns the history of friction, from which a path continues; empty without friction.
    pub fn history(&self) -> &[f64] {
        let array = self.arrays.get(FRICTION);
        array.map_or(&[], |array| &array.values)
    }
}

/// An array of numbers, the last index fastest.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Array {
    /// Length of each index; the product is the number of values.
    pub shape: Vec<usize>,
    /// The numbers.
    pub values: Vec<f64>,
}

/// An error of a saved state.
#[derive(Debug, thiserror::Error)]
pub enum SavedStateError {
    /// The file cannot be read or written.
    #[error(transparent)]
    File(#[from] Error),
    /// The file is not a saved state.
    #[error("this is not a saved state ({0})")]
    Foreign(String),
    /// The file is cut short or too long.
    #[error(
        "the file is cut short or has something added (it holds {bytes} bytes); use another file, or run its case again"
    )]
    Cut {
        /// Bytes of the file.
        bytes: usize,
    },
    /// A later version wrote the file.
    #[error(
        "its format is {found}, and this program reads formats up to {FORMAT}; use a newer version of plica"
    )]
    Newer {
        /// Its format.
        found: u32,
    },
    /// The checksum does not match.
    #[error(
        "the file is damaged: its checksum is {found}, and should be {expected}; \
         use another file, or run its case again"
    )]
    Damaged {
        /// The checksum it carries.
        expected: String,
        /// The checksum it has.
        found: String,
    },
    /// An array is invalid.
    #[error("its array `{name}` {what}")]
    Array {
        /// Its name.
        name: String,
        /// The fault.
        what: String,
    },
    /// The file holds a state, not a mode.
    #[error("this is a saved state, not a mode")]
    NoMode,
    /// The header describes no valid tube or mesh.
    #[error("its header makes no sense: {0}")]
    Header(&'static str),
    /// The state belongs to another tube or mesh.
    #[error("it belongs to another {what}: {found} instead of {expected}")]
    Other {
        /// Tube, mesh or symmetry.
        what: &'static str,
        /// Of the state.
        found: String,
        /// Of the case.
        expected: String,
    },
}

impl SavedState {
    /// Checks that the state has a layout, a set of muscles and lists of obstacles and patches.
    ///
    /// # Errors
    /// [`SavedStateError::Other`] with the difference.
    pub fn check_layout(
        &self,
        expected: &Layout,
        muscles: &[(String, MuscleTarget)],
        obstacles: &[String],
        patches: &[String],
    ) -> Result<(), SavedStateError> {
        let found = &self.layout;
        let compare = |what, found: String, expected: String| {
            if found == expected {
                return Ok(());
            }
            Err(SavedStateError::Other {
                what,
                found,
                expected,
            })
        };
        let size = |l: &Layout| format!("{} D long, {} D thick", l.length, l.thickness);
        let mesh = |l: &Layout| {
            let Mesh {
                axial,
                around,
                thickness,
                degree,
                ..
            } = &l.mesh;
            format!("{axial} x {around} x {thickness} of degree {degree}")
        };
        let refine = |l: &Layout| format!("refined as {:?}", l.mesh.refinements);
        let graded = |l: &Layout| {
            let Mesh {
                grading,
                contact_range,
                ..
            } = l.mesh;
            format!("graded by {grading}, with a range of contact of {contact_range}")
        };
        let layers = |l: &Layout| {
            let layers = l.mesh.layers.iter();
            let elements: Vec<String> = layers.map(|layer| layer.elements.to_string()).collect();
            let shares: Vec<f64> = l.mesh.layers.iter().map(|layer| layer.share).collect();
            match elements.len() {
                0 => "of one layer".to_owned(),
                n => format!(
                    "of {n} layers with {} elements and shares {shares:?}",
                    elements.join(" + ")
                ),
            }
        };
        let rings = |l: &Layout| format!("{} rings", l.rings);
        compare("tube", size(found), size(expected))?;
        compare("mesh", mesh(found), mesh(expected))?;
        compare("mesh", refine(found), refine(expected))?;
        compare("mesh", graded(found), graded(expected))?;
        compare("wall", layers(found), layers(expected))?;
        compare("symmetry", rings(found), rings(expected))?;
        compare(
            "list of obstacles",
            format!("{:?}", self.obstacles),
            format!("{obstacles:?}"),
        )?;
        compare(
            "list of patches",
            format!("{:?}", self.patches),
            format!("{patches:?}"),
        )?;
        compare(
            "set of muscles",
            format!("{:?}", self.muscles),
            format!("{muscles:?}"),
        )
    }
}
