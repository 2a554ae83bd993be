//! One run, one owner.

use super::StudyError;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Read, Write};
use std::path::Path;

/// Name of the file that is locked.
pub(super) const LOCK: &str = "lock";

/// What Linux says (ENOLCK) of a file system whose locks are not served.
const NO_LOCKS: i32 = 37;

/// A run directory as one's own. The system lets go of it when the process ends, however that ends, so that none is ever stale.
#[derive(Debug)]
pub(super) struct Lock(File);

impl Lock {
    /// Takes a directory for this process.
    ///
    /// # Errors
    /// [`StudyError::Busy`] if another process has it. Where the file system knows no locks there is none, and no error.
    pub fn take(directory: &Path) -> Result<Self, StudyError> {
        let path = directory.join(LOCK);
        let trouble = |source| StudyError::File {
            path: path.clone(),
            source,
        };
        if path.is_symlink() {
            let why = "is a link, and a run keeps its own; remove it";
            return Err(trouble(std::io::Error::other(why)));
        }
        let options = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .clone();
        let mut file = options.open(&path).map_err(trouble)?;
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => {
                let mut owner = String::new();
                let _ = file.take(200).read_to_string(&mut owner);
                return Err(StudyError::Busy {
                    path: directory.to_owned(),
                    owner: owner.trim().to_owned(),
                });
            }
            Err(TryLockError::Error(error))
                if error.kind() != std::io::ErrorKind::Unsupported
                    && error.raw_os_error() != Some(NO_LOCKS) =>
            {
                return Err(trouble(error));
            }
            _ => {}
        }
        // For whoever comes meanwhile; without it they are told less.
        let _ = file.set_len(0);
        let _ = writeln!(file, "process {}", std::process::id());
        Ok(Self(file))
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        let _ = self.0.set_len(0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_directory_has_one_owner_at_a_time() {
        let path = std::env::temp_dir().join(format!("plica-lock-{}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        let mine = Lock::take(&path).unwrap();
        let Err(StudyError::Busy { owner, .. }) = Lock::take(&path) else {
            panic!("taken twice");
        };
        assert_eq!(owner, format!("process {}", std::process::id()));
        drop(mine);
        // What a process that was killed has left in it is no lock.
        std::fs::write(path.join(LOCK), "process 1\n").unwrap();
        drop(Lock::take(&path).unwrap());
        assert_eq!(std::fs::read(path.join(LOCK)).unwrap(), b"");
        std::fs::remove_dir_all(path).unwrap();
    }
}
