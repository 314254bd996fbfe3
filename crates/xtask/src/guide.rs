//! Makes the pictures of `docs/guide.md` and of the dialog that says what rigidity means. The program that draws them is
//! an example of the tests' crate: it takes the same window in hand as the tests do.

use crate::failure::Failure;
use crate::vulkan;
use std::path::Path;
use std::process::Command;

/// Runs it, built as users have it.
pub(crate) fn run() -> Result<(), Failure> {
    vulkan::ensure()?;
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).expect("this crate lies in crates/xtask");
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(["run", "--release", "--package", "pliant-tests", "--example", "guide", "--"]);
    command.arg(workspace.join("docs/guide")).current_dir(workspace);
    let program = || "cargo run --example guide".to_owned();
    let status = command.status().map_err(|source| Failure::Start { program: program(), source })?;
    if status.success() { Ok(()) } else { Err(Failure::Stopped { program: program() }) }
}
