//! The lock of a run directory: one process at a time works in it.

use super::RunError;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Read, Write};
use std::path::Path;
use std::time::Duration;

/// Name of the file that is locked.
pub(super) const LOCK: &str = "lock";

/// Error of Linux (ENOLCK) for a file system without locks.
const NO_LOCKS: i32 = 37;

/// Further attempts to lock a directory, and the time between them.
const ATTEMPTS: usize = 5;
const PAUSE: Duration = Duration::from_millis(10);

/// The lock of a run directory. The system releases it when the process ends, so no lock is ever stale.
#[derive(Debug)]
pub(super) struct Lock(File);

impl Lock {
    /// Locks a directory for this process.
    ///
    /// # Errors
    /// [`RunError::Busy`] if another process has locked it. A file system without locks is no error.
    pub fn take(directory: &Path) -> Result<Self, RunError> {
        let path = directory.join(LOCK);
        let error_at = |source| RunError::File {
            path: path.clone(),
            source,
        };
        if path.is_symlink() {
            let why = "is a symbolic link; remove it";
            return Err(error_at(std::io::Error::other(why)));
        }
        let options = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .clone();
        let mut file = options.open(&path).map_err(error_at)?;
        // Another process may just look at the lock.
        let mut attempt = file.try_lock();
        for _ in 0..ATTEMPTS {
            if !matches!(attempt, Err(TryLockError::WouldBlock)) {
                break;
            }
            std::thread::sleep(PAUSE);
            attempt = file.try_lock();
        }
        match attempt {
            Err(TryLockError::WouldBlock) => {
                return Err(busy(directory, file));
            }
            Err(TryLockError::Error(error))
                if error.kind() != std::io::ErrorKind::Unsupported
                    && error.raw_os_error() != Some(NO_LOCKS) =>
            {
                return Err(error_at(error));
            }
            _ => {}
        }
        // For the message of another process; it does not matter if this fails.
        let _ = file.set_len(0);
        let _ = writeln!(file, "process {}", std::process::id());
        Ok(Self(file))
    }

    /// Returns whether the file that is locked is still that of a directory.
    pub fn is_at(&self, directory: &Path) -> bool {
        super::presence::is_at(&self.0, &directory.join(LOCK))
    }

    /// Returns the process that works in a directory, if there is one.
    pub fn owner(directory: &Path) -> Option<RunError> {
        let file = File::open(directory.join(LOCK)).ok()?;
        match file.try_lock_shared() {
            Err(TryLockError::WouldBlock) => Some(busy(directory, file)),
            _ => None,
        }
    }
}

/// Returns the error of a directory that another process has locked.
fn busy(directory: &Path, lock: File) -> RunError {
    let mut owner = String::new();
    let _ = lock.take(200).read_to_string(&mut owner);
    RunError::Busy {
        path: directory.to_owned(),
        owner: owner.trim().to_owned(),
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
    fn one_process_at_a_time_locks_a_directory() {
        let path = std::env::temp_dir().join(format!("plica-lock-{}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        let mine = Lock::take(&path).unwrap();
        let Err(RunError::Busy { owner, .. }) = Lock::take(&path) else {
            panic!("taken twice");
        };
        assert_eq!(owner, format!("process {}", std::process::id()));
        drop(mine);
        // The text that a killed process has left is not a lock.
        std::fs::write(path.join(LOCK), "process 1\n").unwrap();
        drop(Lock::take(&path).unwrap());
        assert_eq!(std::fs::read(path.join(LOCK)).unwrap(), b"");
        std::fs::remove_dir_all(path).unwrap();
    }
}
