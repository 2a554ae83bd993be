//! How many threads a command uses.

use crate::failure::Failure;

/// Uses so many threads, if a number is given.
pub fn limit(threads: Option<u16>) -> Result<(), Failure> {
    let Some(threads) = threads else {
        return Ok(());
    };
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads.into())
        .build_global()
        .map_err(|error| Failure::Usage(format!("{threads} threads: {error}")))
}
