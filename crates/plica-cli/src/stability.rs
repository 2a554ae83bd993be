//! `plica stability`.

use crate::args::StabilityArguments;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::ticker::Ticker;
use crate::{case_file, console, threads};
use plica::report::stability_pictures;
use plica::stability::{Observer, Request, StabilityError, Station, follow};
use plica::study::{RunDirectory, SavedState};
use plica::tube::Tube;

/// Tests a run's states, and writes what it finds beside them.
pub fn stability(arguments: &StabilityArguments) -> Result<(), Failure> {
    let directory = RunDirectory::open(&arguments.run).map_err(Failure::Study)?;
    if directory.states().map_err(Failure::Study)?.is_empty() {
        let none = StabilityError::NoStates {
            directory: arguments.run.clone(),
            found: 0,
        };
        return Err(Failure::Usage(none.to_string()));
    }
    // Where a run began is its own first state.
    let begin = arguments.run.join("states/state-0000.safetensors");
    let case = arguments.run.join("case.toml");
    let (_, plan) = case_file::open_with(&case, &|_| SavedState::read(&begin))?;
    threads::limit(arguments.threads)?;
    let interrupt = Interrupt::listen()
        .map_err(|error| Failure::Files(format!("cannot listen to signals: {error}")))?;
    let request = Request {
        harmonics: arguments
            .harmonics
            .map_or(plan.output.harmonics, usize::from),
        tolerance: arguments.tolerance,
    };
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
    let mut watch = Watcher {
        ticker: Ticker::new(interrupt),
        begun: false,
    };
    let found = follow(&plan, &directory, &request, &mut watch);
    watch.ticker.finish();
    let found = found.map_err(|error| match error {
        StabilityError::Stopped => Failure::Interrupted("interrupted; nothing was written"),
        error if error.is_misuse() => Failure::Usage(error.to_string()),
        error => Failure::Files(error.to_string()),
    })?;
    let mut names = found
        .write(&plan.tube, &directory)
        .map_err(Failure::Study)?;
    match stability_pictures(&plan, &found) {
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
    console::say(&(found.table(&plan.tube) + &written))
}

/// A line per saved state.
struct Watcher {
    ticker: Ticker,
    begun: bool,
}

impl Observer for Watcher {
    fn tested(&mut self, tube: &Tube, station: &Station) {
        if !self.begun {
            self.begun = true;
            let harmonics =
                (0..station.tested.len()).map(|n| format!("{:>11}", format!("n = {n}")));
            self.ticker.line(&format!(
                "{:>5}  {:>7} {:>7}  lowest eigenvalue, E/D²:{}",
                "state",
                "Lmax/L",
                "Dmin/D",
                harmonics.collect::<String>()
            ));
        }
        let lowest = station
            .tested
            .iter()
            .map(|tested| format!("{:>11.3e}", tested.lowest));
        self.ticker.line(&format!(
            "{:>5}  {:>7.4} {:>7.4}  {:>24}{}",
            station.row.unwrap_or_default(),
            tube.length_ratio(&station.load),
            tube.diameter_ratio(&station.load),
            "",
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
