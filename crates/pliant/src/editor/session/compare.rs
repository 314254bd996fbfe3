//! The comparison of methods: opened, told what the document wants, and one of its panes made the document's.

use super::Session;
use crate::document::Command;
use crate::editor::NoticeKind;
use crate::editor::compare::{Compare, PaneKind};

/// Vertices up to which the panes follow a drag on the way; larger surfaces answer when the handle rests, so that the
/// editor's own solver has the processor for itself. An iteration takes some 2 ms there (measured at 12,000).
const LIVE_VERTICES: usize = 20_000;
/// r of the pane with the same everywhere, where the current one is 1 and would repeat ARAP: clearly stiffer (by eye).
const OTHER_RIGIDITY: u16 = 3;

impl Session {
    /// The comparison, while it is open.
    pub fn compare(&self) -> Option<&Compare> {
        self.compare.as_ref()
    }

    /// Opens the comparison, or closes it.
    pub fn toggle_compare(&mut self) {
        if self.compare.take().is_none() {
            self.open_compare();
        }
    }

    /// Solves the handles by every method side by side.
    pub fn open_compare(&mut self) {
        if self.open.is_none() || self.compare.is_some() {
            return;
        }
        self.stop_playing();
        let uniform = if self.options.rigidity > 1 { self.options.rigidity } else { OTHER_RIGIDITY };
        let ground = self.status.report.as_ref().and_then(|report| report.ground.upgrade());
        let wake = self.wake.clone();
        match Compare::start(uniform, ground, move || wake()) {
            Ok(compare) => {
                self.compare = Some(compare);
                self.tell_compare();
            }
            Err(error) => {
                self.notices.push(NoticeKind::Error, format!("No thread to compare with could be started: {error}"));
            }
        }
    }

    /// Closes it: its thread ends by itself.
    pub fn close_compare(&mut self) {
        self.compare = None;
    }

    /// Another r for the pane with the same everywhere.
    pub fn compare_with_rigidity(&mut self, r: u16) {
        if let Some(compare) = &mut self.compare {
            compare.set_uniform(r);
        }
        self.tell_compare();
    }

    /// Lets all panes begin anew from rest, whatever the drags before came to.
    pub fn compare_anew(&mut self) {
        if let Some(compare) = &mut self.compare {
            compare.begin_anew();
        }
        self.tell_compare();
    }

    /// Makes the method of a pane the document's, and its rigidity, in one step.
    pub fn use_pane(&mut self, kind: PaneKind) {
        let (Some(compare), Some(method)) = (&self.compare, self.method()) else { return };
        let uniform = compare.uniform();
        self.apply(Command::Begin("Use method"));
        self.apply(Command::SetMethod(method.with(kind.method())));
        if kind == PaneKind::Uniform {
            self.apply(Command::FillAll(uniform));
        }
        self.apply(Command::Commit);
    }

    /// Esc: what the tool or a number in the inspector has under way is taken back, or the comparison is closed.
    pub fn escape(&mut self) {
        let in_step = self.document().is_some_and(|document| document.in_step());
        if self.player().is_some() {
            self.stop_playing();
        } else if in_step && !self.tool.is_active() {
            self.apply(Command::Cancel);
        } else if self.compare.is_some() && !self.tool.is_active() {
            self.close_compare();
        } else {
            self.input(crate::tools::Input::Key(crate::tools::ToolKey::Escape));
        }
    }

    /// Passes on what the document wants now.
    pub(super) fn tell_compare(&mut self) {
        let (Some(compare), Some(open)) = (&mut self.compare, &self.open) else { return };
        let is_small = open.document.model().mesh.n_vertices() <= LIVE_VERTICES;
        if is_small || !self.tool.is_active() {
            compare.tell(&open.document, self.look.color_by.measure());
        }
    }

    /// Takes what the panes have to show.
    pub(super) fn poll_compare(&mut self) {
        if let Some(compare) = &mut self.compare {
            compare.poll();
        }
    }
}
