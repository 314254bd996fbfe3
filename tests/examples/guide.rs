//! Makes the pictures of `docs/guide.md`, each by Pliant itself: `cargo xtask guide` runs this.
//!
//! The window is drawn as a test draws it, at twice the size that is kept: averaging takes the grain out, which single
//! pixels of the picture have against bands.

mod guide {
    pub(crate) mod bars;
    pub(crate) mod scenes;
    pub(crate) mod stage;
}

use std::path::PathBuf;
use std::process::ExitCode;

fn main() -> ExitCode {
    let Some(folder) = std::env::args_os().nth(1).map(PathBuf::from) else {
        eprintln!("usage: guide FOLDER");
        return ExitCode::FAILURE;
    };
    match guide::bars::make(&folder).and_then(|()| guide::scenes::make(&folder)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("error: {why}");
            ExitCode::FAILURE
        }
    }
}
