//! `plica stability`.

use crate::args::StabilityArguments;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::ticker::Ticker;
use crate::{case_file, console, threads};
use plica::run_directory::{RunDirectory, RunError, Verdict};
use plica::stability::{
    ModesRequest, Observer, Request, Spectrum, StabilityError, Station, follow, lowest_modes,
};
use plica::study::{Plan, check_memory};
use plica::tube::{Load, Tube};
use plica_view::draw::DrawError;
use plica_view::report::{mode_pictures, stability_pictures};

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
    let mut monitor = Monitor {
        ticker: Ticker::new(interrupt),
        has_heading: false,
        has_pressure: plan.has_pressures(),
    };
    if plan.mesh.rings(plan.symmetry) == 1 {
        axisymmetric(arguments, &plan, &directory, &mut monitor)
    } else {
        three_dimensional(arguments, &plan, &directory, &mut monitor)
    }
}

/// Tests the states of an axisymmetric run against circumferential modes.
fn axisymmetric(
    arguments: &StabilityArguments,
    plan: &Plan,
    directory: &RunDirectory,
    monitor: &mut Monitor,
) -> Result<(), Failure> {
    if arguments.modes.is_some() || !arguments.state.is_empty() {
        return Err(Failure::Usage(StabilityError::OneRing.to_string()));
    }
    let request = Request {
        harmonics: arguments
            .harmonics
            .map_or(plan.output.stability_modes, usize::from),
        tolerance: arguments.tolerance.unwrap_or(TOLERANCE),
    };
    let found = follow(plan, directory, &request, monitor);
    monitor.ticker.finish();
    let found = found.map_err(failure)?;
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
    monitor: &mut Monitor,
) -> Result<(), Failure> {
    if arguments.harmonics.is_some() || arguments.tolerance.is_some() {
        return Err(Failure::Usage(
            "--harmonics and --tolerance apply to axisymmetric runs only; use --modes and --state"
                .into(),
        ));
    }
    let request = ModesRequest {
        states: arguments.state.clone(),
        modes: usize::from(arguments.modes.unwrap_or(MODES)),
    };
    let found = lowest_modes(plan, directory, &request, monitor);
    monitor.ticker.finish();
    let found = found.map_err(failure)?;
    if found.states.is_empty() {
        return Err(failure(StabilityError::Stopped));
    }
    let mut names = vec![found.write(&plan.tube, directory)?];
    names.extend(found.modes.iter().cloned());
    let pictures = mode_pictures(plan, &found);
    let table = found.table(&plan.tube);
    finish(arguments, directory, table, names, pictures)?;
    if found.stopped {
        return Err(Failure::Interrupted(
            "interrupted; completed states were written".into(),
        ));
    }
    Ok(())
}

/// Converts an error of the stability test.
fn failure(error: StabilityError) -> Failure {
    match error {
        StabilityError::Stopped => Failure::Interrupted("interrupted; nothing was written".into()),
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

/// Prints a line per saved state.
struct Monitor {
    ticker: Ticker,
    has_heading: bool,
    has_pressure: bool,
}

impl Monitor {
    /// Returns the heading of the load columns.
    fn heading(&self) -> String {
        let pressure = if self.has_pressure {
            "    pressure/E"
        } else {
            ""
        };
        format!("{:>5}  {:>7} {:>7}{pressure}", "state", "Lmax/L", "Dmin/D")
    }

    /// Returns the load columns of a state, with its first non-zero pressure.
    fn load_columns(&self, row: usize, tube: &Tube, load: &Load) -> String {
        let (length, diameter) = (tube.length_ratio(load), tube.diameter_ratio(load));
        let [inner, outer] = load.pressures;
        let pressures = [outer.follower, inner.follower, outer.dead, inner.dead];
        let pressure = pressures.into_iter().find(|p| *p != 0.0).unwrap_or(0.0);
        let pressure = match self.has_pressure {
            true => format!(" {pressure:>13.4e}"),
            false => String::new(),
        };
        format!("{row:>5}  {length:>7.4} {diameter:>7.4}{pressure}")
    }
}

impl Observer for Monitor {
    fn tested(&mut self, tube: &Tube, station: &Station) {
        if !self.has_heading {
            self.has_heading = true;
            let harmonics =
                (0..station.tested.len()).map(|n| format!("{:>11}", format!("n = {n}")));
            self.ticker.line(&format!(
                "{}  lowest eigenvalue, E/D²:{}",
                self.heading(),
                harmonics.collect::<String>()
            ));
        }
        let lowest = station
            .tested
            .iter()
            .map(|tested| format!("{:>11.3e}", tested.lowest));
        self.ticker.line(&format!(
            "{}  {:>24}{}",
            self.load_columns(station.row.unwrap_or_default(), tube, &station.load),
            "",
            lowest.collect::<String>()
        ));
    }

    fn found(&mut self, tube: &Tube, spectrum: &Spectrum) {
        if !self.has_heading {
            self.has_heading = true;
            self.ticker.line(&format!(
                "{}  {:>10}  lowest eigenvalues, E/D²",
                self.heading(),
                "iterations"
            ));
        }
        let lowest = spectrum.lowest.iter().take(5);
        let lowest = lowest.map(|eigenvalue| format!("{:>11.3e}", eigenvalue.value));
        self.ticker.line(&format!(
            "{}  {:>10}{}",
            self.load_columns(spectrum.row, tube, &spectrum.load),
            spectrum.iterations,
            lowest.collect::<String>()
        ));
    }

    fn working(&mut self, what: &str, fraction: f64) {
        self.ticker.working(what, fraction);
    }

    fn stop(&mut self) -> bool {
        self.ticker.stop()
    }
}
