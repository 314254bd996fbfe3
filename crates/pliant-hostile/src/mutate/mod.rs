//! Damage to sound files, the same for the same seed.
//!
//! **Idea.** Damage that any byte may take tests scanners and containers; what lies behind them is reached only by files
//! that are right but for one thing. So half of the damage is done to what a file means: its JSON, its numbers, its
//! lengths.

mod bytes;
mod json;
mod words;

use crate::crafted::{self, Case};
use crate::random::Random;

/// A damaged file.
#[derive(Clone, Debug)]
pub struct Damaged {
    /// The sound file it was made of.
    pub from: String,
    /// Ending of its name.
    pub extension: &'static str,
    /// Its content.
    pub bytes: Vec<u8>,
}

/// Makes damaged files.
#[derive(Debug)]
pub struct Mutator {
    seeds: Vec<Case>,
    /// Endings of all formats, which take turns.
    extensions: Vec<&'static str>,
    seed: u64,
}

impl Mutator {
    /// One for a seed.
    pub fn new(seed: u64) -> Mutator {
        let seeds = crafted::seeds();
        let mut extensions: Vec<&str> = seeds.iter().map(|case| case.extension).collect();
        extensions.sort_unstable();
        extensions.dedup();
        Mutator { seeds, extensions, seed }
    }

    /// File `index`, whatever was asked for before.
    pub fn damaged(&self, index: u64) -> Damaged {
        let mut random = Random::new(self.seed ^ index.wrapping_mul(0xD134_2543_DE82_EF95));
        let extension = self.extensions[index as usize % self.extensions.len()];
        let of_format: Vec<&Case> = self.seeds.iter().filter(|case| case.extension == extension).collect();
        let seed = *random.pick(&of_format);
        let other = *random.pick(&of_format);
        let mut bytes = seed.bytes.clone();
        for _ in 0..=random.below(4) {
            bytes = match (extension, random.below(6)) {
                ("gltf" | "glb", 0..4) => json::edited(&bytes, &mut random).unwrap_or(bytes),
                ("obj" | "off" | "ply" | "stl", 0..3) => words::edited(&bytes, &mut random),
                _ => bytes::damaged(bytes, &other.bytes, &mut random),
            };
        }
        Damaged { from: seed.name.clone(), extension, bytes }
    }
}
