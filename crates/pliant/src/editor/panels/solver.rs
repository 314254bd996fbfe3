//! The section of the inspector about how the surface bends: energy curve, method with its parameters, weights, loose parts.

use egui::{Button, ComboBox, DragValue, Response, RichText, Slider, Ui};
use egui_plot::{Line, Plot, PlotPoints};
use pliant_solver::{LooseComponents, Weights};

use crate::document::{Command, Method, MethodKind};
use crate::editor::{Session, theme};

/// The slider of α; larger ones can be typed. Beyond that nothing but whole limbs turns (by eye).
const ALPHA_SLIDER: std::ops::RangeInclusive<f64> = 0.0..=1.0;
/// Nodes by dragging; more can be typed.
const NODES_PER_POINT: f64 = 2.0;

/// Energy curve, method, weights, loose parts.
pub(super) fn solver(ui: &mut Ui, session: &mut Session) {
    plot(ui, session);
    let Some(document) = session.document() else {
        return;
    };
    let scene = document.scene();
    let (method, weights, loose) = (scene.method, scene.weights, scene.loose);
    let mut commands = Vec::new();
    choice(ui, method, &mut commands);
    parameters(ui, method, &mut commands);
    ui.horizontal(|ui| {
        ui.label("Weights");
        for (value, label, tip) in [
            (Weights::Clamped, "clamped", "Cotangents kept positive: right for any mesh"),
            (Weights::Cotangent, "raw", "Cotangents as in the paper (eq. 2): can fail on irregular meshes"),
            (Weights::Uniform, "uniform", "1 for every edge"),
        ] {
            if ui.selectable_label(weights == value, label).on_hover_text(tip).clicked() {
                commands.push(Command::SetWeights(value));
            }
        }
    });
    ui.horizontal(|ui| {
        ui.label("Parts without handle");
        for (value, label) in [(LooseComponents::KeepAtRest, "stay"), (LooseComponents::FollowNearest, "follow")] {
            let tip = "What separate parts of the mesh do that have no handle: stay at rest, or follow the nearest one";
            if ui.selectable_label(loose == value, label).on_hover_text(tip).clicked() {
                commands.push(Command::SetLoose(value));
            }
        }
    });
    commands.into_iter().for_each(|command| session.apply(command));
}

/// Says that painted rigidity does not count, where it does not, and offers the method with which it does.
pub(super) fn rigidity_note(ui: &mut Ui, session: &mut Session) {
    let Some(why) = session.idle_rigidity() else { return };
    let mut wanted = false;
    ui.horizontal_wrapped(|ui| {
        ui.label(RichText::new(why).color(theme::ACCENT));
        wanted = ui.small_button("Use rigidity").on_hover_text(MethodKind::RRing.description()).clicked();
    });
    if wanted {
        session.choose_method(MethodKind::RRing);
    }
}

fn choice(ui: &mut Ui, method: Method, commands: &mut Vec<Command>) {
    let tip = "How the surface follows its handles. Switching keeps handles, pose and painted rigidity";
    let combo = ComboBox::from_label("method").selected_text(method.kind.label()).width(170.0);
    let shown = combo.show_ui(ui, |ui| {
        for kind in MethodKind::ALL {
            let item = ui.selectable_label(method.kind == kind, kind.label()).on_hover_text(kind.description());
            if item.clicked() && method.kind != kind {
                commands.push(Command::SetMethod(method.with(kind)));
            }
        }
    });
    shown.response.on_hover_text(tip);
}

fn parameters(ui: &mut Ui, method: Method, commands: &mut Vec<Command>) {
    let mut new = method;
    match method.kind {
        MethodKind::RRing | MethodKind::Arap => {}
        MethodKind::SrArap => {
            ui.horizontal(|ui| {
                let slider = Slider::new(&mut new.alpha, ALPHA_SLIDER).logarithmic(true).smallest_positive(1e-4);
                let slider = slider.clamping(egui::SliderClamping::Edits).max_decimals(4);
                let tip = "How much neighbors should turn alike: 0 is ARAP, 0.02 is usual (α in the paper)";
                step(&ui.add(slider).on_hover_text(tip), new, method, commands);
                ui.label("smoothness");
            });
        }
        MethodKind::Embedded => nodes(ui, method, commands),
    }
    reset(ui, method, commands);
}

/// The parameters of embedded deformation.
fn nodes(ui: &mut Ui, method: Method, commands: &mut Vec<Command>) {
    ui.horizontal(|ui| {
        let mut new = method;
        let value = DragValue::new(&mut new.nodes).range(Method::NODES).speed(NODES_PER_POINT);
        let tip = "Points on the surface that carry it. Few are smooth and quick, many follow details";
        step(&ui.add(value).on_hover_text(tip), new, method, commands);
        ui.label("nodes,");
        new = method;
        let value = DragValue::new(&mut new.neighbors).range(Method::NEIGHBORS).speed(0.05);
        let tip = "How many nodes carry each vertex (k in the paper, 4)";
        step(&ui.add(value).on_hover_text(tip), new, method, commands);
        ui.label("a vertex");
    });
    ui.horizontal(|ui| {
        let mut new = method;
        let value = DragValue::new(&mut new.agreement).range(Method::WEIGHTS).speed(0.1);
        let tip = "How much nodes side by side should agree, beside 1 for turning rigidly (w_reg in the paper, 10)";
        step(&ui.add(value).on_hover_text(tip), new, method, commands);
        ui.label("agreement,");
        new = method;
        let value = DragValue::new(&mut new.pull).range(Method::WEIGHTS).speed(1.0);
        let tip = "How strongly handles pull: more brings the surface nearer to them (w_con in the paper, 100)";
        step(&ui.add(value).on_hover_text(tip), new, method, commands);
        ui.label("pull");
    });
    ui.label(RichText::new("Handles are held softly: the surface comes near to them.").weak());
}

/// Back to what the papers use.
fn reset(ui: &mut Ui, method: Method, commands: &mut Vec<Command>) {
    if method.kind.is_of_rings() {
        return;
    }
    let usual = match method.kind {
        MethodKind::SrArap => Method { alpha: Method::default().alpha, ..method },
        _ => Method { kind: method.kind, alpha: method.alpha, ..Method::default() },
    };
    let button = ui.add_enabled(usual != method, Button::new("Usual values").small());
    let response =
        button.on_hover_text("Those of the method's paper").on_disabled_hover_text("These are the usual values");
    if response.clicked() {
        commands.push(Command::SetMethod(usual));
    }
}

/// A drag of a number is one step of the history.
fn step(response: &Response, new: Method, old: Method, commands: &mut Vec<Command>) {
    if response.drag_started() {
        commands.push(Command::Begin("Change method"));
    }
    if response.changed() && new != old {
        commands.push(Command::SetMethod(new));
    }
    if response.drag_stopped() {
        commands.push(Command::Commit);
    }
}

fn plot(ui: &mut Ui, session: &Session) {
    let energies = session.status.report.as_ref().map(|report| report.energies.clone()).unwrap_or_default();
    let points: PlotPoints<'_> =
        energies.iter().enumerate().filter(|&(_, &e)| e > 0.0).map(|(k, &e)| [k as f64, e.log10()]).collect();
    Plot::new("energy")
        .height(84.0)
        .show_axes([false, true])
        .y_axis_formatter(|mark, _| format!("1e{:.0}", mark.value))
        .show_grid([false, true])
        .allow_drag(false)
        .allow_zoom(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .set_margin_fraction(egui::vec2(0.02, 0.12))
        .show(ui, |plot| plot.line(Line::new("energy", points).color(theme::ACCENT).width(1.6)))
        .response
        .on_hover_text("Energy of the last iterations, logarithmic");
}
