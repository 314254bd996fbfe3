//! Taking times.

use std::time::{Duration, Instant};

/// Repetitions, unless they take longer than this together.
const REPETITIONS: usize = 7;
const PATIENCE: Duration = Duration::from_secs(2);

/// The median of several runs; fewer where one takes long, but one at least.
pub(crate) fn median_of(mut run: impl FnMut()) -> Duration {
    timed_median(|| timed(&mut run).1)
}

/// The median of several times that a function takes itself.
pub(crate) fn timed_median(mut run: impl FnMut() -> Duration) -> Duration {
    let begun = Instant::now();
    let mut times = vec![run()];
    while times.len() < REPETITIONS && begun.elapsed() < PATIENCE {
        times.push(run());
    }
    median(times)
}

/// The middle one, or the later of the two in the middle.
pub(crate) fn median(mut times: Vec<Duration>) -> Duration {
    times.sort_unstable();
    times.get(times.len() / 2).copied().unwrap_or_default()
}

/// What a function returns and how long it takes.
pub(crate) fn timed<T>(run: impl FnOnce() -> T) -> (T, Duration) {
    let begun = Instant::now();
    let result = run();
    (result, begun.elapsed())
}
