//! Size of the thread pool.

use crate::args::Threads;
use crate::console;
use crate::failure::Failure;

/// Limits the thread pool to the given number of threads, at most as many as the machine has.
pub fn limit(threads: Threads) -> Result<(), Failure> {
    let Some(requested) = threads.number.map(usize::from) else {
        return Ok(());
    };
    let available = std::thread::available_parallelism().map_or(requested, usize::from);
    if requested > available {
        console::message(&format!(
            "warning: --threads {requested}: this machine has {available}; {available} are used"
        ));
    }
    rayon::ThreadPoolBuilder::new()
        .num_threads(requested.min(available))
        .build_global()
        .map_err(|error| Failure::Fault(format!("cannot start threads: {error}")))
}
