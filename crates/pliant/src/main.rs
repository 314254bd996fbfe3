//! The program `pliant`: the editor, or one of the commands.

use std::process::ExitCode;

fn main() -> ExitCode {
    pliant::cli::main()
}
