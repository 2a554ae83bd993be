//! How many threads compute.

use crate::console;
use crate::failure::Failure;

/// Limits the threads to a number, if one is given; more than the machine has would only stand in each other's way.
pub fn limit(threads: Option<u16>) -> Result<(), Failure> {
    let Some(asked) = threads.map(usize::from) else {
        return Ok(());
    };
    let there = std::thread::available_parallelism().map_or(asked, usize::from);
    if asked > there {
        console::tell(&format!(
            "warning: {asked} threads are asked for, and this machine has {there}; {there} are used"
        ));
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(asked.min(there));
    pool.build_global()
        .map_err(|error| Failure::Fault(format!("no threads: {error}")))
}
