//! Settings of the picture.

use egui::{ComboBox, DragValue, Slider, Ui};
use pliant_solver::Rigidity;

use crate::editor::look::SHADINGS;
use crate::editor::{ColorBy, Look, Session};
use crate::viewport::Theme;

/// What colors the surface, how it is lit, what is drawn with it.
pub(super) fn view(ui: &mut Ui, session: &mut Session) {
    let mut look = session.look.clone();
    color(ui, &mut look);
    shading(ui, &mut look);
    ui.horizontal_wrapped(|ui| {
        ui.checkbox(&mut look.wireframe, "wireframe").on_hover_text("Edges of the mesh over the surface");
        ui.checkbox(&mut look.see_through, "x-ray")
            .on_hover_text("See through the surface, to handles and faces behind it");
        let crossings = ui.checkbox(&mut look.crossings, "self-intersections");
        crossings.on_hover_text(
            "Look for faces that pass through others whenever the surface rests, and point them out in stripes",
        );
        ui.checkbox(&mut look.grid, "grid").on_hover_text("A grid on the ground");
        ui.checkbox(&mut look.handles, "handles").on_hover_text("Dots of handles and anchors, and the gizmo");
    });
    ui.horizontal(|ui| {
        ui.label("Theme");
        ui.selectable_value(&mut look.theme, Theme::Dark, "dark").on_hover_text("A dark window");
        ui.selectable_value(&mut look.theme, Theme::Light, "light").on_hover_text("A light window");
    });
    if look != session.look {
        session.set_look(look);
    }
}

fn shading(ui: &mut Ui, look: &mut Look) {
    let (_, name, about) = SHADINGS.into_iter().find(|shading| shading.0 == look.shading).unwrap_or(SHADINGS[0]);
    ui.horizontal(|ui| {
        let label = ui.label("Shading");
        let list = ComboBox::from_id_salt("shading").selected_text(name).width(150.0);
        let list = list.show_ui(ui, |ui| {
            for (shading, name, about) in SHADINGS {
                ui.selectable_value(&mut look.shading, shading, name).on_hover_text(about);
            }
        });
        list.response.labelled_by(label.id).on_hover_text(about);
    });
}

fn color(ui: &mut Ui, look: &mut Look) {
    ui.horizontal(|ui| {
        let label = ui.label("Color");
        let list = ComboBox::from_id_salt("color by").selected_text(look.color_by.label()).width(150.0);
        let list = list.show_ui(ui, |ui| {
            for color_by in ColorBy::ALL {
                let choice = ui.selectable_value(&mut look.color_by, color_by, color_by.label());
                choice.on_hover_text(color_by.tooltip());
            }
        });
        list.response.labelled_by(label.id).on_hover_text(look.color_by.tooltip());
    });
    if look.color_by == ColorBy::SoftStiff {
        ui.horizontal(|ui| {
            let label = ui.label("stiff from rigidity");
            let value = DragValue::new(&mut look.stiff_from).range(2..=Rigidity::MAX).speed(0.05);
            ui.add(value).labelled_by(label.id).on_hover_text("The smallest rigidity that is shown as stiff");
        });
    }
    ui.add_enabled_ui(look.color_by != ColorBy::Plain, |ui| {
        ui.horizontal(|ui| {
            let slider = Slider::new(&mut look.opacity, 0.0..=1.0).fixed_decimals(2);
            let slider = ui.add(slider).on_hover_text("How much of the color covers the file's own colors");
            let slider = slider.on_disabled_hover_text("Choose a color other than the file's own first");
            let label = ui.label("color strength");
            slider.labelled_by(label.id);
        });
    });
}
