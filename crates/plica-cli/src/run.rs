//! `plica run`.

use crate::args::RunArguments;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::progress::Progress;
use crate::{case_file, console};
use plica::case::advice;
use plica::study::{self, RunDirectory};
use std::path::PathBuf;

/// Runs a case.
pub fn run(arguments: &RunArguments) -> Result<(), Failure> {
    let (text, plan) = case_file::open(&arguments.case)?;
    let out = match &arguments.out {
        Some(out) => out.clone(),
        None => PathBuf::from("runs").join(case_file::stem(&arguments.case)),
    };
    if let Some(threads) = arguments.threads {
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads.into())
            .build_global()
            .map_err(|error| Failure::Usage(format!("{threads} threads: {error}")))?;
    }
    let interrupt = Interrupt::listen()
        .map_err(|error| Failure::Files(format!("cannot listen to signals: {error}")))?;
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
    console::say(&format!("{summary}\n"))?;
    if summary.finished() {
        Ok(())
    } else if interrupt.asked() {
        Err(Failure::Interrupted)
    } else {
        Err(Failure::Unfinished)
    }
}
