//! What a process asks of the system, seen and disturbed through strace.

use std::io::{Error, Result};
use std::path::Path;
use std::process::{Command, Output, Stdio};

/// Whether strace is there and may look at processes, else what to do about it.
pub fn check() -> Result<()> {
    let tried = Command::new("strace").args(["-o", "/dev/null", "true"]).stdin(Stdio::null()).output();
    match tried {
        Ok(output) if output.status.success() => Ok(()),
        Ok(output) => {
            let said = String::from_utf8_lossy(&output.stderr).trim().replace('\n', " / ");
            Err(Error::other(format!("strace cannot look at processes here: {said}")))
        }
        Err(error) => {
            Err(Error::other(format!("strace cannot be started ({error}); install it: apt-get install strace")))
        }
    }
}

/// Runs `program` under strace with `options`, and gives how it ended and the lines of the trace.
pub fn traced(options: &[&str], program: &Path, arguments: &[&str]) -> Result<(Output, Vec<String>)> {
    let log = tempfile::NamedTempFile::new()?;
    let output = Command::new("strace")
        .args(["-f", "-y", "-s", "4096", "-o"])
        .arg(log.path())
        .args(options)
        .arg(program)
        .args(arguments)
        .env("RUST_BACKTRACE", "0")
        .stdin(Stdio::null())
        .output()?;
    let text = std::fs::read(log.path())?;
    // A line begins with the number of the process.
    let call = |line: &str| line.trim_start().split_once(' ').map_or("", |(_, call)| call).trim_start().to_owned();
    Ok((output, String::from_utf8_lossy(&text).lines().map(call).collect()))
}

/// The names of files in a line of a trace: what was asked for in quotes, and what an opened number stands for in angles.
pub fn names(call: &str) -> Vec<String> {
    // The folder that relative names begin in; there are none.
    let parts = call.split("AT_FDCWD<").enumerate();
    let call: String =
        parts.map(|(i, part)| if i == 0 { part } else { part.split_once('>').map_or("", |p| p.1) }).collect();
    let mut names = Vec::new();
    for (open, close) in [('"', '"'), ('<', '>')] {
        let mut rest = call.as_str();
        while let Some((_, after)) = rest.split_once(open) {
            let Some((name, after)) = after.split_once(close) else { break };
            names.push(name.to_owned());
            rest = after;
        }
    }
    names
}
