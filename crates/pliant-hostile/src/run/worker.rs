//! The inside of a worker.

use super::{Batch, limits};
use crate::exercise::{self, Outcome};
use std::io::Write;

/// Tries files `from..to` of a batch, and says on stdout how it goes: `begin INDEX`, then `opened INDEX MS KB VERTICES` or
/// `refused INDEX MS KB MESSAGE`.
pub fn work(batch: Batch, from: u64, to: u64) -> std::io::Result<()> {
    let files = batch.files()?;
    let scratch = exercise::scratch()?;
    limits::limit_memory();
    let mut out = std::io::stdout().lock();
    for index in from..to {
        writeln!(out, "begin {index}")?;
        out.flush()?;
        limits::limit_time();
        limits::peak_kb();
        let start = limits::cpu_ms();
        let outcome = files.exercise(index, scratch.path());
        let cost = format!("{index} {} {}", limits::cpu_ms() - start, limits::peak_kb());
        match outcome {
            Outcome::Opened(n) => writeln!(out, "opened {cost} {n}")?,
            Outcome::Refused(message) => writeln!(out, "refused {cost} {message}")?,
        }
        out.flush()?;
    }
    Ok(())
}
