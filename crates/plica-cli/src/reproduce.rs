//! `plica reproduce`.

use crate::args::ReproduceArguments;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::page_directory::FirstPage;
use crate::ticker::Ticker;
use crate::{console, page_directory, threads};
use plica::run_directory::Verdict;
use plica_verify::reproduction::{
    FIGURES, Figure, Fineness, Observer, Ran, SUMMARY, TITLE, Trouble, reproduce as run_figures,
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
        let figure = Figure::meant(name).ok_or_else(|| {
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
    let mut monitor = Monitor(Ticker::new(interrupt));
    console::message(&format!("writing to {}", out.display()));
    let found = run_figures(&wanted, fineness, &out.join(RUNS), &mut monitor);
    monitor.0.finish();
    let found = found.map_err(|trouble| match trouble {
        Trouble::Stopped => Failure::Interrupted(
            "interrupted; the same command resumes after the completed runs".into(),
        ),
        trouble => Failure::Files(trouble.to_string()),
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

/// Prints a line per run.
struct Monitor(Ticker);

impl Observer for Monitor {
    fn ran(&mut self, ran: &Ran, done: usize, of: usize) {
        let lost = if ran.verdict == Verdict::Complete {
            ""
        } else {
            ", lost"
        };
        self.0.line(&format!(
            "{done:>4} of {of}  {}: {} states, {} solves, {:.1} s{lost}",
            ran.job.name,
            ran.rows.len(),
            ran.solves(),
            ran.seconds()
        ));
    }

    fn failed(&mut self, run: &str, why: &str) {
        self.0.line(&format!("            {run} FAILED: {why}"));
    }

    fn working(&mut self, what: &str, fraction: f64) {
        self.0.working(what, fraction);
    }

    fn stop(&mut self) -> bool {
        self.0.stop()
    }
}
