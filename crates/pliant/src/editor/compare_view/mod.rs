//! The comparison on screen: the document, in which handles are dragged, and a pane for every way to solve, in a grid. They
//! share one camera, and their colors mean the same.

mod cell;
mod export;
mod picture;

use std::collections::HashMap;

use egui::{Align, Button, DragValue, Layout, Rect, RichText, Ui, UiBuilder, pos2, vec2};
use pliant_solver::Rigidity;

use super::viewport_panel::ViewportPanel;
use super::{PaneKind, Session, theme};
use cell::Outcome;
use export::Export;
use picture::PanePicture;

/// The row of buttons above the grid, and the lines above and below each picture, in points.
const BAR: f32 = 34.0;
const HEADER: f32 = 26.0;
const FOOTER: f32 = 52.0;
/// From the corner of the viewport to the legend.
const LEGEND_MARGIN: f32 = 12.0;
/// Between cells.
const GAP: f32 = 2.0;
/// The document's own cell and one for every pane.
const CELLS: usize = PaneKind::ALL.len() + 1;

/// Pictures of the panes, and the export under way.
#[derive(Default)]
pub(super) struct CompareView {
    pictures: HashMap<PaneKind, PanePicture>,
    export: Export,
}

/// Where what lies over the picture belongs.
pub(super) struct Around {
    /// The document's own picture.
    pub(super) picture: Rect,
    /// The legend stands in the lower left corner of this.
    pub(super) legend: Rect,
    /// Messages and panels stand in this.
    pub(super) messages: Rect,
}

impl CompareView {
    /// Whether a dialog of the comparison has the keyboard.
    pub(super) fn is_asking(&self) -> bool {
        self.export.is_asking()
    }

    /// Fills `ui` with the viewport, or with the comparison while it is open. Returns where the rest belongs.
    pub(super) fn show(&mut self, ui: &mut Ui, viewport: &mut ViewportPanel, session: &mut Session) -> Around {
        let all = ui.available_rect_before_wrap();
        self.export.poll(ui.ctx(), session);
        if session.compare().is_none() {
            self.close(viewport);
            viewport.show(ui, session);
            return Around { picture: all, legend: all, messages: all };
        }
        ui.painter().rect_filled(all, 0.0, theme::palette(session.look.theme).line);
        let bar = Rect::from_min_size(all.min, vec2(all.width(), BAR));
        let grid = Rect::from_min_max(pos2(all.left(), bar.bottom()), all.max);
        self.bar(ui, bar, session);
        let cells = cells(grid);
        let (mut picture, mut legend) = (all, all);
        for (place, rect) in cells.into_iter().enumerate() {
            let parts = Parts::of(rect);
            cell::background(ui, rect, session);
            match place.checked_sub(1).map(|place| PaneKind::ALL[place]) {
                None => {
                    cell::own(ui, &parts, session);
                    ui.scope_builder(UiBuilder::new().max_rect(parts.picture), |ui| viewport.show(ui, session));
                    picture = parts.picture;
                    // The legend stands in the lower left corner, a margin away: here below the picture, not on it.
                    legend = parts.footer.translate(vec2(-LEGEND_MARGIN, LEGEND_MARGIN));
                }
                Some(kind) => self.pane(ui, &parts, kind, (viewport, session)),
            }
        }
        self.export.ask(ui.ctx(), grid);
        Around { picture, legend, messages: grid }
    }

    /// Lets the device have its memory back.
    fn close(&mut self, viewport: &ViewportPanel) {
        for (_, picture) in self.pictures.drain() {
            picture.free(viewport.render_state());
        }
        self.export.close();
    }

    fn bar(&mut self, ui: &mut Ui, rect: Rect, session: &mut Session) {
        ui.painter().rect_filled(rect, 0.0, theme::palette(session.look.theme).panel);
        let (mut close, mut anew, mut r) = (false, false, None);
        let inner = rect.shrink2(vec2(10.0, 4.0));
        ui.scope_builder(UiBuilder::new().max_rect(inner).layout(Layout::left_to_right(Align::Center)), |ui| {
            ui.label(RichText::new("Methods side by side").strong());
            ui.separator();
            if let Some(compare) = session.compare() {
                let mut value = compare.uniform();
                let number = DragValue::new(&mut value).range(1..=Rigidity::MAX).speed(0.05);
                let tip = "Rigidity of the pane that has the same everywhere (r in the paper)";
                if ui.add(number).on_hover_text(tip).changed() {
                    r = Some(value);
                }
                ui.label("rigidity everywhere");
            }
            let tip = "Solve all panes from rest, whatever the drags before came to";
            anew = ui.button("From rest").on_hover_text(tip).clicked();
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                close = ui.button("Close").on_hover_text("Back to the document alone (Esc)").clicked();
                let can = session.compare().is_some_and(super::Compare::is_settled);
                let button = ui.add_enabled(can && !self.export.is_busy(), Button::new("Save picture…"));
                let response = button.on_hover_text("Write all panes with their numbers into one PNG");
                if response.on_disabled_hover_text("Wait until all panes have settled").clicked() {
                    self.export.begin(session);
                }
            });
        });
        if let Some(r) = r {
            session.compare_with_rigidity(r);
        }
        if anew {
            session.compare_anew();
        }
        if close {
            session.close_compare();
        }
    }

    fn pane(
        &mut self,
        ui: &mut Ui,
        parts: &Parts,
        kind: PaneKind,
        (viewport, session): (&ViewportPanel, &mut Session),
    ) {
        let outcome = cell::pane(ui, parts, kind, session);
        let picture = self.pictures.entry(kind).or_insert_with(|| PanePicture::new(viewport.sibling()));
        if let Some(shown) = viewport.shown() {
            picture.paint(ui, parts.picture, (viewport.render_state(), shown), (kind, session));
        }
        picture::turn(ui, parts.picture, kind, session);
        if outcome == Some(Outcome::Use) {
            session.use_pane(kind);
        }
    }
}

/// The parts of a cell.
struct Parts {
    header: Rect,
    picture: Rect,
    footer: Rect,
}

impl Parts {
    fn of(cell: Rect) -> Parts {
        let (top, bottom) = (cell.top() + HEADER, cell.bottom() - FOOTER);
        Parts {
            header: Rect::from_min_max(cell.min, pos2(cell.right(), top)),
            picture: Rect::from_min_max(pos2(cell.left(), top), pos2(cell.right(), bottom.max(top + 1.0))),
            footer: Rect::from_min_max(pos2(cell.left(), bottom.max(top + 1.0)), cell.max),
        }
    }
}

/// Six cells of equal size: three beside each other where the grid is wide.
fn cells(grid: Rect) -> Vec<Rect> {
    let columns = if grid.width() >= grid.height() { 3 } else { 2 };
    let rows = CELLS.div_ceil(columns);
    let size = vec2(
        ((grid.width() - GAP * (columns - 1) as f32) / columns as f32).floor(),
        ((grid.height() - GAP * rows as f32) / rows as f32).floor(),
    );
    let at = |place: usize| {
        let (column, row) = ((place % columns) as f32, (place / columns) as f32);
        grid.min + vec2(column * (size.x + GAP), GAP + row * (size.y + GAP))
    };
    (0..CELLS).map(|place| Rect::from_min_size(at(place), size)).collect()
}
