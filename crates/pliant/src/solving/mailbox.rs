//! A place for one letter: a newer one replaces an older one.

use std::sync::{Condvar, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Holds at most one value, and a flag that no more will come.
#[derive(Debug)]
pub(crate) struct Mailbox<T> {
    inner: Mutex<Inner<T>>,
    arrived: Condvar,
}

#[derive(Debug)]
struct Inner<T> {
    letter: Option<T>,
    closed: bool,
}

/// The sender is gone.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Closed;

impl<T> Mailbox<T> {
    pub(crate) fn new() -> Mailbox<T> {
        Mailbox { inner: Mutex::new(Inner { letter: None, closed: false }), arrived: Condvar::new() }
    }

    /// Replaces what has not been taken yet.
    pub(crate) fn put(&self, letter: T) {
        self.put_over(letter, |_, new| new);
    }

    /// Replaces what has not been taken yet by what `merge` makes of it and the new letter.
    pub(crate) fn put_over(&self, letter: T, merge: impl FnOnce(T, T) -> T) {
        let mut inner = self.lock();
        inner.letter = Some(match inner.letter.take() {
            Some(old) => merge(old, letter),
            None => letter,
        });
        drop(inner);
        self.arrived.notify_one();
    }

    /// The newest letter, if one has come since the last look.
    pub(crate) fn take(&self) -> Result<Option<T>, Closed> {
        let mut inner = self.lock();
        if inner.closed { Err(Closed) } else { Ok(inner.letter.take()) }
    }

    /// Whether a letter of that kind is there to be taken, or no more will come.
    pub(crate) fn has(&self, kind: impl FnOnce(&T) -> bool) -> bool {
        let inner = self.lock();
        inner.closed || inner.letter.as_ref().is_some_and(kind)
    }

    /// Sleeps until a letter comes.
    pub(crate) fn wait(&self) -> Result<T, Closed> {
        let mut inner = self.lock();
        loop {
            if inner.closed {
                return Err(Closed);
            }
            if let Some(letter) = inner.letter.take() {
                return Ok(letter);
            }
            inner = self.arrived.wait(inner).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Sleeps until a letter comes, at most so long.
    pub(crate) fn wait_for(&self, patience: Duration) -> Result<Option<T>, Closed> {
        let until = Instant::now() + patience;
        let mut inner = self.lock();
        loop {
            if inner.closed {
                return Err(Closed);
            }
            let left = until.saturating_duration_since(Instant::now());
            if inner.letter.is_some() || left.is_zero() {
                return Ok(inner.letter.take());
            }
            inner = self.arrived.wait_timeout(inner, left).unwrap_or_else(PoisonError::into_inner).0;
        }
    }

    /// Wakes whoever waits, for the last time.
    pub(crate) fn close(&self) {
        self.lock().closed = true;
        self.arrived.notify_all();
    }

    /// A panic elsewhere cannot leave the two fields inconsistent, so a poisoned lock is still good.
    fn lock(&self) -> std::sync::MutexGuard<'_, Inner<T>> {
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
