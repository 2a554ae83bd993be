//! A state in full, and its file.
//!
//! | file | holds |
//! |---|---|
//! | here | what a saved state is, and whether it is one of a plan's |
//! | `header` | what a file says about it, as JSON |
//! | `file` | the file: safetensors with a checksum |

mod file;
mod header;

use super::{Layout, Plan};
use crate::activation::Direction;
use crate::tube::{Load, Mesh};
use file::FORMAT;
use std::collections::BTreeMap;
use std::io::Error;

/// A state with all that it takes to go on from it.
#[derive(Clone, Debug, PartialEq)]
pub struct SavedState {
    /// Name of its stage; `rest` for the tube at rest.
    pub stage: String,
    /// Number of its row in `history.csv`.
    pub row: usize,
    /// How far along its stage it is, 0 to 1.
    pub along: f64,
    /// Name and direction of each muscle, in the order of the load.
    pub muscles: Vec<(String, Direction)>,
    /// The load it is under.
    pub load: Load,
    /// What its unknowns belong to.
    pub layout: Layout,
    /// The unknowns of the sector, in D.
    pub u: Vec<f64>,
    /// Whatever else goes with it, by name; not `u`.
    pub arrays: BTreeMap<String, Array>,
}

/// Numbers in rows and columns, the last index fastest.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Array {
    /// Length of each index; the product is the number of values.
    pub shape: Vec<usize>,
    /// The numbers.
    pub values: Vec<f64>,
}

/// Why a saved state cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum SavedStateError {
    /// It cannot be read or written.
    #[error(transparent)]
    File(#[from] Error),
    /// It is something else.
    #[error("this is not a saved state ({0})")]
    Foreign(String),
    /// It ends early, or late.
    #[error(
        "the file is cut short or has something added (it holds {bytes} bytes); take another, or run its case again"
    )]
    Cut {
        /// Bytes of the file.
        bytes: usize,
    },
    /// A later version wrote it.
    #[error(
        "its format is {found}, and this program reads formats up to {FORMAT}; take a newer plica"
    )]
    Newer {
        /// Its format.
        found: u32,
    },
    /// It is not what was written.
    #[error(
        "the file is damaged: its checksum is {found}, and should be {expected}; \
         take another, or run its case again"
    )]
    Damaged {
        /// The checksum it carries.
        expected: String,
        /// The checksum it has.
        found: String,
    },
    /// An array is not as it must be.
    #[error("its array `{name}` {what}")]
    Array {
        /// Its name.
        name: String,
        /// What is wrong with it.
        what: String,
    },
    /// It is a state, and a mode is wanted.
    #[error("this is a saved state, and no mode")]
    NoMode,
    /// Its tube or mesh is none.
    #[error("its header makes no sense: {0}")]
    Header(&'static str),
    /// It belongs to another tube or mesh.
    #[error("it belongs to another {what}: {found}, and not {expected}")]
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
    /// Whether the state is one of a plan's tube on the plan's mesh.
    ///
    /// # Errors
    /// [`SavedStateError::Other`] with what differs.
    pub fn belongs_to(&self, plan: &Plan) -> Result<(), SavedStateError> {
        let (mine, own) = (&self.layout, &Layout::of(plan));
        let differ = |what, found: String, expected: String| {
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
        let muscles = plan.tube.muscles.iter();
        let muscles: Vec<_> = muscles.map(|m| (m.name.clone(), m.direction)).collect();
        differ("tube", size(mine), size(own))?;
        differ("mesh", mesh(mine), mesh(own))?;
        differ("mesh", refine(mine), refine(own))?;
        differ(
            "symmetry",
            format!("{} rings", mine.rings),
            format!("{} rings", own.rings),
        )?;
        differ(
            "set of muscles",
            format!("{:?}", self.muscles),
            format!("{muscles:?}"),
        )
    }
}
