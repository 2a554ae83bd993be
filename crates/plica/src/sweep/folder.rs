//! The folder of a study: the runs of its points, their outcomes, and the table.

use super::point::PointError;
use super::{Outcome, Point, PointCase, Status, Sweep, SweepError};
use crate::monitor::Monitor;
use crate::run_directory::{Run, RunDirectory, RunError, Verdict, write_file};
use crate::study::{Ending, Findings, Scale, check_memory};
use std::fs;
use std::path::{Path, PathBuf};

/// Folder of the runs.
const POINTS: &str = "points";

/// File of an outcome, in the directory of its run.
const OUTCOME: &str = "outcome.json";

/// Folder of the outcomes of points whose runs failed.
const FAILED: &str = "failed";

/// The folder of a study:
///
/// | file | holds |
/// |---|---|
/// | `points/NAME/` | the run directory of a point, with its `outcome.json` |
/// | `failed/NAME.json` | the outcome of a point whose run ended with an error |
/// | `table.csv` | a row for each point |
#[derive(Clone, Debug)]
pub struct StudyFolder {
    path: PathBuf,
}

/// Result of an attempt to compute a point.
#[derive(Clone, Debug, PartialEq)]
pub enum Claim {
    /// This attempt has computed the point.
    Computed(Box<Outcome>),
    /// The point has an outcome already, or its case is not valid.
    Known(Box<Outcome>),
    /// Another process works on it.
    Taken,
    /// The attempt was cancelled; what was computed is kept.
    Cancelled,
}

impl StudyFolder {
    /// Returns the folder at a path, which need not exist yet.
    pub fn new(path: &Path) -> Self {
        Self {
            path: path.to_owned(),
        }
    }

    /// Returns its path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the directory of the run of a point.
    pub fn run(&self, name: &str) -> PathBuf {
        self.path.join(POINTS).join(name)
    }

    fn failed(&self, name: &str) -> PathBuf {
        self.path.join(FAILED).join(format!("{name}.json"))
    }

    /// Returns the outcome of a point so far.
    pub fn outcome(&self, sweep: &Sweep, point: &Point) -> (String, Outcome) {
        match sweep.case(point) {
            Ok(case) => (case.name.clone(), self.outcome_of(&case)),
            Err(error) => (String::new(), invalid(&error)),
        }
    }

    /// Returns the outcome of a valid case so far.
    pub fn outcome_of(&self, case: &PointCase) -> Outcome {
        let run = self.run(&case.name);
        let read = |path: &Path| {
            let outcome: Outcome = serde_json::from_slice(&fs::read(path).ok()?).ok()?;
            Some(outcome)
        };
        let kept = read(&run.join(OUTCOME)).or_else(|| read(&self.failed(&case.name)));
        kept.unwrap_or_else(|| {
            // Killed between the end of the run and its outcome: the next attempt finds that.
            let status = match RunDirectory::exists(&run) {
                true => Status::Begun,
                false => Status::Missing,
            };
            Outcome::of_status(status)
        })
    }

    /// Computes a point, or resumes it after an interruption. Its directory is locked meanwhile, so that one process at a time
    /// works on it. An error of its run is an outcome too, which [`StudyFolder::retry`] removes.
    ///
    /// # Errors
    /// [`SweepError::Memory`] if the machine has too little free memory, [`SweepError::File`] if the outcome cannot be written.
    pub fn compute(
        &self,
        sweep: &Sweep,
        point: &Point,
        monitor: &mut dyn Monitor,
    ) -> Result<Claim, SweepError> {
        let case = match sweep.case(point) {
            Ok(case) => case,
            Err(error) => return Ok(Claim::Known(invalid(&error).into())),
        };
        let outcome = self.outcome_of(&case);
        if outcome.status.is_final() {
            return Ok(Claim::Known(outcome.into()));
        }
        check_memory(&case.plan)?;
        let path = self.run(&case.name);
        let (outcome, file) = match follow(&case, &path, monitor) {
            Ok(Followed::Ended(outcome)) => (outcome, path.join(OUTCOME)),
            Ok(Followed::HadEnded(outcome)) => {
                save(&path.join(OUTCOME), &outcome)?;
                return Ok(Claim::Known(outcome.into()));
            }
            Ok(Followed::Cancelled) => return Ok(Claim::Cancelled),
            // Occupied: another process has just begun it.
            Err(RunError::Busy { .. } | RunError::Occupied(_)) => return Ok(Claim::Taken),
            Err(error) => (
                Outcome::without_states(Status::Failed, error),
                self.failed(&case.name),
            ),
        };
        save(&file, &outcome)?;
        Ok(Claim::Computed(outcome.into()))
    }

    /// Removes the outcomes of points whose runs failed, so that they are computed again; returns their number.
    ///
    /// # Errors
    /// [`SweepError::File`] if one cannot be removed.
    pub fn retry(&self) -> Result<usize, SweepError> {
        let folder = self.path.join(FAILED);
        let Ok(files) = fs::read_dir(&folder) else {
            return Ok(0);
        };
        let mut removed = 0;
        for file in files.flatten() {
            let path = file.path();
            if path
                .extension()
                .is_some_and(|extension| extension == "json")
            {
                fs::remove_file(&path).map_err(|source| SweepError::File { path, source })?;
                removed += 1;
            }
        }
        Ok(removed)
    }

    /// Writes a file into the folder, whole or not at all; returns its path.
    ///
    /// # Errors
    /// [`SweepError::File`].
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<PathBuf, SweepError> {
        let path = self.path.join(name);
        write(&path, bytes)?;
        Ok(path)
    }
}

/// Returns the outcome of a case that is not valid.
fn invalid(error: &PointError) -> Outcome {
    Outcome::without_states(Status::Invalid, error.to_string().replace('\n', "; "))
}

/// The end of an attempt to follow a run.
enum Followed {
    /// The run has ended.
    Ended(Outcome),
    /// The run had ended before.
    HadEnded(Outcome),
    /// The attempt was cancelled.
    Cancelled,
}

/// Follows the run of a point to its end.
fn follow(case: &PointCase, path: &Path, monitor: &mut dyn Monitor) -> Result<Followed, RunError> {
    let plan = &case.plan;
    let is_begun = RunDirectory::exists(path);
    let mut directory = match is_begun {
        true => RunDirectory::open(path)?,
        false => RunDirectory::create(path, &case.text, &plan.title, false)?,
    };
    directory.lock()?;
    // Ended, but killed before its outcome was written.
    let has_ended = matches!(directory.verdict(), Verdict::Complete | Verdict::Lost);
    if !has_ended {
        let mut run = match is_begun {
            true => Run::resume(plan, &mut directory, monitor)?,
            false => Run::begin(plan, &mut directory)?,
        };
        while run.next_row(monitor)?.is_some() {}
        if *run.finish()?.ending() == Ending::Stopped {
            return Ok(Followed::Cancelled);
        }
    }
    directory.close()?;
    // From the files, so that an outcome has the same digits whenever it is made.
    let rows = directory.checked_history()?.rows;
    let scale = Scale::of(plan.units.as_ref());
    let findings = Findings::of(&rows, &scale, plan.symmetry);
    let (verdict, manifest) = (directory.verdict(), directory.manifest());
    let reason = match verdict {
        Verdict::Lost => manifest["verdict_text"].as_str().unwrap_or_default(),
        _ => "",
    };
    let outcome = Outcome::of_run(&findings, verdict, reason);
    Ok(match has_ended {
        true => Followed::HadEnded(outcome),
        false => Followed::Ended(outcome),
    })
}

/// Writes the file of an outcome.
fn save(path: &Path, outcome: &Outcome) -> Result<(), SweepError> {
    write(
        path,
        &serde_json::to_vec_pretty(outcome).unwrap_or_default(),
    )
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), SweepError> {
    let error_at = |source| SweepError::File {
        path: path.to_owned(),
        source,
    };
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(error_at)?;
    }
    write_file(path, bytes).map_err(error_at)
}
