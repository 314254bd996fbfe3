//! Other programs on the same files, by `tools/peers.py`.

use super::Failure;
use super::outside::Files;
use super::scene::Scene;
use crate::assets;
use std::path::Path;
use std::process::{Command, Stdio};

/// The script's tables, or a line that says what is missing.
pub(crate) fn tables(program: &Path, scenes: &[&Scene], folder: &Path, most: usize) -> Result<String, Failure> {
    let mut command = Command::new("python3");
    command.arg(assets::folder().with_file_name("tools").join("peers.py"));
    command.arg("--most-iterations").arg(most.to_string()).arg(program);
    for scene in scenes {
        let files = Files::write(scene, folder)?;
        command.arg(files.mesh).arg(files.handles);
    }
    let Ok(output) = command.stderr(Stdio::inherit()).output() else {
        return Ok("Left out: there is no `python3`.\n\n".to_owned());
    };
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    if output.status.success() {
        return Ok(text);
    }
    Ok(format!("{text}Left out: `tools/peers.py` did not end well; it says why when it is run by itself.\n\n"))
}
