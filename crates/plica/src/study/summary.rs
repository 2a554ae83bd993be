//! How a run ended, and the short table it closes with.

use super::units::Scale;
use super::{Findings, Plan, Row};
use crate::assembly::Inverted;
use crate::solve::PathError;
use crate::tube::Load;
use std::fmt;
use std::path::{Path, PathBuf};

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// Every stage was done.
    Complete,
    /// Someone asked to stop.
    Stopped,
    /// The tube could not be followed further.
    Lost {
        /// The stage it was lost in.
        stage: String,
        /// What was tried.
        error: PathError<Inverted>,
    },
}

impl Ending {
    /// In one word.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Complete => "complete",
            Self::Stopped => "stopped",
            Self::Lost { .. } => "lost",
        }
    }
}

impl fmt::Display for Ending {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Complete => f.write_str("every stage was done"),
            Self::Stopped => f.write_str("stopped on request; every state so far is kept"),
            Self::Lost { stage, error } => write!(
                f,
                "the tube could not be followed further in stage `{stage}` ({error}); the last good \
                 state is kept. Try more steps in this stage, more solver.halvings or \
                 solver.relaxation_steps, or a finer mesh in the zone"
            ),
        }
    }
}

/// An accepted state in full.
#[derive(Clone, Debug, PartialEq)]
pub struct Snapshot {
    /// The load it is under.
    pub load: Load,
    /// Its unknowns.
    pub u: Vec<f64>,
}

/// What a run found.
#[derive(Clone, Debug)]
pub struct Summary {
    rows: Vec<Row>,
    snapshots: Vec<Option<Snapshot>>,
    ending: Ending,
    scale: Scale,
    directory: PathBuf,
}

impl Summary {
    /// Of a run.
    pub fn new(
        plan: &Plan,
        rows: Vec<Row>,
        snapshots: Vec<Option<Snapshot>>,
        ending: Ending,
        directory: &Path,
    ) -> Self {
        let scale = Scale::of(plan.units.as_ref());
        Self {
            rows,
            snapshots,
            ending,
            scale,
            directory: directory.to_owned(),
        }
    }

    /// Whether every stage was done.
    pub fn finished(&self) -> bool {
        self.ending == Ending::Complete
    }

    /// How it ended.
    pub fn ending(&self) -> &Ending {
        &self.ending
    }

    /// The accepted states.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// The accepted states in full, one per row, none of what a run that was taken up again could not read back; nothing at all if
    /// the case wants no pictures.
    pub fn snapshots(&self) -> &[Option<Snapshot>] {
        &self.snapshots
    }

    /// What they come to.
    pub fn findings(&self) -> Findings<'_> {
        Findings {
            rows: &self.rows,
            scale: self.scale.clone(),
        }
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let lines = self.findings().lines();
        if lines.is_empty() {
            return write!(f, "no state was accepted");
        }
        for (name, value) in lines {
            writeln!(f, "  {name:<22} {value}")?;
        }
        writeln!(f, "  {:<22} {}", "written to", self.directory.display())
    }
}
