//! The method that bends the surface.

use super::Session;
use crate::document::{Command, Method, MethodKind};
use crate::tools::ToolKind;

impl Session {
    /// The document's method, if one is open.
    pub fn method(&self) -> Option<Method> {
        self.document().map(|document| document.scene().method)
    }

    /// Bends by another method, with the parameters that it had last.
    pub fn choose_method(&mut self, kind: MethodKind) {
        if let Some(method) = self.method() {
            self.apply(Command::SetMethod(method.with(kind)));
        }
    }

    /// Why painted rigidity changes nothing now, if it does not.
    pub fn idle_rigidity(&self) -> Option<String> {
        let kind = self.method()?.kind;
        (!kind.uses_rigidity()).then(|| format!("{} does not look at rigidity", kind.label()))
    }

    /// The same, while a tool is in hand that paints it.
    pub fn idle_painting(&self) -> Option<String> {
        self.idle_rigidity().filter(|_| matches!(self.tool_kind(), ToolKind::Brush | ToolKind::Fill))
    }
}
