//! Memory of large objects, kept to be used again.
//!
//! The system hands out new memory page by page, each cleared and entered into its tables when it is
//! first touched. At paper scale a Newton step fills some 600 MB, for which that took a second of
//! CPU time on two threads, as long as the step itself.

use std::sync::Mutex;

/// Objects whose memory is no longer in use.
#[derive(Debug)]
pub struct Spare<T>(Mutex<Vec<T>>);

impl<T> Default for Spare<T> {
    fn default() -> Self {
        Self(Mutex::new(vec![]))
    }
}

impl<T> Spare<T> {
    /// One of them, if there is any; what it holds is of no use.
    pub fn take(&self) -> Option<T> {
        self.0.lock().ok()?.pop()
    }

    /// Puts one by.
    pub fn give(&self, object: T) {
        if let Ok(mut spare) = self.0.lock() {
            spare.push(object);
        }
    }
}
