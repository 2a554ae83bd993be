//! `plica follow`.

use crate::args::FollowArguments;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::render::failure as drawing;
use crate::ticker::Ticker;
use crate::{case_file, console, threads};
use plica::branches::{
    Branch, BranchError, BranchState, Branches, Follow, Progress, SpecialPoint, start_state,
};
use plica::run_directory::{RunError, write_file};
use plica::saved_state::{Array, SavedState};
use plica::study::{Plan, StudyError, check_memory};
use plica_view::report::branch_diagrams;
use std::path::{Path, PathBuf};

/// Name of the table of special points.
const POINTS: &str = "points.csv";
/// Name of the file that marks a directory of branches, and its content.
const MARK: (&str, &str) = ("branches.json", "{ \"program\": \"plica follow\" }\n");
/// Width of the diagrams in pixels.
const WIDTH: usize = 1800;

/// Follows the branches of a case and writes them to a directory.
pub fn follow(arguments: &FollowArguments) -> Result<(), Failure> {
    threads::limit(arguments.threads)?;
    let (text, plan) = case_file::open(&arguments.case)?;
    let following = Follow::new(&plan).map_err(failure)?;
    let out = match &arguments.out {
        Some(out) => out.clone(),
        None => {
            let name = format!("{}-branches", case_file::stem(&arguments.case.file));
            PathBuf::from("runs").join(name)
        }
    };
    check_memory(&plan).map_err(RunError::from)?;
    let interrupt = Interrupt::listen()?;
    let directory = Directory::create(out, arguments.overwrite)?;
    console::message(&format!(
        "{}\nwriting to {}",
        plan.title,
        directory.path.display()
    ));
    let mut ticker = Ticker::new(interrupt.clone());
    let (send, lines) = std::sync::mpsc::channel();
    let found = {
        let table = Table::new(&plan);
        let mut shown = Lines {
            ticker: &mut ticker,
            lines,
        };
        let mut sink = |progress: Progress<'_>| {
            for line in table.lines(&progress) {
                // The receiver lives as long as the sender.
                let _ = send.send(line);
            }
        };
        let found = following.run(&mut shown, &mut sink);
        shown.flush();
        found
    };
    ticker.finish();
    let found = found.map_err(failure)?;
    directory.prepare()?;
    directory.write("case.toml", text.as_bytes())?;
    let files = write(&directory, &following, &found)?;
    let pictures = draw(&directory, &following, &found)?;
    let mut page = found.summary();
    page += &format!("  written to {}: {files}\n", directory.path.display());
    if !pictures.is_empty() {
        page += &format!("  diagrams: {}\n", pictures.join(", "));
    }
    console::print(&page)?;
    if found.cancelled {
        return Err(Failure::Interrupted(
            "interrupted; the branches so far are written".into(),
        ));
    }
    Ok(())
}

fn failure(error: BranchError) -> Failure {
    match error {
        BranchError::NoBranch | BranchError::Outside { .. } => Failure::Usage(error.to_string()),
        BranchError::Cancelled => Failure::Interrupted("interrupted; nothing was written".into()),
        BranchError::Study(StudyError::Lost(lost)) => Failure::Fault(lost.to_string()),
        error => Failure::Fault(error.to_string()),
    }
}

/// A directory of branches.
struct Directory {
    path: PathBuf,
}

impl Directory {
    /// Chooses a directory. One that exists must be empty, or be one of branches that is to be replaced. Its files stay until
    /// there are others.
    fn create(path: PathBuf, overwrite: bool) -> Result<Self, Failure> {
        let place = path.display();
        let files = |error| Failure::Files(format!("{place}: {error}"));
        if path.exists() {
            let is_empty = std::fs::read_dir(&path).map_err(files)?.next().is_none();
            let is_ours =
                std::fs::read_to_string(path.join(MARK.0)).is_ok_and(|mark| mark == MARK.1);
            match (is_empty, is_ours, overwrite) {
                (true, ..) | (false, true, true) => {}
                (false, true, false) => {
                    return Err(Failure::Usage(format!(
                        "{place} has branches already; replace them with --overwrite, or choose another directory with --out"
                    )));
                }
                (false, false, _) => {
                    return Err(Failure::Usage(format!(
                        "{place} is not a directory of branches; choose another with --out"
                    )));
                }
            }
        }
        // Tells now if it cannot be written to.
        std::fs::create_dir_all(&path).map_err(files)?;
        Ok(Self { path })
    }

    /// Marks the directory, and removes the files of earlier branches.
    fn prepare(&self) -> Result<(), Failure> {
        let path = &self.path;
        let files = |error| Failure::Files(format!("{}: {error}", path.display()));
        self.write(MARK.0, MARK.1.as_bytes())?;
        clear(path).map_err(files)?;
        for folder in ["branches", "points", "modes"] {
            std::fs::create_dir_all(path.join(folder)).map_err(files)?;
        }
        Ok(())
    }

    fn write(&self, name: &str, bytes: &[u8]) -> Result<(), Failure> {
        let path = self.path.join(name);
        let written = write_file(&path, bytes);
        written.map_err(|error| Failure::Files(format!("{}: {error}", path.display())))
    }

    fn write_state(&self, name: &str, state: &SavedState) -> Result<(), Failure> {
        let bytes = state.to_bytes();
        let bytes = bytes.map_err(|error| Failure::Fault(format!("{name}: {error}")))?;
        self.write(name, &bytes)
    }
}

/// Removes the files of earlier branches.
fn clear(path: &Path) -> std::io::Result<()> {
    for folder in ["branches", "points", "modes"] {
        let Ok(files) = std::fs::read_dir(path.join(folder)) else {
            continue;
        };
        for file in files.flatten().map(|file| file.path()) {
            let is_ours = |ending: &str| file.extension().is_some_and(|own| own == ending);
            if is_ours("csv") || is_ours("safetensors") {
                std::fs::remove_file(file)?;
            }
        }
    }
    for entry in std::fs::read_dir(path)? {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        if name == POINTS || name == "case.toml" || name.starts_with("diagram-") {
            std::fs::remove_file(entry.path())?;
        }
    }
    Ok(())
}

/// Writes the tables, states and modes. Returns their names in words.
fn write(directory: &Directory, following: &Follow, found: &Branches) -> Result<String, Failure> {
    for branch in &found.branches {
        let name = format!("branches/{:02}.csv", branch.number);
        directory.write(&name, &branch.csv())?;
    }
    let mut modes = 0;
    for point in &found.points {
        let name = |folder: &str, end: &str| format!("{folder}/{}{end}.safetensors", point.label);
        directory.write_state(&name("points", ""), &point.state)?;
        if let Some((harmonic, shape)) = &point.mode {
            modes += 1;
            directory.write_state(&name("modes", ""), &mode(point, *harmonic, shape))?;
            let switch = following.switch_to(*harmonic);
            let start = switch.and_then(|switch| start_state(following, point, switch.amplitude));
            if let Some(start) = start {
                directory.write_state(&name("points", "-with-mode"), &start)?;
            }
        }
    }
    directory.write(POINTS, &found.points_csv())?;
    Ok(format!(
        "branches/ ({}), {POINTS}, points/ ({}), modes/ ({modes})",
        found.branches.len(),
        found.points.len()
    ))
}

/// Returns a mode as a saved state, which gives an imperfection its shape.
fn mode(point: &SpecialPoint, harmonic: usize, shape: &[f64]) -> SavedState {
    let mut state = point.state.clone();
    let [axial, thickness, components, _] = state.layout.shape();
    let array = |shape: Vec<usize>, values: Vec<f64>| Array { shape, values };
    state.arrays = [
        (
            "mode".to_owned(),
            array(vec![axial, thickness, components], shape.to_vec()),
        ),
        ("harmonic".to_owned(), array(vec![1], vec![harmonic as f64])),
        ("eigenvalue".to_owned(), array(vec![1], vec![0.0])),
    ]
    .into();
    state
}

fn draw(
    directory: &Directory,
    following: &Follow,
    found: &Branches,
) -> Result<Vec<String>, Failure> {
    let plan = following.plan();
    let columns = plan.following.as_ref().map_or(&[][..], |of| &of.plot);
    let mut names = vec![];
    for (column, chart) in branch_diagrams(plan, found, columns) {
        let name = format!("diagram-{column}");
        let svg = chart.svg().map_err(drawing)?;
        directory.write(&format!("{name}.svg"), svg.as_bytes())?;
        directory.write(&format!("{name}.png"), &chart.png(WIDTH).map_err(drawing)?)?;
        names.push(format!("{name}.png"));
    }
    Ok(names)
}

/// A ticker that also shows the lines that a sink has sent.
struct Lines<'a> {
    ticker: &'a mut Ticker,
    lines: std::sync::mpsc::Receiver<String>,
}

impl Lines<'_> {
    fn flush(&self) {
        for line in self.lines.try_iter() {
            self.ticker.line(&line);
        }
    }
}

impl plica::monitor::Monitor for Lines<'_> {
    fn working(&mut self, activity: &dyn std::fmt::Display, fraction: f64) {
        self.flush();
        self.ticker.working(&activity.to_string(), fraction);
    }

    fn notice(&mut self, message: &str) {
        self.flush();
        self.ticker.line(message);
    }

    fn is_cancelled(&self) -> bool {
        self.ticker.stop()
    }
}

/// Progress as lines of a table.
struct Table {
    parameter: String,
}

impl Table {
    fn new(plan: &Plan) -> Self {
        let of = plan
            .following
            .as_ref()
            .map(|following| following.of.clone());
        Self {
            parameter: of.unwrap_or_default(),
        }
    }

    fn lines(&self, progress: &Progress<'_>) -> Vec<String> {
        match progress {
            Progress::Begin(branch) => self.heading(branch),
            Progress::State(state) => vec![line(state)],
            Progress::Point(point) => {
                vec![format!(
                    "{:>6} {:>13.8}  {:>10.3}  {}",
                    point.label,
                    point.parameter,
                    point.s,
                    point.describe()
                )]
            }
            Progress::End(branch) => vec![format!("branch {} {}", branch.number, branch.end)],
        }
    }

    fn heading(&self, branch: &Branch) -> Vec<String> {
        let from = branch.from.as_ref();
        let from = from.map_or(String::new(), |label| format!(" from {label}"));
        vec![
            format!("branch {}{from}, in {}", branch.number, self.parameter),
            format!(
                "{:>6} {:>13}  {:>10}  {:>12}  {:>6}  {:>9}  unstable modes",
                "", "parameter", "arc length", "energy", "angle", "overhang"
            ),
        ]
    }
}

fn line(state: &BranchState) -> String {
    format!(
        "{:>6} {:>13.8}  {:>10.3}  {:>12.5e}  {:>6.1}  {:>9.4}  {}",
        "",
        state.parameter,
        state.s,
        state.row.energy,
        state.row.max_wall_angle_deg,
        state.row.overhang,
        state.row.stability
    )
}
