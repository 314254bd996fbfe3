//! Messages that stay until they are dismissed: what happened and what to do.

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoticeKind {
    /// Something went well.
    Done,
    /// Something to know.
    Warning,
    /// Something did not happen.
    Error,
}

/// One message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Notice {
    /// How bad.
    pub kind: NoticeKind,
    /// One or two sentences.
    pub text: String,
}

/// The messages on screen, oldest first.
#[derive(Debug, Default)]
pub struct Notices {
    list: Vec<Notice>,
}

/// Older ones give way, so that a flood cannot cover the window (by eye).
const AT_MOST: usize = 6;

impl Notices {
    /// Shows a message; the same one is not shown twice.
    pub fn push(&mut self, kind: NoticeKind, text: impl Into<String>) {
        let notice = Notice { kind, text: text.into() };
        self.list.retain(|old| *old != notice);
        self.list.push(notice);
        let surplus = self.list.len().saturating_sub(AT_MOST);
        self.list.drain(..surplus);
    }

    /// Takes one off the screen.
    pub fn dismiss(&mut self, index: usize) {
        if index < self.list.len() {
            self.list.remove(index);
        }
    }

    /// Takes off all: they spoke of something that is over.
    pub fn clear(&mut self) {
        self.list.clear();
    }

    /// What is on screen.
    pub fn list(&self) -> &[Notice] {
        &self.list
    }
}
