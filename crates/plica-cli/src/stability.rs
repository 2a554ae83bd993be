//! `plica stability`.

use crate::args::StabilityArguments;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::ticker::Ticker;
use crate::{case_file, console, threads};
use plica::run_directory::{RunDirectory, RunError, Verdict};
use plica::stability::{CriticalLoads, LowestModes, Spectrum, StabilityError, TestedState};
use plica::study::{Plan, check_memory};
use plica::tube::{Load, Tube};
use plica_view::draw::DrawError;
use plica_view::report::{mode_pictures, stability_pictures};
use std::mem;

/// Default width of the brackets of critical values.
const TOLERANCE: f64 = 1e-4;
/// Default number of lowest modes of a state.
const MODES: u8 = 3;

/// Tests the stability of a run's states and writes the results to its directory.
pub fn stability(arguments: &StabilityArguments) -> Result<(), Failure> {
    let mut directory = RunDirectory::open(&arguments.run)?;
    directory.lock()?;
    if directory.states()?.is_empty() {
        let none = StabilityError::NoStates {
            directory: arguments.run.clone(),
            found: 0,
        };
        return Err(Failure::Usage(none.to_string()));
    }
    // Must precede reading the case, which may compute in parallel.
    threads::limit(arguments.threads)?;
    let plan = case_file::of_run(&directory)?;
    check_memory(&plan).map_err(RunError::from)?;
    let interrupt = Interrupt::listen()?;
    console::message(&format!(
        "{}\nstates of {}",
        plan.title,
        arguments.run.display()
    ));
    if directory.verdict() == Verdict::Running {
        console::message("warning: the run is unfinished; its states so far are tested");
    }
    let ticker = Ticker::new(interrupt);
    if plan.mesh.rings(plan.symmetry) == 1 {
        axisymmetric(arguments, &plan, &directory, ticker)
    } else {
        three_dimensional(arguments, &plan, &directory, ticker)
    }
}

/// Tests the states of an axisymmetric run against circumferential modes.
fn axisymmetric(
    arguments: &StabilityArguments,
    plan: &Plan,
    directory: &RunDirectory,
    mut ticker: Ticker,
) -> Result<(), Failure> {
    if arguments.modes.is_some() || !arguments.state.is_empty() {
        return Err(Failure::Usage(StabilityError::OneRing.to_string()));
    }
    let highest = arguments
        .harmonics
        .map_or(plan.output.stability_modes, usize::from);
    let tolerance = arguments.tolerance.unwrap_or(TOLERANCE);
    let mut test = CriticalLoads::new(plan, directory, highest, tolerance).map_err(failure)?;
    let table = StateTable::new(plan);
    let mut is_first = true;
    loop {
        match test.next_state(&mut ticker) {
            Ok(Some(state)) => {
                if mem::take(&mut is_first) {
                    ticker.line(&table.modes_heading(state.modes.len()));
                }
                ticker.line(&table.modes_line(state));
            }
            Ok(None) => break,
            Err(error) => {
                ticker.finish();
                return Err(failure(error));
            }
        }
    }
    ticker.finish();
    let found = test.finish();
    let names = found.write(&plan.tube, directory)?;
    let pictures = stability_pictures(plan, &found);
    finish(
        arguments,
        directory,
        found.table(&plan.tube),
        names,
        pictures,
    )
}

/// Computes the lowest modes of the states of a three-dimensional run.
fn three_dimensional(
    arguments: &StabilityArguments,
    plan: &Plan,
    directory: &RunDirectory,
    mut ticker: Ticker,
) -> Result<(), Failure> {
    if arguments.harmonics.is_some() || arguments.tolerance.is_some() {
        return Err(Failure::Usage(
            "--harmonics and --tolerance apply to axisymmetric runs only; use --modes and --state"
                .into(),
        ));
    }
    let modes = usize::from(arguments.modes.unwrap_or(MODES));
    let mut search = LowestModes::new(plan, directory, &arguments.state, modes).map_err(failure)?;
    let table = StateTable::new(plan);
    let mut is_first = true;
    let interrupted = loop {
        match search.next_state(&mut ticker) {
            Ok(Some(spectrum)) => {
                if mem::take(&mut is_first) {
                    ticker.line(&table.spectrum_heading());
                }
                ticker.line(&table.spectrum_line(spectrum));
            }
            Ok(None) => break false,
            // The completed states are written.
            Err(StabilityError::Cancelled) if !is_first => break true,
            Err(error) => {
                ticker.finish();
                return Err(failure(error));
            }
        }
    };
    ticker.finish();
    let found = search.finish();
    let mut names = vec![found.write(&plan.tube, directory)?];
    names.extend(found.modes.iter().cloned());
    let pictures = mode_pictures(plan, &found);
    let table = found.table(&plan.tube);
    finish(arguments, directory, table, names, pictures)?;
    if interrupted {
        return Err(Failure::Interrupted(
            "interrupted; completed states were written, and earlier results of other states are kept".into(),
        ));
    }
    Ok(())
}

/// Converts an error of the stability test.
fn failure(error: StabilityError) -> Failure {
    match error {
        StabilityError::Cancelled => {
            Failure::Interrupted("interrupted; nothing was written".into())
        }
        error if error.is_misuse() => Failure::Usage(error.to_string()),
        error => Failure::Files(error.to_string()),
    }
}

/// Writes the pictures and prints the table and the names of the files.
fn finish(
    arguments: &StabilityArguments,
    directory: &RunDirectory,
    table: String,
    mut names: Vec<String>,
    pictures: Result<Vec<(String, Vec<u8>)>, DrawError>,
) -> Result<(), Failure> {
    match pictures {
        Ok(pictures) => {
            for (name, png) in pictures {
                directory.write(&name, &png)?;
                names.push(name);
            }
        }
        Err(error) => console::message(&format!("warning: no pictures: {error}")),
    }
    let gaps = directory.stability_coverage();
    let gaps = gaps.and_then(|tested| tested.gaps(&directory.state_numbers().unwrap_or_default()));
    if let Some(gaps) = gaps {
        console::message(&format!("note: {gaps}"));
    }
    let (modes, mut files): (Vec<String>, Vec<String>) = names
        .into_iter()
        .partition(|name| name.starts_with("modes/"));
    if !modes.is_empty() {
        files.push(format!("modes/ ({})", modes.len()));
    }
    let run = arguments.run.display();
    let written = format!("  {:<22} {run}: {}\n", "written to", files.join(", "));
    console::print(&(table + &written))
}

/// Progress table with a line per state.
struct StateTable<'a> {
    tube: &'a Tube,
    has_pressure: bool,
}

impl<'a> StateTable<'a> {
    fn new(plan: &'a Plan) -> Self {
        Self {
            tube: &plan.tube,
            has_pressure: plan.has_pressures(),
        }
    }

    /// Returns the heading of the load columns.
    fn load_heading(&self) -> String {
        let pressure = if self.has_pressure {
            "    pressure/E"
        } else {
            ""
        };
        format!("{:>5}  {:>7} {:>7}{pressure}", "state", "Lmax/L", "Dmin/D")
    }

    /// Returns the load columns of a state, with its first non-zero pressure.
    fn load_columns(&self, row: usize, load: &Load) -> String {
        let (length, diameter) = (self.tube.length_ratio(load), self.tube.diameter_ratio(load));
        let [inner, outer] = load.pressures;
        let pressures = [outer.follower, inner.follower, outer.dead, inner.dead];
        let pressure = pressures.into_iter().find(|p| *p != 0.0).unwrap_or(0.0);
        let pressure = match self.has_pressure {
            true => format!(" {pressure:>13.4e}"),
            false => String::new(),
        };
        format!("{row:>5}  {length:>7.4} {diameter:>7.4}{pressure}")
    }

    fn modes_heading(&self, modes: usize) -> String {
        let modes = (0..modes).map(|n| format!("{:>11}", format!("n = {n}")));
        format!(
            "{}  lowest eigenvalue, E/D²:{}",
            self.load_heading(),
            modes.collect::<String>()
        )
    }

    fn modes_line(&self, state: &TestedState) -> String {
        let lowest = state
            .modes
            .iter()
            .map(|mode| format!("{:>11.3e}", mode.lowest));
        format!(
            "{}  {:>24}{}",
            self.load_columns(state.row.unwrap_or_default(), &state.load),
            "",
            lowest.collect::<String>()
        )
    }

    fn spectrum_heading(&self) -> String {
        format!(
            "{}  {:>10}  lowest eigenvalues, E/D²",
            self.load_heading(),
            "iterations"
        )
    }

    fn spectrum_line(&self, spectrum: &Spectrum) -> String {
        let lowest = spectrum.lowest.iter().take(5);
        let lowest = lowest.map(|eigenvalue| format!("{:>11.3e}", eigenvalue.value));
        format!(
            "{}  {:>10}{}",
            self.load_columns(spectrum.row, &spectrum.load),
            spectrum.iterations,
            lowest.collect::<String>()
        )
    }
}
