//! Makes the pictures of `docs/guide.md` and of the dialog that says what rigidity means. The program that draws them is
//! an example of the tests' crate: it takes the same window in hand as the tests do.

use crate::failure::Failure;
use crate::{program, vulkan};
use std::ffi::OsString;

/// Runs it, built as users have it.
pub(crate) fn run() -> Result<(), Failure> {
    vulkan::ensure()?;
    let arguments = ["--release", "--package", "pliant-tests", "--example", "guide", "--"].map(OsString::from);
    program::run("--example guide", arguments.into_iter().chain([program::workspace().join("docs/guide").into()]))
}
