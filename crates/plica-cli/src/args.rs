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
    /// Go on with a run where it was left: by Ctrl-C, a time limit, a full disk or a failure of power
    Resume(ResumeArguments),
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
    /// Draw states of a run, cut open and coloured by a field
    #[command(after_long_help = RENDER_EPILOGUE)]
    Render(RenderArguments),
    /// Plot numbers of a run's states against each other, or its walls, as SVG and PNG
    #[command(after_long_help = PLOT_EPILOGUE)]
    Plot(PlotArguments),
    /// Draw the whole path of a run as an animation, the tube above its energy
    #[command(after_long_help = ANIMATE_EPILOGUE)]
    Animate(AnimateArguments),
    /// Write a run as one HTML page: the tube to turn and follow, plots, findings; or several, to compare
    #[command(after_long_help = REPORT_EPILOGUE)]
    Report(ReportArguments),
    /// Say whether a case is sound, and what running it would take
    Check(CaseArguments),
    /// Write a commented case file to start from
    New {
        /// Where to; - prints it
        #[arg(default_value = "case.toml")]
        file: PathBuf,
    },
    /// Print the JSON schema of the case file, with which editors complete and check a case
    Schema,
    /// Print a completion script for a shell
    Completions {
        /// The shell
        shell: Shell,
    },
}

/// A case, and where the files lie that it names.
#[derive(Args, Debug)]
pub struct CaseArguments {
    /// The case file
    #[arg(value_name = "CASE")]
    pub file: PathBuf,
    /// Files that the case names may lie anywhere in this folder; else only in that of the case, or where plica runs
    #[arg(long, value_name = "DIR")]
    pub within: Option<PathBuf>,
}

/// What `plica run` takes.
#[derive(Args, Debug)]
pub struct RunArguments {
    /// Directory to write to [default: runs/ and the name of the case]
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Replace a former run in that directory
    #[arg(long)]
    pub overwrite: bool,
    /// Go on with a former run in that directory where it was left, or begin if there is none. Of the case the
    /// title, [solver], [output], the steps of the stage it is in and all later stages may have changed
    #[arg(long, conflicts_with = "overwrite")]
    pub resume: bool,
    /// The case, and where its files lie
    #[command(flatten)]
    pub case: CaseArguments,
    /// Threads to use [default: all cores]
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

/// What `plica resume` takes.
#[derive(Args, Debug)]
pub struct ResumeArguments {
    /// The directory of a run
    #[arg(value_name = "RUN_DIR")]
    pub run: PathBuf,
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
    #[arg(long, value_name = "N", value_delimiter = ',')]
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

/// What `plica plot` takes.
#[derive(Args, Debug)]
pub struct PlotArguments {
    /// The directory of a run
    #[arg(value_name = "RUN_DIR")]
    pub run: PathBuf,
    /// What to plot: walls, or a column of history.csv; several give several plots
    #[arg(value_name = "WHAT", default_value = "energy")]
    pub what: Vec<String>,
    /// Column to plot it against [default: the number of the state]
    #[arg(long, value_name = "COLUMN")]
    pub along: Option<String>,
    /// For walls: number of a state; may be given again [default: the last]
    #[arg(long, value_name = "N", value_delimiter = ',')]
    pub state: Vec<usize>,
    /// Width of the PNG in pixels
    #[arg(long, value_name = "PX", default_value = "1800", value_parser = clap::value_parser!(u16).range(600..=8000))]
    pub width: u16,
    /// File to write to, of one plot: .svg or .png by its ending [default: both, in pictures/ of the run]
    #[arg(short, long, value_name = "FILE")]
    pub out: Option<PathBuf>,
}

/// What `plica report` takes.
#[derive(Args, Debug)]
pub struct ReportArguments {
    /// The directory of a run; of several, to compare them
    #[arg(value_name = "RUN_DIR", required = true, num_args = 1..=4)]
    pub runs: Vec<PathBuf>,
    /// File to write to [default: report.html of the run; of several, comparison.html here]
    #[arg(short, long, value_name = "FILE")]
    pub out: Option<PathBuf>,
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
    /// The paper's mesh, and three dimensions where they matter: an hour or two
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
    #[arg(long, value_name = "N", value_delimiter = ',', conflicts_with = "all")]
    pub state: Vec<usize>,
    /// Write the volume of every saved state
    #[arg(long)]
    pub all: bool,
    /// Write volumes as linear cells too, for filters that cannot follow curved ones
    #[arg(long)]
    pub linear: bool,
    /// Write the walls of all saved states as one VTKHDF file, too
    #[arg(long)]
    pub hdf: bool,
    /// Threads to use [default: all cores]
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

/// What `plica render` takes.
#[derive(Args, Debug)]
pub struct RenderArguments {
    /// The directory of a run
    #[arg(value_name = "RUN_DIR")]
    pub run: PathBuf,
    /// Number of a state to draw; given again, they stand one below the other [default: the last saved]
    #[arg(long, value_name = "N", value_delimiter = ',')]
    pub state: Vec<usize>,
    /// How it is drawn
    #[command(flatten)]
    pub look: LookArguments,
}

/// What `plica animate` takes.
#[derive(Args, Debug)]
pub struct AnimateArguments {
    /// The directory of a run
    #[arg(value_name = "RUN_DIR")]
    pub run: PathBuf,
    /// States shown in a second
    #[arg(long, value_name = "N", default_value = "6", value_parser = frames)]
    pub fps: f64,
    /// How it is drawn
    #[command(flatten)]
    pub look: LookArguments,
}

/// How states are drawn.
#[derive(Args, Debug)]
pub struct LookArguments {
    /// What the wall is coloured by
    #[arg(long, value_name = "FIELD", default_value = "energy", value_parser = fields())]
    pub field: String,
    /// Angle of the wall that is taken away: 180 is the near half, 90 its upper quarter, 0 nothing
    #[arg(long, value_name = "DEG", default_value = "180", value_parser = cutaway)]
    pub cutaway: f64,
    /// Show what is taken away as if of glass
    #[arg(long)]
    pub see_through: bool,
    /// From where: oblique, front, above, colon, ileum, or a direction UP,NEAR,ALONG
    #[arg(long, value_name = "VIEW", default_value = "oblique", value_parser = view, allow_hyphen_values = true)]
    pub view: Direction,
    /// Ends of the colour bar [default: chosen from what is there]
    #[arg(long, value_name = "LOW,HIGH", value_parser = range, allow_hyphen_values = true)]
    pub range: Option<Ends>,
    /// Width of the picture in pixels
    #[arg(long, value_name = "PX", default_value = "1800", value_parser = clap::value_parser!(u16).range(600..=8000))]
    pub width: u16,
    /// File to write to [default: in pictures/ of the run]
    #[arg(short, long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Threads to use [default: all cores]
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

/// A direction of the viewer: (up, towards the viewer, along the tube).
pub type Direction = [f64; 3];

/// The two ends of a colour bar.
pub type Ends = [f64; 2];

/// The names of fields.
fn fields() -> clap::builder::PossibleValuesParser {
    plica_view::report::Field::ALL
        .map(|field| field.name())
        .into()
}

/// An angle to take away.
fn cutaway(text: &str) -> Result<f64, String> {
    match text.strip_suffix("deg").unwrap_or(text).parse::<f64>() {
        Ok(x) if (0.0..=350.0).contains(&x) => Ok(x),
        _ => Err("must be an angle from 0 to 350 degrees".into()),
    }
}

/// States in a second.
fn frames(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if (0.1..=60.0).contains(&x) => Ok(x),
        _ => Err("must be a number from 0.1 to 60".into()),
    }
}

/// A direction by name, or three numbers.
fn view(text: &str) -> Result<Direction, String> {
    if let Some((_, view)) = crate::render::VIEWS.iter().find(|(name, _)| *name == text) {
        return Ok(*view);
    }
    let names = crate::render::VIEWS.map(|(name, _)| name);
    let rule = format!(
        "must be {}, or three numbers UP,NEAR,ALONG, and not along the tube itself",
        names.join(", ")
    );
    let Some(numbers) = numbers::<3>(text) else {
        return Err(rule);
    };
    let aside = numbers[0].hypot(numbers[1]);
    if aside > 1e-3 * numbers[2].abs() {
        Ok(numbers)
    } else {
        Err(rule)
    }
}

/// The ends of a colour bar.
fn range(text: &str) -> Result<Ends, String> {
    match numbers::<2>(text) {
        Some([low, high]) if low < high => Ok([low, high]),
        _ => Err("must be two numbers LOW,HIGH, the first below the second".into()),
    }
}

/// Numbers between commas.
fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let numbers = text.split(',').map(|word| word.trim().parse::<f64>());
    let numbers: Vec<f64> = numbers.collect::<Result<_, _>>().ok()?;
    let finite = numbers.iter().all(|x| x.is_finite());
    numbers.try_into().ok().filter(|_| finite)
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
  plica resume runs/tube         go on where a run was left
  plica stability runs/tube      where does its path become unstable, and how?
  plica verify                   is this program right?
  plica render runs/tube         its last state as a picture
  plica plot runs/tube energy    its energy along the path, as SVG and PNG
  plica animate runs/tube        its whole path as an animation
  plica report runs/tube         all of it as one page for a browser
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
Ctrl-C ends it at once. However it ends, `plica resume RUN_DIR` goes on from its last state.";

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
  vtk/walls.vtkhdf with --hdf, the surfaces of all states in one file
  vtk/walls/, volume/, linear/
                   the files of the states

Every file has displacement, det Fe, grown stretches, strain energy density, Cauchy and von Mises stress, principal
stretches with their directions, and Green-Lagrange strain; docs/run-directory.md tells what each is. States that were
written before stay in the collections.

Ctrl-C or SIGTERM ends it after the file at hand.";

const PLOT_EPILOGUE: &str = "\
Examples:
  plica plot runs/tube overhang --along length_ratio
  plica plot runs/tube walls --state 15 --state 30 --out walls.svg

Columns that can be plotted are those that the run has of: length_ratio, diameter_ratio, colon_displacement, ileum_displacement,
colon_twist_deg, ileum_twist_deg, inner_pressure, outer_pressure, inner_dead_load, outer_dead_load, energy, potential, max_wall_angle_deg, overhang, outer_radius_min, flatness, gap, lumen,
asymmetry, min_det_fe, damping_work, residual, iterations; docs/run-directory.md tells what they are.

Texts of an SVG stay texts, to be found and edited.";

const REPORT_EPILOGUE: &str = "\
The page needs nothing else: it opens from disk, goes by mail, and keeps beside a paper. It holds the tube in three
dimensions to turn and to follow along its path, plots that move with it, what was found in words, what to beware of,
stability, pictures, the states as a table, the case, and how to compute it again. Run plica stability first to have the
critical values in it.

Examples:
  plica report runs/tube                     to runs/tube/report.html
  plica report runs/one runs/other -o p.html
                                             paths beside each other, with one slider

Up to four runs are shown together, each at the state whose load is nearest. Without --out, their page is comparison.html where you are.";

const RENDER_EPILOGUE: &str = "\
Examples:
  plica render runs/tube --state 15 --state 40 --field von-mises
  plica render runs/tube --cutaway 90 --view colon --out figure.png
  plica render runs/tube --view 0.2,1,-0.5 --range 0,0.1 --width 3600

Without --out the picture goes to pictures/ in the directory of the run, named by field and states. Needs no display.";

const ANIMATE_EPILOGUE: &str = "\
One picture per saved state, all of one scale and one colour bar; the last stays longer. The file is an animated PNG: browsers
play it, slides and web pages take it, and programs that know no animation show the first state. With --out and a file that
ends in .mp4 it is a film, if ffmpeg is there.

Ctrl-C or SIGTERM ends it after the pictures at hand, with nothing written.";
