//! Checks that a run still writes where it began: other programs may move or remove its directory or files.

use super::lock::{LOCK, Lock};
use super::{CASE, HISTORY, MANIFEST, RunDirectory, RunError};
use crate::study::Row;
use std::fs::{File, Metadata};
use std::path::Path;

/// A directory that is held open, so that its identity stays unique.
#[derive(Debug)]
pub(super) struct Folder(Option<File>);

impl Folder {
    /// Opens a directory. Where the system does not open directories, it does not let them be moved either.
    pub fn open(path: &Path) -> Self {
        Self(File::open(path).ok())
    }

    /// Returns whether the directory is still at its path.
    fn is_at(&self, path: &Path) -> bool {
        match &self.0 {
            Some(folder) => is_at(folder, path),
            None => path.is_dir(),
        }
    }
}

/// Returns whether a path leads to an open file.
pub(super) fn is_at(file: &File, path: &Path) -> bool {
    match (file.metadata(), path.metadata()) {
        (Ok(open), Ok(found)) => is_same(&open, &found),
        _ => false,
    }
}

#[cfg(unix)]
fn is_same(a: &Metadata, b: &Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    (a.dev(), a.ino()) == (b.dev(), b.ino())
}

#[cfg(not(unix))]
fn is_same(_: &Metadata, _: &Metadata) -> bool {
    true
}

impl RunDirectory {
    /// Checks that the directory is still at its path.
    ///
    /// # Errors
    /// [`RunError::Moved`] if it was removed, moved or replaced.
    pub(super) fn check_place(&self) -> Result<(), RunError> {
        match self.folder.is_at(&self.path) {
            true => Ok(()),
            false => Err(RunError::Moved(self.path.clone())),
        }
    }

    /// Checks that the files of a run in progress are as this process left them.
    ///
    /// # Errors
    /// [`RunError::Moved`] as [`RunDirectory::check_place`]; [`RunError::Changed`] if a file was removed or changed.
    pub(super) fn check_files(&self) -> Result<(), RunError> {
        self.check_place()?;
        let is_locked = |lock: &Lock| lock.is_at(&self.path);
        let history = self.path.join(HISTORY);
        let is_written = |file: &File| {
            is_at(file, &history)
                && history
                    .metadata()
                    .is_ok_and(|about| about.len() == self.history_length)
        };
        let sound = [
            (LOCK, self.lock.as_ref().is_none_or(is_locked)),
            (MANIFEST, self.path.join(MANIFEST).is_file()),
            (CASE, self.path.join(CASE).is_file()),
            (HISTORY, self.history.as_ref().is_none_or(is_written)),
        ];
        match sound.into_iter().find(|(_, is_sound)| !is_sound) {
            None => Ok(()),
            Some((name, _)) => Err(RunError::Changed(self.path.join(name))),
        }
    }

    /// Writes the files again that [`RunDirectory::check_files`] misses, except for the manifest.
    ///
    /// # Errors
    /// [`RunError::Busy`] if another process works in the directory by now; [`RunError::File`] if a file cannot be written.
    pub(super) fn restore(&mut self, rows: &[Row]) -> Result<(), RunError> {
        self.check_place()?;
        if self
            .lock
            .as_ref()
            .is_none_or(|lock| !lock.is_at(&self.path))
        {
            self.lock = Some(Lock::take(&self.path)?);
        }
        if !self.path.join(CASE).is_file() {
            self.write(CASE, &self.case)?;
        }
        self.write_history(rows)
    }
}
