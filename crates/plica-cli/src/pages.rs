//! Directories of pages that the program writes, and may write again.

use crate::failure::Failure;
use std::fs;
use std::path::Path;

/// Makes a directory for pages, before minutes of work and not after; refuses one whose first page is someone's own.
pub fn prepare(out: &Path, first: &str, title: &str, command: &str) -> Result<(), Failure> {
    fs::create_dir_all(out)
        .map_err(|error| Failure::Files(format!("{}: {error}", out.display())))?;
    let page = out.join(first);
    let written = fs::read_to_string(&page).unwrap_or_default();
    if page.exists() && !written.starts_with(title) {
        return Err(Failure::Usage(format!(
            "{}: there is such a page already, and it is none of {command}'s; choose another --out",
            page.display()
        )));
    }
    Ok(())
}
