//! The result of a run, and its closing table.

use crate::study::{Ending, Findings, HalfRange, Plan, RangeChanges, Row, Scale};
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
    half_range: Option<HalfRange>,
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
            half_range: None,
            directory: directory.to_owned(),
        }
    }

    /// Adds what half the range of contact changes in the last state.
    #[must_use]
    pub(super) fn with_half_range(mut self, found: Option<HalfRange>) -> Self {
        self.half_range = found;
        self
    }

    /// Returns what half the range of contact changes in the last state; none if that touches nothing, or with friction.
    pub fn half_range(&self) -> Option<HalfRange> {
        self.half_range
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
        if let Some(HalfRange { changes, .. }) = self.half_range {
            let line = match changes {
                Some(RangeChanges { energy, force }) => format!(
                    "half of it changes W of the last state by {:+.1e} and the contact force by {force:+.1e} (relative)",
                    energy
                ),
                None => "no equilibrium was found for the last state with half of it".to_owned(),
            };
            writeln!(f, "  {:<22} {line}", "range of contact")?;
        }
        writeln!(f, "  {:<22} {}", "written to", self.directory.display())
    }
}
