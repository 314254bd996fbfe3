//! Runs every test of the workspace and ends with one line that sums them up.
//!
//! With cargo-nextest where it is installed (it runs the tests of all crates side by side; examples in the documentation
//! then come extra), else with `cargo test`.

use crate::failure::Failure;
use crate::vulkan;
use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Command, Stdio};

/// How many tests passed and failed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Totals {
    passed: usize,
    failed: usize,
}

/// Runs all tests, or those that `filter` (arguments for the runner) chooses.
pub(crate) fn run(filter: &[String]) -> Result<(), Failure> {
    vulkan::ensure()?;
    let (mut totals, mut all_well) = (Totals::default(), true);
    for arguments in runs(has_nextest(), filter) {
        eprintln!("cargo {}", arguments.join(" "));
        all_well &= run_cargo(&arguments, &mut totals)?;
    }
    eprintln!("{} passed, {} failed", totals.passed, totals.failed);
    if all_well { Ok(()) } else { Err(Failure::TestsFailed) }
}

/// The commands that together run every test; all go on after a failure, so that one run tells everything.
fn runs(nextest: bool, filter: &[String]) -> Vec<Vec<String>> {
    let commands: &[&[&str]] = if nextest {
        &[
            &["nextest", "run", "--workspace", "--no-fail-fast", "--no-tests", "pass"],
            &["test", "--workspace", "--doc", "--no-fail-fast"],
        ]
    } else {
        &[&["test", "--workspace", "--no-fail-fast"]]
    };
    let with_filter = |c: &&[&str]| c.iter().map(|a| a.to_string()).chain(filter.iter().cloned()).collect();
    commands.iter().map(with_filter).collect()
}

fn has_nextest() -> bool {
    let asked = cargo().args(["nextest", "--version"]).stdout(Stdio::null()).stderr(Stdio::null()).status();
    asked.is_ok_and(|status| status.success())
}

/// The cargo that runs this, else the one in the path.
fn cargo() -> Command {
    Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}

/// Runs cargo, passes on all it prints and adds up the totals in it; whether it succeeded.
fn run_cargo(arguments: &[String], totals: &mut Totals) -> Result<bool, Failure> {
    let color = if std::io::IsTerminal::is_terminal(&std::io::stderr()) { "always" } else { "never" };
    let mut command = cargo();
    command.args(arguments).env("CARGO_TERM_COLOR", color).stdout(Stdio::piped()).stderr(Stdio::piped());
    let start = |source| Failure::Start { program: "cargo".into(), source };
    let mut child = command.spawn().map_err(start)?;
    // nextest sums up on stderr, `cargo test` on stdout.
    let (out, err) = (child.stdout.take(), child.stderr.take());
    let (from_out, from_err) = std::thread::scope(|scope| {
        let out = scope.spawn(|| out.map(|pipe| pass_on(pipe, std::io::stdout())).unwrap_or_default());
        let err = err.map(|pipe| pass_on(pipe, std::io::stderr())).unwrap_or_default();
        (out.join().unwrap_or_default(), err)
    });
    for part in [from_out, from_err] {
        totals.passed += part.passed;
        totals.failed += part.failed;
    }
    child.wait().map(|status| status.success()).map_err(start)
}

/// Copies lines as they come and adds up the totals they name.
fn pass_on(from: impl Read, mut to: impl Write) -> Totals {
    let mut totals = Totals::default();
    for line in BufReader::new(from).split(b'\n').map_while(Result::ok) {
        // Nobody listening is no reason to stop counting.
        let _ = to.write_all(&line).and_then(|()| to.write_all(b"\n")).and_then(|()| to.flush());
        if let Some(found) = totals_in(&without_colors(&String::from_utf8_lossy(&line))) {
            totals.passed += found.passed;
            totals.failed += found.failed;
        }
    }
    totals
}

/// The totals in a runner's closing line: `test result: ok. 3 passed; 0 failed; …` of the built-in harness, or `Summary
/// [ 1.2s] 5 tests run: 4 passed (1 slow), 1 failed, 0 skipped` of nextest.
fn totals_in(line: &str) -> Option<Totals> {
    // nextest indents what a failed test printed, where the harness sums up just this one.
    let sums_up = line.starts_with("test result:") || line.trim_start().starts_with("Summary [");
    if !sums_up {
        return None;
    }
    let words: Vec<&str> = line.split([' ', ',', ';']).filter(|w| !w.is_empty()).collect();
    let count = |what: &[&str]| -> usize {
        let before = words.windows(2).filter(|pair| what.contains(&pair[1]));
        before.filter_map(|pair| pair[0].parse::<usize>().ok()).sum()
    };
    // What ran out of time or could not be started has not passed either.
    Some(Totals { passed: count(&["passed"]), failed: count(&["failed", "timed", "exec"]) })
}

fn without_colors(line: &str) -> String {
    let mut plain = String::new();
    for (i, piece) in line.split('\u{1b}').enumerate() {
        plain.push_str(if i == 0 { piece } else { piece.split_once('m').map_or("", |(_, rest)| rest) });
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn totals_of_both_runners_are_understood() {
        let cases = [
            (
                "test result: ok. 21 passed; 0 failed; 0 ignored; 0 measured; 0 filtered out; finished in 1.20s",
                Some((21, 0)),
            ),
            ("test result: FAILED. 2 passed; 3 failed; 0 ignored; 0 measured; 0 filtered out", Some((2, 3))),
            ("     Summary [   1.215s] 21 tests run: 21 passed, 0 skipped", Some((21, 0))),
            ("     Summary [   1.215s] 9 tests run: 6 passed (1 slow), 2 failed, 1 timed out, 4 skipped", Some((6, 3))),
            (
                "\u{1b}[32;1m     Summary\u{1b}[0m [   0.1s] \u{1b}[1m2\u{1b}[0m tests run: \u{1b}[1m2\u{1b}[0m \u{1b}[32;1mpassed\u{1b}[0m, 0 skipped",
                Some((2, 0)),
            ),
            ("    test result: FAILED. 0 passed; 1 failed; 0 ignored", None),
            ("test shapes::bar ... ok", None),
            ("error: 3 failed", None),
        ];
        for (line, expected) in cases {
            let got = totals_in(&without_colors(line)).map(|t| (t.passed, t.failed));
            assert_eq!(got, expected, "{line}");
        }
    }

    #[test]
    fn examples_in_the_documentation_run_with_either_runner() {
        let with = runs(true, &[]);
        assert!(with[0].contains(&"nextest".to_string()) && with[1].contains(&"--doc".to_string()));
        assert_eq!(runs(false, &["name".to_string()]), [["test", "--workspace", "--no-fail-fast", "name"]]);
    }

    #[test]
    fn all_that_a_runner_prints_is_passed_on() {
        let printed = b"one\n\xff two\ntest result: ok. 4 passed; 1 failed;\n";
        let mut copy = Vec::new();
        assert_eq!(pass_on(&printed[..], &mut copy), Totals { passed: 4, failed: 1 });
        assert_eq!(copy, printed);
    }
}
