//! The handle and anchor tools: click to hold a patch, drag to bend, gizmo for the active group.

use glam::{DAffine3, Vec2, Vec3};
use pliant_solver::VertexId;

use super::region::patch;
use super::{Context, Cursor, Gizmo, GizmoPart, Input, Marks, Pick, Pointer, Reaction, Tool, ToolKey, View};
use crate::document::{Command, Group, GroupId, GroupKind, Model};
use crate::viewport::Dot;

/// A press that moves less than this many points is a click (by eye).
const CLICK_PX: f32 = 3.0;
/// How near, in points, the pointer must be to the middle of a group to take it.
const REACH_PX: f32 = 11.0;
/// Of larger groups only so many vertices are marked under the pointer.
const MARKED_VERTICES: usize = 200;
/// Preview of what a click would hold.
const PREVIEW_COLOR: [u8; 4] = [255, 255, 255, 150];

/// What is under the pointer.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Target {
    Gizmo(GizmoPart),
    Group(GroupId),
    Surface(Pick),
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum State {
    Idle {
        hover: Option<Target>,
    },
    /// Button down on a group or gizmo part; nothing moved yet.
    Pressed {
        grip: Grip,
    },
    /// The group follows the pointer.
    Dragging {
        grip: Grip,
    },
}

/// What is being dragged, as it was when the button went down.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Grip {
    group: GroupId,
    part: Option<GizmoPart>,
    /// Middle of the group then, view space.
    center: Vec3,
    from_px: Vec2,
    motion: DAffine3,
    /// The press also placed the group: releasing without a move keeps it.
    placed: bool,
}

/// Handles or anchors, by kind.
pub(super) struct PlaceTool {
    kind: GroupKind,
    state: State,
}

impl PlaceTool {
    pub(super) fn new(kind: GroupKind) -> PlaceTool {
        PlaceTool { kind, state: State::Idle { hover: None } }
    }

    fn press(&mut self, pointer: Pointer, context: &mut Context<'_>) -> Reaction {
        match self.target(pointer.px, context) {
            Some(Target::Gizmo(part)) => match context.document.scene().active_group() {
                Some(group) => self.grip(group, Some(part), pointer.px, context.document.model()),
                None => Reaction::default(),
            },
            Some(Target::Group(id)) => match context.document.scene().group(id) {
                Some(group) if group.kind == GroupKind::Handle && self.kind == GroupKind::Handle => {
                    let mut reaction = self.grip(group, None, pointer.px, context.document.model());
                    reaction.commands.insert(0, Command::Activate(Some(id)));
                    reaction
                }
                _ => vec![Command::Activate(Some(id))].into(),
            },
            Some(Target::Surface(pick)) => self.place(pick, pointer.px, context),
            None => vec![Command::Activate(None)].into(),
        }
    }

    fn grip(&mut self, group: &Group, part: Option<GizmoPart>, from_px: Vec2, model: &Model) -> Reaction {
        let center = model.to_view(group.center());
        let grip = Grip { group: group.id, part, center, from_px, motion: group.motion, placed: false };
        self.state = State::Pressed { grip };
        vec![Command::Begin("Move handle")].into()
    }

    fn place(&mut self, pick: Pick, from_px: Vec2, context: &Context<'_>) -> Reaction {
        let vertices = patch(&context.document.model().mesh, pick.vertex, context.options.patch_rings);
        let hold = Command::Hold { kind: self.kind, vertices };
        if self.kind == GroupKind::Anchor {
            return vec![hold].into();
        }
        let group = context.document.next_group();
        let motion = DAffine3::IDENTITY;
        let grip = Grip { group, part: None, center: pick.position, from_px, motion, placed: true };
        self.state = State::Pressed { grip };
        vec![Command::Begin("Place handle"), hold].into()
    }

    fn drag(&mut self, pointer: Pointer, context: &Context<'_>) -> Reaction {
        let (State::Pressed { grip } | State::Dragging { grip }) = self.state else {
            return Reaction::default();
        };
        let is_click = matches!(self.state, State::Pressed { .. }) && pointer.px.distance(grip.from_px) < CLICK_PX;
        if is_click {
            return Reaction::default();
        }
        self.state = State::Dragging { grip };
        match moved(&grip, pointer, &context.view) {
            Some(in_view) => {
                let motion = in_world(in_view, context.document.model()) * grip.motion;
                vec![Command::Move { group: grip.group, motion }].into()
            }
            None => Reaction::default(),
        }
    }

    /// What the pointer would take: gizmo first, then groups, then the surface.
    fn target(&self, px: Vec2, context: &mut Context<'_>) -> Option<Target> {
        let view = context.view;
        if let Some(part) = self.gizmo(context).and_then(|gizmo| gizmo.hit(px, &view)) {
            return Some(Target::Gizmo(part));
        }
        let pick = context.surface.pick(px, &view);
        let (scene, model) = (context.document.scene(), context.document.model());
        if let Some(group) = pick.and_then(|pick| scene.group_holding(pick.vertex)) {
            return Some(Target::Group(group.id));
        }
        // Anchors are taken by their vertices: their middle may lie in the open.
        let handles = scene.groups.iter().filter(|group| group.kind == GroupKind::Handle);
        let reachable = handles.filter_map(|group| {
            let (at, _) = view.camera.project(model.to_view(group.center()), view.size)?;
            let distance = at.distance(px);
            (distance < REACH_PX).then_some((distance, group.id))
        });
        match reachable.min_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((_, id)) => Some(Target::Group(id)),
            None => pick.map(Target::Surface),
        }
    }

    fn gizmo(&self, context: &Context<'_>) -> Option<Gizmo> {
        let group = context.document.scene().active_group()?;
        let is_handle = self.kind == GroupKind::Handle && group.kind == GroupKind::Handle;
        let shown = is_handle && context.options.show_gizmo;
        shown.then(|| Gizmo::new(context.document.model().to_view(group.center()), &context.view))
    }

    fn delete(&self, context: &Context<'_>) -> Reaction {
        let hovered = match self.state {
            State::Idle { hover: Some(Target::Group(id)) } => Some(id),
            _ => None,
        };
        let active = &context.document.scene().active;
        match hovered {
            Some(id) if !active.contains(id) => vec![Command::Release(vec![id])].into(),
            _ if active.is_empty() => Reaction::default(),
            _ => vec![Command::Release(active.ids().to_vec())].into(),
        }
    }
}

/// Motion in view space for the way the pointer went.
fn moved(grip: &Grip, pointer: Pointer, view: &View) -> Option<DAffine3> {
    if let Some(part) = grip.part {
        return Gizmo::new(grip.center, view).drag(part, grip.from_px, pointer.px, pointer.modifiers, view);
    }
    let mut way = view.camera.drag_in_view_plane(grip.center, pointer.px - grip.from_px, view.size);
    if pointer.modifiers.shift {
        let longest = (0..3).max_by(|&a, &b| way[a].abs().total_cmp(&way[b].abs())).unwrap_or(0);
        way = Vec3::AXES[longest] * way[longest];
    }
    Some(DAffine3::from_translation(way.as_dvec3()))
}

/// The same motion with world space's origin.
fn in_world(in_view: DAffine3, model: &Model) -> DAffine3 {
    if in_view.matrix3 == glam::DMat3::IDENTITY {
        return in_view;
    }
    DAffine3::from_translation(model.origin) * in_view * DAffine3::from_translation(-model.origin)
}

impl Tool for PlaceTool {
    fn handle(&mut self, input: Input, context: &mut Context<'_>) -> Reaction {
        let is_idle = matches!(self.state, State::Idle { .. });
        match input {
            Input::Hover(pointer) if is_idle => {
                self.state = State::Idle { hover: self.target(pointer.px, context) };
                Reaction::default()
            }
            Input::Leave if is_idle => {
                self.state = State::Idle { hover: None };
                Reaction::default()
            }
            Input::Press(pointer) if is_idle => self.press(pointer, context),
            Input::Drag(pointer) => self.drag(pointer, context),
            Input::Release(pointer) if !is_idle => {
                let mut reaction = self.drag(pointer, context);
                self.state = State::Idle { hover: None };
                reaction.commands.push(Command::Commit);
                reaction
            }
            Input::Key(ToolKey::Escape) if !is_idle => {
                self.state = State::Idle { hover: None };
                vec![Command::Cancel].into()
            }
            Input::Key(ToolKey::Escape) => vec![Command::Activate(None)].into(),
            Input::Key(ToolKey::Delete) if is_idle => self.delete(context),
            _ => Reaction::default(),
        }
    }

    fn hint(&self, context: &Context<'_>) -> String {
        let hint = match (self.state, self.kind) {
            (State::Pressed { grip } | State::Dragging { grip }, _) => match grip.part {
                Some(GizmoPart::Rotate(_)) => "Ctrl snaps to 15° · Esc takes the move back",
                Some(_) => "Esc takes the move back",
                None => "Shift keeps to an axis · Esc takes the move back",
            },
            (State::Idle { hover: Some(Target::Gizmo(GizmoPart::Move(_))) }, _) => "Drag to move along this axis",
            (State::Idle { hover: Some(Target::Gizmo(GizmoPart::Rotate(_))) }, _) => "Drag to turn about this axis",
            (State::Idle { hover: Some(Target::Gizmo(GizmoPart::Scale)) }, _) => "Drag to scale",
            (State::Idle { hover: Some(Target::Group(_)) }, GroupKind::Handle) => "Drag to bend · Del removes",
            (State::Idle { hover: Some(Target::Group(_)) }, GroupKind::Anchor) => "Click to choose · Del removes",
            (State::Idle { hover: Some(Target::Surface(_)) }, GroupKind::Handle)
                if context.document.scene().groups.is_empty() =>
            {
                "Click to place a first handle that holds the surface, then another one to pull"
            }
            (State::Idle { hover: Some(Target::Surface(_)) }, GroupKind::Handle) => "Click or drag: a new handle here",
            (State::Idle { hover: Some(Target::Surface(_)) }, GroupKind::Anchor) => "Click: hold this patch in place",
            (State::Idle { hover: None }, GroupKind::Handle) => "Click the surface to place handles, drag them to bend",
            (State::Idle { hover: None }, GroupKind::Anchor) => "Click the surface to hold it in place",
        };
        hint.into()
    }

    fn marks(&self, context: &Context<'_>) -> Marks {
        let mut marks = Marks::default();
        let hot = match self.state {
            State::Idle { hover: Some(Target::Gizmo(part)) } => Some(part),
            State::Pressed { grip } | State::Dragging { grip } => grip.part,
            State::Idle { .. } => None,
        };
        if let Some(gizmo) = self.gizmo(context) {
            marks.lines = gizmo.lines(hot, &context.view);
        }
        let positions = &context.surface.frame().positions;
        let dot = |v: &VertexId| Dot { position: positions[v.index()], color: PREVIEW_COLOR, radius_px: 2.5 };
        match self.state {
            State::Idle { hover: Some(Target::Surface(pick)) } => {
                let preview = patch(&context.document.model().mesh, pick.vertex, context.options.patch_rings);
                marks.dots = preview.iter().map(dot).collect();
            }
            State::Idle { hover: Some(Target::Group(id)) } => {
                let held = context.document.scene().group(id).map_or(&[][..], |group| &group.vertices);
                marks.dots = held.iter().step_by(held.len().div_ceil(MARKED_VERTICES).max(1)).map(dot).collect();
            }
            _ => {}
        }
        marks
    }

    fn cursor(&self) -> Cursor {
        match self.state {
            State::Pressed { .. } | State::Dragging { .. } => Cursor::Grabbing,
            State::Idle { hover: Some(Target::Group(_) | Target::Gizmo(_)) } => Cursor::Grab,
            State::Idle { hover: Some(Target::Surface(_)) } => Cursor::Cross,
            State::Idle { hover: None } => Cursor::Arrow,
        }
    }

    fn is_active(&self) -> bool {
        !matches!(self.state, State::Idle { .. })
    }
}
