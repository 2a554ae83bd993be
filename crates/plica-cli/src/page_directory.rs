//! Output directories of `plica verify` and `plica reproduce`.

use crate::failure::Failure;
use std::fs;
use std::path::Path;

/// First page of an output directory; its beginning identifies the directory.
pub struct FirstPage<'a> {
    /// File name.
    pub name: &'a str,
    /// Beginning of the page.
    pub title: &'a str,
    /// Text after the title, which depends on the options.
    pub manner: &'a str,
    /// Command that writes it.
    pub command: &'a str,
}

/// Creates the directory and a placeholder of its first page, before minutes of work. Refuses a directory with other
/// content.
pub fn prepare(out: &Path, first: &FirstPage<'_>) -> Result<(), Failure> {
    let FirstPage {
        name,
        title,
        manner,
        command,
    } = first;
    let file_error = |error| Failure::Files(format!("{}: {error}", out.display()));
    let refuse = |what: &str| {
        Err(Failure::Usage(format!(
            "{}: {what}; choose another --out",
            out.display()
        )))
    };
    fs::create_dir_all(out).map_err(file_error)?;
    let page = out.join(name);
    let head = format!("{title}\n\n{manner}");
    match fs::read_to_string(&page) {
        Ok(written) if written.starts_with(&head) => Ok(()),
        Ok(written) if written.starts_with(title) => refuse(&format!(
            "its {name} was written by {command} with other options and would be overwritten"
        )),
        Ok(_) => refuse(&format!(
            "it contains a {name} that {command} did not write"
        )),
        Err(_) if page.exists() => refuse(&format!("its {name} cannot be read")),
        Err(_) if fs::read_dir(out).map_err(file_error)?.next().is_some() => {
            refuse(&format!("it contains files that {command} did not write"))
        }
        Err(_) => write(
            out,
            name,
            format!("{head}\n\nNot computed yet.\n").as_bytes(),
        ),
    }
}

/// Writes a file under a temporary name and renames it, so that an existing file stays until the new one is complete.
pub fn write(out: &Path, name: &str, bytes: &[u8]) -> Result<(), Failure> {
    let path = out.join(name);
    let temporary = path.with_extension("part");
    let written = fs::write(&temporary, bytes).and_then(|()| fs::rename(&temporary, &path));
    written.map_err(|error| {
        let _ = fs::remove_file(&temporary);
        Failure::Files(format!("{}: {error}", path.display()))
    })
}
