//! `plica reproduce`.

use crate::args::ReproduceArguments;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::pages::First;
use crate::ticker::Ticker;
use crate::{console, pages, threads};
use plica_verify::reproduction::{
    FIGURES, Figure, Fineness, Observer, Ran, SUMMARY, TITLE, Trouble, reproduce as tell,
};
use std::path::PathBuf;

/// The folder of the runs, in that of the pages.
const RUNS: &str = "runs";

/// Runs what figures are told from, prints what became of the paper's statements, and writes the pages.
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
                "{name:?}: there is no such figure; these are: {}",
                names.join(", ")
            ))
        })?;
        wanted.push(figure);
    }
    if wanted.is_empty() {
        wanted.extend(FIGURES);
    }
    if arguments.list {
        return console::say(&list(&wanted, fineness));
    }
    threads::limit(arguments.threads)?;
    let usual = fineness.choose("runs/reproduction", "runs/reproduction-full");
    let out = arguments
        .out
        .clone()
        .unwrap_or_else(|| PathBuf::from(usual));
    let first = First {
        name: SUMMARY,
        title: TITLE,
        manner: fineness.sentence(),
        command: "plica reproduce",
    };
    pages::prepare(&out, &first)?;
    let interrupt = Interrupt::listen()
        .map_err(|error| Failure::Files(format!("cannot listen to signals: {error}")))?;
    let mut watcher = Watcher(Ticker::new(interrupt));
    console::tell(&format!("writing to {}", out.display()));
    let told = tell(&wanted, fineness, &out.join(RUNS), &mut watcher);
    watcher.0.finish();
    let told = told.map_err(|trouble| match trouble {
        Trouble::Stopped => Failure::Interrupted(
            "interrupted; the same command goes on after the runs that are done".into(),
        ),
        trouble => Failure::Files(trouble.to_string()),
    })?;
    // First of all, whatever becomes of the files.
    console::say(&told.text())?;
    let files = told.files();
    for (name, bytes) in &files {
        pages::write(&out, name, bytes)?;
    }
    let pictures = files.iter().filter(|(name, _)| name.ends_with(".png"));
    console::say(&format!(
        "written to {}: {SUMMARY}, pages of figures ({}), pictures ({}), {RUNS}/\n",
        out.display(),
        told.pages.len(),
        pictures.count()
    ))?;
    if told.failed() > 0 {
        Err(Failure::Unfinished)
    } else {
        Ok(())
    }
}

/// The figures and the runs that they are told from.
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

/// A line per run.
struct Watcher(Ticker);

impl Observer for Watcher {
    fn ran(&mut self, ran: &Ran, done: usize, of: usize) {
        let lost = if ran.verdict == "complete" {
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
