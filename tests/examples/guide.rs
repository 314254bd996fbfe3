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
        eprintln!("usage: guide FOLDER [SCENE…]");
        return ExitCode::FAILURE;
    };
    let wanted: Vec<String> = std::env::args().skip(2).collect();
    let is_wanted = |name: &str| wanted.is_empty() || wanted.iter().any(|other| other == name);
    let bars = if is_wanted("bars") { guide::bars::make(&folder) } else { Ok(()) };
    let scenes = guide::scenes::SCENES.iter().filter(|(name, _)| is_wanted(name));
    match bars.and_then(|()| scenes.map(|(_, scene)| scene).try_for_each(|scene| scene(&folder))) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("error: {why}");
            ExitCode::FAILURE
        }
    }
}
