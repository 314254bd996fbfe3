//! A card of the strip: a picture of the pose and its name. Clicked it shows the pose, dragged it finds another place.

use egui::{
    Align2, Color32, CornerRadius, FontId, Key, Rect, Response, Sense, Stroke, StrokeKind, TextEdit, TextureId, Ui,
    WidgetInfo, pos2, vec2,
};

use super::super::theme;
use crate::document::{KeptPose, PoseChange, PoseId};

/// Of the picture, in points; pictures have twice as many pixels.
pub(super) const PICTURE: [u32; 2] = [96, 60];
/// Below the picture.
const NAME: f32 = 20.0;

/// What was done to a card.
pub(super) enum Wish {
    Show(PoseId),
    Change(PoseChange),
    /// Another name is to be typed.
    Rename(PoseId),
    Named(PoseId, String),
    NotNamed,
}

/// How a card stands among the others.
#[derive(Clone, Copy)]
pub(super) struct State {
    /// The keys are for it from now on.
    pub(super) is_wanted: bool,
    pub(super) is_shown: bool,
    pub(super) is_chosen: bool,
    pub(super) place: usize,
}

/// Shows the card of a pose; returns what was done to it.
pub(super) fn show(
    ui: &mut Ui,
    kept: &KeptPose,
    picture: Option<TextureId>,
    state: State,
    renaming: &mut Option<(PoseId, String)>,
) -> (Response, Option<Wish>) {
    let size = vec2(PICTURE[0] as f32, PICTURE[1] as f32 + NAME);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    response
        .widget_info(|| WidgetInfo::selected(egui::Role::Button, true, state.is_shown, format!("Show {}", kept.name)));
    let top = Rect::from_min_size(rect.min, vec2(rect.width(), PICTURE[1] as f32));
    if state.is_wanted {
        response.request_focus();
    }
    if response.gained_focus() {
        response.scroll_to_me(None);
    }
    paint(ui, &response, (rect, top), picture, state);
    let below = Rect::from_min_max(pos2(rect.left(), top.bottom()), rect.max);
    let named = match renaming {
        Some((id, name)) if *id == kept.id => type_name(ui, below, kept, name),
        _ => {
            name_below(ui, below, &kept.name, state);
            None
        }
    };
    let wish = named.or_else(|| wish(ui, rect, response.clone(), kept, state));
    (response, wish)
}

fn wish(ui: &Ui, rect: Rect, response: Response, kept: &KeptPose, state: State) -> Option<Wish> {
    response.dnd_set_drag_payload(kept.id);
    if let Some(dragged) = response.dnd_hover_payload::<PoseId>()
        && *dragged != kept.id
    {
        ui.painter().rect_stroke(rect.expand(2.0), CornerRadius::same(5), accent(2.0), StrokeKind::Outside);
    }
    let dropped = response.dnd_release_payload::<PoseId>().filter(|dragged| **dragged != kept.id);
    let mut wish = dropped.map(|dragged| Wish::Change(PoseChange::Place(*dragged, state.place)));
    if response.double_clicked() {
        wish = Some(Wish::Rename(kept.id));
    } else if response.clicked() && !state.is_shown {
        wish = Some(Wish::Show(kept.id));
    }
    let response = response.on_hover_text(format!(
        "{}\nClick, Enter: back to this pose. Double click, F2: another name. Drag, Ctrl+arrows: another place. Del: off the \
         strip",
        kept.name
    ));
    response.context_menu(|ui| {
        let mut item = |ui: &mut Ui, label: &str, tip: &str, means: Wish| {
            if ui.button(label).on_hover_text(tip).clicked() {
                wish = Some(means);
                ui.close();
            }
        };
        item(ui, "Show", "Bring handles and surface back to this pose", Wish::Show(kept.id));
        item(ui, "Rename", "Type another name", Wish::Rename(kept.id));
        let update = Wish::Change(PoseChange::Update(kept.id));
        item(ui, "Update", "Replace it by what handles and surface are now", update);
        if state.place > 0 {
            let earlier = Wish::Change(PoseChange::Place(kept.id, state.place - 1));
            item(ui, "Move earlier", "One place to the left", earlier);
        }
        item(ui, "Move later", "One place to the right", Wish::Change(PoseChange::Place(kept.id, state.place + 1)));
        item(ui, "Delete", "Take it off the strip", Wish::Change(PoseChange::Delete(kept.id)));
    });
    wish
}

fn accent(width: f32) -> Stroke {
    Stroke::new(width, theme::ACCENT)
}

fn paint(ui: &Ui, response: &Response, (rect, top): (Rect, Rect), picture: Option<TextureId>, state: State) {
    let painter = ui.painter();
    let round = CornerRadius::same(5);
    let visuals = ui.style().interact(response);
    painter.rect_filled(rect, round, visuals.weak_bg_fill);
    match picture {
        Some(texture) => {
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            painter.image(texture, top, whole, Color32::WHITE);
        }
        None => {
            painter.rect_filled(top, round, ui.visuals().extreme_bg_color);
        }
    }
    if state.is_shown || response.has_focus() {
        painter.rect_stroke(rect, round, accent(2.0), StrokeKind::Inside);
    } else if state.is_chosen {
        painter.rect_stroke(rect, round, accent(1.0), StrokeKind::Inside);
    }
}

fn name_below(ui: &Ui, rect: Rect, name: &str, state: State) {
    let color = if state.is_shown { ui.visuals().strong_text_color() } else { ui.visuals().text_color() };
    let painter = ui.painter().with_clip_rect(rect.shrink2(vec2(4.0, 0.0)).intersect(ui.clip_rect()));
    let font = FontId::proportional(11.0);
    let galley = painter.layout_no_wrap(name.to_owned(), font.clone(), color);
    // What is too long begins at the left, so that its beginning can be read.
    if galley.size().x > rect.width() - 8.0 {
        painter.galley(rect.left_center() + vec2(4.0, -galley.size().y / 2.0), galley, color);
    } else {
        painter.text(rect.center(), Align2::CENTER_CENTER, name, font, color);
    }
}

fn type_name(ui: &mut Ui, rect: Rect, kept: &KeptPose, name: &mut String) -> Option<Wish> {
    let id = ui.scope_id().with(("name of a pose", kept.id.0));
    let field = TextEdit::singleline(name).id(id).font(FontId::proportional(11.0)).margin(vec2(2.0, 1.0));
    let response = ui.put(rect, field);
    response.widget_info(|| WidgetInfo::labeled(egui::Role::TextInput, true, format!("Name of {}", kept.name)));
    if ui.input(|input| input.key_pressed(Key::Escape)) {
        return Some(Wish::NotNamed);
    }
    if response.lost_focus() {
        return Some(Wish::Named(kept.id, name.clone()));
    }
    response.request_focus();
    None
}
