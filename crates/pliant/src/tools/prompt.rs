//! Threads for questions that the window waits for. Those that all of the program shares may be in the middle of an
//! iteration, and take up nothing else before its end: a pass of a millisecond then waited for thirty (measured while painting
//! 100,000 vertices). These compete with them for the processors, which the system shares out fairly.

use std::sync::OnceLock;

use rayon::{ThreadPool, ThreadPoolBuilder};

/// Runs `work`, whose parallel loops are then carried out by threads that do nothing else.
pub(super) fn promptly<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    static THREADS: OnceLock<Option<ThreadPool>> = OnceLock::new();
    let name = |thread| format!("prompt {thread}");
    match THREADS.get_or_init(|| ThreadPoolBuilder::new().thread_name(name).build().ok()) {
        Some(threads) => threads.install(work),
        None => work(), // the system has no more threads
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::sync::Barrier;

    use super::*;

    #[test]
    fn a_question_is_answered_while_all_shared_threads_are_busy() {
        let n = rayon::current_num_threads();
        let [begun, ended] = [(); 2].map(|()| Arc::new(Barrier::new(n + 1)));
        for _ in 0..n {
            let (begun, ended) = (begun.clone(), ended.clone());
            rayon::spawn(move || _ = (begun.wait(), ended.wait()));
        }
        begun.wait();
        assert_eq!(promptly(|| rayon::join(|| 6, || 7)), (6, 7));
        ended.wait();
    }
}
