//! Unsaved work on the disk, for the case that the program or the machine stops.
//!
//! Every window writes one project of its own into the platform's data folder: a minute after the first change that is not
//! saved, and again a minute after each further one, on a thread. It is removed as soon as nothing can be lost: when the work
//! was saved, or given up by the user. What is left there at the next start was left by a window that stopped.
//!
//! Beside each autosave lies a file that its window holds locked as long as it lives; the system lets go of the lock however the
//! process ends. A leftover is an autosave whose lock can be had. Having it keeps other windows from offering it too.

mod leftover;

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

pub use leftover::{Leftover, leftovers};

use crate::document::{Document, Snapshot};
use crate::project::{self, Contents};

/// At most this much work is lost.
pub(super) const EVERY: Duration = Duration::from_secs(60);

/// The autosave of one window.
pub struct Autosave {
    file: PathBuf,
    /// Locked as long as this window lives.
    lock: (PathBuf, File),
    /// When the next one is due, while there is something to write.
    due: Option<Instant>,
    /// What was last written, or is being written.
    last: Option<Snapshot>,
    writing: Option<Writing>,
    /// Leftovers that this document was made of: needed until it is safe itself.
    superseded: Vec<Arc<Leftover>>,
}

/// An autosave on its way to the disk.
struct Writing {
    thread: JoinHandle<Result<(), String>>,
    /// Whether it is about what is open now.
    is_wanted: bool,
}

impl Autosave {
    /// The autosave of a new window, in a folder that is made if need be.
    pub fn new(folder: &Path) -> std::io::Result<Autosave> {
        fs::create_dir_all(folder)?;
        for number in 0..1000 {
            let name = format!("{}-{number}", std::process::id());
            let path = folder.join(format!("{name}.lock"));
            // A file of this name belongs to another window of this process, or to a dead process of the same number.
            let Ok(lock) = File::create_new(&path) else { continue };
            // Where a file system has no locks, leftovers are told by their age alone.
            let _ = lock.try_lock();
            let file = folder.join(format!("{name}.{}", project::EXTENSION));
            return Ok(Autosave {
                file,
                lock: (path, lock),
                due: None,
                last: None,
                writing: None,
                superseded: Vec::new(),
            });
        }
        Err(std::io::Error::other("every name for an autosave is taken"))
    }

    /// Looks after the autosave: `contents` of what is open are asked for when it is time to write them. `is_busy` while a
    /// gesture is under way, whose state in the middle is nobody's wish. Returns what went wrong with the last one.
    pub fn tick(
        &mut self,
        now: Instant,
        document: Option<&Document>,
        is_busy: bool,
        contents: impl FnOnce() -> Option<Contents>,
        wake: &Arc<dyn Fn() + Send + Sync>,
    ) -> Option<String> {
        let trouble = self.collect(false);
        let Some(document) = document.filter(|document| document.is_modified()) else {
            self.due = None;
            if self.writing.is_none() && (self.last.is_some() || !self.superseded.is_empty()) {
                self.remove();
            }
            return trouble;
        };
        if self.last.as_ref().is_some_and(|last| is_same(last, document)) {
            self.due = None;
            return trouble;
        }
        let due = *self.due.get_or_insert(now + EVERY);
        if now >= due
            && !is_busy
            && self.writing.is_none()
            && let Some(contents) = contents()
        {
            self.due = None;
            self.last = Some(contents.snapshot.clone());
            let (to, wake) = (self.file.clone(), wake.clone());
            let write = move || {
                let outcome = project::save(&contents, &to).map(drop).map_err(|error| error.to_string());
                wake();
                outcome
            };
            match std::thread::Builder::new().name("autosave".into()).spawn(write) {
                Ok(thread) => self.writing = Some(Writing { thread, is_wanted: true }),
                Err(error) => return self.try_again(&format!("no thread could be started: {error}")),
            }
        }
        trouble
    }

    /// How long until [`Autosave::tick`] has something to do, if nothing else happens.
    pub fn due_in(&self, now: Instant) -> Option<Duration> {
        self.due.filter(|_| self.writing.is_none()).map(|due| due.saturating_duration_since(now))
    }

    /// Waits for what is being written, if it is done or `waits`. Returns what went wrong.
    fn collect(&mut self, waits: bool) -> Option<String> {
        let Writing { thread, is_wanted } = self.writing.take_if(|writing| waits || writing.thread.is_finished())?;
        match thread.join() {
            _ if !is_wanted => {
                let _ = fs::remove_file(&self.file);
                None
            }
            Ok(Ok(())) => {
                self.superseded.drain(..).for_each(|leftover| leftover.discard());
                None
            }
            Ok(Err(why)) => self.try_again(&why),
            Err(_) => self.try_again("it stopped unexpectedly; please report it"),
        }
    }

    fn try_again(&mut self, why: &str) -> Option<String> {
        self.last = None;
        Some(format!("Work is not kept for the case of a crash: {why}. Save the project (Ctrl+S) now and then"))
    }

    /// Keeps a leftover until the document made of it is safe.
    pub fn recovered(&mut self, leftover: Arc<Leftover>) {
        self.superseded.push(leftover);
        // Soon, since the leftover would be offered again after the next crash, without what was done since.
        self.due = Some(Instant::now());
    }

    /// Forgets what was open: it was saved, or given up.
    pub fn start_over(&mut self) {
        // One that is being written is removed once it is there: the window does not wait for it.
        self.writing.iter_mut().for_each(|writing| writing.is_wanted = false);
        self.remove();
        self.due = None;
    }

    fn remove(&mut self) {
        self.last = None;
        // Nothing is there yet, or it cannot be removed and is offered once more.
        let _ = fs::remove_file(&self.file);
        self.superseded.drain(..).for_each(|leftover| leftover.discard());
    }

    /// The window closes in order: nothing is left behind.
    pub fn finish(mut self) {
        self.collect(true);
        self.remove();
        let _ = fs::remove_file(&self.lock.0);
    }

    /// Where this window's autosave is.
    pub fn path(&self) -> &Path {
        &self.file
    }
}

fn is_same(last: &Snapshot, document: &Document) -> bool {
    Arc::ptr_eq(&last.pose.positions, &document.pose().positions) && last.scene == *document.scene()
}
