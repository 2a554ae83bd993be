//! `plica verify`.

use crate::args::VerifyArguments;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::pages::First;
use crate::ticker::Ticker;
use crate::{console, pages, threads};
use plica_verify::verification::{CHECKS, Check, TITLE, VerificationError, verify as run_checks};
use std::fs;

/// The page with the table.
const PAGE: &str = "verification.md";

/// Holds the checks, prints the table and writes it with its pictures.
pub fn verify(arguments: &VerifyArguments) -> Result<(), Failure> {
    if arguments.list {
        return console::say(&list());
    }
    // Nothing is a part of everything.
    let is = |check: &Check, name: &String| !name.is_empty() && check.name.contains(name.as_str());
    let only = &arguments.only;
    let wanted = |check: &Check| only.is_empty() || only.iter().any(|name| is(check, name));
    let full = arguments.full;
    if let Some(name) = only.iter().find(|name| {
        let mut held = CHECKS.iter().filter(|check| full || !check.slow);
        !held.any(|check| is(check, name))
    }) {
        let slow = CHECKS.iter().any(|check| is(check, name));
        let cure = if slow {
            "it is a slow one: add --full"
        } else {
            "plica verify --list names them"
        };
        return Err(Failure::Usage(format!(
            "--only {name:?}: no check has this name; {cure}"
        )));
    }
    threads::limit(arguments.threads)?;
    let first = First {
        name: PAGE,
        title: TITLE,
        manner: "",
        command: "plica verify",
    };
    pages::prepare(&arguments.out, &first)?;
    let file_trouble = |error| Failure::Files(format!("{}: {error}", arguments.out.display()));
    let page = arguments.out.join(PAGE);
    let interrupt = Interrupt::listen()
        .map_err(|error| Failure::Files(format!("cannot listen to signals: {error}")))?;
    let mut ticker = Ticker::new(interrupt);
    let held = run_checks(full, &wanted, &mut ticker);
    ticker.finish();
    let held = held.map_err(|error| match error {
        VerificationError::Cancelled => {
            Failure::Interrupted("interrupted; nothing was written".into())
        }
        error => Failure::Files(error.to_string()),
    })?;
    // First of all, whatever becomes of the files.
    console::say(&held.text())?;
    let mut names = vec![PAGE.to_owned()];
    fs::write(&page, held.page()).map_err(file_trouble)?;
    match held.pictures() {
        Ok(pictures) => {
            for (name, png) in pictures {
                fs::write(arguments.out.join(&name), png).map_err(file_trouble)?;
                names.push(name);
            }
        }
        Err(error) => console::tell(&format!("warning: no pictures: {error}")),
    }
    let out = arguments.out.display();
    console::say(&format!("written to {out}: {}\n", names.join(", ")))?;
    if held.failed() > 0 {
        Err(Failure::Unfinished)
    } else {
        Ok(())
    }
}

/// The checks and what they are about.
fn list() -> String {
    let line = |check: &Check| {
        let slow = if check.slow { " (--full)" } else { "" };
        format!("{:<22}{}{slow}\n", check.name, check.description)
    };
    CHECKS.iter().map(line).collect()
}
