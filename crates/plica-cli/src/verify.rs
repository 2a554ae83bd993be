//! `plica verify`.

use crate::args::VerifyArguments;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::page_directory::FirstPage;
use crate::ticker::Ticker;
use crate::{console, page_directory, threads};
use plica_verify::verification::{CHECKS, Check, TITLE, VerificationError, verify as run_checks};
use std::fs;

/// Page with the table.
const PAGE: &str = "verification.md";

/// Runs the checks, prints the table and writes it with its pictures.
pub fn verify(arguments: &VerifyArguments) -> Result<(), Failure> {
    if arguments.list {
        return console::print(&list());
    }
    // An empty name would match every check.
    let matches =
        |check: &Check, name: &String| !name.is_empty() && check.name.contains(name.as_str());
    let only = &arguments.only;
    let wanted = |check: &Check| only.is_empty() || only.iter().any(|name| matches(check, name));
    let full = arguments.full;
    if let Some(name) = only.iter().find(|name| {
        let mut available = CHECKS.iter().filter(|check| full || !check.slow);
        !available.any(|check| matches(check, name))
    }) {
        let slow = CHECKS.iter().any(|check| matches(check, name));
        let help = if slow {
            "it is slow: add --full"
        } else {
            "see plica verify --list"
        };
        return Err(Failure::Usage(format!(
            "--only {name:?}: no such check; {help}"
        )));
    }
    threads::limit(arguments.threads)?;
    let first = FirstPage {
        name: PAGE,
        title: TITLE,
        manner: "",
        command: "plica verify",
    };
    page_directory::prepare(&arguments.out, &first)?;
    let file_error = |error| Failure::Files(format!("{}: {error}", arguments.out.display()));
    let page = arguments.out.join(PAGE);
    let interrupt = Interrupt::listen()?;
    let mut ticker = Ticker::new(interrupt);
    let found = run_checks(full, &wanted, &mut ticker);
    ticker.finish();
    let found = found.map_err(|error| match error {
        VerificationError::Cancelled => {
            Failure::Interrupted("interrupted; nothing was written".into())
        }
        error => Failure::Files(error.to_string()),
    })?;
    // Print first: writing the files may fail.
    console::print(&found.text())?;
    let mut names = vec![PAGE.to_owned()];
    fs::write(&page, found.page()).map_err(file_error)?;
    match found.pictures() {
        Ok(pictures) => {
            for (name, png) in pictures {
                fs::write(arguments.out.join(&name), png).map_err(file_error)?;
                names.push(name);
            }
        }
        Err(error) => console::message(&format!("warning: no pictures: {error}")),
    }
    let out = arguments.out.display();
    console::print(&format!("written to {out}: {}\n", names.join(", ")))?;
    if found.failed() > 0 {
        Err(Failure::Unfinished)
    } else {
        Ok(())
    }
}

/// Lists the checks and their subjects.
fn list() -> String {
    let line = |check: &Check| {
        let slow = if check.slow { " (--full)" } else { "" };
        format!("{:<22}{}{slow}\n", check.name, check.description)
    };
    CHECKS.iter().map(line).collect()
}
