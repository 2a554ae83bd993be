//! Output that tolerates closed pipes.

use crate::failure::Failure;
use std::io::{ErrorKind, IsTerminal, Write, stderr, stdout};

/// Prints a result to standard output. A closed pipe (`plica new - | head -1`) is not an error.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut out = stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::Files(format!("standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// Prints a line of progress or an error to standard error.
pub fn message(line: &str) {
    // Nothing can be done where standard error is closed.
    let _ = writeln!(stderr().lock(), "{line}");
}

/// Returns whether standard error is a terminal that can redraw a line.
pub fn is_terminal() -> bool {
    stderr().is_terminal() && std::env::var_os("TERM").is_none_or(|term| term != "dumb")
}

/// Returns whether messages may be coloured (see no-color.org).
pub fn is_coloured() -> bool {
    is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}
