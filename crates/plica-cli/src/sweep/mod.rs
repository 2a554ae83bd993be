//! `plica sweep`: studies of many tubes.

mod check;
mod engine;
mod picture;

use crate::args::Threads;
use crate::console;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::threads;
use clap::{Args, Subcommand};
use engine::{Engine, Known, Quiet};
use plica::run_directory::write_file;
use plica::study::{available_memory, memory_bytes};
use plica::sweep::{
    Claim, Outcome, Point, PointCase, Status, StudyFolder, Sweep, SweepError, table,
};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Arguments of `plica sweep`.
#[derive(Args, Debug)]
pub struct SweepArguments {
    /// The command to execute
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Check a study: the number of its points, the points that are not valid, time, memory and disk
    Check(StudyArguments),
    /// Compute the points that are missing, and write the table
    Run(RunArguments),
    /// Print the numbers of points that are computed and missing
    Status(StudyArguments),
    /// Write the table of all points
    Table(TableArguments),
    /// Draw the outcomes over two axes
    Picture(picture::PictureArguments),
    /// Compute one point, for job arrays of a cluster
    Point(PointArguments),
}

/// Variable of a job array with the number of the point.
const TASK: &str = "SLURM_ARRAY_TASK_ID";

/// A study.
#[derive(Args, Debug)]
struct StudyArguments {
    /// The study file
    #[arg(value_name = "STUDY")]
    study: PathBuf,
    /// Folder of the study [default: studies/NAME for a study NAME.toml]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// The number of threads
    #[command(flatten)]
    threads: Threads,
}

#[derive(Args, Debug)]
struct RunArguments {
    /// Compute points again whose runs ended with an error
    #[arg(long)]
    retry: bool,
    /// Points that are computed at a time, each on one thread [default: the number of cores]
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// The study
    #[command(flatten)]
    study: StudyArguments,
}

#[derive(Args, Debug)]
struct TableArguments {
    /// File to write to; - writes to standard output [default: table.csv in the folder of the study]
    #[arg(long, value_name = "FILE")]
    file: Option<PathBuf>,
    /// The study
    #[command(flatten)]
    study: StudyArguments,
}

#[derive(Args, Debug)]
struct PointArguments {
    /// The study
    #[command(flatten)]
    study: StudyArguments,
    /// Number of the point, from 0 [default: the variable SLURM_ARRAY_TASK_ID]
    #[arg(value_name = "POINT")]
    point: Option<usize>,
}

/// Executes a command on a study.
pub fn sweep(arguments: &SweepArguments) -> Result<(), Failure> {
    match &arguments.command {
        Command::Check(study) => check::check(&Study::open(study)?),
        Command::Run(arguments) => run(arguments),
        Command::Status(study) => status(&Study::open(study)?),
        Command::Table(arguments) => write_table(arguments),
        Command::Picture(arguments) => picture::picture(arguments),
        Command::Point(arguments) => point(arguments),
    }
}

/// A study and its folder.
struct Study {
    sweep: Sweep,
    folder: StudyFolder,
    file: PathBuf,
}

impl Study {
    fn open(arguments: &StudyArguments) -> Result<Self, Failure> {
        threads::limit(arguments.threads)?;
        let file = arguments.study.clone();
        let stem = file.file_stem().unwrap_or(file.as_os_str());
        let out = arguments.out.clone();
        let out = out.unwrap_or_else(|| Path::new("studies").join(stem));
        Ok(Self {
            sweep: Sweep::read(&file)?,
            folder: StudyFolder::new(&out),
            file,
        })
    }

    /// Returns all points with their runs and outcomes so far.
    fn rows(&self) -> Vec<(Point, String, Outcome)> {
        let mut known = Known::new(&self.sweep, &self.folder);
        known.rows()
    }

    /// Returns the cases of the first, the middle and the last valid point, as samples of all.
    fn samples(&self) -> Vec<PointCase> {
        let size = self.sweep.size();
        let mut samples: Vec<PointCase> = vec![];
        for from in [0, size / 2, size.saturating_sub(1)] {
            let valid = (from..size).find_map(|i| self.sweep.case(&self.sweep.point(i)).ok());
            samples.extend(valid);
        }
        samples.dedup_by(|a, b| a.name == b.name);
        samples
    }

    /// Describes a point.
    fn describe(&self, point: &Point) -> String {
        let axes = self.sweep.axes().iter().zip(&point.values);
        let parts: Vec<String> = axes
            .map(|(axis, value)| format!("{} = {value}", axis.name))
            .collect();
        parts.join(", ")
    }
}

impl From<SweepError> for Failure {
    fn from(error: SweepError) -> Self {
        match error {
            SweepError::Study { path, text, error } => Self::Case { path, text, error },
            SweepError::Memory(error) => Self::Run(error.into()),
            error @ SweepError::File { .. } => Self::Files(error.to_string()),
        }
    }
}

/// Computes the points that are missing.
fn run(arguments: &RunArguments) -> Result<(), Failure> {
    let study = Study::open(&arguments.study)?;
    let interrupt = Interrupt::listen()?;
    if arguments.retry {
        let removed = study.folder.retry()?;
        console::message(&format!("{removed} failed points are computed again"));
    }
    let jobs = jobs(&study, arguments.jobs);
    let engine = Engine {
        study: &study,
        interrupt: interrupt.clone(),
        jobs,
    };
    let rows = engine.compute()?;
    let text = table(study.sweep.axes(), &rows);
    let path = study.folder.write("table.csv", text.as_bytes())?;
    console::print(&summary(&rows))?;
    console::print(&format!("  {:<22} {}\n", "written to", path.display()))?;
    if interrupt.is_requested() {
        return Err(Failure::Interrupted(
            "interrupted; what was computed is kept, and the same command goes on".into(),
        ));
    }
    let count = |status| rows.iter().filter(|row| row.2.status == status).count();
    match count(Status::Failed) {
        0 => Ok(()),
        failed => {
            let how = "their reasons are in the table; --retry computes them again";
            console::message(&format!("{failed} points failed: {how}"));
            Err(Failure::Unfinished)
        }
    }
}

/// Returns the number of points to compute at a time: as many as asked for or as there are cores, and as fit into the memory.
fn jobs(study: &Study, asked: Option<u16>) -> usize {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let wanted = asked.map_or(cores, usize::from);
    let samples = study.samples();
    let needed = samples.iter().map(|case| memory_bytes(&case.plan)).max();
    let (Some(needed), Some(available)) = (needed, available_memory()) else {
        return wanted;
    };
    let fit = usize::try_from(available / needed.max(1)).unwrap_or(wanted);
    if fit < wanted {
        console::message(&format!(
            "{} at a time: a point needs about {:.1} GB",
            fit.max(1),
            needed as f64 / 1e9
        ));
    }
    wanted.min(fit.max(1))
}

/// Prints how many points are computed.
fn status(study: &Study) -> Result<(), Failure> {
    console::print(&summary(&study.rows()))
}

/// Writes the table of all points.
fn write_table(arguments: &TableArguments) -> Result<(), Failure> {
    let study = Study::open(&arguments.study)?;
    let text = table(study.sweep.axes(), &study.rows());
    match &arguments.file {
        Some(file) if file.as_os_str() == "-" => console::print(&text),
        Some(file) => write_named(file, text.as_bytes()),
        None => {
            let path = study.folder.write("table.csv", text.as_bytes())?;
            console::print(&format!("written to {}\n", path.display()))
        }
    }
}

/// Writes a file that the user has named.
fn write_named(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let written = write_file(path, bytes);
    written.map_err(|error| Failure::Files(format!("--file {}: {error}", path.display())))
}

/// Computes one point.
fn point(arguments: &PointArguments) -> Result<(), Failure> {
    let study = Study::open(&arguments.study)?;
    let size = study.sweep.size();
    let task = || std::env::var(TASK).ok()?.parse().ok();
    let Some(number) = arguments.point.or_else(task) else {
        return Err(Failure::Usage(format!(
            "give the number of a point, or set {TASK}"
        )));
    };
    if number >= size {
        return Err(Failure::Usage(format!(
            "point {number}: the study has {size} points, 0 to {}",
            size.saturating_sub(1)
        )));
    }
    let point = study.sweep.point(number);
    let name = study.describe(&point);
    let mut monitor = Quiet::new(Interrupt::listen()?);
    match study.folder.compute(&study.sweep, &point, &mut monitor)? {
        Claim::Computed(outcome) | Claim::Known(outcome) => {
            console::print(&format!("point {number}, {name}: {}\n", short(&outcome)))?;
            match outcome.status {
                Status::Failed | Status::Invalid => Err(Failure::Unfinished),
                _ => Ok(()),
            }
        }
        Claim::Taken => console::print(&format!(
            "point {number}, {name}: another process works on it\n"
        )),
        Claim::Cancelled => Err(Failure::Interrupted(
            "interrupted; what was computed is kept, and the same command goes on".into(),
        )),
    }
}

/// Describes an outcome in a few words.
fn short(outcome: &Outcome) -> String {
    match outcome.status {
        Status::Complete => format!("{}, {} states", outcome.shape, outcome.states),
        Status::Lost => format!(
            "lost after {} states ({}): {}",
            outcome.states, outcome.shape, outcome.reason
        ),
        status if outcome.reason.is_empty() => status.to_string(),
        status => format!("{status}: {}", outcome.reason),
    }
}

/// Counts points by their status, and those with states by the shape of the last one.
fn summary(rows: &[(Point, String, Outcome)]) -> String {
    let mut by_status: BTreeMap<String, usize> = BTreeMap::new();
    let mut by_shape: BTreeMap<String, usize> = BTreeMap::new();
    for (_, _, outcome) in rows {
        *by_status.entry(outcome.status.to_string()).or_default() += 1;
        if outcome.status.has_states() {
            *by_shape.entry(outcome.shape.clone()).or_default() += 1;
        }
    }
    let list = |counts: &BTreeMap<String, usize>| {
        let parts: Vec<String> = counts
            .iter()
            .map(|(name, n)| format!("{n} {name}"))
            .collect();
        parts.join(", ")
    };
    let mut text = format!("  {:<22} {}: {}\n", "points", rows.len(), list(&by_status));
    if !by_shape.is_empty() {
        text += &format!("  {:<22} {}\n", "last states", list(&by_shape));
    }
    text
}
