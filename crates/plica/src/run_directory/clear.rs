//! The files of a run, by name: only these are ever removed from a directory.

use super::RunError;
use super::{
    CASE, CHECKPOINTS, HISTORY, IMPERFECTIONS, MATERIALS, OF_STATES, START, STATE_ENDING,
    number_of_state,
};
use std::fs;
use std::path::{Path, PathBuf};

/// Removes the files of a previous run, known by name. Every other file stays, and so does the manifest, so that the
/// directory stays a run if this is interrupted.
pub(super) fn clear(path: &Path) -> Result<(), RunError> {
    // The case first: without it the rest is not a run, if this is interrupted.
    let mut old = vec![path.join(CASE)];
    old.extend(stability_files(path));
    let pictures = [
        "energy.png",
        "walls.png",
        "tube.png",
        "manometry.png",
        "manometry.csv",
        "report.html",
    ];
    old.extend(
        [START, HISTORY, "history.part", "checkpoint.part"]
            .iter()
            .chain(&CHECKPOINTS)
            .chain(&pictures)
            .map(|name| path.join(name)),
    );
    old.extend(modes(&path.join(IMPERFECTIONS)));
    old.extend(libraries(&path.join(MATERIALS)));
    let exported = [
        ("vtk/walls", "vtp"),
        ("vtk/meridian", "vtp"),
        ("vtk/volume", "vtu"),
        ("vtk/linear", "vtu"),
        ("vtk/obstacles", "vtp"),
    ];
    for (folder, ending) in OF_STATES.into_iter().chain(exported) {
        let mine = |file: &Path, ending| number_of_state(file, ending).is_some();
        old.extend(files(&path.join(folder)).filter(|f| mine(f, ending) || mine(f, "part")));
        old.extend(parts(&path.join(folder), &["state-"]));
    }
    old.extend(parts(path, &["report.html."]));
    old.extend(parts(
        &path.join("vtk"),
        &["walls.", "meridian.", "volume.", "linear.", "obstacles."],
    ));
    old.extend(files(&path.join("pictures")).filter(|file| {
        let name = file
            .file_name()
            .and_then(|name| name.to_str())
            .unwrap_or_default();
        let (stem, ending) = name.rsplit_once('.').unwrap_or_default();
        let is_part = ending == "part" && (name.contains("-state-") || name.contains("-path."));
        (stem.contains("-state-") || stem.ends_with("-path"))
            && ["png", "svg", "apng", "mp4"].contains(&ending)
            || is_part
    }));
    old.extend(
        ["walls", "meridian", "volume", "linear", "obstacles"]
            .map(|what| path.join(format!("vtk/{what}.pvd"))),
    );
    old.push(path.join("vtk/walls.vtkhdf"));
    remove(old)
}

/// Returns the temporary files in a folder whose names begin so: a process that writes without the lock gives them names of
/// their own.
fn parts<'a>(folder: &Path, begin: &'a [&str]) -> impl Iterator<Item = PathBuf> + use<'a> {
    files(folder).filter(move |file| {
        let name = file.file_name().and_then(|name| name.to_str());
        let begins = |name: &str| begin.iter().any(|begin| name.starts_with(begin));
        name.is_some_and(|name| name.ends_with(".part") && begins(name))
    })
}

/// Returns the files that a stability analysis writes.
pub(super) fn stability_files(path: &Path) -> Vec<PathBuf> {
    let names = [
        "stability.csv",
        "eigenvalues.csv",
        "eigenpairs.csv",
        "stability.png",
        "mode.png",
    ];
    let modes = modes(&path.join("modes"));
    names
        .iter()
        .map(|name| path.join(name))
        .chain(modes)
        .collect()
}

/// Returns the files of modes in a folder.
pub(super) fn modes(folder: &Path) -> impl Iterator<Item = PathBuf> + use<> {
    files(folder).filter(|file| {
        let name = file
            .file_name()
            .and_then(|name| name.to_str())
            .unwrap_or_default();
        name.starts_with("mode-") && name.ends_with(STATE_ENDING)
    })
}

/// Returns the copies of libraries of materials in a folder.
pub(super) fn libraries(folder: &Path) -> impl Iterator<Item = PathBuf> + use<> {
    files(folder).filter(|file| {
        let name = file
            .file_name()
            .and_then(|name| name.to_str())
            .unwrap_or_default();
        name.starts_with("library-") && name.ends_with(".toml")
    })
}

/// Returns the files in a folder, if it exists.
pub(super) fn files(folder: &Path) -> impl Iterator<Item = PathBuf> + use<> {
    let entries = fs::read_dir(folder).into_iter().flatten();
    entries.flatten().map(|entry| entry.path())
}

/// Removes files, if they exist.
pub(super) fn remove(files: Vec<PathBuf>) -> Result<(), RunError> {
    for file in files {
        match fs::remove_file(&file) {
            Err(e) if e.kind() != std::io::ErrorKind::NotFound => {
                return Err(RunError::File {
                    path: file,
                    source: e,
                });
            }
            _ => {}
        }
    }
    Ok(())
}
