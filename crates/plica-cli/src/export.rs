//! `plica export`.

use crate::args::ExportArguments;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::ticker::Ticker;
use crate::{case_file, console, threads};
use plica::export::{Exporter, What};
use plica::study::{Plan, Row, RunDirectory, SavedState};
use plica::vtk::collection;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Writes states of a run as files of VTK.
pub fn export(arguments: &ExportArguments) -> Result<(), Failure> {
    let directory = RunDirectory::open(&arguments.run).map_err(Failure::Study)?;
    let saved = directory
        .numbered("states", "safetensors")
        .map_err(Failure::Study)?;
    let Some((&last, _)) = saved.last_key_value() else {
        return Err(Failure::Usage(format!(
            "{}: the run has saved no states; set output.states_every in its case and run it again",
            arguments.run.display()
        )));
    };
    for state in &arguments.state {
        if !saved.contains_key(state) {
            return Err(Failure::Usage(format!(
                "state {state} is not saved in {}; these are: {}",
                arguments.run.display(),
                listed(&saved)
            )));
        }
    }
    threads::limit(arguments.threads)?;
    let plan = case_file::of_run(&directory)?;
    let rows = directory.history().map_err(Failure::Study)?;
    let chosen = |state: usize| match (arguments.all, arguments.state.as_slice()) {
        (true, _) => true,
        (_, []) => state == last,
        (_, states) => states.contains(&state),
    };
    let mut files: Vec<(What, usize)> = saved.keys().map(|&state| (What::Walls, state)).collect();
    for state in saved.keys().copied().filter(|&state| chosen(state)) {
        files.push((What::Volume, state));
        if arguments.linear {
            files.push((What::Linear, state));
        }
    }
    let interrupt = Interrupt::listen()
        .map_err(|error| Failure::Files(format!("cannot listen to signals: {error}")))?;
    let mut ticker = Ticker::new(interrupt);
    console::tell(&format!(
        "{}\nstates of {}",
        plan.title,
        arguments.run.display()
    ));
    let mut work = Work {
        exporter: Exporter::new(&plan),
        plan: &plan,
        directory: &directory,
        saved: &saved,
        rows: &rows,
        written: BTreeMap::new(),
    };
    for (done, &(what, state)) in files.iter().enumerate() {
        if ticker.stop() {
            break;
        }
        let name = format!("state {state}, {}", what.name());
        ticker.working(&name, done as f64 / files.len() as f64);
        work.write(what, state)?;
    }
    let stopped = ticker.stop();
    ticker.finish();
    for what in work.written.keys() {
        collect(&directory, *what)?;
    }
    let mut text = String::new();
    for (what, (files, bytes)) in &work.written {
        text += &format!(
            "{}: {files} files, {:.1} MB; open {}\n",
            what.name(),
            *bytes as f64 * 1e-6,
            arguments.run.join(collection_of(*what)).display()
        );
    }
    console::say(&text)?;
    if stopped {
        return Err(Failure::Interrupted(
            "interrupted; what is written is whole, and the collections name it",
        ));
    }
    Ok(())
}

/// What it takes to write a file, and what is written.
struct Work<'a> {
    exporter: Exporter,
    plan: &'a Plan,
    directory: &'a RunDirectory,
    saved: &'a BTreeMap<usize, PathBuf>,
    rows: &'a [Row],
    /// Files and bytes of each kind.
    written: BTreeMap<What, (usize, usize)>,
}

impl Work<'_> {
    fn write(&mut self, what: What, number: usize) -> Result<(), Failure> {
        let path = &self.saved[&number];
        let trouble =
            |why: &dyn std::fmt::Display| Failure::Files(format!("{}: {why}", path.display()));
        let state = SavedState::read(path).map_err(|error| trouble(&error))?;
        state
            .belongs_to(self.plan)
            .map_err(|error| trouble(&error))?;
        let row = self.rows.iter().find(|row| row.step == number);
        let row = row.ok_or_else(|| trouble(&"history.csv has no such state"))?;
        let bytes = self.exporter.bytes(what, &state, row);
        let name = format!("{}/state-{number:04}.{}", folder(what), what.ending());
        self.directory
            .write(&name, &bytes)
            .map_err(Failure::Study)?;
        let (files, size) = self.written.entry(what).or_default();
        (*files, *size) = (*files + 1, *size + bytes.len());
        Ok(())
    }
}

/// The folder of the files of a kind, in that of the run.
fn folder(what: What) -> String {
    format!("vtk/{}", what.name())
}

/// The collection of the files of a kind.
fn collection_of(what: What) -> String {
    format!("vtk/{}.pvd", what.name())
}

/// Names all files of a kind that are there.
fn collect(directory: &RunDirectory, what: What) -> Result<(), Failure> {
    let files = directory
        .numbered(&folder(what), what.ending())
        .map_err(Failure::Study)?;
    let name = |path: &Path| {
        let file = path.file_name().unwrap_or_default().to_string_lossy();
        format!("{}/{file}", what.name())
    };
    let names: Vec<(usize, String)> = files.iter().map(|(&n, path)| (n, name(path))).collect();
    let text = collection(names.iter().map(|(n, name)| (*n, name.as_str())));
    directory
        .write(&collection_of(what), text.as_bytes())
        .map_err(Failure::Study)
}

/// The numbers of saved states, in few words.
fn listed(saved: &BTreeMap<usize, PathBuf>) -> String {
    let numbers: Vec<String> = saved.keys().map(ToString::to_string).collect();
    match numbers.as_slice() {
        [first, .., last] if numbers.len() > 12 => {
            format!("{} of them from {first} to {last}", numbers.len())
        }
        _ => numbers.join(", "),
    }
}
