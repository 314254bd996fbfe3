//! The history: every step by name, to go back to or forward to, and how much memory it may take.

use egui::{DragValue, RichText, ScrollArea, Ui};

use crate::document::History;
use crate::editor::Session;

/// Rows that are seen at once (by eye).
const ROWS: f32 = 9.0;
const MIB: f64 = (1 << 20) as f64;

/// Shows the steps; a click goes to the state after one.
pub(super) fn history(ui: &mut Ui, session: &mut Session) {
    let Some(document) = session.document() else {
        ui.label(RichText::new("Nothing is open").weak());
        return;
    };
    let history = document.history();
    let (now, all) = (history.len(), history.names().len());
    let mut chosen = None;
    let height = ui.text_style_height(&egui::TextStyle::Body) + 2.0 * ui.spacing().button_padding.y;
    let rows = ScrollArea::vertical().max_height(ROWS * height).min_scrolled_height(ROWS * height).id_salt("history");
    rows.auto_shrink([false, true]).stick_to_bottom(true).show_rows(ui, height, all + 1, |ui, range| {
        for n in range {
            // Row 0 is the state before the first step that is remembered.
            let name = if n == 0 { "Start" } else { history.name(n - 1) };
            let text = RichText::new(name);
            let text = if n > now { text.weak() } else { text };
            let tip = match n.cmp(&now) {
                std::cmp::Ordering::Less => "Go back to this state",
                std::cmp::Ordering::Equal => "This is the present state",
                std::cmp::Ordering::Greater => "Undone: make it again, up to here",
            };
            ui.push_id(n, |ui| {
                if ui.selectable_label(n == now, text).on_hover_text(tip).clicked() {
                    chosen = Some(n);
                }
            });
        }
    });
    let used = history.bytes() as f64 / MIB;
    memory(ui, session, used);
    if let Some(n) = chosen {
        session.jump(n);
    }
}

fn memory(ui: &mut Ui, session: &mut Session, used: f64) {
    let (least, most) = (*History::BUDGETS.start() as f64 / MIB, *History::BUDGETS.end() as f64 / MIB);
    let mut budget = session.history_budget() as f64 / MIB;
    ui.horizontal(|ui| {
        let value = DragValue::new(&mut budget).range(least..=most).speed(8.0).max_decimals(0).suffix(" MB");
        let tip = "Memory for the history; beyond it the oldest steps are forgotten";
        if ui.add(value).on_hover_text(tip).changed() {
            session.set_history_budget((budget * MIB) as usize);
        }
        ui.label(RichText::new(format!("at most, {used:.1} MB used")).weak());
    });
}
