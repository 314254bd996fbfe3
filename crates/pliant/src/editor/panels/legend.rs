//! The legend of the coloring, in a corner of the viewport: what is shown, which color is how much.

use egui::{Align2, Color32, CornerRadius, FontId, Painter, Rect, Ui, Vec2, pos2, vec2};

use crate::editor::look::ramp_max;
use crate::editor::theme::{Palette, palette};
use crate::editor::{ColorBy, Crossings, Learning, Session, Shown, theme};
use crate::solving::Measure;
use crate::viewport::{Coloring, energy_color, rigidity_color, soft_stiff_color, stretch_color};

const SWATCH: Vec2 = Vec2::new(26.0, 14.0);
/// Longer ramps are drawn without a number on every swatch.
const NUMBERED: u16 = 12;
/// Width and height of a card with a ramp and numbers under it.
const CARD: Vec2 = Vec2::new(212.0, 62.0);
/// Pieces a ramp is painted in: each is 4 points wide.
const PIECES: usize = 48;
const MARGIN: f32 = 10.0;
/// The light stripes of faces that cross others.
const FLAW: Color32 = Color32::from_rgb(255, 48, 150);

/// A ramp, what it shows, and the numbers at its start, middle and end.
struct Scale {
    title: &'static str,
    marks: [String; 3],
    about: String,
    color: fn(f32) -> [u8; 3],
}

/// Paints the legend into the lower left corner of `viewport`. With a click on a swatch its r becomes the current one.
pub(in crate::editor) fn legend(ui: &mut Ui, viewport: Rect, session: &mut Session) {
    let Some(max) = session.shown_rigidity().map(ramp_max) else { return };
    let coloring = session.coloring().0;
    let size = match coloring {
        Coloring::Plain if session.look.color_by.measure().is_none() => return crossings(ui, viewport, 0.0, session),
        Coloring::Rigidity => vec2(f32::from(max.min(NUMBERED)) * SWATCH.x + 2.0 * MARGIN, 52.0),
        _ => CARD,
    };
    crossings(ui, viewport, size.y + 6.0, session);
    let corner = pos2(viewport.left() + 12.0, viewport.bottom() - size.y - 12.0);
    // A layer of its own, so that a click on the legend does nothing to the surface behind it.
    egui::Area::new(egui::Id::unique("legend")).fixed_pos(corner).show(ui.ctx(), |ui| {
        let (card, response) = ui.allocate_exact_size(size, egui::Sense::click_and_drag());
        let colors = palette(session.look.theme);
        ui.painter().rect_filled(card, CornerRadius::same(6), colors.panel.gamma_multiply(0.86));
        let about = match coloring {
            Coloring::Rigidity => return rigidity(ui, card, max, session),
            Coloring::Plain => nothing_yet(ui.painter(), card, &colors, session.look.color_by),
            Coloring::SoftStiff { stiff_from } => soft_stiff(ui.painter(), card, &colors, stiff_from),
            Coloring::Energy | Coloring::Stretch => {
                let scale = scale(session);
                paint_scale(ui.painter(), card, &colors, &scale);
                scale.about
            }
        };
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, &about));
        response.on_hover_text(about);
    });
}

/// What is known of faces that cross others, on a card so far above the lower edge.
fn crossings(ui: &mut Ui, viewport: Rect, above: f32, session: &Session) {
    let (words, is_bad) = match session.crossings() {
        Crossings::Off => return,
        Crossings::Waiting => ("Self-intersections: when it rests".to_owned(), false),
        Crossings::Searching => ("Self-intersections: looking…".to_owned(), false),
        Crossings::Found { n_faces: 0, .. } => ("No self-intersections".to_owned(), false),
        Crossings::Found { n_faces, .. } => (format!("Self-intersections: {n_faces} faces"), true),
    };
    let about = match session.crossings() {
        Crossings::Found { n_pairs, .. } if is_bad => {
            format!("{n_pairs} pairs of faces pass through each other; they are striped, faintly also inside")
        }
        _ => "Faces that pass through each other are looked for whenever the surface rests".to_owned(),
    };
    let size = vec2(CARD.x, 26.0);
    let corner = pos2(viewport.left() + 12.0, viewport.bottom() - size.y - 12.0 - above);
    egui::Area::new(egui::Id::unique("self-intersections")).fixed_pos(corner).show(ui.ctx(), |ui| {
        let (card, response) = ui.allocate_exact_size(size, egui::Sense::hover());
        let colors = palette(session.look.theme);
        ui.painter().rect_filled(card, CornerRadius::same(6), colors.panel.gamma_multiply(0.86));
        let mark = Rect::from_center_size(card.left_center() + vec2(MARGIN + 6.0, 0.0), vec2(12.0, 12.0));
        let ink = if is_bad { FLAW } else { colors.quiet };
        ui.painter().rect_filled(mark, CornerRadius::same(2), ink.gamma_multiply(if is_bad { 1.0 } else { 0.4 }));
        let at = card.left_center() + vec2(MARGIN + 20.0, 0.0);
        ui.painter().text(at, Align2::LEFT_CENTER, &words, FontId::proportional(11.0), colors.text);
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, &words));
        response.on_hover_text(about);
    });
}

fn rigidity(ui: &mut Ui, card: Rect, max: u16, session: &mut Session) {
    let n = max.min(NUMBERED);
    title(ui.painter(), card, &palette(session.look.theme), ["soft", "Rigidity", "stiff"]);
    for k in 0..n {
        let r = if n < 2 { 1 } else { 1 + (u32::from(k) * u32::from(max - 1) / u32::from(n - 1)) as u16 };
        let corner = pos2(card.left() + MARGIN + f32::from(k) * SWATCH.x, card.top() + 26.0);
        let rect = Rect::from_min_size(corner, SWATCH + vec2(0.0, 6.0));
        let response = ui.interact(rect, ui.scope_id().with(("legend", r)), egui::Sense::click());
        swatch(ui.painter(), rect, rigidity_color(r, max), &r.to_string());
        if r == session.options.rigidity {
            let stroke = egui::Stroke::new(2.0, theme::ACCENT);
            ui.painter().rect_stroke(rect, CornerRadius::ZERO, stroke, egui::StrokeKind::Outside);
        }
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, format!("Rigidity {r}")));
        if response.on_hover_text(format!("Paint and fill with rigidity {r}")).clicked() {
            session.choose_rigidity(r);
        }
    }
}

/// A field of one color with words on it that can be read.
fn swatch(painter: &Painter, rect: Rect, [red, green, blue]: [u8; 3], words: &str) {
    painter.rect_filled(rect, CornerRadius::ZERO, Color32::from_rgb(red, green, blue));
    let luma = 0.3 * f32::from(red) + 0.59 * f32::from(green) + 0.11 * f32::from(blue);
    let ink = if luma > 140.0 { Color32::from_gray(20) } else { Color32::from_gray(240) };
    painter.text(rect.center(), Align2::CENTER_CENTER, words, FontId::proportional(11.0), ink);
}

fn soft_stiff(painter: &Painter, card: Rect, colors: &Palette, stiff_from: u16) -> String {
    title(painter, card, colors, ["soft", "Rigidity", "stiff"]);
    let most_soft = stiff_from.saturating_sub(1);
    let half = vec2((card.width() - 2.0 * MARGIN) * 0.5, SWATCH.y + 6.0);
    for (k, words) in [format!("up to {most_soft}"), format!("from {stiff_from}")].iter().enumerate() {
        let corner = pos2(card.left() + MARGIN + k as f32 * half.x, card.top() + 28.0);
        swatch(painter, Rect::from_min_size(corner, half), soft_stiff_color(k == 1), words);
    }
    format!("Soft up to rigidity {most_soft}, stiff from {stiff_from}; the limit is set in the inspector under View")
}

/// Says why there is no color where one was asked for.
fn nothing_yet(painter: &Painter, card: Rect, colors: &Palette, color_by: ColorBy) -> String {
    title(painter, card, colors, ["", color_by.label(), ""]);
    let why = "Nothing to show: place a handle first";
    painter.text(card.center() + vec2(0.0, 8.0), Align2::CENTER_CENTER, why, FontId::proportional(11.0), colors.quiet);
    format!("{}. {why}", color_by.tooltip())
}

/// The scale of what colors the surface now: what is learned, while it is looked at, else what the solver's thread measured.
fn scale(session: &Session) -> Scale {
    let is_confidence =
        session.learning.as_ref().and_then(Learning::trial).is_some_and(|trial| trial.shown == Shown::Confidence);
    let energy = |title, top: f64, about: &str| Scale {
        title,
        marks: ["0".into(), scientific(0.5 * top), format!("≥ {}", scientific(top))],
        about: format!("{about}. In squared units of the file (eq. 1)"),
        color: energy_color,
    };
    match session.measured() {
        Some(measured) if !is_confidence => match measured.measure {
            Measure::Energy => energy("Energy", measured.ends[1], ColorBy::Energy.tooltip()),
            Measure::EnergyDifference => {
                energy("Energy difference", measured.ends[1], ColorBy::EnergyDifference.tooltip())
            }
            Measure::Stretch => Scale {
                title: "Edge stretch",
                marks: [format!("÷ {:.2}", measured.ends[1]), "1".into(), format!("× {:.2}", measured.ends[1])],
                about: format!("{}. Shorter than at rest is violet, longer is green", ColorBy::Stretch.tooltip()),
                color: stretch_color,
            },
        },
        _ => Scale {
            title: "Confidence",
            marks: ["low".into(), String::new(), "high".into()],
            about: "How sure the learned rigidity is".into(),
            color: energy_color,
        },
    }
}

fn paint_scale(painter: &Painter, card: Rect, colors: &Palette, scale: &Scale) {
    title(painter, card, colors, ["", scale.title, ""]);
    let piece = (card.width() - 2.0 * MARGIN) / PIECES as f32;
    for k in 0..PIECES {
        let [r, g, b] = (scale.color)(k as f32 / (PIECES - 1) as f32);
        let corner = pos2(card.left() + MARGIN + k as f32 * piece, card.top() + 25.0);
        // A little overlap, so that no seam shows between pieces.
        let rect = Rect::from_min_size(corner, vec2(piece + 0.5, 13.0));
        painter.rect_filled(rect, CornerRadius::ZERO, Color32::from_rgb(r, g, b));
    }
    row(painter, card, card.top() + 49.0, scale.marks.each_ref().map(String::as_str), [colors.text; 3]);
}

fn title(painter: &Painter, card: Rect, colors: &Palette, words: [&str; 3]) {
    row(painter, card, card.top() + 14.0, words, [colors.quiet, colors.text, colors.quiet]);
}

/// Words at the left, in the middle and at the right.
fn row(painter: &Painter, card: Rect, y: f32, words: [&str; 3], ink: [Color32; 3]) {
    let places = [
        (card.left() + MARGIN, Align2::LEFT_CENTER),
        (card.center().x, Align2::CENTER_CENTER),
        (card.right() - MARGIN, Align2::RIGHT_CENTER),
    ];
    for (((x, align), words), ink) in places.into_iter().zip(words).zip(ink) {
        painter.text(pos2(x, y), align, words, FontId::proportional(11.0), ink);
    }
}

/// Two digits and an exponent: as wide whatever the number.
fn scientific(value: f64) -> String {
    format!("{value:.1e}")
}
