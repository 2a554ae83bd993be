//! Pictures of a run directory, embedded in a page.

use super::Run;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;

/// A picture from the run directory.
#[derive(Serialize)]
pub struct Picture {
    caption: &'static str,
    data: String,
}

impl Picture {
    /// Reads those of the given pictures that exist; each name comes with a caption.
    pub fn read_all(run: &Run<'_>, names: &[(&str, &'static str)]) -> Vec<Self> {
        let read = |&(name, caption): &(&str, &'static str)| {
            let data = STANDARD.encode(run.directory.read(name)?);
            Some(Self { caption, data })
        };
        names.iter().filter_map(read).collect()
    }
}
