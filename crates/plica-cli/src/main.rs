//! The program `plica`: parses arguments, calls the libraries and prints. Only this crate prints or exits.

mod args;
mod case_file;
mod check;
mod console;
mod diagnostics;
mod existing_run;
mod export;
mod failure;
mod follow;
mod interrupt;
mod law_text;
mod materials;
mod new;
mod page_directory;
mod plot;
mod progress;
mod render;
mod report;
mod reproduce;
mod run;
mod stability;
mod sweep;
mod table;
mod threads;
mod ticker;
mod verify;
mod video;

use args::{Arguments, Command};
use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(answer) => {
            // Includes help and version. A closed pipe is not an error.
            let _ = answer.print();
            return ExitCode::from(u8::try_from(answer.exit_code()).unwrap_or(2));
        }
    };
    let done = match arguments.command {
        Command::Run(arguments) => run::run(&arguments),
        Command::Resume(arguments) => run::resume(&arguments),
        Command::Stability(arguments) => stability::stability(&arguments),
        Command::Sweep(arguments) => sweep::sweep(&arguments),
        Command::Follow(arguments) => follow::follow(&arguments),
        Command::Verify(arguments) => verify::verify(&arguments),
        Command::Reproduce(arguments) => reproduce::reproduce(&arguments),
        Command::Export(arguments) => export::export(&arguments),
        Command::Render(arguments) => render::render(&arguments),
        Command::Plot(arguments) => plot::plot(&arguments),
        Command::Animate(arguments) => render::animate(&arguments),
        Command::Report(arguments) => report::report(&arguments),
        Command::Table(arguments) => table::table(&arguments),
        Command::Check(arguments) => check::check(&arguments),
        Command::Materials(arguments) => materials::materials(&arguments),
        Command::New { file } => new::new(&file),
        Command::Schema => new::schema(),
        Command::Completions { shell } => new::completions(shell),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}
