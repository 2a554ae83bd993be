//! What may be written after `plica`.

use clap::{Args, Parser, Subcommand};
use clap_complete::Shell;
use std::path::PathBuf;

/// Simulates soft muscular tubes: how a wall that contracts around and relaxes along itself
/// deforms, buckles and invaginates.
#[derive(Debug, Parser)]
#[command(name = "plica", version, after_long_help = EPILOGUE, arg_required_else_help = true)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Run a case and write its states, curves and pictures to a directory
    #[command(after_long_help = RUN_EPILOGUE)]
    Run(RunArguments),
    /// Tell which modes a run's path becomes unstable to, where, and in what shape
    #[command(after_long_help = STABILITY_EPILOGUE)]
    Stability(StabilityArguments),
    /// Solve problems whose answer is known otherwise, and say how far off each is
    #[command(after_long_help = VERIFY_EPILOGUE)]
    Verify(VerifyArguments),
    /// Run the computations of Okino et al. (2025) and lay them beside what the paper reports
    #[command(after_long_help = REPRODUCE_EPILOGUE)]
    Reproduce(ReproduceArguments),
    /// Write states of a run as files of VTK, for ParaView and PyVista
    #[command(after_long_help = EXPORT_EPILOGUE)]
    Export(ExportArguments),
    /// Say whether a case is sound, and what running it would take
    Check {
        /// The case file
        case: PathBuf,
    },
    /// Write a commented case file to start from
    New {
        /// Where to; - prints it
        #[arg(default_value = "case.toml")]
        file: PathBuf,
    },
    /// Print a completion script for a shell
    Completions {
        /// The shell
        shell: Shell,
    },
}

/// What `plica run` takes.
#[derive(Args, Debug)]
pub struct RunArguments {
    /// The case file
    pub case: PathBuf,
    /// Directory to write to [default: runs/ and the name of the case]
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Replace a former run in that directory
    #[arg(long)]
    pub overwrite: bool,
    /// Threads to use [default: all cores]
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

/// What `plica stability` takes.
#[derive(Args, Debug)]
pub struct StabilityArguments {
    /// The directory of a run
    #[arg(value_name = "RUN_DIR")]
    pub run: PathBuf,
    /// Axisymmetric runs: circumferential harmonics to test, 0 to N [default: as in the case, 4 there]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(0..=100))]
    pub harmonics: Option<u8>,
    /// Axisymmetric runs: width to which a critical value is bracketed, in what is driven (Lmax/L,
    /// Dmin/D, or D; a fraction of a pressure) [default: 1e-4]
    #[arg(long, value_name = "X", value_parser = tolerance)]
    pub tolerance: Option<f64>,
    /// Three-dimensional runs: how many of the lowest eigenvalues and modes of each state [default: 3]
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u8).range(1..=50))]
    pub modes: Option<u8>,
    /// Three-dimensional runs: number of a state to look at; may be given again [default: all saved]
    #[arg(long, value_name = "N")]
    pub state: Vec<usize>,
    /// Threads to use [default: all cores]
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

/// What `plica verify` takes.
#[derive(Args, Debug)]
pub struct VerifyArguments {
    /// Take the slow checks along, and finer meshes
    #[arg(long)]
    pub full: bool,
    /// A check to hold alone, by its name or a part of it; may be given again [default: all]
    #[arg(long, value_name = "NAME")]
    pub only: Vec<String>,
    /// List the checks by name, and hold none
    #[arg(long, conflicts_with_all = ["full", "only", "out"])]
    pub list: bool,
    /// Directory to write the table and the pictures to
    #[arg(short, long, value_name = "DIR", default_value = "runs/verification")]
    pub out: PathBuf,
    /// Threads to use [default: all cores]
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

/// What `plica reproduce` takes.
#[derive(Args, Debug)]
pub struct ReproduceArguments {
    /// Figures: fig3 to fig7, appendix-a, appendix-b [default: all]
    #[arg(value_name = "FIGURE")]
    pub figures: Vec<String>,
    /// Coarser meshes than the paper's: some minutes [default]
    #[arg(long, conflicts_with = "full")]
    pub quick: bool,
    /// The paper's mesh, and three dimensions where they matter: hours
    #[arg(long)]
    pub full: bool,
    /// List the figures and the cases that they are told from, and run none
    #[arg(long)]
    pub list: bool,
    /// Directory to write to [default: runs/reproduction, or runs/reproduction-full]
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Threads to use [default: all cores]
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

/// What `plica export` takes.
#[derive(Args, Debug)]
pub struct ExportArguments {
    /// The directory of a run
    #[arg(value_name = "RUN_DIR")]
    pub run: PathBuf,
    /// Number of a state whose volume is written; may be given again [default: the last saved]
    #[arg(long, value_name = "N", conflicts_with = "all")]
    pub state: Vec<usize>,
    /// Write the volume of every saved state
    #[arg(long)]
    pub all: bool,
    /// Write volumes as linear cells too, for filters that cannot follow curved ones
    #[arg(long)]
    pub linear: bool,
    /// Threads to use [default: all cores]
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

/// A tolerance that can be reached.
fn tolerance(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if (1e-9..=1.0).contains(&x) => Ok(x),
        _ => Err("must be a number from 1e-9 to 1".into()),
    }
}

const EPILOGUE: &str = "\
Examples:
  plica new tube.toml            write a case to start from
  plica check tube.toml          is it sound, how large, how long?
  plica run tube.toml            run it; results go to runs/tube
  plica run tube.toml -o again -t 4
  plica stability runs/tube      where does its path become unstable, and how?
  plica verify                   is this program right?
  plica export runs/tube         its states for ParaView
  plica reproduce fig4           a figure of the paper, beside what the paper reports

A case file is described, key by key, in docs/case-file.md.

Exit codes:
  0    done
  1    the run could not be finished: no equilibrium was found any more, or too little memory;
       or a row of the verification is too far off, or a statement of the paper not met
  2    wrong arguments, or a case with problems
  3    files could not be read or written
  130  interrupted (Ctrl-C or SIGTERM); what was computed until then is written";

const RUN_EPILOGUE: &str = "\
What a run leaves behind:
  case.toml       the case as it was run
  manifest.json   version, machine, begin and end, verdict
  history.csv     one row per accepted state: targets, energy, shape, stability
  profiles/       outer and inner wall of the states, as tables
  states/         the states in full
  pictures        curves and walls (unless the case says otherwise)

Ctrl-C or SIGTERM ends a run after the solve or iteration at hand, with everything written. A second
Ctrl-C ends it at once.";

const STABILITY_EPILOGUE: &str = "\
Every saved state of an axisymmetric run is tested against circumferential harmonics: 0 keeps the
tube round, 1 tilts it sideways, 2 turns it oval, n folds it into n lobes. Where a harmonic is lost
or regained between two states, the path is followed again between them, halving the interval.

What it leaves in the directory of the run:
  stability.csv    critical values: stage, harmonic, lost or regained, where, how
  eigenvalues.csv  lowest eigenvalue of every harmonic at every state
  modes/           the shapes in which the tube leaves its path, with the state they belong to
  stability.png    lowest eigenvalues along the path, critical values marked
  mode.png         the first mode to go

Ctrl-C or SIGTERM ends it after the solve at hand, with nothing written.

The states of a three-dimensional run do not part into harmonics: the lowest eigenvalues of their
own tangent are looked for, with their modes, and the share that each harmonic has in them.

What it leaves in the directory of the run:
  eigenpairs.csv   lowest eigenvalues of every state, how exact they are, their harmonics
  modes/           the modes, with the state they belong to
  stability.png    lowest eigenvalues, state by state
  mode.png         the modes of the first unstable state, or else of the last

Ctrl-C or SIGTERM ends it after the iteration at hand, with the states before written.";

const VERIFY_EPILOGUE: &str = "\
Closed forms, an independent one-dimensional solution, orders of convergence, and second routes through
the program itself; every row says what was computed, what it should be, who says so, and how far off
it may be. docs/verification.md tells how each is found.

What it leaves behind:
  verification.md   the table and the pictures as a page
  *.png             the pictures

Ctrl-C or SIGTERM ends it after the problem at hand, some seconds at most, with nothing written. A
second Ctrl-C ends it at once.";

const REPRODUCE_EPILOGUE: &str = "\
Each figure is told from runs of cases in cases/, some with keys changed; each statement of the paper
stands beside what was found, and whether that agrees. docs/reproduction.md tells what is measured, and how.

What it leaves behind:
  reproduction.md     every statement of the paper, and whether it is met
  fig3.md, ...        the figures: pictures, tables, what was run and how long it took
  *.png               the pictures
  runs/               the runs, each with the case as it was run

Runs that are there already are not done again, and figures whose runs are all there are told along with those
asked for. Ctrl-C or SIGTERM ends it after the solve at hand; the same command then goes on after the
last run that was done. A second Ctrl-C ends it at once.";

const EXPORT_EPILOGUE: &str = "\
What it leaves in the directory of the run:
  vtk/walls.pvd    the surface of the wall at every saved state: open this in ParaView
  vtk/volume.pvd   the wall itself at the chosen states, as curved cells that are the splines exactly
  vtk/linear.pvd   with --linear, the same cut into straight cells
  vtk/walls/, volume/, linear/
                   the files of the states

Every file has displacement, det Fe, grown stretches, strain energy density, Cauchy and von Mises stress, principal
stretches with their directions, and Green-Lagrange strain; docs/run-directory.md tells what each is. States that were
written before stay in the collections.

Ctrl-C or SIGTERM ends it after the file at hand.";
