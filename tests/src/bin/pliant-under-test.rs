//! The program `pliant` once more, so that the tests can start it as a process whatever built them.

use std::process::ExitCode;

fn main() -> ExitCode {
    pliant::cli::main()
}
