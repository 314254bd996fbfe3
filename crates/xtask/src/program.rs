//! Programs of this workspace that a command has built and run.

use crate::failure::Failure;
use std::ffi::OsStr;
use std::path::Path;
use std::process::Command;

/// The folder of the workspace.
pub(crate) fn workspace() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).expect("this crate lies in crates/xtask")
}

/// `cargo run` with these arguments, in the workspace.
pub(crate) fn run<S: AsRef<OsStr>>(name: &str, arguments: impl IntoIterator<Item = S>) -> Result<(), Failure> {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.arg("run").args(arguments).current_dir(workspace());
    let program = || format!("cargo run {name}");
    let status = command.status().map_err(|source| Failure::Start { program: program(), source })?;
    if status.success() { Ok(()) } else { Err(Failure::Stopped { program: program() }) }
}
