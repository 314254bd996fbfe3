//! Files tried in processes of their own, so that a crash, a hang or hunger for memory ends only one of those and names
//! the file.
//!
//! A worker says which file it is about to open before it does so. When it ends without having said how that went, the
//! file is to blame, and the next worker goes on behind it.

mod limits;
mod pool;
mod worker;

pub use limits::{CPU_SECONDS, MEMORY_BYTES};
pub use pool::{Report, Trouble, run};
pub use worker::work;

use crate::crafted;
use crate::exercise::Outcome;
use crate::mutate::Mutator;

/// A list of files that every process makes for itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Batch {
    /// The crafted ones.
    Crafted,
    /// Damaged ones of a seed.
    Damaged(u64),
}

impl Batch {
    /// As an argument of a worker.
    fn argument(self) -> String {
        match self {
            Batch::Crafted => "crafted".into(),
            Batch::Damaged(seed) => seed.to_string(),
        }
    }

    /// From an argument of a worker.
    pub fn parse(argument: &str) -> Option<Batch> {
        match argument {
            "crafted" => Some(Batch::Crafted),
            seed => seed.parse().ok().map(Batch::Damaged),
        }
    }

    /// The files, by number.
    pub fn files(self) -> Files {
        match self {
            Batch::Crafted => Files::Crafted(crafted::all()),
            Batch::Damaged(seed) => Files::Damaged(Mutator::new(seed)),
        }
    }
}

/// Files by number.
#[derive(Debug)]
pub enum Files {
    /// With their expected outcomes.
    Crafted(Vec<crafted::Case>),
    /// As many as one asks for.
    Damaged(Mutator),
}

impl Files {
    /// What file `index` is, the ending of its name, and its content.
    pub fn get(&self, index: u64) -> (String, &'static str, Vec<u8>) {
        match self {
            Files::Crafted(cases) => {
                let case = &cases[index as usize];
                (case.name.clone(), case.extension, case.bytes.clone())
            }
            Files::Damaged(mutator) => {
                let damaged = mutator.damaged(index);
                (format!("number {index} from {}", damaged.from), damaged.extension, damaged.bytes)
            }
        }
    }

    /// Why an outcome is not what must become of file `index`, if it is not.
    fn complaint(&self, index: u64, outcome: &Outcome) -> Option<String> {
        let Files::Crafted(cases) = self else { return None };
        let expected = &cases[index as usize].expected;
        (!expected.is(outcome)).then(|| format!("{outcome:?} instead of {expected:?}"))
    }
}
