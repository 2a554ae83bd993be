//! Directories of pages that the program writes, and may write again.

use crate::failure::Failure;
use std::fs;
use std::path::Path;

/// What is known of a first page of ours.
pub struct First<'a> {
    /// The name of its file.
    pub name: &'a str,
    /// What it begins with, whoever asked for it.
    pub title: &'a str,
    /// What follows that if it was asked for in the same way.
    pub manner: &'a str,
    /// The command that writes it.
    pub command: &'a str,
}

/// Makes a directory for pages, before minutes of work and not after, and begins its first page, by which it is known the next
/// time; refuses one that holds other things.
pub fn prepare(out: &Path, first: &First<'_>) -> Result<(), Failure> {
    let First {
        name,
        title,
        manner,
        command,
    } = first;
    let files = |error| Failure::Files(format!("{}: {error}", out.display()));
    let refuse = |what: &str| {
        Err(Failure::Usage(format!(
            "{}: {what}; choose another --out",
            out.display()
        )))
    };
    fs::create_dir_all(out).map_err(files)?;
    let page = out.join(name);
    let head = format!("{title}\n\n{manner}");
    match fs::read_to_string(&page) {
        Ok(written) if written.starts_with(&head) => Ok(()),
        Ok(written) if written.starts_with(title) => refuse(&format!(
            "{name} there was written by {command} with other options, whose work would be lost"
        )),
        Ok(_) => refuse(&format!(
            "there is a {name} already, and {command} did not write it"
        )),
        Err(_) if page.exists() => refuse(&format!("{name} there cannot be read")),
        Err(_) if fs::read_dir(out).map_err(files)?.next().is_some() => refuse(&format!(
            "the directory holds other things than the pages of {command}, and could lose them"
        )),
        Err(_) => write(out, name, format!("{head}\n\nNot done yet.\n").as_bytes()),
    }
}

/// Writes a file of a directory of pages: aside first, then renamed, so that what was there stays until the new one is whole.
pub fn write(out: &Path, name: &str, bytes: &[u8]) -> Result<(), Failure> {
    let path = out.join(name);
    let aside = path.with_extension("part");
    let written = fs::write(&aside, bytes).and_then(|()| fs::rename(&aside, &path));
    written.map_err(|error| {
        let _ = fs::remove_file(&aside);
        Failure::Files(format!("{}: {error}", path.display()))
    })
}
