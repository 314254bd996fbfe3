//! What rigidity means, and what this program is.

use egui::{RichText, Ui};

macro_rules! bar {
    ($r:literal) => {
        concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/guide/rigidity-", $r, ".png")
    };
}

/// About: version, license, method.
pub(super) fn about(ui: &mut Ui, close: &mut bool) {
    ui.heading(concat!("Pliant ", env!("CARGO_PKG_VERSION")));
    ui.label("Bends any mesh, and lets you say where it is stiff.");
    ui.add_space(6.0);
    ui.label(
        "The method is rigidity-controllable as-rigid-as-possible deformation by S.-Y. Chen, L. Gao, Y.-K. Lai and \
         S. Xia (2017): every vertex has a rigidity r, the size of the neighborhood that moves as one piece.",
    );
    ui.add_space(6.0);
    ui.label(concat!("License: ", env!("CARGO_PKG_LICENSE"), ". Without any warranty."));
    ui.label(RichText::new("Built with egui, wgpu and faer.").weak());
    ui.add_space(10.0);
    *close |= ui.button("Close").on_hover_text("Close (Esc)").clicked();
}

/// The same pull with four rigidities, and what is seen.
const BARS: [(u16, &str, &str, &[u8]); 4] = [
    (1, "soft rubber", "It gives way where the strain is largest", include_bytes!(bar!("1"))),
    (2, "firm rubber", "Kinks spread out", include_bytes!(bar!("2"))),
    (6, "stiff", "The bend is even from end to end", include_bytes!(bar!("6"))),
    (20, "nearly metal", "It stays straight and takes up the bend at its ends", include_bytes!(bar!("20"))),
];

/// The decoded picture, kept by egui once it has been shown.
fn texture(ctx: &egui::Context, r: u16, bytes: &[u8]) -> Option<egui::TextureHandle> {
    let id = egui::Id::unique(("rigidity picture", r));
    if let Some(known) = ctx.data(|data| data.get_temp(id)) {
        return Some(known);
    }
    let pixels = image::load_from_memory(bytes).ok()?.into_rgba8();
    let size = [pixels.width() as usize, pixels.height() as usize];
    let image = egui::ColorImage::from_rgba_unmultiplied(size, pixels.as_raw());
    let texture = ctx.load_texture(format!("rigidity {r}"), image, egui::TextureOptions::LINEAR);
    ctx.data_mut(|data| data.insert_temp(id, texture.clone()));
    Some(texture)
}

/// What r means, with pictures.
pub(super) fn what_rigidity_is(ui: &mut Ui, close: &mut bool) {
    ui.heading("What rigidity means");
    ui.label(
        "Every vertex takes a neighborhood along when it turns. Rigidity is how far that neighborhood reaches, counted in \
         rings of edges: the larger it is, the more of the surface moves as one piece there.",
    );
    ui.add_space(8.0);
    ui.columns(BARS.len(), |columns| {
        for (ui, (r, name, what, bytes)) in columns.iter_mut().zip(BARS) {
            let alt = format!("A bar of rigidity {r}, both ends turned. {what}");
            if let Some(texture) = texture(ui.ctx(), r, bytes) {
                let picture = egui::Image::from_texture(&texture).max_width(ui.available_width()).corner_radius(4);
                ui.add(picture.alt_text(alt));
            }
            ui.label(RichText::new(format!("{r} – {name}")).strong());
            ui.label(RichText::new(what).weak());
        }
    });
    ui.add_space(8.0);
    ui.label(
        "Both ends of this bar are held and turned, the rest follows. Paint rigidity where bones or wood are, leave it at 1 \
         or 2 where the shape should bend. On a mesh with smaller triangles the same look needs a larger number, for rings \
         are counted in edges.",
    );
    ui.add_space(10.0);
    *close |= ui.button("Close").on_hover_text("Close (Esc)").clicked();
}
