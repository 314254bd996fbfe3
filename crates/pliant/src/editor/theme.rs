//! Colors, sizes and spacing of the window: one type scale, one grid of 4 points, one accent.

use egui::{Color32, CornerRadius, FontFamily, FontId, Margin, Stroke, Style, TextStyle, Vec2, Visuals};

use crate::viewport::Theme;

/// The one color that means *this one*.
pub(super) const ACCENT: Color32 = Color32::from_rgb(240, 160, 60);

/// Colors that differ between themes.
pub(super) struct Palette {
    /// Behind panels.
    pub panel: Color32,
    /// Behind fields and plots.
    pub well: Color32,
    /// Buttons at rest.
    pub raised: Color32,
    /// Buttons under the pointer.
    pub hovered: Color32,
    /// Separators.
    pub line: Color32,
    /// Words.
    pub text: Color32,
    /// Words that matter less.
    pub quiet: Color32,
}

/// The palette of a theme.
pub(super) fn palette(theme: Theme) -> Palette {
    let gray = Color32::from_gray;
    match theme {
        Theme::Dark => Palette {
            panel: Color32::from_rgb(31, 33, 37),
            well: Color32::from_rgb(22, 24, 27),
            raised: Color32::from_rgb(50, 53, 59),
            hovered: Color32::from_rgb(64, 68, 76),
            line: Color32::from_rgb(48, 51, 57),
            text: gray(222),
            quiet: gray(150),
        },
        Theme::Light => Palette {
            panel: Color32::from_rgb(243, 243, 245),
            well: Color32::from_rgb(255, 255, 255),
            raised: Color32::from_rgb(224, 226, 230),
            hovered: Color32::from_rgb(209, 212, 218),
            line: Color32::from_rgb(212, 214, 219),
            text: gray(36),
            quiet: gray(100),
        },
    }
}

/// Dresses the whole window.
pub(super) fn apply(ctx: &egui::Context, theme: Theme) {
    let egui_theme = match theme {
        Theme::Dark => egui::Theme::Dark,
        Theme::Light => egui::Theme::Light,
    };
    ctx.set_theme(egui_theme);
    ctx.style_mut_of(egui_theme, |style| dress(style, theme));
}

fn dress(style: &mut Style, theme: Theme) {
    let colors = palette(theme);
    let mut visuals = if theme == Theme::Dark { Visuals::dark() } else { Visuals::light() };
    visuals.panel_fill = colors.panel;
    visuals.window_fill = colors.panel;
    visuals.extreme_bg_color = colors.well;
    visuals.faint_bg_color = colors.raised;
    visuals.override_text_color = None;
    visuals.weak_text_color = Some(colors.quiet);
    visuals.selection.bg_fill = ACCENT.gamma_multiply(0.45);
    visuals.selection.stroke = Stroke::new(1.0, colors.text);
    visuals.slider_trailing_fill = true;
    visuals.window_corner_radius = CornerRadius::same(8);
    visuals.menu_corner_radius = CornerRadius::same(6);
    visuals.window_stroke = Stroke::new(1.0, colors.line);
    let widgets = &mut visuals.widgets;
    for widget in [&mut widgets.inactive, &mut widgets.hovered, &mut widgets.active, &mut widgets.open] {
        widget.corner_radius = CornerRadius::same(5);
        widget.bg_stroke = Stroke::NONE;
        widget.expansion = 0.0;
        widget.fg_stroke = Stroke::new(1.0, colors.text);
    }
    widgets.inactive.weak_bg_fill = colors.raised;
    widgets.inactive.bg_fill = colors.raised;
    widgets.hovered.weak_bg_fill = colors.hovered;
    widgets.hovered.bg_fill = colors.hovered;
    widgets.active.weak_bg_fill = ACCENT.gamma_multiply(0.6);
    widgets.active.bg_fill = ACCENT.gamma_multiply(0.6);
    widgets.open.weak_bg_fill = colors.hovered;
    widgets.open.bg_fill = colors.hovered;
    // What has the keyboard's focus is drawn as if pressed: it must be plain to see.
    widgets.active.bg_stroke = Stroke::new(1.5, ACCENT);
    widgets.noninteractive.bg_stroke = Stroke::new(1.0, colors.line);
    widgets.noninteractive.fg_stroke = Stroke::new(1.0, colors.text);
    style.visuals = visuals;
    style.spacing.item_spacing = Vec2::new(8.0, 6.0);
    style.spacing.button_padding = Vec2::new(8.0, 4.0);
    style.spacing.interact_size.y = 24.0;
    style.spacing.slider_width = 120.0;
    style.spacing.window_margin = Margin::same(16);
    style.spacing.menu_margin = Margin::same(6);
    style.text_styles = [
        (TextStyle::Small, FontId::new(11.0, FontFamily::Proportional)),
        (TextStyle::Body, FontId::new(13.0, FontFamily::Proportional)),
        (TextStyle::Button, FontId::new(13.0, FontFamily::Proportional)),
        (TextStyle::Heading, FontId::new(17.0, FontFamily::Proportional)),
        (TextStyle::Monospace, FontId::new(12.0, FontFamily::Monospace)),
    ]
    .into();
}
