//! Cards of the inspect tool: the numbers of a vertex, beside it or beside the pointer.

use egui::{Area, Frame, Grid, Id, Order, Pos2, Rect, RichText, Ui, Vec2, pos2, vec2};

use super::status::grouped;
use crate::editor::{Along, Inspection, Session};
use crate::tools::Card;

/// Width of a card: room for three coordinates (by eye).
const WIDTH: f32 = 236.0;
/// Height of a row and of the frame around all (by eye).
const ROW: f32 = 18.0;
const FRAME: f32 = 18.0;
/// From the pointer or vertex to the card: the vertex and its neighbors stay in sight (by eye).
const OFFSET: Vec2 = vec2(20.0, 20.0);

/// Shows the cards over the viewport.
pub(in crate::editor) fn inspect(ui: &Ui, rect: Rect, session: &mut Session) {
    // Numbers and places are those of the pose.
    if session.shows_rest() {
        return;
    }
    let inspections = session.inspections();
    let Some(open) = session.open() else { return };
    let decimals = decimals(f64::from(open.document.model().diagonal()));
    let n = inspections.len();
    for (k, (card, inspection)) in inspections.iter().enumerate() {
        let Some(at) = place(card, rect, session) else { continue };
        let rows = rows(inspection, decimals);
        let size = vec2(WIDTH, ROW * rows.len() as f32 + FRAME);
        // Of two cards the first goes to the other side, so that they do not lie over each other.
        let corner = corner(at, size, rect, n > 1 && k == 0);
        Area::new(Id::unique(("inspect", k))).order(Order::Middle).interactable(false).fixed_pos(corner).show(
            ui,
            |ui| {
                Frame::popup(ui.style()).show(ui, |ui| {
                    ui.set_width(WIDTH - FRAME);
                    Grid::new(("inspect rows", k)).num_columns(2).spacing([10.0, 2.0]).show(ui, |ui| {
                        for (name, value) in rows {
                            ui.label(RichText::new(name).weak());
                            ui.label(RichText::new(value).monospace());
                            ui.end_row();
                        }
                    });
                });
            },
        );
    }
}

/// The pointer or the vertex, in the window.
fn place(card: &Card, rect: Rect, session: &Session) -> Option<Pos2> {
    let open = session.open()?;
    let px = match card.pointer {
        Some(px) => px,
        None => {
            let position = *open.surface.frame().positions.get(card.vertex.index())?;
            open.camera.project(position, session.viewport_size())?.0
        }
    };
    let at = rect.min + vec2(px.x, px.y);
    rect.contains(at).then_some(at)
}

/// Right below, or on the other sides where there is no room.
fn corner(at: Pos2, size: Vec2, rect: Rect, prefers_left: bool) -> Pos2 {
    let side = |at: f32, size: f32, offset: f32, lo: f32, hi: f32, first: bool| {
        let (before, after) = (at - offset - size, at + offset);
        let fits = (before >= lo, after + size <= hi);
        let at = match fits {
            (true, _) if first => before,
            (true, false) => before,
            _ => after,
        };
        at.clamp(lo, (hi - size).max(lo))
    };
    pos2(
        side(at.x, size.x, OFFSET.x, rect.left(), rect.right(), prefers_left),
        side(at.y, size.y, OFFSET.y, rect.top(), rect.bottom(), prefers_left),
    )
}

/// What a card says, line by line.
fn rows(of: &Inspection, decimals: Option<usize>) -> Vec<(&'static str, String)> {
    let length = |value: f64| number(value, decimals);
    let vertex = grouped(of.vertex.index());
    let vertex = match of.in_file {
        Some(number) => format!("{vertex} (in the file {})", grouped(number as usize)),
        None => vertex,
    };
    let [x, y, z] = of.position.to_array().map(length);
    let energy = of.energy.map(|(energy, share)| format!("{energy:.2e} ({:.2} %)", share * 100.0));
    let stretch = of.stretch.map(|(lo, hi)| format!("{lo:.3} to {hi:.3}"));
    let none = || "–".to_owned();
    let mut rows = vec![
        ("Vertex", vertex),
        ("Position", format!("{x} {y} {z}")),
        ("Moved", length(of.moved)),
        ("Rigidity", of.rigidity.to_string()),
        ("Energy", energy.unwrap_or_else(none)),
        ("Edges at", stretch.unwrap_or_else(none)),
    ];
    rows.extend(of.part.clone().map(|part| ("Part", part)));
    rows.extend(of.held_by.clone().map(|group| ("Held by", group)));
    if let Some((straight, along)) = of.way {
        rows.push(("Straight", length(straight)));
        let along = along.map(|along| match along {
            Along::UnderWay => "measuring…".into(),
            Along::Far(far) => length(f64::from(far)),
            Along::Apart => "no way: separate parts".into(),
        });
        rows.push(("On surface", along.unwrap_or_else(|| "click to measure".into())));
    }
    rows
}

/// Decimals that tell a ten-thousandth of a mesh, or none where numbers would be too long.
fn decimals(diagonal: f64) -> Option<usize> {
    let wanted = 4.0 - diagonal.log10().floor();
    (0.0..=6.0).contains(&wanted).then_some(wanted as usize)
}

fn number(value: f64, decimals: Option<usize>) -> String {
    match decimals {
        Some(decimals) => format!("{value:.decimals$}"),
        None => format!("{value:.3e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_have_the_digits_that_the_size_of_the_mesh_deserves() {
        for (diagonal, expected) in
            [(1.7, "0.1235"), (250.0, "0.12"), (0.02, "0.123457"), (1e-7, "1.235e-1"), (1e9, "1.235e-1")]
        {
            assert_eq!(number(0.123_456_7, decimals(diagonal)), expected, "a diagonal of {diagonal}");
        }
    }

    #[test]
    fn a_card_lies_in_the_viewport_and_beside_the_pointer() {
        let rect = Rect::from_min_size(pos2(50.0, 30.0), vec2(800.0, 600.0));
        let size = vec2(236.0, 150.0);
        for x in (50..=850).step_by(40) {
            for y in (30..=630).step_by(40) {
                for first in [false, true] {
                    let at = pos2(x as f32, y as f32);
                    let card = Rect::from_min_size(corner(at, size, rect, first), size);
                    assert!(rect.contains_rect(card), "{card} for {at}");
                    assert!(!card.contains(at), "{card} covers {at}");
                }
            }
        }
    }
}
