//! The words of a cell: what it is above the picture, and its numbers below.

use egui::{Align, Layout, Rect, RichText, Ui, UiBuilder, vec2};

use super::Parts;
use crate::document::MethodKind;
use crate::editor::{Pane, PaneKind, Session, theme};
use crate::solving::SolveState;

/// What was pressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Outcome {
    /// The pane's method should be the document's.
    Use,
}

pub(super) fn background(ui: &Ui, rect: Rect, session: &Session) {
    ui.painter().rect_filled(rect, 0.0, theme::palette(session.look.theme).panel);
}

/// Above the document's own picture. Below is room for the legend; what its solver does is told in the status line.
pub(super) fn own(ui: &mut Ui, parts: &Parts, session: &Session) {
    let kind = session.method().unwrap_or_default().kind;
    line(ui, parts.header, |ui| {
        ui.label(RichText::new(format!("Document: {}", kind.label())).strong())
            .on_hover_text("Drag handles and paint here: all panes follow");
    });
}

/// Above and below a pane; returns what was pressed.
pub(super) fn pane(ui: &mut Ui, parts: &Parts, kind: PaneKind, session: &Session) -> Option<Outcome> {
    let (compare, method) = (session.compare()?, session.method()?);
    let pane = compare.panes().iter().find(|pane| pane.kind == kind)?;
    let mut outcome = None;
    line(ui, parts.header, |ui| {
        let title = kind.title(&method, compare.uniform());
        ui.label(RichText::new(&title).strong()).on_hover_text(kind.method().description());
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let button = ui.small_button("Use this").on_hover_text("Make this the method of the document, in one step");
            button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, format!("Use {title}")));
            if button.clicked() {
                outcome = Some(Outcome::Use);
            }
        });
    });
    lines(ui, parts.footer, session, numbers(pane));
    outcome
}

/// The three lines below a pane, each with what it means.
fn numbers(pane: &Pane) -> [(String, &'static str); 3] {
    const WORK: &str =
        "Time of its own work since handles or rigidity last changed, preparation included, and iterations";
    const ENERGY: &str = "Energy of the method itself, in its own units: not to be compared between methods. Strain is the \
                          same for all: the ARAP energy (eq. 1 at r = 1) of the surface, whatever made it";
    const SHAPE: &str = "Pairs of faces that cross; volume relative to that at rest (closed surfaces only); how far handles \
                         are missed, where they are held softly";
    let state = pane.state.as_ref();
    if let Some(SolveState::Failed(why)) = state {
        return [(format!("cannot solve: {why}"), WORK), (String::new(), ENERGY), (String::new(), SHAPE)];
    }
    let work = format!("{} · {} · {:>4} iterations", words(state), time(pane.spent), pane.iterations);
    let measures = pane.measures.as_ref().filter(|_| pane.is_current);
    let strain = measures.map_or_else(|| "…".into(), |measures| number(measures.strain));
    let energy = format!("energy {} · strain {strain}", number(pane.energy));
    let shape = measures.map_or_else(
        || "…".into(),
        |measures| {
            let mut parts = vec![format!("{} crossings", measures.crossings)];
            parts.extend(measures.volume.map(|ratio| format!("volume {:.1} %", 100.0 * ratio)));
            if pane.kind.method() == MethodKind::Embedded {
                parts.push(format!("off {:.1e}", measures.handle_error));
            }
            parts.join(" · ")
        },
    );
    [(work, WORK), (energy, ENERGY), (shape, SHAPE)]
}

fn words(state: Option<&SolveState>) -> String {
    match state {
        None | Some(SolveState::Preparing { .. }) => "preparing".into(),
        Some(SolveState::Resting) => "no handles".into(),
        Some(SolveState::Iterating) => "iterating".into(),
        Some(SolveState::Settled) => "settled".into(),
        Some(SolveState::Failed(why)) => format!("cannot solve: {why}"),
    }
}

fn time(spent: std::time::Duration) -> String {
    let ms = spent.as_secs_f64() * 1e3;
    if ms < 1000.0 { format!("{ms:>5.0} ms") } else { format!("{:>5.1} s ", ms / 1e3) }
}

/// Four digits: what differs between methods shows, and nothing moves when it changes.
fn number(value: f64) -> String {
    if value == 0.0 { "0        ".into() } else { format!("{value:<9.3e}") }
}

fn line(ui: &mut Ui, rect: Rect, contents: impl FnOnce(&mut Ui)) {
    let layout = Layout::left_to_right(Align::Center);
    ui.scope_builder(UiBuilder::new().max_rect(rect.shrink2(vec2(8.0, 2.0))).layout(layout), |ui| {
        ui.set_clip_rect(rect);
        contents(ui);
    });
}

fn lines(ui: &mut Ui, rect: Rect, session: &Session, lines: [(String, &'static str); 3]) {
    let quiet = theme::palette(session.look.theme).quiet;
    ui.scope_builder(UiBuilder::new().max_rect(rect.shrink2(vec2(8.0, 2.0))), |ui| {
        ui.set_clip_rect(rect);
        ui.spacing_mut().item_spacing.y = 1.0;
        for (text, tip) in lines {
            let text = RichText::new(text).color(quiet).monospace().size(11.0);
            ui.add(egui::Label::new(text).extend()).on_hover_text(tip);
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_any_size_are_equally_wide() {
        let widths: Vec<usize> = [0.0, 1.0, 12345.678, 1e-12, 9.9999e7].map(|value| number(value).len()).into();
        assert!(widths.iter().all(|&width| width == widths[0]), "{widths:?}");
        for ms in [0.2, 15.0, 999.4, 1000.0, 61_000.0] {
            let text = time(std::time::Duration::from_secs_f64(ms / 1e3));
            assert_eq!(text.len(), 8, "{text}");
        }
    }
}
