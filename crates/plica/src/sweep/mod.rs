//! Studies of many tubes: a base case, axes over any of its keys, and a folder with one run for each point.
//!
//! A [`Sweep`] is read from a study file:
//!
//! ```toml
//! base = "invagination.toml"
//!
//! [axes]
//! "tube.thickness" = [0.04, 0.05, 0.06]
//! "stages.contract.drive.circular.diameter_ratio" = { from = 0.2, to = 0.5, points = 4 }
//!
//! [refine]
//! of = "shape"
//! until = { "stages.contract.drive.circular.diameter_ratio" = 0.01 }
//! ```
//!
//! A [`Point`] is one tube. Its run directory is named by the content of its case, the files that the case names and the
//! version of Plica, so studies that overlap share runs, and a change of the base case computes what it must. Nothing
//! schedules points: a process claims one by the lock of its run directory, so several processes can work on a study at once.

mod axis;
mod file;
mod folder;
mod outcome;
mod point;
mod refine;
mod table;

pub use axis::Axis;
pub use folder::{Claim, StudyFolder};
pub use outcome::{Outcome, Status};
pub use point::{Point, PointCase, PointError};
pub use refine::{Measure, Refinement};
pub use table::table;

use crate::case::CaseError;
use std::path::{Path, PathBuf};

/// Largest number of points that the axes of a study may have.
pub const LARGEST: usize = 1_000_000;

/// A study of many tubes.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// The base case: its path, and its text.
    base: PathBuf,
    text: String,
    axes: Vec<Axis>,
    /// Points of a design in place of a grid; a value for each axis.
    design: Option<Vec<Vec<String>>>,
    refinement: Option<Refinement>,
    keep: Keep,
}

/// The states that the runs of a study keep.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Keep {
    /// The last state of every stage.
    #[default]
    Last,
    /// Those that the base case asks for.
    All,
}

/// Errors of studies of many tubes.
#[derive(Debug, thiserror::Error)]
pub enum SweepError {
    /// A file cannot be read or written.
    #[error("{}: {source}", path.display())]
    File {
        /// Its path.
        path: PathBuf,
        /// The error.
        source: std::io::Error,
    },
    /// The machine has too little free memory for a point.
    #[error(transparent)]
    Memory(#[from] crate::study::StudyError),
    /// The study file is wrong.
    #[error("{}: {error}", path.display())]
    Study {
        /// Its path.
        path: PathBuf,
        /// Its text.
        text: String,
        /// Its problems.
        error: CaseError,
    },
}

impl Sweep {
    /// Reads a study file and its base case.
    ///
    /// # Errors
    /// [`SweepError::File`] if one of the files cannot be read; [`SweepError::Study`] if the study file is wrong, or names a
    /// stage that the base case does not have.
    pub fn read(path: &Path) -> Result<Self, SweepError> {
        file::read(path)
    }

    /// Returns the path of the base case.
    pub fn base(&self) -> &Path {
        &self.base
    }

    /// Returns the axes.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// Returns the number of points of the grid or the design, without those of the refinement.
    pub fn size(&self) -> usize {
        match &self.design {
            Some(rows) => rows.len(),
            None => self.axes.iter().map(|axis| axis.values.len()).product(),
        }
    }

    /// Returns a point of the grid or the design, counted from 0; the last axis changes fastest.
    pub fn point(&self, index: usize) -> Point {
        let values = match &self.design {
            Some(rows) => rows[index].clone(),
            None => {
                let mut rest = index;
                let mut values: Vec<String> = vec![];
                for axis in self.axes.iter().rev() {
                    values.push(axis.values[rest % axis.values.len()].clone());
                    rest /= axis.values.len();
                }
                values.reverse();
                values
            }
        };
        Point { values }
    }

    /// Returns all points: those of the grid or the design, and those by which the refinement bisects the boundaries between
    /// outcomes that differ, as far as outcomes are known. They are in the same order whatever was computed first.
    pub fn points(&self, outcome: &dyn Fn(&Point) -> Option<Outcome>) -> Vec<Point> {
        let mut points: Vec<Point> = (0..self.size()).map(|i| self.point(i)).collect();
        if let Some(refinement) = &self.refinement {
            points.extend(refinement.points(&self.axes, &points, outcome));
        }
        points
    }

    /// Returns whether outcomes bring further points.
    pub fn is_refined(&self) -> bool {
        self.refinement.is_some()
    }
}
