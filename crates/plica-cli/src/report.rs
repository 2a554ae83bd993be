//! `plica report`.

use crate::args::ReportArguments;
use crate::failure::Failure;
use crate::finished::{Finished, endings};
use crate::{console, threads};
use plica::page::{PageError, Run, page};
use plica::study::SavedState;
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
    let open = |path: &PathBuf| {
        let run = Finished::open(path)?;
        let state = |&number: &usize| Ok(run.state(number)?.0);
        let states: Result<Vec<SavedState>, Failure> = run.saved.keys().map(state).collect();
        Ok((run, states?))
    };
    let runs: Result<Vec<(Finished, Vec<SavedState>)>, Failure> =
        arguments.runs.iter().map(open).collect();
    let runs = runs?;
    let names = names(&arguments.runs);
    let told: Vec<Run<'_>> = (runs.iter().zip(names))
        .map(|((run, states), name)| Run {
            name,
            plan: &run.plan,
            rows: &run.rows,
            states,
            directory: &run.directory,
        })
        .collect();
    let html = page(&told).map_err(|error| match error {
        PageError::Units(_) => Failure::Usage(error.to_string()),
        PageError::Template(_) => Failure::Fault(error.to_string()),
    })?;
    let path = match (&arguments.out, runs.as_slice()) {
        (None, [(run, _)]) => {
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
