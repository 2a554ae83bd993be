//! `plica run` and `plica resume`.

use crate::args::{ResumeArguments, RunArguments};
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::progress::Progress;
use crate::{case_file, console, threads};
use plica::case::differences;
use plica::run_directory::{Run, RunDirectory, RunError, Summary};
use plica::study::findings::states_in;
use plica::study::{Condition, Ending, Findings, Plan, check_memory, forbidden_changes};
use plica_view::report::pictures;
use std::path::{Path, PathBuf};

/// Draws the pictures of a run and returns a line with their names. A failure to draw is only a warning.
fn draw(plan: &Plan, summary: &Summary, directory: &RunDirectory) -> Result<String, Failure> {
    if !plan.output.pictures {
        return Ok(String::new());
    }
    let pictures = match pictures(plan, summary) {
        Ok(pictures) => pictures,
        Err(error) => {
            console::message(&format!("warning: no pictures: {error}"));
            return Ok(String::new());
        }
    };
    for (name, png) in &pictures {
        directory.write(name, png)?;
    }
    if pictures.is_empty() {
        return Ok(String::new());
    }
    let names: Vec<&str> = pictures.iter().map(|(name, _)| name.as_str()).collect();
    Ok(format!("  {:<22} {}\n", "pictures", names.join(", ")))
}

/// Runs a case, from the beginning or after its last checkpoint.
pub fn run(arguments: &RunArguments) -> Result<(), Failure> {
    // Checking a case may already compute on several threads.
    threads::limit(arguments.threads)?;
    let out = match &arguments.out {
        Some(out) => out.clone(),
        None => PathBuf::from("runs").join(case_file::stem(&arguments.case.file)),
    };
    if arguments.resume && RunDirectory::exists(&out) {
        return resume_with_case(arguments, &out);
    }
    let (text, plan) = case_file::open(&arguments.case)?;
    let until = until(arguments, &plan)?;
    let interrupt = Interrupt::listen()?;
    check_memory(&plan).map_err(RunError::from)?;
    let mut directory = RunDirectory::create(&out, &text, &plan.title, arguments.overwrite)?;
    let how = How {
        resume: false,
        strict: arguments.strict,
        until,
    };
    follow(&plan, &mut directory, interrupt, &how)
}

/// Returns the condition at which a run is to stop.
fn until(arguments: &RunArguments, plan: &Plan) -> Result<Option<Condition>, Failure> {
    let parsed = arguments.until.as_deref();
    let parsed = parsed.map(|text| Condition::parse(text, plan));
    parsed
        .transpose()
        .map_err(|error| Failure::Usage(format!("--until: {error}")))
}

/// The manner in which a run is followed.
struct How {
    /// True to resume an interrupted run.
    resume: bool,
    /// True to treat unphysical states as an error.
    strict: bool,
    /// Condition at which it stops.
    until: Option<Condition>,
}

/// Resumes a run with a case, which may differ from the one of the run in what is still ahead.
fn resume_with_case(arguments: &RunArguments, out: &Path) -> Result<(), Failure> {
    let mut directory = RunDirectory::open(out)?;
    directory.lock()?;
    let before = directory.read("case.toml").unwrap_or_default();
    let (text, plan) = if directory.has_hardly_begun() {
        case_file::open(&arguments.case)?
    } else {
        let old = case_file::of_run(&directory)?;
        let (text, plan) = case_file::open_again(&arguments.case, &directory, &old)?;
        if before == text.as_bytes() {
            if directory.is_complete() {
                return nothing_to_do(&mut directory, &plan);
            }
        } else {
            let before = String::from_utf8_lossy(&before);
            check_changes(&directory, [(&before, &old), (&text, &plan)])?;
        }
        (text, plan)
    };
    let how = How {
        resume: true,
        strict: arguments.strict,
        until: until(arguments, &plan)?,
    };
    let interrupt = Interrupt::listen()?;
    check_memory(&plan).map_err(RunError::from)?;
    if before != text.as_bytes() {
        directory.write_case(&text, &plan.title)?;
    }
    follow(&plan, &mut directory, interrupt, &how)
}

/// Resumes a run.
pub fn resume(arguments: &ResumeArguments) -> Result<(), Failure> {
    threads::limit(arguments.threads)?;
    let mut directory = RunDirectory::open(&arguments.run)?;
    directory.lock()?;
    let plan = case_file::of_run(&directory)?;
    if directory.is_complete() {
        return nothing_to_do(&mut directory, &plan);
    }
    let how = How {
        resume: true,
        strict: arguments.strict,
        until: None,
    };
    follow(&plan, &mut directory, Interrupt::listen()?, &how)
}

/// Prints that a run is complete, restores its history if that is damaged, and lists its damaged files.
fn nothing_to_do(directory: &mut RunDirectory, plan: &Plan) -> Result<(), Failure> {
    directory.close()?;
    let restored = directory.mend(plan)?;
    if !restored.is_empty() {
        console::message("history.csv was damaged or incomplete; restored from the checkpoint");
    }
    console::print(&format!(
        "{} is complete; there is nothing to resume\n",
        directory.path().display()
    ))
}

/// Refuses a case that differs from the one of the run in what is already computed.
fn check_changes(
    directory: &RunDirectory,
    [(before, old), (text, new)]: [(&str, &Plan); 2],
) -> Result<(), Failure> {
    let checkpoint = directory.checkpoint(old)?.checkpoint;
    let reached = checkpoint.path.reached;
    let changes = forbidden_changes(old, new, checkpoint.stage.map(|stage| (stage, reached)));
    if changes.is_empty() {
        return Ok(());
    }
    let mut message = format!(
        "{}: the run was begun with another case. This case must not change {}:",
        directory.path().display(),
        changes.join(", ")
    );
    for difference in differences(before, text) {
        message += &format!("\n  {difference}");
    }
    message += "\nThe title, [solver], [output], the steps of the current stage and all later stages may change. \
        Run this case in another directory, or begin again with --overwrite";
    Err(Failure::Usage(message))
}

/// Follows a run to its end, shows its states, and draws its pictures.
fn follow(
    plan: &Plan,
    directory: &mut RunDirectory,
    interrupt: Interrupt,
    how: &How,
) -> Result<(), Failure> {
    let out = directory.path().to_owned();
    console::message(&format!("{}\nwriting to {}", plan.title, out.display()));
    for warning in case_file::advice(plan) {
        console::message(&format!("warning: {warning}"));
    }
    let mut progress = Progress::new(plan, interrupt.clone());
    let summary = all_states(plan, directory, &mut progress, how);
    progress.finish();
    let summary = summary.map_err(|error| Failure::OfRun {
        error,
        run: out.clone(),
    })?;
    // The table is printed before the pictures, which take longer.
    let printed = console::print(&summary.to_string());
    let drawn = draw(plan, &summary, directory).map_err(|failure| failure.of_run(&out))?;
    if let Some(gaps) = stability_gaps(directory) {
        console::message(&format!(
            "warning: {gaps}; run `plica stability {}` again",
            out.display()
        ));
    }
    printed.and_then(|()| console::print(&drawn))?;
    match summary.ending() {
        Ending::Complete => {
            let closed = directory.close();
            closed.map_err(|error| Failure::from(error).of_run(&out))?;
            if let Some(condition) = directory.stopped_at() {
                console::message(&format!(
                    "stopped at the first state with {condition}, as asked; `plica resume {}` goes on",
                    out.display()
                ));
            }
            return if how.strict {
                check_states(summary.findings())
            } else {
                Ok(())
            };
        }
        Ending::Stopped => console::message("stopped on request; every state so far is kept"),
        Ending::Lost(lost) => console::message(&lost.to_string()),
    }
    if interrupt.is_requested() {
        return Err(Failure::Interrupted(format!(
            "interrupted; everything up to the last accepted state is written, and `plica resume {}` continues from there",
            out.display()
        )));
    }
    Err(Failure::Unfinished)
}

/// Refuses states that do not describe a real tube, and states whose stability is not known.
fn check_states(findings: &Findings) -> Result<(), Failure> {
    let untested = states_in(&findings.untested);
    if findings.unphysical_states() == 0 && untested == 0 {
        return Ok(());
    }
    Err(Failure::Unphysical(format!(
        "--strict: {} of {} states cross themselves, overlap an obstacle, have a closed lumen or are not in equilibrium, and the stability of {untested} \
        is not known; the table above lists them",
        findings.unphysical_states(),
        findings.work.states
    )))
}

/// Returns a statement on the saved states that earlier results of `plica stability` do not cover.
fn stability_gaps(directory: &RunDirectory) -> Option<String> {
    let saved = directory.state_numbers().unwrap_or_default();
    directory.stability_coverage()?.gaps(&saved)
}

/// Computes all states and shows a line for each.
fn all_states(
    plan: &Plan,
    directory: &mut RunDirectory,
    progress: &mut Progress,
    how: &How,
) -> Result<Summary, RunError> {
    let mut run = if how.resume {
        Run::resume(plan, directory, progress)?
    } else {
        Run::begin(plan, directory)?
    };
    while let Some(row) = run.next_row(progress)? {
        progress.show(row);
        if let Some(condition) = how.until.as_ref().filter(|until| until.holds(row)) {
            run.stop_at(condition);
            break;
        }
    }
    run.finish()
}
