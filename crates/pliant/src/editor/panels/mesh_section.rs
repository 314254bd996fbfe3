//! The section of the inspector about the mesh as it was opened: how large it is and what is unusual about it.

use egui::{RichText, Ui};

use crate::document::{Command, Finding, SelectMode};
use crate::editor::{Session, theme};

/// Sizes and findings; a finding's button selects the vertices concerned and turns the camera to them.
pub(super) fn mesh(ui: &mut Ui, session: &mut Session) {
    let Some(document) = session.document() else { return };
    let model = document.model().clone();
    let (mesh, file) = (&model.mesh, &model.file);
    let (vertices, points) = (file.positions.len(), mesh.n_vertices());
    let of_file = if vertices == points { String::new() } else { format!(" ({vertices} in the file)") };
    let sizes = format!("{points} vertices{of_file}, {} triangles", mesh.n_faces());
    ui.label(RichText::new(sizes).weak())
        .on_hover_text("Copies of a vertex at its place, which the file may list, are one vertex of the surface");
    if model.findings.is_empty() {
        ui.label(RichText::new("Closed, in one piece, nothing unusual.").weak());
    }
    let mut looked_at = None;
    for finding in &model.findings {
        ui.horizontal_top(|ui| {
            if finding.has_place() && select_button(ui, finding) {
                looked_at = Some(finding);
            }
            let text = RichText::new(&finding.found);
            let text = if finding.is_suspect { text.color(theme::ACCENT) } else { text };
            ui.add(egui::Label::new(text).wrap()).on_hover_text(finding.treatment);
        });
    }
    if let Some(finding) = looked_at {
        session.apply(Command::Select(finding.vertices(mesh), SelectMode::Replace));
        session.frame();
    }
}

fn select_button(ui: &mut Ui, finding: &Finding) -> bool {
    let button = ui.small_button("show").on_hover_text("Select the vertices concerned and look at them");
    button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, format!("Show {}", finding.found)));
    button.clicked()
}
