//! Reuse of large buffers.
//!
//! The system clears every new page of memory when it is first used. A Newton step on the paper's mesh fills about 600 MB,
//! for which that took a second of CPU time on two threads, as long as the step itself.

use std::sync::Mutex;

/// Objects whose buffers are free for reuse.
#[derive(Debug)]
pub struct Buffers<T>(Mutex<Vec<T>>);

impl<T> Default for Buffers<T> {
    fn default() -> Self {
        Self(Mutex::new(vec![]))
    }
}

impl<T> Buffers<T> {
    /// Takes an object, if there is any; its content is undefined.
    pub fn take(&self) -> Option<T> {
        self.0.lock().ok()?.pop()
    }

    /// Returns an object for reuse, if there is one.
    pub fn give_some(&self, object: Option<T>) {
        if let Some(object) = object {
            self.give(object);
        }
    }

    /// Returns an object for reuse.
    pub fn give(&self, object: T) {
        if let Ok(mut free) = self.0.lock() {
            free.push(object);
        }
    }
}
