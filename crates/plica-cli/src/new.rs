//! `plica new`, `plica schema` and `plica completions`.

use crate::args::Arguments;
use crate::console;
use crate::failure::Failure;
use clap::CommandFactory;
use clap_complete::Shell;
use plica::case::{self, STARTER};
use std::fs::File;
use std::io::{ErrorKind, Write};
use std::path::Path;

/// Writes the example case; never overwrites a file.
pub fn new(path: &Path) -> Result<(), Failure> {
    if path == Path::new("-") {
        return console::print(STARTER);
    }
    let name = path.display();
    let written = File::create_new(path).and_then(|mut file| file.write_all(STARTER.as_bytes()));
    match written {
        Ok(()) => console::print(&format!(
            "written to {name}; edit it, then run: plica run {name}\n"
        )),
        Err(error) if error.kind() == ErrorKind::AlreadyExists => Err(Failure::Files(format!(
            "{name} already exists; choose another name"
        ))),
        Err(error) => Err(Failure::Files(format!("{name}: {error}"))),
    }
}

/// Prints a completion script.
pub fn completions(shell: Shell) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "plica", &mut script);
    console::print(&String::from_utf8_lossy(&script))
}

/// Prints the JSON schema of the case file.
pub fn schema() -> Result<(), Failure> {
    console::print(&format!("{:#}\n", case::schema()))
}
