//! Reading a case from disk.

use crate::failure::Failure;
use plica::case::{self, Open, Wanted};
use plica::study::{Plan, RunDirectory, SavedState};
use std::io::{Error, ErrorKind, Read};
use std::path::Path;

/// Larger than any case; smaller than the memory of any machine.
const LARGEST: u64 = 1 << 20;

/// The text of a case file and what it means; files that it names are looked for from the folder of the file on. They lie in
/// that folder, in the one that the program runs in, or in one that the user has given.
pub fn open(path: &Path, within: Option<&Path>) -> Result<(String, Plan), Failure> {
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    if let Some(within) = within.filter(|within| !within.is_dir()) {
        let what = format!("--within {}: there is no such folder", within.display());
        return Err(Failure::Usage(what));
    }
    open_with(path, &|wanted| {
        let file = folder.join(wanted.path());
        let roots = [Some(folder), Some(Path::new(".")), within];
        if !lies_in(&file, roots.into_iter().flatten())? {
            let why = "it lies neither in the folder of the case nor in the one that plica runs in, and a case does not reach further by \
                itself; if it may, name a folder that holds it with --within DIR";
            return Err(Error::new(ErrorKind::PermissionDenied, why).into());
        }
        SavedState::read(&file)
    })
}

/// Whether a file lies in one of some folders, links followed.
fn lies_in<'a>(file: &Path, mut folders: impl Iterator<Item = &'a Path>) -> Result<bool, Error> {
    let file = file.canonicalize()?;
    Ok(folders.any(|folder| {
        folder
            .canonicalize()
            .is_ok_and(|folder| file.starts_with(folder))
    }))
}

/// The same, with another way to the files that it names.
pub fn open_with(path: &Path, named: &Open<'_>) -> Result<(String, Plan), Failure> {
    let trouble = |error| Failure::Files(format!("{}: {error}", path.display()));
    let size = std::fs::metadata(path).map_err(trouble)?.len();
    if size > LARGEST {
        let what = format!("{} is too large for a case ({size} bytes)", path.display());
        return Err(Failure::Usage(what));
    }
    // A device or a pipe has no size; no more than the largest case is read of it.
    let mut bytes = vec![];
    let file = std::fs::File::open(path).map_err(trouble)?;
    file.take(LARGEST + 1)
        .read_to_end(&mut bytes)
        .map_err(trouble)?;
    if bytes.len() as u64 > LARGEST {
        return Err(Failure::Usage(format!(
            "{} is too large for a case",
            path.display()
        )));
    }
    let Ok(text) = String::from_utf8(bytes) else {
        let what = format!("{} is not text (a case is TOML, in UTF-8)", path.display());
        return Err(Failure::Usage(what));
    };
    match case::read_with(&text, &stem(path), named) {
        Ok(plan) => Ok((text, plan)),
        Err(error) => Err(Failure::Case {
            path: path.to_owned(),
            text,
            error,
        }),
    }
}

/// The plan of a run that is there. The state it began from it has kept, and the modes of its imperfections.
pub fn of_run(directory: &RunDirectory) -> Result<Plan, Failure> {
    let own = |wanted: Wanted<'_>| match wanted {
        Wanted::State(_) => {
            let kept = directory.start();
            // A run of before that was kept has its own first state.
            let first = directory.path().join(RunDirectory::name_of_state(0));
            SavedState::read(if kept.exists() { &kept } else { &first })
        }
        Wanted::Mode(number, _) => SavedState::read(&directory.imperfection(number)),
    };
    let (_, mut plan) = open_with(&directory.path().join("case.toml"), &own)?;
    // A case without a title had that of its file, which was called otherwise then.
    if let Some(title) = directory.manifest()["title"].as_str() {
        plan.title = title.to_owned();
    }
    Ok(plan)
}

/// The name of a case: that of its file, without the ending.
pub fn stem(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or(path.as_os_str());
    stem.to_string_lossy().into_owned()
}
