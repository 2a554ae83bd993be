//! The result of a run, and its closing table.

use crate::study::{Ending, Findings, Plan, Row, Scale};
use crate::tube::Load;
use std::fmt;
use std::path::{Path, PathBuf};

/// Load and unknowns of an accepted state, for drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct Snapshot {
    /// Its load.
    pub load: Load,
    /// Its unknowns.
    pub u: Vec<f64>,
}

/// The result of a run.
#[derive(Clone, Debug)]
pub struct Summary {
    rows: Vec<Row>,
    snapshots: Vec<Option<Snapshot>>,
    ending: Ending,
    findings: Findings,
    directory: PathBuf,
}

impl Summary {
    /// Makes the summary of a run.
    pub(super) fn new(
        plan: &Plan,
        rows: Vec<Row>,
        snapshots: Vec<Option<Snapshot>>,
        ending: Ending,
        directory: &Path,
    ) -> Self {
        let scale = Scale::of(plan.units.as_ref());
        Self {
            findings: Findings::of(&rows, &scale, plan.symmetry),
            rows,
            snapshots,
            ending,
            directory: directory.to_owned(),
        }
    }

    /// Returns whether every stage was completed.
    pub fn is_complete(&self) -> bool {
        self.ending == Ending::Complete
    }

    /// Returns how the run ended.
    pub fn ending(&self) -> &Ending {
        &self.ending
    }

    /// Returns the rows of the accepted states.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Returns the accepted states for pictures, one per row: none for a state that a resumed run could not read back. The list is
    /// empty if the case has no pictures.
    pub fn snapshots(&self) -> &[Option<Snapshot>] {
        &self.snapshots
    }

    /// Returns statements about the path.
    pub fn findings(&self) -> &Findings {
        &self.findings
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let lines = self.findings().lines();
        if lines.is_empty() {
            return writeln!(f, "no state was accepted");
        }
        for (name, value) in lines {
            writeln!(f, "  {name:<22} {value}")?;
        }
        writeln!(f, "  {:<22} {}", "written to", self.directory.display())
    }
}
