//! Directories of pages that the program writes, and may write again.

use crate::failure::Failure;
use std::fs;
use std::path::Path;

/// Makes a directory for pages, before minutes of work and not after, and begins its first page, by which it is known the next
/// time; refuses one that holds other things.
pub fn prepare(out: &Path, first: &str, title: &str, command: &str) -> Result<(), Failure> {
    let files = |error| Failure::Files(format!("{}: {error}", out.display()));
    fs::create_dir_all(out).map_err(files)?;
    let page = out.join(first);
    let written = fs::read_to_string(&page).unwrap_or_default();
    if page.exists() && !written.starts_with(title) {
        return Err(Failure::Usage(format!(
            "{}: there is such a page already, and {command} did not write it; choose another --out",
            page.display()
        )));
    }
    if !page.exists() {
        if fs::read_dir(out).map_err(files)?.next().is_some() {
            return Err(Failure::Usage(format!(
                "{}: the directory holds other things than the pages of {command}, and could lose them; choose another --out",
                out.display()
            )));
        }
        fs::write(&page, format!("{title}\n\nNot done yet.\n")).map_err(files)?;
    }
    Ok(())
}
