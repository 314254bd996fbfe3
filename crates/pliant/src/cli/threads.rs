//! `--threads`.

use super::failure::Failure;

/// Does the work with so many threads, or as many as there are cores.
pub(super) fn on_threads(
    threads: Option<usize>,
    work: impl FnOnce() -> Result<(), Failure> + Send,
) -> Result<(), Failure> {
    let threads = threads.unwrap_or(0);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|source| Failure::Threads { threads, source })?.install(work)
}
