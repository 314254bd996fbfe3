//! Broken and hostile mesh files, and the proof that none does harm.
//!
//! **Promise.** No file, however broken or hostile, ends the program, hangs it, eats the machine's memory or makes it
//! read another file; and a saving that is stopped leaves the old file or the new one.
//!
//! | module | what it does |
//! |---|---|
//! | [`crafted`] | makes files that are odd in one way, each with what must become of it |
//! | [`mutate`] | damages sound files, the same for the same seed |
//! | [`exercise`] | does with a file all that the program does: opening, saving, poses |
//! | `references` | lays out files that name others, with traps around them |
//! | [`run`] | does so in processes with limits |
//! | `trace` | looks at what the system was asked to open meanwhile |
//! | `interrupted` | stops savings at every call to the system, and has calls fail |
//!
//! The fuzz targets in `fuzz/` call the same [`exercise`], guided by coverage.

pub mod crafted;
pub mod exercise;
#[cfg(target_os = "linux")]
pub mod interrupted;
pub mod mutate;
pub mod random;
#[cfg(target_os = "linux")]
pub mod references;
pub mod run;
#[cfg(target_os = "linux")]
pub mod strace;
#[cfg(target_os = "linux")]
pub mod trace;
