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
use crate::exercise::{self, Outcome};
use crate::mutate::Mutator;
#[cfg(target_os = "linux")]
use crate::references::Traps;
use pliant_meshfile::Format;
use std::path::Path;

/// A list of files that every process makes for itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Batch {
    /// The crafted ones.
    Crafted,
    /// Damaged ones of a seed.
    Damaged(u64),
    /// Those that name other files.
    #[cfg(target_os = "linux")]
    References,
}

impl Batch {
    /// As an argument of a worker.
    fn argument(self) -> String {
        match self {
            Batch::Crafted => "crafted".into(),
            Batch::Damaged(seed) => seed.to_string(),
            #[cfg(target_os = "linux")]
            Batch::References => "references".into(),
        }
    }

    /// From an argument of a worker.
    pub fn parse(argument: &str) -> Option<Batch> {
        match argument {
            "crafted" => Some(Batch::Crafted),
            #[cfg(target_os = "linux")]
            "references" => Some(Batch::References),
            seed => seed.parse().ok().map(Batch::Damaged),
        }
    }

    /// The files, by number.
    pub fn files(self) -> std::io::Result<Files> {
        Ok(match self {
            Batch::Crafted => Files::Crafted(crafted::all()),
            Batch::Damaged(seed) => Files::Damaged(Mutator::new(seed)),
            #[cfg(target_os = "linux")]
            Batch::References => Files::References(Traps::new()?),
        })
    }
}

/// Files by number.
#[derive(Debug)]
pub enum Files {
    /// With their expected outcomes.
    Crafted(Vec<crafted::Case>),
    /// As many as one asks for.
    Damaged(Mutator),
    /// In a folder with traps.
    #[cfg(target_os = "linux")]
    References(Traps),
}

impl Files {
    /// What file `index` is.
    pub fn name(&self, index: u64) -> String {
        match self {
            Files::Crafted(cases) => cases[index as usize].name.clone(),
            Files::Damaged(mutator) => format!("number {index} from {}", mutator.damaged(index).from),
            #[cfg(target_os = "linux")]
            Files::References(traps) => traps.case(index as usize).0.to_owned(),
        }
    }

    /// Ending of the name of file `index`, and its content; nothing for files that mean something in their folder only.
    pub fn content(&self, index: u64) -> Option<(&'static str, Vec<u8>)> {
        match self {
            Files::Crafted(cases) => {
                let case = &cases[index as usize];
                Some((case.extension, case.bytes.clone()))
            }
            Files::Damaged(mutator) => {
                let damaged = mutator.damaged(index);
                Some((damaged.extension, damaged.bytes))
            }
            #[cfg(target_os = "linux")]
            Files::References(_) => None,
        }
    }

    /// Opens file `index`, saves it into `scratch` and asks for its poses.
    fn exercise(&self, index: u64, scratch: &Path) -> Outcome {
        #[cfg(target_os = "linux")]
        if let Files::References(traps) = self {
            return traps.try_one(index as usize, scratch);
        }
        let (extension, bytes) = self.content(index).expect("all others have a content");
        let format = Format::of(&Path::new("x").with_extension(extension)).expect("made files have known endings");
        exercise::in_memory(&bytes, format, scratch)
    }

    /// Why an outcome is not what must become of file `index`, if it is not.
    fn complaint(&self, index: u64, outcome: &Outcome) -> Option<String> {
        let expected = match self {
            Files::Crafted(cases) => &cases[index as usize].expected,
            Files::Damaged(_) => return None,
            #[cfg(target_os = "linux")]
            Files::References(traps) => traps.case(index as usize).1,
        };
        (!expected.is(outcome)).then(|| format!("{outcome:?} instead of {expected:?}"))
    }
}
