//! What the hint line says.

use super::{PlaceTool, State, Target};
use crate::document::GroupKind;
use crate::tools::{Context, GizmoPart};

impl PlaceTool {
    /// What the mouse and the keys do now.
    pub(super) fn words(&self, context: &Context<'_>) -> String {
        match &self.state {
            State::Typing(grip) => {
                let what = match grip.taken() {
                    part if part.turns() => "an angle in degrees",
                    part if part.scales() => "a factor",
                    _ => "a distance",
                };
                format!("Type {what} · X Y Z choose the axis · Enter applies · Esc takes it back")
            }
            State::Pressed(grip) | State::Dragging(grip) => {
                let keys = match grip.taken() {
                    part if part.turns() => "Ctrl snaps to 15°",
                    part if part.scales() => "Ctrl snaps to tenths",
                    GizmoPart::Move(_) => "Ctrl snaps to the grid, Alt to a vertex",
                    _ => "Shift keeps to an axis · Ctrl snaps to the grid, Alt to a vertex",
                };
                if let Some(target) = grip.target() {
                    return format!(
                        "On vertex {} of the surface · Shift keeps to an axis · Esc takes it back",
                        target.vertex.0
                    );
                }
                format!("{keys} · X Y Z lock an axis · or type a number · Esc takes it back")
            }
            State::PickingPivot => "Click the surface where the pivot shall be · Esc leaves it where it was".into(),
            State::Idle { hover } => self.idle_words(*hover, context),
        }
    }

    fn idle_words(&self, hover: Option<Target>, context: &Context<'_>) -> String {
        let scene = context.document.scene();
        let size = |center| {
            let n = self.previewed(center, context).len();
            format!("{n} {} · [ ] change the size", if n == 1 { "vertex" } else { "vertices" })
        };
        match (hover, self.kind) {
            (Some(Target::Gizmo(part)), _) => {
                let what = match part {
                    GizmoPart::Free => "move",
                    GizmoPart::Move(_) => "move along this axis",
                    GizmoPart::MovePlane(_) => "move in this plane",
                    GizmoPart::Rotate(_) => "turn about this axis",
                    GizmoPart::RotateView => "turn in the plane of the view",
                    GizmoPart::Scale => "scale",
                    GizmoPart::ScaleAxis(_) => "scale along this axis",
                };
                format!("Drag to {what} · or click and type a number")
            }
            (Some(Target::Group(id)), kind) => {
                let name = scene.group(id).map_or("", |group| &group.name);
                let is_moved =
                    kind == GroupKind::Handle && scene.group(id).is_some_and(|group| group.kind == GroupKind::Handle);
                let click = if is_moved { "drag to bend" } else { "click to choose" };
                format!("{name}: {click} · Shift+click chooses several · Del removes")
            }
            (Some(Target::Surface(pick)), GroupKind::Handle) if scene.groups.is_empty() => {
                format!("Click to hold the surface here, then place another handle to pull: {}", size(pick.vertex))
            }
            (Some(Target::Surface(pick)), GroupKind::Handle) => {
                format!("Click or drag: a new handle of {}", size(pick.vertex))
            }
            (Some(Target::Surface(pick)), GroupKind::Anchor) => format!("Click: hold in place {}", size(pick.vertex)),
            (None, GroupKind::Handle) => "Click the surface to place handles, drag them to bend".into(),
            (None, GroupKind::Anchor) => "Click the surface to hold it in place".into(),
        }
    }
}
