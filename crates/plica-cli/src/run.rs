//! `plica run`.

use crate::args::RunArguments;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::progress::Progress;
use crate::{case_file, console, threads};
use plica::case::advice;
use plica::report::pictures;
use plica::study::{self, Plan, RunDirectory, Summary};
use std::path::PathBuf;

/// Draws the pictures of a run; says which. A picture that cannot be drawn does not undo a run.
fn draw(plan: &Plan, summary: &Summary, directory: &RunDirectory) -> Result<String, Failure> {
    if !plan.output.pictures {
        return Ok(String::new());
    }
    let pictures = match pictures(plan, summary) {
        Ok(pictures) => pictures,
        Err(error) => {
            console::tell(&format!("warning: no pictures: {error}"));
            return Ok(String::new());
        }
    };
    for (name, png) in &pictures {
        directory.write(name, png).map_err(Failure::Study)?;
    }
    let names: Vec<&str> = pictures.iter().map(|(name, _)| name.as_str()).collect();
    Ok(format!("  {:<22} {}\n", "pictures", names.join(", ")))
}

/// Runs a case.
pub fn run(arguments: &RunArguments) -> Result<(), Failure> {
    // Before anything computes, which checking a case may do already.
    threads::limit(arguments.threads)?;
    let (text, plan) = case_file::open(&arguments.case)?;
    let out = match &arguments.out {
        Some(out) => out.clone(),
        None => PathBuf::from("runs").join(case_file::stem(&arguments.case)),
    };
    let interrupt = Interrupt::listen()
        .map_err(|error| Failure::Files(format!("cannot listen to signals: {error}")))?;
    study::fits(&plan).map_err(Failure::Study)?;
    let mut directory =
        RunDirectory::create(&out, &text, arguments.overwrite).map_err(Failure::Study)?;
    console::tell(&format!("{}\nwriting to {}", plan.title, out.display()));
    for warning in advice(&plan) {
        console::tell(&format!("warning: {warning}"));
    }

    let mut progress = Progress::new(&plan, interrupt.clone());
    let summary = study::run(&plan, &mut directory, &mut progress);
    progress.finish();
    let summary = summary.map_err(Failure::Study)?;
    let drawn = draw(&plan, &summary, &directory)?;
    console::say(&format!("{summary}{drawn}"))?;
    if !summary.finished() {
        console::tell(&summary.ending().to_string());
    }
    if summary.finished() {
        Ok(())
    } else if interrupt.asked() {
        Err(Failure::Interrupted(
            "interrupted; everything up to the last accepted state is written",
        ))
    } else {
        Err(Failure::Unfinished)
    }
}
