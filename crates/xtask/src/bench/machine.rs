//! What the machine is and how fast it reads memory: the floor under everything that streams.

use super::clock::median_of;
use std::fs;
use std::hint::black_box;

/// Numbers read: 256 MiB, more than any cache.
const N_NUMBERS: usize = 32 << 20;

/// The machine by its own words.
pub(crate) struct Machine {
    model: String,
    n_threads: usize,
    /// Bytes a second, read by one and by two threads.
    pub(crate) bandwidth: [f64; 2],
}

impl Machine {
    /// Takes about half a second.
    pub(crate) fn measure() -> Machine {
        let numbers = vec![1.0; N_NUMBERS];
        let model = fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| {
            let line = text.lines().find(|line| line.starts_with("model name"))?;
            line.split_once(':').map(|(_, name)| name.trim().to_owned())
        });
        Machine {
            model: model.unwrap_or_else(|| format!("{} processor", std::env::consts::ARCH)),
            n_threads: std::thread::available_parallelism().map_or(1, usize::from),
            bandwidth: [1, 2].map(|n_threads| bandwidth(&numbers, n_threads)),
        }
    }

    /// One sentence.
    pub(crate) fn description(&self) -> String {
        let [one, two] = self.bandwidth.map(|bytes| bytes / 1e9);
        let Machine { model, n_threads, .. } = self;
        format!(
            "Machine: {model}, {n_threads} cores; one thread reads {one:.1} GB/s from memory, two read {two:.1} GB/s."
        )
    }
}

fn bandwidth(numbers: &[f64], n_threads: usize) -> f64 {
    let time = median_of(|| {
        std::thread::scope(|scope| {
            for part in numbers.chunks(numbers.len().div_ceil(n_threads)) {
                scope.spawn(|| black_box(sum(black_box(part))));
            }
        });
    });
    size_of_val(numbers) as f64 / time.as_secs_f64()
}

/// In 32 sums at once, so that reading is all that takes time.
fn sum(numbers: &[f64]) -> f64 {
    let mut sums = [0.0; 32];
    for chunk in numbers.chunks_exact(32) {
        sums.iter_mut().zip(chunk).for_each(|(sum, x)| *sum += x);
    }
    sums.iter().sum()
}
