//! `plica export`.

use crate::args::ExportArguments;
use crate::existing_run::{ExistingRun, size};
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::ticker::Ticker;
use crate::{console, threads};
use plica::run_directory::RunDirectory;
use plica::tube::Symmetry;
use plica_view::export::{Exporter, Geometry};
use plica_view::vtk::collection;
use std::collections::BTreeMap;
use std::path::Path;

/// Content of a kind of files.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Content {
    /// A geometry of the wall with its fields.
    Wall(Geometry),
    /// The surfaces of the obstacles.
    Obstacles,
}

impl Content {
    /// Returns the name of its folder and its collection.
    fn name(self) -> &'static str {
        match self {
            Self::Wall(geometry) => geometry.name(),
            Self::Obstacles => "obstacles",
        }
    }

    fn extension(self) -> &'static str {
        match self {
            Self::Wall(geometry) => geometry.extension(),
            Self::Obstacles => "vtp",
        }
    }
}

/// Exports states of a run to VTK files.
pub fn export(arguments: &ExportArguments) -> Result<(), Failure> {
    let run = ExistingRun::open(&arguments.run)?;
    run.check_saved(&arguments.state)?;
    threads::limit(arguments.threads)?;
    let last = run.last()?;
    let selected = |state: usize| match (arguments.all, arguments.state.as_slice()) {
        (true, _) => true,
        (_, []) => state == last,
        (_, states) => states.contains(&state),
    };
    let all = |what: Content| run.saved.keys().map(move |&state| (what, state));
    let mut files: Vec<(Content, usize)> = all(Content::Wall(Geometry::Walls)).collect();
    if run.plan.symmetry == Symmetry::Axisymmetric {
        files.extend(all(Content::Wall(Geometry::Meridian)));
    }
    if !run.plan.tube.obstacles.is_empty() {
        files.extend(all(Content::Obstacles));
    }
    for state in run.saved.keys().copied().filter(|&state| selected(state)) {
        files.push((Content::Wall(Geometry::Volume), state));
        if arguments.linear {
            files.push((Content::Wall(Geometry::Linear), state));
        }
    }
    let interrupt = Interrupt::listen()?;
    let mut ticker = Ticker::new(interrupt);
    console::message(&format!(
        "{}\nstates of {}",
        run.plan.title,
        arguments.run.display()
    ));
    let mut work = Work {
        exporter: Exporter::new(&run.plan),
        run: &run,
        written: BTreeMap::new(),
    };
    let mut failures = vec![];
    for (done, &(what, state)) in files.iter().enumerate() {
        if ticker.stop() {
            break;
        }
        let name = format!("state {state}, {}", what.name());
        ticker.working(&name, done as f64 / files.len() as f64);
        // An unreadable state does not prevent the export of the others.
        if let Err(failure) = work.write(what, state) {
            failures.push(failure);
        }
    }
    let series = match arguments.hdf && !ticker.stop() {
        true => write_series(&run, &work.exporter, &mut ticker),
        false => Ok(None),
    };
    let series = series.unwrap_or_else(|failure| {
        failures.push(failure);
        None
    });
    let stopped = ticker.stop();
    ticker.finish();
    for what in work.written.keys() {
        collect(&run.directory, *what)?;
    }
    let mut text = String::new();
    for (what, (files, bytes)) in &work.written {
        text += &format!(
            "{}: {files} files, {}; open {}\n",
            what.name(),
            size(*bytes),
            arguments.run.join(collection_of(*what)).display()
        );
    }
    if let Some((states, bytes)) = series {
        let path = arguments.run.join(SERIES);
        text += &format!(
            "{states} states in one file: {}; open {}\n",
            size(bytes),
            path.display()
        );
    }
    console::print(&text)?;
    let others = failures.len().saturating_sub(1);
    if let Some(first) = failures.into_iter().next() {
        if others > 0 {
            console::message(&format!(
                "{others} more file(s) could not be written; the first error:"
            ));
        }
        return Err(first);
    }
    if stopped {
        return Err(Failure::Interrupted(
            "interrupted; the files written so far are complete and listed in the collections"
                .into(),
        ));
    }
    Ok(())
}

/// File with the walls of all states.
const SERIES: &str = "vtk/walls.vtkhdf";

/// Writes the walls of all states to one file. Returns the numbers of states and bytes, or `None` if it was interrupted or no
/// state can be read.
fn write_series(
    run: &ExistingRun,
    exporter: &Exporter,
    ticker: &mut Ticker,
) -> Result<Option<(usize, usize)>, Failure> {
    let mut movie = exporter.series();
    let mut states = 0;
    for (done, &state) in run.saved.keys().enumerate() {
        if ticker.stop() {
            return Ok(None);
        }
        let part = done as f64 / run.saved.len() as f64;
        ticker.working(&format!("state {state}, in one file"), part);
        // The export of its own file reports an unreadable state.
        if let Ok((state, row)) = run.state(state) {
            exporter.append(&mut movie, &state, &row);
            states += 1;
        }
    }
    if states == 0 {
        return Ok(None);
    }
    let failure = |what: String| Failure::Files(format!("{SERIES}: {what}"));
    let bytes = movie.bytes().map_err(failure)?;
    run.directory.write(SERIES, &bytes)?;
    Ok(Some((states, bytes.len())))
}

/// An export in progress.
struct Work<'a> {
    exporter: Exporter,
    run: &'a ExistingRun,
    /// Numbers of files and bytes of each kind.
    written: BTreeMap<Content, (usize, usize)>,
}

impl Work<'_> {
    /// Writes one file.
    fn write(&mut self, what: Content, number: usize) -> Result<(), Failure> {
        let (state, row) = self.run.state(number)?;
        let bytes = match what {
            Content::Wall(geometry) => self.exporter.file(geometry, &state, &row),
            Content::Obstacles => self.exporter.obstacles_file(&state, &row),
        };
        let name = format!("{}/state-{number:04}.{}", folder(what), what.extension());
        let written = self.run.directory.write(&name, &bytes);
        written?;
        let (files, size) = self.written.entry(what).or_default();
        (*files, *size) = (*files + 1, *size + bytes.len());
        Ok(())
    }
}

/// Returns the directory of the files of a kind, relative to the run.
fn folder(what: Content) -> String {
    format!("vtk/{}", what.name())
}

/// Returns the collection of the files of a kind, relative to the run.
fn collection_of(what: Content) -> String {
    format!("vtk/{}.pvd", what.name())
}

/// Writes the collection of all existing files of a kind.
fn collect(directory: &RunDirectory, what: Content) -> Result<(), Failure> {
    let list = || directory.numbered(&folder(what), what.extension());
    let mut files = list()?;
    loop {
        let name = |path: &Path| {
            let file = path.file_name().unwrap_or_default().to_string_lossy();
            format!("{}/{file}", what.name())
        };
        let names: Vec<(usize, String)> = files.iter().map(|(&n, path)| (n, name(path))).collect();
        let text = collection(names.iter().map(|(n, name)| (*n, name.as_str())));
        directory.write(&collection_of(what), text.as_bytes())?;
        // Another export may have added files in the meantime.
        let now = list()?;
        if now == files {
            return Ok(());
        }
        files = now;
    }
}
