//! `plica run` and `plica resume`.

use crate::args::{ResumeArguments, RunArguments};
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::progress::Progress;
use crate::{case_file, console, threads};
use plica::case::differences;
use plica::study::{self, Observer, Plan, RunDirectory, StudyError, Summary};
use plica_view::report::pictures;
use std::path::{Path, PathBuf};

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
    if pictures.is_empty() {
        return Ok(String::new());
    }
    let names: Vec<&str> = pictures.iter().map(|(name, _)| name.as_str()).collect();
    Ok(format!("  {:<22} {}\n", "pictures", names.join(", ")))
}

/// Runs a case, from the beginning or where it was left.
pub fn run(arguments: &RunArguments) -> Result<(), Failure> {
    // Before anything computes, which checking a case may do already.
    threads::limit(arguments.threads)?;
    let out = match &arguments.out {
        Some(out) => out.clone(),
        None => PathBuf::from("runs").join(case_file::stem(&arguments.case.file)),
    };
    if arguments.resume && RunDirectory::is_there(&out) {
        return take_up(arguments, &out);
    }
    let (text, plan) = case_file::open(&arguments.case)?;
    let interrupt = listen()?;
    study::fits(&plan).map_err(Failure::Study)?;
    let directory = RunDirectory::create(&out, &text, &plan.title, arguments.overwrite)
        .map_err(Failure::Study)?;
    lead(&plan, directory, interrupt, study::run)
}

/// Goes on with a run by a case, which may have changed ahead of where it is.
fn take_up(arguments: &RunArguments, out: &Path) -> Result<(), Failure> {
    let mut directory = RunDirectory::open(out).map_err(Failure::Study)?;
    directory.own().map_err(Failure::Study)?;
    let before = directory.read("case.toml").unwrap_or_default();
    let (text, plan) = if directory.has_hardly_begun() {
        case_file::open(&arguments.case)?
    } else {
        let old = case_file::of_run(&directory)?;
        let (text, plan) = case_file::open_again(&arguments.case, &directory, &old)?;
        if before == text.as_bytes() {
            if directory.is_complete() {
                return nothing_to_do(&directory);
            }
        } else {
            let before = String::from_utf8_lossy(&before);
            may_go_on(&directory, [(&before, &old), (&text, &plan)])?;
        }
        (text, plan)
    };
    let interrupt = listen()?;
    study::fits(&plan).map_err(Failure::Study)?;
    if before != text.as_bytes() {
        directory
            .write_case(&text, &plan.title)
            .map_err(Failure::Study)?;
    }
    lead(&plan, directory, interrupt, study::resume)
}

/// Goes on with a run.
pub fn resume(arguments: &ResumeArguments) -> Result<(), Failure> {
    threads::limit(arguments.threads)?;
    let mut directory = RunDirectory::open(&arguments.run).map_err(Failure::Study)?;
    directory.own().map_err(Failure::Study)?;
    let plan = case_file::of_run(&directory)?;
    if directory.is_complete() {
        return nothing_to_do(&directory);
    }
    lead(&plan, directory, listen()?, study::resume)
}

fn listen() -> Result<Interrupt, Failure> {
    Interrupt::listen()
        .map_err(|error| Failure::Files(format!("cannot listen to signals: {error}")))
}

fn nothing_to_do(directory: &RunDirectory) -> Result<(), Failure> {
    directory.tidy().map_err(Failure::Study)?;
    console::say(&format!(
        "{} is complete; there is nothing to go on with\n",
        directory.path().display()
    ))
}

/// Refuses another case than the one that was begun, but for what may change.
fn may_go_on(
    directory: &RunDirectory,
    [(before, old), (text, new)]: [(&str, &Plan); 2],
) -> Result<(), Failure> {
    let (rows, _) = directory.history_so_far().map_err(Failure::Study)?;
    let (checkpoint, _) = directory.checkpoint(old, &rows).map_err(Failure::Study)?;
    let reached = checkpoint.memory.reached;
    let kept = study::kept(old, new, checkpoint.stage.map(|stage| (stage, reached)));
    if kept.is_empty() {
        return Ok(());
    }
    let mut what = format!(
        "{}: begun with another case. Of this one {} must stay as it was:",
        directory.path().display(),
        kept.join(", ")
    );
    for difference in differences(before, text) {
        what += &format!("\n  {difference}");
    }
    what += "\nThe title, [solver], [output], the steps of the stage it is in and all later stages may change. \
        Run this case into another directory, or begin again with --overwrite";
    Err(Failure::Usage(what))
}

/// Leads a run to its end, and draws it.
fn lead(
    plan: &Plan,
    mut directory: RunDirectory,
    interrupt: Interrupt,
    by: fn(&Plan, &mut RunDirectory, &mut dyn Observer) -> Result<Summary, StudyError>,
) -> Result<(), Failure> {
    let out = directory.path().to_owned();
    console::tell(&format!("{}\nwriting to {}", plan.title, out.display()));
    for warning in case_file::advice(plan) {
        console::tell(&format!("warning: {warning}"));
    }
    let mut progress = Progress::new(plan, interrupt.clone());
    let summary = by(plan, &mut directory, &mut progress);
    progress.finish();
    let summary = summary.map_err(Failure::Study)?;
    // Whoever waits for numbers does not wait for pictures.
    let told = console::say(&summary.to_string());
    let drawn = draw(plan, &summary, &directory)?;
    told.and_then(|()| console::say(&drawn))?;
    if summary.finished() {
        directory.tidy().map_err(Failure::Study)?;
        return Ok(());
    }
    console::tell(&summary.ending().to_string());
    if interrupt.asked() {
        return Err(Failure::Interrupted(format!(
            "interrupted; everything up to the last accepted state is written, and `plica resume {}` goes on from there",
            out.display()
        )));
    }
    Err(Failure::Unfinished)
}
