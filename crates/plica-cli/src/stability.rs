//! `plica stability`.

use crate::args::StabilityArguments;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::ticker::Ticker;
use crate::{case_file, console, threads};
use plica::stability::{
    ModesRequest, Observer, Request, Spectrum, StabilityError, Station, follow, lowest_modes,
};
use plica::study::{Plan, RunDirectory, fits};
use plica::tube::{Load, Tube};
use plica_view::draw::DrawError;
use plica_view::report::{mode_pictures, stability_pictures};

/// How close critical values are bracketed, unless told otherwise.
const TOLERANCE: f64 = 1e-4;
/// Lowest modes of a state, unless told otherwise.
const MODES: u8 = 3;

/// Tests a run's states, and writes what it finds beside them.
pub fn stability(arguments: &StabilityArguments) -> Result<(), Failure> {
    let mut directory = RunDirectory::open(&arguments.run).map_err(Failure::Study)?;
    directory.own().map_err(Failure::Study)?;
    if directory.states().map_err(Failure::Study)?.is_empty() {
        let none = StabilityError::NoStates {
            directory: arguments.run.clone(),
            found: 0,
        };
        return Err(Failure::Usage(none.to_string()));
    }
    // Before anything computes, which checking a case may do already.
    threads::limit(arguments.threads)?;
    let plan = case_file::of_run(&directory)?;
    fits(&plan).map_err(Failure::Study)?;
    let interrupt = Interrupt::listen()
        .map_err(|error| Failure::Files(format!("cannot listen to signals: {error}")))?;
    console::tell(&format!(
        "{}\nstates of {}",
        plan.title,
        arguments.run.display()
    ));
    if directory.verdict() == "running" {
        console::tell(
            "warning: the run has not ended, or was killed; its states so far are tested",
        );
    }
    let mut monitor = Watcher {
        ticker: Ticker::new(interrupt),
        begun: false,
        pressed: plan.is_pressed(),
    };
    if plan.mesh.rings(plan.symmetry) == 1 {
        by_harmonics(arguments, &plan, &directory, &mut monitor)
    } else {
        by_modes(arguments, &plan, &directory, &mut monitor)
    }
}

/// A run of one ring, harmonic by harmonic.
fn by_harmonics(
    arguments: &StabilityArguments,
    plan: &Plan,
    directory: &RunDirectory,
    monitor: &mut Watcher,
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
    let names = found.write(&plan.tube, directory).map_err(Failure::Study)?;
    let pictures = stability_pictures(plan, &found);
    finish(
        arguments,
        directory,
        found.table(&plan.tube),
        names,
        pictures,
    )
}

/// A run of many rings: the lowest modes of its states.
fn by_modes(
    arguments: &StabilityArguments,
    plan: &Plan,
    directory: &RunDirectory,
    monitor: &mut Watcher,
) -> Result<(), Failure> {
    if arguments.harmonics.is_some() || arguments.tolerance.is_some() {
        return Err(Failure::Usage(
            "the run is not axisymmetric: --harmonics and --tolerance do not apply to it; \
             --modes and --state do"
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
    let mut names = vec![found.write(&plan.tube, directory).map_err(Failure::Study)?];
    names.extend(found.modes.iter().cloned());
    let pictures = mode_pictures(plan, &found);
    let table = found.table(&plan.tube);
    finish(arguments, directory, table, names, pictures)?;
    if found.stopped {
        return Err(Failure::Interrupted(
            "interrupted; the states before were written".into(),
        ));
    }
    Ok(())
}

fn failure(error: StabilityError) -> Failure {
    match error {
        StabilityError::Stopped => Failure::Interrupted("interrupted; nothing was written".into()),
        error if error.is_misuse() => Failure::Usage(error.to_string()),
        error => Failure::Files(error.to_string()),
    }
}

/// Pictures, the table, and where everything is.
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
                directory.write(&name, &png).map_err(Failure::Study)?;
                names.push(name);
            }
        }
        Err(error) => console::tell(&format!("warning: no pictures: {error}")),
    }
    let (modes, mut files): (Vec<String>, Vec<String>) = names
        .into_iter()
        .partition(|name| name.starts_with("modes/"));
    if !modes.is_empty() {
        files.push(format!("modes/ ({})", modes.len()));
    }
    let run = arguments.run.display();
    let written = format!("  {:<22} {run}: {}\n", "written to", files.join(", "));
    console::say(&(table + &written))
}

/// A line per saved state.
struct Watcher {
    ticker: Ticker,
    begun: bool,
    pressed: bool,
}

impl Watcher {
    /// The heading of what a state is under.
    fn heading(&self) -> String {
        let pressure = if self.pressed { "    pressure/E" } else { "" };
        format!("{:>5}  {:>7} {:>7}{pressure}", "state", "Lmax/L", "Dmin/D")
    }

    /// What a state is under; the first of its pressures, if there is any.
    fn under(&self, row: usize, tube: &Tube, load: &Load) -> String {
        let (length, diameter) = (tube.length_ratio(load), tube.diameter_ratio(load));
        let [inner, outer] = load.pressures;
        let pressures = [outer.follower, inner.follower, outer.dead, inner.dead];
        let pressure = pressures.into_iter().find(|p| *p != 0.0).unwrap_or(0.0);
        let pressure = match self.pressed {
            true => format!(" {pressure:>13.4e}"),
            false => String::new(),
        };
        format!("{row:>5}  {length:>7.4} {diameter:>7.4}{pressure}")
    }
}

impl Observer for Watcher {
    fn tested(&mut self, tube: &Tube, station: &Station) {
        if !self.begun {
            self.begun = true;
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
            self.under(station.row.unwrap_or_default(), tube, &station.load),
            "",
            lowest.collect::<String>()
        ));
    }

    fn found(&mut self, tube: &Tube, spectrum: &Spectrum) {
        if !self.begun {
            self.begun = true;
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
            self.under(spectrum.row, tube, &spectrum.load),
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
