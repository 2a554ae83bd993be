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

const EPILOGUE: &str = "\
Examples:
  plica new tube.toml            write a case to start from
  plica check tube.toml          is it sound, how large, how long?
  plica run tube.toml            run it; results go to runs/tube
  plica run tube.toml -o again -t 4

A case file is described, key by key, in docs/case-file.md.

Exit codes:
  0    done
  1    the run could not be finished: no equilibrium was found any more, or too little memory
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

Ctrl-C or SIGTERM ends a run after the solve at hand, with everything written. A second Ctrl-C
ends it at once.";
