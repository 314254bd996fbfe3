//! The command line: the document and the solver of the editor, without a window.
//!
//! ```text
//! arguments ── args ──▶ editor | deform | learn | compare | info | render ──▶ files, standard output
//!                                     │
//!                                  Failure ──▶ one line on standard error and an exit code
//! ```
//!
//! Exit codes: 0 done · 1 refused or failed, with no output file written or touched · 2 wrong usage · 3 no graphics
//! adapter or no display.
//!
//! Commands write through a [`Console`] and never to the process's own streams, so that a test can run them in its
//! own process and read what they said.

mod args;
mod compare;
mod console;
mod deform;
mod failure;
mod handles_file;
mod info;
mod learn;
mod render;
mod report;
mod rigidity;
mod solve;
mod staged;
mod surface;
mod threads;

pub use console::Console;

use std::ffi::OsString;
use std::io::IsTerminal;
use std::process::ExitCode;

use clap::Parser;

use args::{Arguments, Command};
use failure::Failure;

/// Runs the program with the process's own arguments and streams.
pub fn main() -> ExitCode {
    let (mut out, mut err) = (std::io::stdout(), std::io::stderr());
    let err_is_terminal = err.is_terminal();
    let mut console = Console::new(&mut out, &mut err, err_is_terminal);
    ExitCode::from(main_with(std::env::args_os(), &mut console))
}

/// Runs the program with `arguments` (the first is the program's own name) and returns its exit code.
///
/// Everything said goes to `console`. Only `pliant [FILE…]` opens a window.
pub fn main_with<I, T>(arguments: I, console: &mut Console<'_>) -> u8
where
    I: IntoIterator<Item = T>,
    T: Into<OsString> + Clone,
{
    let parsed = match Arguments::try_parse_from(arguments) {
        Ok(parsed) => parsed,
        Err(message) => return say_usage(&message, console),
    };
    console.set_quiet(parsed.quiet);
    match dispatch(parsed, console) {
        Ok(()) => 0,
        Err(Failure::Usage(message)) => say_usage(&message, console),
        Err(failure) => {
            console.fail(&failure);
            failure.exit_code()
        }
    }
}

fn dispatch(parsed: Arguments, console: &mut Console<'_>) -> Result<(), Failure> {
    match parsed.command {
        Some(Command::Deform(options)) => deform::run(&options, console),
        Some(Command::Compare(options)) => compare::run(&options, console),
        Some(Command::Learn(options)) => learn::run(&options, console),
        Some(Command::Info(options)) => info::run(&options, console),
        Some(Command::Render(options)) => render::run(&options, console),
        None => crate::editor::run(parsed.files).map_err(Failure::Editor),
    }
}

/// Help and version go to standard output with exit code 0, complaints to standard error with 2.
fn say_usage(message: &clap::Error, console: &mut Console<'_>) -> u8 {
    if message.use_stderr() {
        console.complain(&message.render().to_string());
        2
    } else {
        console.print(&message.render().to_string());
        0
    }
}
