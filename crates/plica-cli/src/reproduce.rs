//! `plica reproduce`.

use crate::args::ReproduceArguments;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::page_directory::FirstPage;
use crate::ticker::Ticker;
use crate::{console, page_directory, threads};
use plica_verify::reproduction::{
    FIGURES, Figure, Fineness, ReproductionError, SUMMARY, TITLE, reproduce as run_figures,
};
use std::path::PathBuf;

/// Directory of the runs, in that of the pages.
const RUNS: &str = "runs";

/// Runs the computations behind figures, prints the comparison with the paper and writes the pages.
pub fn reproduce(arguments: &ReproduceArguments) -> Result<(), Failure> {
    let fineness = if arguments.full {
        Fineness::Full
    } else {
        Fineness::Quick
    };
    let mut wanted: Vec<&'static Figure> = vec![];
    for name in &arguments.figures {
        let figure = Figure::find(name).ok_or_else(|| {
            let names: Vec<&str> = FIGURES.iter().map(|figure| figure.name).collect();
            Failure::Usage(format!(
                "{name:?}: no such figure; choose one of {}",
                names.join(", ")
            ))
        })?;
        wanted.push(figure);
    }
    if wanted.is_empty() {
        wanted.extend(FIGURES);
    }
    if arguments.list {
        return console::print(&list(&wanted, fineness));
    }
    threads::limit(arguments.threads)?;
    let default = fineness.choose("runs/reproduction", "runs/reproduction-full");
    let out = arguments
        .out
        .clone()
        .unwrap_or_else(|| PathBuf::from(default));
    let first = FirstPage {
        name: SUMMARY,
        title: TITLE,
        manner: fineness.sentence(),
        command: "plica reproduce",
    };
    page_directory::prepare(&out, &first)?;
    let interrupt = Interrupt::listen()?;
    let mut ticker = Ticker::new(interrupt);
    console::message(&format!("writing to {}", out.display()));
    let found = run_figures(&wanted, fineness, &out.join(RUNS), &mut ticker);
    ticker.finish();
    let found = found.map_err(|error| match error {
        ReproductionError::Cancelled => Failure::Interrupted(
            "interrupted; the same command resumes after the completed runs".into(),
        ),
        error => Failure::Files(error.to_string()),
    })?;
    // Print first: writing the files may fail.
    console::print(&found.text())?;
    let files = found.files();
    for (name, bytes) in &files {
        page_directory::write(&out, name, bytes)?;
    }
    let pictures = files.iter().filter(|(name, _)| name.ends_with(".png"));
    console::print(&format!(
        "written to {}: {SUMMARY}, pages of figures ({}), pictures ({}), {RUNS}/\n",
        out.display(),
        found.pages.len(),
        pictures.count()
    ))?;
    if found.failed() > 0 {
        Err(Failure::Unfinished)
    } else {
        Ok(())
    }
}

/// Lists figures and the runs they need.
fn list(figures: &[&Figure], fineness: Fineness) -> String {
    let mut text = String::new();
    for figure in figures {
        text += &format!("{:<12}{}\n", figure.name, figure.title);
        let mut cases: Vec<&str> = vec![];
        let jobs = figure.jobs(fineness);
        for job in &jobs {
            if !cases.contains(&job.case) {
                cases.push(job.case);
            }
        }
        let cases: Vec<String> = cases
            .iter()
            .map(|case| format!("cases/{case}.toml"))
            .collect();
        text += &format!("            {} runs of {}\n", jobs.len(), cases.join(", "));
    }
    text
}
