//! Where commands speak: results on standard output, progress, warnings and failures on standard error.

use std::fmt::Display;
use std::io::Write;
use std::time::{Duration, Instant};

/// Between two progress messages: fast enough to look alive, too slow to cost anything.
const PROGRESS_PERIOD: Duration = Duration::from_millis(100);

/// The two streams of one run of the program.
///
/// Write errors are ignored: a closed pipe (`pliant info … | head`) is not a failure of the command.
pub struct Console<'a> {
    out: &'a mut (dyn Write + Send),
    err: &'a mut (dyn Write + Send),
    progress: Progress,
    quiet: bool,
    /// What the progress is about, before each line of it.
    task: String,
}

enum Progress {
    Hidden,
    /// Nothing of it is on the screen at present.
    Clear {
        last: Option<Instant>,
    },
    /// A line without its end is on the screen.
    Shown {
        last: Instant,
    },
}

impl<'a> Console<'a> {
    /// Progress is shown only if `err_is_terminal`.
    pub fn new(out: &'a mut (dyn Write + Send), err: &'a mut (dyn Write + Send), err_is_terminal: bool) -> Self {
        let progress = if err_is_terminal { Progress::Clear { last: None } } else { Progress::Hidden };
        Console { out, err, progress, quiet: false, task: String::new() }
    }

    pub(super) fn set_quiet(&mut self, quiet: bool) {
        self.quiet = quiet;
        if quiet {
            self.clear_progress();
            self.progress = Progress::Hidden;
        }
    }

    /// Writes a result as it is.
    pub(super) fn print(&mut self, text: &str) {
        let _ = self.out.write_all(text.as_bytes());
        let _ = self.out.flush();
    }

    /// One line about what was done, unless quiet.
    pub(super) fn summarize(&mut self, line: &str) {
        if !self.quiet {
            self.clear_progress();
            let _ = writeln!(self.out, "{line}");
            let _ = self.out.flush();
        }
    }

    /// One line about something that went otherwise than asked, unless quiet.
    pub(super) fn warn(&mut self, line: &str) {
        if !self.quiet {
            self.clear_progress();
            let _ = writeln!(self.err, "warning: {}", one_line(line));
        }
    }

    /// The one line of a failure.
    pub(super) fn fail(&mut self, failure: &dyn Display) {
        self.clear_progress();
        let _ = writeln!(self.err, "pliant: {}", one_line(&failure.to_string()));
    }

    /// Writes a complaint about usage as it is.
    pub(super) fn complain(&mut self, text: &str) {
        let _ = self.err.write_all(text.as_bytes());
    }

    /// Says what the following progress is about; nothing for an empty text.
    pub(super) fn set_task(&mut self, task: String) {
        self.task = task;
    }

    /// Replaces the progress line by one about what may take long, however young the last one is.
    pub(super) fn stage(&mut self, what: &str) {
        match self.progress {
            Progress::Hidden => return,
            Progress::Clear { .. } | Progress::Shown { .. } => self.clear_progress(),
        }
        self.progress = Progress::Clear { last: None };
        self.progress(|| what.to_owned());
    }

    /// Replaces the progress line; does nothing unless a terminal is watching and the last one is old enough.
    pub(super) fn progress(&mut self, what: impl FnOnce() -> String) {
        let last = match self.progress {
            Progress::Hidden => return,
            Progress::Clear { last } => last,
            Progress::Shown { last } => Some(last),
        };
        if last.is_some_and(|last| last.elapsed() < PROGRESS_PERIOD) {
            return;
        }
        self.clear_progress();
        let _ = write!(self.err, "{}{}", self.task, one_line(&what()));
        let _ = self.err.flush();
        self.progress = Progress::Shown { last: Instant::now() };
    }

    /// Wipes the progress line; results follow.
    pub(super) fn clear_progress(&mut self) {
        if let Progress::Shown { last } = self.progress {
            // Carriage return, then erase to the end of the line.
            let _ = write!(self.err, "\r\x1b[K");
            let _ = self.err.flush();
            self.progress = Progress::Clear { last: Some(last) };
        }
    }
}

/// A failure is one line whatever a file name or a parser's message contains.
fn one_line(text: &str) -> String {
    let words = text.split(char::is_control).map(str::trim);
    words.filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(terminal: bool, quiet: bool, speak: impl FnOnce(&mut Console<'_>)) -> (String, String) {
        let (mut out, mut err) = (Vec::new(), Vec::new());
        let mut console = Console::new(&mut out, &mut err, terminal);
        console.set_quiet(quiet);
        speak(&mut console);
        let text = |bytes| String::from_utf8(bytes).expect("only text was written");
        (text(out), text(err))
    }

    #[test]
    fn a_failure_is_one_line_whatever_it_contains() {
        let (_, err) = said(false, true, |console| console.fail(&"cannot read a\nb\r\n\tc: \u{1b}[31mno"));
        assert_eq!(err, "pliant: cannot read a b c: [31mno\n");
    }

    #[test]
    fn a_stage_is_said_at_once_and_progress_names_its_task() {
        let speak = |console: &mut Console<'_>| {
            console.set_task("entry 1 of 2: ".to_owned());
            console.progress(|| "iteration 1".to_owned());
            console.progress(|| "too young".to_owned());
            console.stage("drawing");
        };
        assert_eq!(said(true, false, speak).1, "entry 1 of 2: iteration 1\r\x1b[Kentry 1 of 2: drawing");
        assert_eq!([said(false, false, speak).1, said(true, true, speak).1], ["", ""]);
    }

    #[test]
    fn progress_is_shown_to_terminals_only_and_wiped_before_anything_else() {
        let speak = |console: &mut Console<'_>| {
            console.progress(|| "iteration 1".to_owned());
            console.warn("careful");
        };
        assert_eq!(said(false, false, speak).1, "warning: careful\n");
        assert_eq!(said(true, true, speak).1, "");
        assert_eq!(said(true, false, speak).1, "iteration 1\r\x1b[Kwarning: careful\n");
    }
}
