//! The inspector at the right: settings of the tool in hand first, then what is always of interest.

use egui::{CollapsingHeader, RichText, ScrollArea, Ui};

use super::{gizmo, handles, history, mesh_section, mirror, paint, select, solver, view, weld};
use crate::editor::{Action, Session};
use crate::tools::ToolKind;

/// Shows the sections; returns an action whose button was pressed.
pub(in crate::editor) fn inspector(ui: &mut Ui, session: &mut Session) -> Option<Action> {
    let mut chosen = None;
    ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
        // Room for the scroll bar, which would lie over the rightmost buttons.
        ui.set_max_width(ui.available_width() - 8.0);
        ui.add_space(4.0);
        let kind = session.tool_kind();
        ui.label(RichText::new(kind.label()).heading());
        ui.label(RichText::new(kind.description()).weak());
        ui.add_space(4.0);
        match kind {
            ToolKind::Handle | ToolKind::Anchor => gizmo::tool(ui, session, &mut chosen),
            ToolKind::Select => select::select(ui, session, &mut chosen),
            ToolKind::Brush => paint::brush(ui, session),
            ToolKind::Fill => paint::fill(ui, session),
            ToolKind::Inspect => {}
        }
        let about_rigidity = matches!(kind, ToolKind::Brush | ToolKind::Fill);
        if about_rigidity {
            ui.add_space(6.0);
            paint::rigidity(ui, session, &mut chosen);
        }
        ui.separator();
        let about_handles = matches!(kind, ToolKind::Handle | ToolKind::Anchor);
        if about_handles {
            section(ui, "Handles", true, |ui| handles::handles(ui, session, &mut chosen));
        }
        if about_rigidity {
            section(ui, "Mirror", true, |ui| mirror::mirror(ui, session, &mut chosen));
            section(ui, "Locks", true, |ui| paint::locks(ui, session, &mut chosen));
        } else {
            section(ui, "Rigidity", true, |ui| paint::rigidity(ui, session, &mut chosen));
        }
        if !about_handles {
            section(ui, "Handles", true, |ui| handles::handles(ui, session, &mut chosen));
        }
        section(ui, "Solver", true, |ui| solver::solver(ui, session));
        section(ui, "History", false, |ui| history::history(ui, session));
        section(ui, "View", false, |ui| view::view(ui, session));
        section(ui, "Mesh", false, |ui| {
            mesh_section::mesh(ui, session);
            weld::mesh(ui, session, &mut chosen);
        });
    });
    chosen
}

fn section(ui: &mut Ui, name: &str, open: bool, contents: impl FnOnce(&mut Ui)) {
    CollapsingHeader::new(RichText::new(name).strong()).default_open(open).show_unindented(ui, |ui| {
        contents(ui);
        ui.add_space(6.0);
    });
}
