//! `plica report`.

use crate::args::ReportArguments;
use crate::existing_run::{ExistingRun, check_out, size, write_out};
use crate::failure::Failure;
use crate::{console, threads};
use plica::saved_state::SavedState;
use plica_view::page::{PageError, Run, drawn, page};
use plica_view::report::FieldScales;
use rayon::prelude::*;
use std::path::{Path, PathBuf};

/// Largest number of runs on one page.
const MOST: usize = 4;

/// Writes the HTML report of one run or a comparison of several.
pub fn report(arguments: &ReportArguments) -> Result<(), Failure> {
    if arguments.runs.len() > MOST {
        return Err(Failure::Usage(format!(
            "{} runs are too many for one page; name {MOST} at most",
            arguments.runs.len()
        )));
    }
    threads::limit(arguments.threads)?;
    if let Some(path) = &arguments.out {
        check_out(path, &["html", "htm"])?;
    }
    for (i, path) in arguments.runs.iter().enumerate() {
        let same = |other: &PathBuf| path.canonicalize().ok() == other.canonicalize().ok();
        if path.exists() && arguments.runs[..i].iter().any(same) {
            return Err(Failure::Usage(format!(
                "{}: given twice; name different runs",
                path.display()
            )));
        }
    }
    let open = |path: &PathBuf| ReportedRun::open(path, arguments.runs.len());
    let runs: Result<Vec<ReportedRun>, Failure> = arguments.runs.iter().map(open).collect();
    let runs = runs?;
    let names = names(&arguments.runs);
    let pages: Vec<Run<'_>> = runs.iter().zip(names).map(ReportedRun::named).collect();
    let html = page(&pages).map_err(|error| match error {
        PageError::Units(_) => Failure::Usage(error.to_string()),
        PageError::Template(_) => Failure::Fault(error.to_string()),
    })?;
    let path = match (&arguments.out, runs.as_slice()) {
        (None, [ReportedRun { run, .. }]) => {
            let name = "report.html";
            run.directory.write(name, html.as_bytes())?;
            run.directory.path().join(name)
        }
        (out, _) => {
            let path = out.clone().unwrap_or("comparison.html".into());
            write_out(&path, html.as_bytes())?;
            path
        }
    };
    console::print(&format!(
        "written to {} ({}); open it in a browser\n",
        path.display(),
        size(html.len())
    ))
}

/// A run and its readable states.
struct ReportedRun {
    run: ExistingRun,
    states: Vec<SavedState>,
    scales: FieldScales,
    left_out: usize,
    unread: Vec<String>,
}

impl ReportedRun {
    /// Opens one of `runs` runs. An unreadable state is reported and skipped.
    fn open(path: &Path, runs: usize) -> Result<Self, Failure> {
        let run = ExistingRun::open(path)?;
        let saved: Vec<usize> = run.saved.keys().copied().collect();
        let chosen = drawn(&run.plan, &saved, runs);
        let mut unread: Vec<String> = run.unreadable.iter().cloned().collect();
        let mut states = vec![];
        for &number in &chosen {
            match run.try_state(number) {
                Ok((state, _)) => states.push(state),
                Err(why) => {
                    console::message(&format!("warning: not read: {why}"));
                    unread.push(why);
                }
            }
        }
        let scales = if chosen.len() == saved.len() {
            FieldScales::of_states(&run.plan, states.par_iter())
        } else {
            run.field_scales()
        };
        Ok(Self {
            scales,
            left_out: saved.len() - chosen.len(),
            run,
            states,
            unread,
        })
    }

    /// Returns the run as the page takes it.
    fn named((reported, name): (&Self, String)) -> Run<'_> {
        Run {
            name,
            plan: &reported.run.plan,
            rows: &reported.run.rows,
            states: &reported.states,
            scales: &reported.scales,
            saved: reported.run.saved.len(),
            left_out: reported.left_out,
            unread: &reported.unread,
            directory: &reported.run.directory,
        }
    }
}

/// Returns the names of runs: their directories, or their paths where two directories have the same name.
fn names(paths: &[PathBuf]) -> Vec<String> {
    let folder = |path: &PathBuf| {
        let whole = path.canonicalize().unwrap_or_else(|_| path.clone());
        let name = whole.file_name().unwrap_or(whole.as_os_str());
        Path::new(name).display().to_string()
    };
    let short: Vec<String> = paths.iter().map(folder).collect();
    let repeated = (1..short.len()).any(|i| short[..i].contains(&short[i]));
    if repeated {
        paths
            .iter()
            .map(|path| path.display().to_string())
            .collect()
    } else {
        short
    }
}
