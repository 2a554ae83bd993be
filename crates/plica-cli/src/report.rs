//! `plica report`.

use crate::args::ReportArguments;
use crate::failure::Failure;
use crate::finished::{Finished, endings};
use crate::{console, threads};
use plica::study::SavedState;
use plica_view::page::{PageError, Run, drawn, page};
use std::path::{Path, PathBuf};

/// Writes runs as a page.
pub fn report(arguments: &ReportArguments) -> Result<(), Failure> {
    threads::limit(arguments.threads)?;
    if let Some(path) = &arguments.out {
        endings(path, &["html", "htm"])?;
    }
    for (i, path) in arguments.runs.iter().enumerate() {
        let same = |other: &PathBuf| path.canonicalize().ok() == other.canonicalize().ok();
        if path.exists() && arguments.runs[..i].iter().any(same) {
            return Err(Failure::Usage(format!(
                "{}: named twice; compare it with another run",
                path.display()
            )));
        }
    }
    let open = |path: &PathBuf| Told::open(path, arguments.runs.len());
    let runs: Result<Vec<Told>, Failure> = arguments.runs.iter().map(open).collect();
    let runs = runs?;
    let names = names(&arguments.runs);
    let told: Vec<Run<'_>> = runs.iter().zip(names).map(Told::under).collect();
    let html = page(&told).map_err(|error| match error {
        PageError::Units(_) => Failure::Usage(error.to_string()),
        PageError::Template(_) => Failure::Fault(error.to_string()),
    })?;
    let path = match (&arguments.out, runs.as_slice()) {
        (None, [Told { run, .. }]) => {
            let name = "report.html";
            run.directory
                .write(name, html.as_bytes())
                .map_err(Failure::Study)?;
            run.directory.path().join(name)
        }
        (out, _) => {
            let path = out.clone().unwrap_or("comparison.html".into());
            std::fs::write(&path, &html)
                .map_err(|error| Failure::Files(format!("{}: {error}", path.display())))?;
            path
        }
    };
    console::say(&format!(
        "written to {} ({:.1} MB): open it in a browser\n",
        path.display(),
        html.len() as f64 * 1e-6
    ))
}

/// A run, and what of it could be read.
struct Told {
    run: Finished,
    states: Vec<SavedState>,
    left_out: usize,
    unread: Vec<String>,
}

impl Told {
    /// Opens one of so many. A state that cannot be read is no reason to keep back the others.
    fn open(path: &Path, runs: usize) -> Result<Self, Failure> {
        let run = Finished::open(path)?;
        let saved: Vec<usize> = run.saved.keys().copied().collect();
        let chosen = drawn(&run.plan, &saved, runs);
        let mut unread: Vec<String> = run.broken.iter().cloned().collect();
        let mut states = vec![];
        for &number in &chosen {
            match run.try_state(number) {
                Ok((state, _)) => states.push(state),
                Err(why) => {
                    console::tell(&format!("warning: not read: {why}"));
                    unread.push(why);
                }
            }
        }
        Ok(Self {
            left_out: saved.len() - chosen.len(),
            run,
            states,
            unread,
        })
    }

    /// As the page knows it, under a name.
    fn under((told, name): (&Self, String)) -> Run<'_> {
        Run {
            name,
            plan: &told.run.plan,
            rows: &told.run.rows,
            states: &told.states,
            saved: told.run.saved.len(),
            left_out: told.left_out,
            unread: &told.unread,
            directory: &told.run.directory,
        }
    }
}

/// What runs are called: by their folders, or by the whole way there where those are alike.
fn names(paths: &[PathBuf]) -> Vec<String> {
    let folder = |path: &PathBuf| {
        let whole = path.canonicalize().unwrap_or_else(|_| path.clone());
        let name = whole.file_name().unwrap_or(whole.as_os_str());
        Path::new(name).display().to_string()
    };
    let short: Vec<String> = paths.iter().map(folder).collect();
    let alike = (1..short.len()).any(|i| short[..i].contains(&short[i]));
    if alike {
        paths
            .iter()
            .map(|path| path.display().to_string())
            .collect()
    } else {
        short
    }
}
