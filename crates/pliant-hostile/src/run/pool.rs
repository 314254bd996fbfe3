//! The outside of the workers.

use super::{Batch, limits};
use crate::exercise::Outcome;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Files that one worker tries before the next starts: enough that starting it costs little, and few enough that memory
/// it does not give back would show.
const PER_WORKER: u64 = 250;
/// A file that waits instead of working (for a pipe, a lock) is ended after so long on the clock. Far beyond the limit
/// of processor time: a busy machine makes slow, not stuck.
const STUCK: Duration = Duration::from_secs(120);

/// A file that did harm, or became something else than it must.
#[derive(Clone, Debug)]
pub struct Trouble {
    /// Its number in the batch.
    pub index: u64,
    /// What it is.
    pub name: String,
    /// What happened.
    pub what: String,
}

/// How a run went.
#[derive(Debug, Default)]
pub struct Report {
    /// Files that opened.
    pub opened: u64,
    /// Files that were refused.
    pub refused: u64,
    /// Files that did harm, by number.
    pub troubles: Vec<Trouble>,
    /// The most processor time of a file, in milliseconds, and its number.
    pub slowest: (u64, u64),
    /// The most memory while a file was tried, in kilobytes, and its number.
    pub largest: (u64, u64),
}

/// Tries files `0..n` of a batch in workers of `program`, or as many as can be begun before `until`.
pub fn run(program: &Path, batch: Batch, n: u64, until: Option<Instant>) -> std::io::Result<Report> {
    let next = AtomicU64::new(0);
    let report = Mutex::new(Report::default());
    let n_workers = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        let workers: Vec<_> =
            (0..n_workers).map(|_| scope.spawn(|| take_turns(program, batch, n, until, &next, &report))).collect();
        workers.into_iter().try_for_each(|worker| worker.join().expect("a thread that only counts"))
    })?;
    let mut report = report.into_inner().unwrap_or_else(PoisonError::into_inner);
    report.troubles.sort_by_key(|trouble| trouble.index);
    Ok(report)
}

fn take_turns(
    program: &Path,
    batch: Batch,
    n: u64,
    until: Option<Instant>,
    next: &AtomicU64,
    report: &Mutex<Report>,
) -> std::io::Result<()> {
    let files = batch.files()?;
    loop {
        let from = next.fetch_add(PER_WORKER, Ordering::Relaxed);
        if from >= n || until.is_some_and(|until| Instant::now() > until) {
            return Ok(());
        }
        let (mut at, to) = (from, n.min(from + PER_WORKER));
        while at < to {
            let mut tally = Report::default();
            at = one_worker(program, batch, at, to, &mut |index, outcome, cost| {
                tally.count(index, outcome, cost, files.complaint(index, outcome), || files.name(index));
            })?
            .map_or(to, |(index, what)| {
                tally.troubles.push(Trouble { index, name: files.name(index), what });
                index + 1
            });
            report.lock().unwrap_or_else(PoisonError::into_inner).add(tally);
        }
    }
}

impl Report {
    fn count(
        &mut self,
        index: u64,
        outcome: &Outcome,
        cost: (u64, u64),
        complaint: Option<String>,
        name: impl Fn() -> String,
    ) {
        match outcome {
            Outcome::Opened(_) => self.opened += 1,
            Outcome::Refused(_) => self.refused += 1,
        }
        self.slowest = self.slowest.max((cost.0, index));
        self.largest = self.largest.max((cost.1, index));
        let slow = cost.0 > limits::CPU_SECONDS * 1000;
        let late = slow.then(|| format!("took {} ms of processor time", cost.0));
        for what in complaint.into_iter().chain(late) {
            self.troubles.push(Trouble { index, name: name(), what });
        }
    }

    fn add(&mut self, other: Report) {
        self.opened += other.opened;
        self.refused += other.refused;
        self.troubles.extend(other.troubles);
        self.slowest = self.slowest.max(other.slowest);
        self.largest = self.largest.max(other.largest);
    }
}

/// Takes the number of a file, what became of it, and what it cost in milliseconds and kilobytes.
type Told<'a> = &'a mut dyn FnMut(u64, &Outcome, (u64, u64));

/// Runs a worker to its end; the file that ended it early, and how, if one did.
fn one_worker(
    program: &Path,
    batch: Batch,
    from: u64,
    to: u64,
    told: Told<'_>,
) -> std::io::Result<Option<(u64, String)>> {
    let mut worker = Command::new(program)
        .args(["worker", &batch.argument(), &from.to_string(), &to.to_string()])
        .env("RUST_BACKTRACE", "0")
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()?;
    let (lines, stderr) = (worker.stdout.take(), worker.stderr.take());
    let (send, receive) = channel();
    let read_lines = move || {
        for line in lines.into_iter().flat_map(|lines| BufReader::new(lines).lines()).map_while(Result::ok) {
            if send.send(line).is_err() {
                return;
            }
        }
    };
    let read_errors = move || {
        let mut text = String::new();
        stderr.into_iter().for_each(|mut stderr| drop(stderr.read_to_string(&mut text)));
        text
    };
    let (reader, errors) = (std::thread::spawn(read_lines), std::thread::spawn(read_errors));
    let (mut open, mut stuck) = (Some(from), false);
    loop {
        match receive.recv_timeout(STUCK) {
            Ok(line) => open = heard(&line, told),
            Err(RecvTimeoutError::Disconnected) => break,
            Err(RecvTimeoutError::Timeout) => {
                stuck = true;
                worker.kill()?;
            }
        }
    }
    let status = worker.wait()?;
    let _ = reader.join();
    let said = errors.join().unwrap_or_default();
    let how = if stuck { format!("waited for {} s", STUCK.as_secs()) } else { ended(status, &said) };
    Ok(match open {
        Some(index) => Some((index, how)),
        None if status.success() => None,
        None => Some((to - 1, format!("its worker ended badly: {how}"))),
    })
}

/// Takes in a line of a worker; the file that it is about to try, if it says so.
fn heard(line: &str, told: Told<'_>) -> Option<u64> {
    let mut words = line.splitn(5, ' ');
    let keyword = words.next()?;
    let index = words.next()?.parse().ok()?;
    if keyword == "begin" {
        return Some(index);
    }
    let cost = (words.next()?.parse().ok()?, words.next()?.parse().ok()?);
    let rest = words.next().unwrap_or_default();
    let outcome = match keyword {
        "opened" => Outcome::Opened(rest.parse().ok()?),
        _ => Outcome::Refused(rest.to_owned()),
    };
    told(index, &outcome, cost);
    None
}

fn ended(status: ExitStatus, said: &str) -> String {
    let said = said.trim();
    let last: Vec<&str> = said.lines().filter(|line| !line.starts_with("note:")).collect();
    format!("{status}: {}", last.join(" / "))
}
