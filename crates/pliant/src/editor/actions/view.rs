//! The menu *View*.

use egui::Key;

use super::actions;
use super::entry::{ALT, CTRL, Entry, NONE};
use crate::editor::{ColorBy, Habits, Session};
use crate::viewport::{Axis, Projection, Shading, Theme};

actions! {
    /// The file's own colors.
    COLOR_PLAIN = color("view.color-plain", ColorBy::Plain)
        .on(|session| session.look.color_by == ColorBy::Plain)
        .look(|look| look.color_by = ColorBy::Plain);
    /// Colors by r.
    COLOR_RIGIDITY = color("view.color-rigidity", ColorBy::Rigidity)
        .on(|session| session.look.color_by == ColorBy::Rigidity)
        .look(|look| look.color_by = ColorBy::Rigidity);
    /// Soft and stiff in two colors.
    COLOR_SOFT_STIFF = color("view.color-soft-stiff", ColorBy::SoftStiff)
        .on(|session| session.look.color_by == ColorBy::SoftStiff)
        .look(|look| look.color_by = ColorBy::SoftStiff);
    /// Colors by energy.
    COLOR_ENERGY = color("view.color-energy", ColorBy::Energy)
        .on(|session| session.look.color_by == ColorBy::Energy)
        .look(|look| look.color_by = ColorBy::Energy);
    /// Colors by the difference of energy to neighbors.
    COLOR_ENERGY_DIFFERENCE = color("view.color-energy-difference", ColorBy::EnergyDifference)
        .on(|session| session.look.color_by == ColorBy::EnergyDifference)
        .look(|look| look.color_by = ColorBy::EnergyDifference);
    /// Colors by the stretch of edges.
    COLOR_STRETCH = color("view.color-stretch", ColorBy::Stretch)
        .on(|session| session.look.color_by == ColorBy::Stretch)
        .look(|look| look.color_by = ColorBy::Stretch);
    /// Edges over the surface.
    TOGGLE_WIREFRAME = Entry::new("view.wireframe", "Wireframe", "Show the edges of the mesh")
        .key(NONE, Key::W)
        .apart()
        .on(|session| session.look.wireframe)
        .look(|look| look.wireframe = !look.wireframe);
    /// Smooth or flat.
    TOGGLE_SHADING = Entry::new("view.flat", "Flat shading", "Show single faces rather than a smooth surface")
        .key(NONE, Key::N)
        .on(|session| session.look.shading == Shading::Flat)
        .look(|look| {
            look.shading = if look.shading == Shading::Smooth { Shading::Flat } else { Shading::Smooth };
        });
    /// A surface that hides little.
    TOGGLE_SEE_THROUGH = Entry::new("view.see-through", "X-ray", "See through the surface, to handles and faces behind it")
        .key(ALT, Key::Z)
        .on(|session| session.look.see_through)
        .look(|look| look.see_through = !look.see_through);
    /// Faces that pass through others.
    TOGGLE_CROSSINGS = Entry::new(
        "view.self-intersections",
        "Self-intersections",
        "Look for faces that pass through others whenever the surface rests, and point them out",
    )
    .on(|session| session.look.crossings)
    .look(|look| look.crossings = !look.crossings);
    /// The shape at rest instead of the pose.
    TOGGLE_REST = Entry::new("view.rest", "Rest shape", "Show the shape before it was bent; hold the key for a short look")
        .key(NONE, Key::O)
        .on(Session::shows_rest)
        .does(Session::toggle_rest);
    /// Ground grid.
    TOGGLE_GRID = Entry::new("view.grid", "Ground grid", "Show a grid below the mesh")
        .on(|session| session.look.grid)
        .look(|look| look.grid = !look.grid);
    /// Dots and gizmo.
    TOGGLE_HANDLES = Entry::new("view.handles", "Handles and gizmo", "Show handles, anchors and the gizmo")
        .on(|session| session.look.handles)
        .look(|look| look.handles = !look.handles);
    /// Fits selection or surface into the viewport.
    FRAME = Entry::new(
        "view.frame",
        "Frame selection or all",
        "Bring the selection, or else the whole surface, into view",
    )
    .key(NONE, Key::Period)
    .key(NONE, Key::Home)
    .apart()
    .does(Session::frame);
    /// Perspective or orthographic.
    TOGGLE_PROJECTION = Entry::new("view.orthographic", "Orthographic", "Show the mesh without vanishing points")
        .key(NONE, Key::P)
        .key(ALT, Key::Num5)
        .on(|session| session.open().is_some_and(|open| open.camera.projection == Projection::Orthographic))
        .does(toggle_projection);
    /// From the front.
    LOOK_FRONT = from("view.front", "Front").key(ALT, Key::Num1).does(|session| look_from(session, Axis::Front));
    /// From behind.
    LOOK_BACK = from("view.back", "Back").does(|session| look_from(session, Axis::Back));
    /// From the right.
    LOOK_RIGHT = from("view.right", "Right").key(ALT, Key::Num3).does(|session| look_from(session, Axis::Right));
    /// From the left.
    LOOK_LEFT = from("view.left", "Left").does(|session| look_from(session, Axis::Left));
    /// From above.
    LOOK_TOP = from("view.top", "Top").key(ALT, Key::Num7).does(|session| look_from(session, Axis::Top));
    /// From below.
    LOOK_BOTTOM = from("view.bottom", "Bottom").does(|session| look_from(session, Axis::Bottom));
    /// All methods side by side.
    COMPARE = Entry::new("view.compare", "Compare methods", "Solve the handles by every method, side by side")
        .key(NONE, Key::C)
        .apart()
        .on(|session| session.compare().is_some())
        .does(Session::toggle_compare);
    /// A larger window.
    LARGER_UI = Entry::new("view.larger-ui", "Larger text and buttons", "Make everything but the picture larger, up to 250 %")
        .key(CTRL, Key::Plus)
        .key(CTRL, Key::Equals)
        .anytime()
        .within("Size of text and buttons")
        .apart()
        .unless(|session| {
            let is_largest = session.habits.ui_scale >= *Habits::UI_SCALE.end();
            is_largest.then_some("Everything is as large as it gets: 250 %")
        })
        .does(|session| session.habits.scale_up());
    /// A smaller window.
    SMALLER_UI =
        Entry::new("view.smaller-ui", "Smaller text and buttons", "Make everything but the picture smaller, down to 75 %")
            .key(CTRL, Key::Minus)
            .anytime()
            .within("Size of text and buttons")
            .unless(|session| {
                let is_smallest = session.habits.ui_scale <= *Habits::UI_SCALE.start();
                is_smallest.then_some("Everything is as small as it gets: 75 %")
            })
            .does(|session| session.habits.scale_down());
    /// As the platform has it.
    NORMAL_UI = Entry::new("view.normal-ui", "Normal size", "Make text and buttons as large as the platform has them")
        .key(CTRL, Key::Num0)
        .anytime()
        .within("Size of text and buttons")
        .unless(|session| (session.habits.ui_scale == 1.0).then_some("Everything has its normal size"))
        .does(|session| session.habits.ui_scale = 1.0);
    /// Dark or light.
    TOGGLE_THEME = Entry::new("view.light", "Light window", "Switch between the light and the dark window")
        .anytime()
        .on(|session| session.look.theme == Theme::Light)
        .look(|look| look.theme = if look.theme == Theme::Dark { Theme::Light } else { Theme::Dark });
}

const fn color(id: &'static str, color_by: ColorBy) -> Entry {
    Entry::new(id, color_by.label(), color_by.tooltip()).within("Color by")
}

const fn from(id: &'static str, label: &'static str) -> Entry {
    Entry::new(id, label, "Look along an axis").within("Look from")
}

fn look_from(session: &mut Session, axis: Axis) {
    if let Some(open) = session.open_mut() {
        open.camera.look_along(axis);
    }
}

fn toggle_projection(session: &mut Session) {
    if let Some(open) = session.open_mut() {
        open.camera.projection = match open.camera.projection {
            Projection::Perspective => Projection::Orthographic,
            Projection::Orthographic => Projection::Perspective,
        };
    }
}
