//! The command line: commands, arguments and help.

use crate::materials::MaterialsArguments;
use crate::sweep::SweepArguments;
use clap::{Args, Parser, Subcommand};
use clap_complete::Shell;
use plica_view::report::ColourScale;
use std::path::PathBuf;

/// Simulate soft muscular tubes that contract, buckle and invaginate
#[derive(Debug, Parser)]
#[command(name = "plica", version, after_long_help = EPILOGUE, arg_required_else_help = true)]
pub struct Arguments {
    /// The command to execute
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Run a case and write its states, curves and pictures to a directory
    #[command(after_long_help = RUN_EPILOGUE)]
    Run(RunArguments),
    /// Resume an interrupted run
    Resume(ResumeArguments),
    /// Find where a run becomes unstable, and the buckling modes
    #[command(after_long_help = STABILITY_EPILOGUE)]
    Stability(StabilityArguments),
    /// Compute a study of many tubes: a case with axes over its keys
    #[command(after_long_help = SWEEP_EPILOGUE)]
    Sweep(SweepArguments),
    /// Follow branches of equilibria, stable or not, through folds and branch points
    #[command(after_long_help = FOLLOW_EPILOGUE)]
    Follow(FollowArguments),
    /// Compare Plica with closed forms and independent solutions
    #[command(after_long_help = VERIFY_EPILOGUE)]
    Verify(VerifyArguments),
    /// Reproduce the figures of Okino et al. (2025)
    #[command(after_long_help = REPRODUCE_EPILOGUE)]
    Reproduce(ReproduceArguments),
    /// Export the states of a run to VTK files for ParaView and PyVista
    #[command(after_long_help = EXPORT_EPILOGUE)]
    Export(ExportArguments),
    /// Draw states of a run, cut open and coloured by a field
    #[command(after_long_help = RENDER_EPILOGUE)]
    Render(RenderArguments),
    /// Plot columns of the history, or wall profiles, as SVG and PNG
    #[command(after_long_help = PLOT_EPILOGUE)]
    Plot(PlotArguments),
    /// Animate a run, with a plot of its energy
    #[command(after_long_help = ANIMATE_EPILOGUE)]
    Animate(AnimateArguments),
    /// Write an HTML report of a run, or a comparison of several
    #[command(after_long_help = REPORT_EPILOGUE)]
    Report(ReportArguments),
    /// Print the closing table of runs, or their findings as JSON
    Table(TableArguments),
    /// Check a case and estimate its size and run time
    Check(CaseArguments),
    /// List the library of materials, draw curves of a law, or fit a law to tests
    Materials(MaterialsArguments),
    /// Write a commented example case
    New {
        /// File to write; - writes to standard output
        #[arg(default_value = "case.toml")]
        file: PathBuf,
    },
    /// Print the JSON schema of the case file, for completion in editors
    Schema,
    /// Print a shell completion script
    Completions {
        /// Shell to complete for
        shell: Shell,
    },
}

/// A case file and the directories that it may read from.
#[derive(Args, Debug)]
pub struct CaseArguments {
    /// The case file
    #[arg(value_name = "CASE")]
    pub file: PathBuf,
    /// Change a key of the case, for example mesh.degree=2 or stages[2].steps=40; may be repeated. The case.toml of a run
    /// has the change
    #[arg(long, value_name = "KEY=VALUE", value_parser = setting)]
    pub set: Vec<Setting>,
    /// Also allow the case to read files in this directory [default: only the directory of the case and the working directory]
    #[arg(long, value_name = "DIR")]
    pub within: Option<PathBuf>,
}

/// The number of threads.
#[derive(Args, Clone, Copy, Debug)]
pub struct Threads {
    /// Number of threads [default: all cores]
    #[arg(short = 't', long = "threads", value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub number: Option<u16>,
}

/// Arguments of `plica run`.
#[derive(Args, Debug)]
pub struct RunArguments {
    /// Directory to write to [default: runs/NAME for a case NAME.toml]
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Replace an existing run in that directory
    #[arg(long)]
    pub overwrite: bool,
    /// Resume the run in that directory, or start it if there is none. The title, [solver], [output], the number of
    /// steps of the current stage, and later stages of the case may have changed
    #[arg(long, conflicts_with = "overwrite")]
    pub resume: bool,
    /// Stop after the first state that fulfils a condition, for example "shape = invaginated", overhangs, unstable, or
    /// "overhang > 0.1" with any column of history.csv. The run is then complete; plica resume goes on
    #[arg(long, value_name = "CONDITION")]
    pub until: Option<String>,
    /// Exit with code 4 if the run is complete, but a wall crosses itself, the lumen is closed, or a state is not in
    /// equilibrium or was not tested for stability
    #[arg(long)]
    pub strict: bool,
    /// The case file and the directories that it may read from
    #[command(flatten)]
    pub case: CaseArguments,
    /// The number of threads
    #[command(flatten)]
    pub threads: Threads,
}

/// Arguments of `plica follow`.
#[derive(Args, Debug)]
pub struct FollowArguments {
    /// Directory to write to [default: runs/NAME-branches for a case NAME.toml]
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Replace the branches in that directory
    #[arg(long)]
    pub overwrite: bool,
    /// The case file and the directories that it may read from
    #[command(flatten)]
    pub case: CaseArguments,
    /// The number of threads
    #[command(flatten)]
    pub threads: Threads,
}

/// Arguments of `plica resume`.
#[derive(Args, Debug)]
pub struct ResumeArguments {
    /// Directory of the run
    #[arg(value_name = "RUN_DIR")]
    pub run: PathBuf,
    /// Exit with code 4 as `plica run --strict` does
    #[arg(long)]
    pub strict: bool,
    /// The number of threads
    #[command(flatten)]
    pub threads: Threads,
}

/// Arguments of `plica stability`.
#[derive(Args, Debug)]
pub struct StabilityArguments {
    /// Directory of the run
    #[arg(value_name = "RUN_DIR")]
    pub run: PathBuf,
    /// Axisymmetric runs: highest circumferential mode to test [default: output.stability_modes of the case]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(0..=100))]
    pub harmonics: Option<u8>,
    /// Axisymmetric runs: width of the brackets of critical values, in the unit of the driven quantity (Lmax/L, Dmin/D or
    /// D; relative for a pressure), from 1e-9 to 1 [default: 1e-4]
    #[arg(long, value_name = "X", value_parser = tolerance, allow_negative_numbers = true)]
    pub tolerance: Option<f64>,
    /// Three-dimensional runs: number of lowest eigenvalues and modes per state [default: 3]
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u8).range(1..=50))]
    pub modes: Option<u8>,
    /// Three-dimensional runs: state to analyse; may be repeated [default: all saved states]
    #[arg(long, value_name = "N", value_delimiter = ',')]
    pub state: Vec<usize>,
    /// The number of threads
    #[command(flatten)]
    pub threads: Threads,
}

/// Arguments of `plica verify`.
#[derive(Args, Debug)]
pub struct VerifyArguments {
    /// Include slow checks and finer meshes
    #[arg(long)]
    pub full: bool,
    /// Run only checks whose name contains NAME; may be repeated [default: all]
    #[arg(long, value_name = "NAME")]
    pub only: Vec<String>,
    /// List the checks without running them
    #[arg(long, conflicts_with_all = ["full", "only", "out"])]
    pub list: bool,
    /// Directory to write the table and pictures to
    #[arg(short, long, value_name = "DIR", default_value = "runs/verification")]
    pub out: PathBuf,
    /// The number of threads
    #[command(flatten)]
    pub threads: Threads,
}

/// Arguments of `plica plot`.
#[derive(Args, Debug)]
pub struct PlotArguments {
    /// Directory of the run
    #[arg(value_name = "RUN_DIR")]
    pub run: PathBuf,
    /// Walls, or columns of history.csv to plot, one plot each
    #[arg(value_name = "WHAT", default_value = "energy")]
    pub what: Vec<String>,
    /// Column for the horizontal axis [default: the number of the state]
    #[arg(long, alias = "along", value_name = "COLUMN")]
    pub against: Option<String>,
    /// For walls: state to plot; may be repeated [default: the last saved state]
    #[arg(long, value_name = "N", value_delimiter = ',')]
    pub state: Vec<usize>,
    /// Width of the PNG in pixels, from 600 to 8000
    #[arg(long, value_name = "PX", default_value = "1800", value_parser = clap::value_parser!(u16).range(600..=8000))]
    pub width: u16,
    /// File to write a single plot to, ending in .svg or .png [default: both, in pictures/ of the run]
    #[arg(short, long, value_name = "FILE")]
    pub out: Option<PathBuf>,
}

/// Arguments of `plica report`.
#[derive(Args, Debug)]
pub struct ReportArguments {
    /// Directories of one to four runs; several are compared
    #[arg(value_name = "RUN_DIR", required = true)]
    pub runs: Vec<PathBuf>,
    /// File to write to [default: report.html of the run; comparison.html in the working directory for several]
    #[arg(short, long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// The number of threads
    #[command(flatten)]
    pub threads: Threads,
}

/// Arguments of `plica table`.
#[derive(Args, Debug)]
pub struct TableArguments {
    /// Directories of runs
    #[arg(value_name = "RUN_DIR", required = true)]
    pub runs: Vec<PathBuf>,
    /// Print one JSON array with the findings of every run, numbers and intervals of states included
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `plica reproduce`.
#[derive(Args, Debug)]
pub struct ReproduceArguments {
    /// Figures: fig3 to fig7, appendix-a, appendix-b [default: all]
    #[arg(value_name = "FIGURE")]
    pub figures: Vec<String>,
    /// Use coarser meshes than the paper; takes minutes [default]
    #[arg(long, conflicts_with = "full")]
    pub quick: bool,
    /// Use the paper's mesh, in three dimensions where that matters; takes one to two hours
    #[arg(long)]
    pub full: bool,
    /// List the figures and their cases without running them
    #[arg(long)]
    pub list: bool,
    /// Directory to write to [default: runs/reproduction, or runs/reproduction-full]
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// The number of threads
    #[command(flatten)]
    pub threads: Threads,
}

/// Arguments of `plica export`.
#[derive(Args, Debug)]
pub struct ExportArguments {
    /// Directory of the run
    #[arg(value_name = "RUN_DIR")]
    pub run: PathBuf,
    /// State whose volume to export; may be repeated [default: the last saved state]
    #[arg(long, value_name = "N", value_delimiter = ',', conflicts_with = "all")]
    pub state: Vec<usize>,
    /// Export the volume of every saved state
    #[arg(long)]
    pub all: bool,
    /// Also export volumes as linear cells, for filters that do not support curved ones
    #[arg(long)]
    pub linear: bool,
    /// Also export the walls of all saved states to one VTKHDF file
    #[arg(long)]
    pub hdf: bool,
    /// The number of threads
    #[command(flatten)]
    pub threads: Threads,
}

/// Arguments of `plica render`.
#[derive(Args, Debug)]
pub struct RenderArguments {
    /// Directory of the run
    #[arg(value_name = "RUN_DIR")]
    pub run: PathBuf,
    /// State to draw; may be repeated, for a column of states [default: the last saved state]
    #[arg(long, value_name = "N", value_delimiter = ',')]
    pub state: Vec<usize>,
    /// Appearance of the picture
    #[command(flatten)]
    pub look: LookArguments,
}

/// Arguments of `plica animate`.
#[derive(Args, Debug)]
pub struct AnimateArguments {
    /// Directory of the run
    #[arg(value_name = "RUN_DIR")]
    pub run: PathBuf,
    /// States per second, from 0.1 to 60
    #[arg(long, value_name = "N", default_value = "6", value_parser = frame_rate, allow_negative_numbers = true)]
    pub fps: f64,
    /// Appearance of the picture
    #[command(flatten)]
    pub look: LookArguments,
}

/// Appearance of a picture.
#[derive(Args, Debug)]
pub struct LookArguments {
    /// Field to colour the wall by
    #[arg(long, value_name = "FIELD", default_value = "energy", value_parser = fields())]
    pub field: String,
    /// Angle of the wall to cut away, from 0 to 350 degrees: 180 the near half, 90 its upper quarter, 0 nothing
    #[arg(long, value_name = "DEG", default_value = "180", value_parser = cutaway, allow_negative_numbers = true)]
    pub cutaway: f64,
    /// Draw the removed part transparent
    #[arg(long)]
    pub see_through: bool,
    /// View direction: oblique, front, above, colon, ileum, or three numbers UP,NEAR,ALONG
    #[arg(long, value_name = "VIEW", default_value = "oblique", value_parser = view, allow_hyphen_values = true)]
    pub view: Direction,
    /// Colour range: `path` for that of all saved states, `shown` for that of the states drawn, or its two limits
    #[arg(long, value_name = "RANGE", default_value = "path", value_parser = range, allow_hyphen_values = true)]
    pub range: ColourScale,
    /// Width of the picture in pixels, from 600 to 8000
    #[arg(long, value_name = "PX", default_value = "1800", value_parser = clap::value_parser!(u16).range(600..=8000))]
    pub width: u16,
    /// File to write to [default: in pictures/ of the run]
    #[arg(short, long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// The number of threads
    #[command(flatten)]
    pub threads: Threads,
}

/// A direction of the viewer: (up, towards the viewer, along the tube).
pub type Direction = [f64; 3];

/// Returns the names of all fields.
fn fields() -> clap::builder::PossibleValuesParser {
    plica_view::report::Field::ALL
        .map(|field| field.name())
        .into()
}

/// Parses the angle of a cutaway, in degrees.
fn cutaway(text: &str) -> Result<f64, String> {
    match text.strip_suffix("deg").unwrap_or(text).parse::<f64>() {
        Ok(x) if (0.0..=350.0).contains(&x) => Ok(x),
        _ => Err("must be an angle from 0 to 350 degrees".into()),
    }
}

/// Parses a number of states per second.
fn frame_rate(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if (0.1..=60.0).contains(&x) => Ok(x),
        _ => Err("must be a number from 0.1 to 60".into()),
    }
}

/// Parses a view direction: a name, or three numbers.
fn view(text: &str) -> Result<Direction, String> {
    if let Some((_, view)) = crate::render::VIEWS.iter().find(|(name, _)| *name == text) {
        return Ok(*view);
    }
    match numbers::<3>(text) {
        Some([up, near, along]) if up.hypot(near) > 1e-3 * along.abs() => Ok([up, near, along]),
        _ => {
            let names = crate::render::VIEWS.map(|(name, _)| name);
            Err(format!(
                "must be {}, or three numbers UP,NEAR,ALONG in a direction that is not along the tube",
                names.join(", ")
            ))
        }
    }
}

/// A key of a case and its new value.
pub type Setting = (String, String);

/// Parses a changed key.
fn setting(text: &str) -> Result<Setting, String> {
    match text.split_once('=') {
        Some((key, value)) if !key.trim().is_empty() && !value.trim().is_empty() => {
            Ok((key.trim().to_owned(), value.trim().to_owned()))
        }
        _ => Err("must be KEY=VALUE, as in mesh.degree=2".into()),
    }
}

/// Parses a colour range.
fn range(text: &str) -> Result<ColourScale, String> {
    match (text, numbers::<2>(text)) {
        ("path", _) => Ok(ColourScale::Path),
        ("shown", _) => Ok(ColourScale::Shown),
        (_, Some([low, high])) if low < high => Ok(ColourScale::Given([low, high])),
        _ => Err("must be path, shown, or two numbers LOW,HIGH with LOW < HIGH".into()),
    }
}

/// Parses N finite numbers separated by commas.
fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let numbers = text.split(',').map(|word| word.trim().parse::<f64>());
    let numbers: Vec<f64> = numbers.collect::<Result<_, _>>().ok()?;
    let finite = numbers.iter().all(|x| x.is_finite());
    numbers.try_into().ok().filter(|_| finite)
}

/// Parses a tolerance between 1e-9, which can still be reached, and 1.
fn tolerance(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if (1e-9..=1.0).contains(&x) => Ok(x),
        _ => Err("must be a number from 1e-9 to 1".into()),
    }
}

const FOLLOW_EPILOGUE: &str = "\
The table [continuation] of the case names the parameter, its range, the events to locate and the
modes to switch to. The stages up to `after` are run first; the branch begins at their last state.

Files:
  branches/NN.csv            states of a branch: arc length, parameter, unstable modes, measures
  points.csv                 folds, branch points, losses of stability and other events
  points/LABEL.safetensors   the states there, from which a case can start
  modes/LABEL.safetensors    the critical modes
  diagram-COLUMN.png, .svg   bifurcation diagrams: stable solid, unstable dashed

Examples:
  plica follow tube.toml
  plica follow tube.toml --set continuation.between=[1.0,1.2]";

const EPILOGUE: &str = "\
Examples:
  plica new tube.toml            write an example case
  plica check tube.toml          check it and estimate its run time
  plica run tube.toml            run it and write to runs/tube
  plica run tube.toml -o again -t 4
  plica resume runs/tube         resume an interrupted run
  plica stability runs/tube      find critical values and buckling modes
  plica render runs/tube         draw the last state
  plica plot runs/tube energy    plot the energy
  plica animate runs/tube        animate all states
  plica report runs/tube         write an HTML report
  plica export runs/tube         export to ParaView
  plica verify                   verify this program
  plica reproduce fig4           reproduce a figure of the paper

docs/case-file.md describes every key of a case file.

Exit codes:
  0    success
  1    a run did not finish, a check failed, or a statement of the paper is not met
  2    wrong arguments, or an invalid case
  3    a file could not be read or written
  130  interrupted by Ctrl-C or SIGTERM; completed results are written";

const RUN_EPILOGUE: &str = "\
Output:
  case.toml       the case
  manifest.json   version, machine, start and end time, verdict
  history.csv     one row per accepted state: targets, energy, shape, stability
  profiles/       outer and inner wall of the states, as tables
  states/         complete states
  *.png           plots and pictures, unless output.pictures is false

Ctrl-C or SIGTERM stops the run after the current solve or iteration and writes all results. A second Ctrl-C stops it \
at once. `plica resume RUN_DIR` resumes the run from its last state in either case.";

const STABILITY_EPILOGUE: &str = "\
Axisymmetric runs: every saved state is tested against circumferential modes: mode 0 is axisymmetric, mode 1 tilts the \
tube sideways, mode 2 makes it oval, mode n gives it n lobes. Where the tube loses or regains stability to a mode between \
two states, the critical value is bracketed by bisection.

Output in the directory of the run:
  stability.csv    critical values: stage, mode, lost or regained, position
  eigenvalues.csv  lowest eigenvalue of every mode at every state
  modes/           buckling modes with the states they belong to
  stability.png    lowest eigenvalues along the path with the critical values
  mode.png         the first buckling mode

Ctrl-C or SIGTERM stops the analysis after the current solve; nothing is written, and earlier results stay.

Three-dimensional runs: the lowest eigenvalues and modes of the tangent at each state are computed, with the share of \
each circumferential mode in them.

Output in the directory of the run:
  eigenpairs.csv   lowest eigenvalues of every state, their accuracy and circumferential modes
  modes/           modes with the states they belong to
  stability.png    lowest eigenvalues by state
  mode.png         modes of the first unstable state, or of the last state if all are stable

Ctrl-C or SIGTERM stops the analysis after the current iteration; completed states are written. \
Earlier results of other states stay in any case.";

const SWEEP_EPILOGUE: &str = "\
A study file names a base case and the values of its keys:

  base = \"invagination.toml\"

  [axes]
  \"tube.thickness\" = [0.04, 0.05, 0.06]
  \"stages.contract.drive.circular.diameter_ratio\" = { from = 0.2, to = 0.5, points = 16 }

  [refine]                       # optional: bisect where neighbours differ
  of = \"shape\"
  until = { \"stages.contract.drive.circular.diameter_ratio\" = 0.01 }

Output in the folder of the study:
  points/NAME/   the run of a point, named by its content
  table.csv      one row for each point
  failed/        the reasons of runs that ended with an error

Ctrl-C, SIGTERM or a kill loses nothing: the same command computes what is missing. Several processes, also on several \
machines that share a disk, may work on a study at once. docs/how-to/study.md shows a job array.";

const VERIFY_EPILOGUE: &str = "\
The checks compare Plica with closed forms, an independent one-dimensional solution, expected orders of convergence and \
reference implementations of its own algorithms. Every row shows the computed value, the reference, its source, the \
error and the tolerance. docs/verification.md describes the checks.

Output:
  verification.md   the table and pictures as a page
  *.png             pictures

Ctrl-C or SIGTERM stops the verification after the current problem; nothing is written. A second Ctrl-C stops it at once.";

const REPRODUCE_EPILOGUE: &str = "\
Each figure is reproduced from runs of cases in cases/, some with changed keys. Each statement of the paper is compared \
with the computed result. docs/reproduction.md describes the measurements.

Output:
  reproduction.md     every statement of the paper and whether it is met
  fig3.md, ...        one page per figure: pictures, tables, runs and their times
  *.png               pictures
  runs/               the runs, each with its case

Existing runs are reused, and figures whose runs all exist are included. Ctrl-C or SIGTERM stops after the current \
solve; the same command then resumes after the last completed run. A second Ctrl-C stops at once.";

const EXPORT_EPILOGUE: &str = "\
Output in the directory of the run:
  vtk/walls.pvd    the surface of the wall at every saved state; open this in ParaView
  vtk/meridian.pvd of an axisymmetric run, a meridian section at every saved state, in small files
  vtk/volume.pvd   the wall at the selected states, as curved Lagrange cells that represent the splines exactly
  vtk/linear.pvd   with --linear, the same as linear cells
  vtk/walls.vtkhdf with --hdf, the surfaces of all states in one file
  vtk/walls/, vtk/meridian/, vtk/volume/, vtk/linear/
                   the files of the states

Fields: displacement, det Fe, growth stretches, strain energy density, Cauchy stress, von Mises stress, principal \
stretches and directions, Green-Lagrange strain. docs/run-directory.md defines them. The collections keep states that \
were exported before.

Ctrl-C or SIGTERM stops the export after the current file.";

const PLOT_EPILOGUE: &str = "\
Examples:
  plica plot runs/tube lumen_volume --against inner_pressure
  plica plot runs/tube walls --state 15 --state 30 --out walls.svg

Every column of numbers in history.csv can be plotted, against any other: energy, overhang, lumen_volume, outer_radius_mid, \
inner_pressure, axial_force_END, torque_END, target_MUSCLE, work_MUSCLE and so on. docs/run-directory.md defines them; the \
message for an unknown name lists those of the run.

The SVG keeps text as text.";

const REPORT_EPILOGUE: &str = "\
The page is a single file that opens in any browser without a network. It shows the tube in three dimensions along its \
path, linked plots, findings, warnings, stability, pictures, a table of states, the case, and instructions to repeat the \
run. Run `plica stability` first to include critical values.

Examples:
  plica report runs/tube                     write runs/tube/report.html
  plica report runs/one runs/other -o p.html
                                             compare two runs

A comparison shows each run at the state whose load is nearest.";

const RENDER_EPILOGUE: &str = "\
Examples:
  plica render runs/tube --state 15 --state 40 --field von-mises
  plica render runs/tube --cutaway 90 --view colon --out figure.png
  plica render runs/tube --view 0.2,1,-0.5 --range 0,0.1 --width 3600

Without --out, the picture is written to pictures/ in the directory of the run and named after field and states. No \
display is needed.";

const ANIMATE_EPILOGUE: &str = "\
The animation shows every saved state at one scale and with one colour bar; the last state stays longer. It is an \
animated PNG, which browsers and presentation programs play; other programs show the first state. If --out ends in \
.mp4, ffmpeg converts it to a video.

Ctrl-C or SIGTERM stops after the current pictures; nothing is written.";
