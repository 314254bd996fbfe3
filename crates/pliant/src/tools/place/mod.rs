//! The handle and anchor tools: click to hold a patch, drag to bend, gizmo and typed values for the active handles.

mod grip;
mod snap;
mod words;

use std::borrow::Cow;

use glam::{DMat3, DVec3, Vec2};
use pliant_solver::VertexId;

use super::region::patch;
use super::{
    Context, Cursor, Gizmo, GizmoPart, GizmoShown, Input, Label, Marks, Pick, Pointer, Reaction, Tool, ToolKey,
};
use crate::document::{ActiveGroups, Command, Group, GroupId, GroupKind};
use crate::viewport::Dot;
use grip::Grip;

/// A press that moves less than this many points is a click (by eye).
const CLICK_PX: f32 = 3.0;
/// How near, in points, the pointer must be to the middle of a group to take it.
const REACH_PX: f32 = 11.0;
/// Handles nearer to each other on screen than this many points cannot be told apart (by eye).
const SAME_PX: f32 = 3.0;
/// Of larger patches and groups only so many vertices are marked under the pointer.
const MARKED_VERTICES: usize = 400;
/// Preview of what a click would hold.
const PREVIEW_COLOR: [u8; 4] = [255, 255, 255, 150];

/// What is under the pointer.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Target {
    Gizmo(GizmoPart),
    Group(GroupId),
    Surface(Pick),
}

#[derive(Clone, Debug)]
enum State {
    Idle {
        hover: Option<Target>,
    },
    /// Button down on a group or gizmo part; nothing moved yet.
    Pressed(Grip),
    /// The handles follow the pointer or what is typed.
    Dragging(Grip),
    /// A part of the gizmo was clicked: it waits for a number.
    Typing(Grip),
    /// The next click on the surface is the pivot.
    PickingPivot,
}

/// The patch that a click would hold.
#[derive(Clone, Debug, PartialEq)]
struct Preview {
    center: VertexId,
    rings: u16,
    vertices: Vec<VertexId>,
}

/// Handles or anchors, by kind.
pub(super) struct PlaceTool {
    kind: GroupKind,
    state: State,
    preview: Option<Preview>,
    /// Where the pointer was last seen.
    pointer: Option<Vec2>,
}

impl PlaceTool {
    pub(super) fn new(kind: GroupKind) -> PlaceTool {
        PlaceTool { kind, state: State::Idle { hover: None }, preview: None, pointer: None }
    }

    fn rest(&mut self) {
        self.state = State::Idle { hover: None };
    }

    fn hover(&mut self, px: Vec2, context: &mut Context<'_>) {
        self.pointer = Some(px);
        let hover = self.target(px, context);
        if let Some(Target::Surface(pick)) = hover {
            self.look_at(pick.vertex, context);
        }
        self.state = State::Idle { hover };
    }

    /// Finds the patch that a click would hold, unless it is known.
    fn look_at(&mut self, center: VertexId, context: &Context<'_>) {
        let rings = context.options.patch_rings;
        if self.preview.as_ref().is_none_or(|known| (known.center, known.rings) != (center, rings)) {
            let vertices = patch(&context.document.model().mesh, center, rings);
            self.preview = Some(Preview { center, rings, vertices });
        }
    }

    /// The patch that a click on the surface would hold.
    fn previewed<'a>(&'a self, center: VertexId, context: &Context<'_>) -> Cow<'a, [VertexId]> {
        let rings = context.options.patch_rings;
        match &self.preview {
            Some(known) if (known.center, known.rings) == (center, rings) => Cow::Borrowed(&known.vertices),
            // The size was changed by a key while the pointer rested.
            _ => Cow::Owned(patch(&context.document.model().mesh, center, rings)),
        }
    }

    fn press(&mut self, pointer: Pointer, context: &mut Context<'_>) -> Reaction {
        match self.target(pointer.px, context) {
            Some(Target::Gizmo(part)) => self.take(part, pointer, context),
            Some(Target::Group(id)) => self.choose(id, pointer, context),
            Some(Target::Surface(pick)) => self.place(pick, pointer, context),
            None if pointer.modifiers.shift => Reaction::default(),
            None => vec![Command::Activate(None)].into(),
        }
    }

    /// Takes the active handles by a part of the gizmo.
    fn take(&mut self, part: GizmoPart, pointer: Pointer, context: &Context<'_>) -> Reaction {
        let Some((gizmo, place)) = self.gizmo(context) else { return Reaction::default() };
        let grip = Grip::new(part, gizmo, pointer, context.surface.frame());
        let grip = grip.holding(context.document.scene(), &context.options.gizmo, place);
        let begin = Command::Begin(grip.step_name());
        self.state = State::Pressed(grip);
        vec![begin].into()
    }

    /// A press on a group: works on it, with Shift on it as well, and takes it if it can be moved.
    fn choose(&mut self, id: GroupId, pointer: Pointer, context: &Context<'_>) -> Reaction {
        let scene = context.document.scene();
        let (shift, was_active) = (pointer.modifiers.shift, scene.active.contains(id));
        let group = scene.group(id).filter(|group| group.kind == GroupKind::Handle && self.kind == GroupKind::Handle);
        let Some(group) = group else {
            let ids = if shift { scene.active.toggled(id) } else { vec![id] };
            return vec![Command::ActivateSeveral(ids)].into();
        };
        let chosen = match (shift, was_active) {
            (false, false) => vec![id],
            (true, false) => scene.active.toggled(id),
            // Those that are worked on together are dragged together, led by the one that was taken.
            (_, true) => [scene.active.toggled(id), vec![id]].concat(),
        };
        let mut after = scene.clone();
        after.active = ActiveGroups::new(chosen.clone());
        let settings = &context.options.gizmo;
        let (axes, place) = (settings.axes(&after, &context.view), settings.place(&after).unwrap_or(group.center()));
        // The drag follows the pointer at the depth of the handle that was taken, wherever the gizmo stands.
        let center = context.document.model().to_view(group.center());
        let gizmo = Gizmo::new(center, axes, settings.shown, &context.view);
        let mut grip = Grip::new(GizmoPart::Free, gizmo, pointer, context.surface.frame());
        grip = grip.holding(&after, settings, place);
        grip.on_click = match (shift, was_active) {
            (true, true) => Some(scene.active.toggled(id)),
            (false, true) if scene.active.len() == 1 => self.beneath(group, context).map(|next| vec![next]),
            _ => None,
        };
        self.state = State::Pressed(grip);
        vec![Command::ActivateSeveral(chosen), Command::Begin("Move handle")].into()
    }

    /// The next handle in the same place, where several lie upon each other: clicks go through them.
    fn beneath(&self, group: &Group, context: &Context<'_>) -> Option<GroupId> {
        let model = context.document.model();
        let on_screen = |group: &Group| context.view.camera.project(model.to_view(group.center()), context.view.size);
        let (here, _) = on_screen(group)?;
        let is_here = |other: &&Group| {
            other.kind == GroupKind::Handle && on_screen(other).is_some_and(|(px, _)| px.distance(here) < SAME_PX)
        };
        let pile: Vec<GroupId> = context.document.scene().groups.iter().filter(is_here).map(|other| other.id).collect();
        let next = pile[(pile.iter().position(|&id| id == group.id)? + 1) % pile.len()];
        (next != group.id).then_some(next)
    }

    fn place(&mut self, pick: Pick, pointer: Pointer, context: &Context<'_>) -> Reaction {
        let vertices = self.previewed(pick.vertex, context).into_owned();
        let hold = Command::Hold { kind: self.kind, vertices };
        if self.kind == GroupKind::Anchor {
            return vec![hold].into();
        }
        let gizmo = Gizmo::new(pick.position, DMat3::IDENTITY, GizmoShown::All, &context.view);
        let pivot = context.document.model().origin + pick.position.as_dvec3();
        let grip = Grip::new(GizmoPart::Free, gizmo, pointer, context.surface.frame());
        let grip = grip.holding_new(context.document.next_group(), pivot);
        self.state = State::Pressed(grip);
        vec![Command::Begin("Place handle"), hold].into()
    }

    fn drag(&mut self, pointer: Pointer, context: &Context<'_>) -> Reaction {
        let (State::Pressed(grip) | State::Dragging(grip)) = &mut self.state else {
            return Reaction::default();
        };
        let is_click = grip.distance(pointer.px) < CLICK_PX && !grip.is_typed();
        grip.follow(pointer, context);
        if is_click && matches!(self.state, State::Pressed(_)) {
            return Reaction::default();
        }
        self.moved(context)
    }

    /// What the grip comes to now; from here on it is a drag.
    fn moved(&mut self, context: &Context<'_>) -> Reaction {
        let (State::Pressed(grip) | State::Dragging(grip)) = &self.state else { return Reaction::default() };
        let reaction = grip.motions(context).map(|motions| vec![motions].into()).unwrap_or_default();
        self.state = State::Dragging(grip.clone());
        reaction
    }

    fn release(&mut self, pointer: Pointer, context: &Context<'_>) -> Reaction {
        let mut reaction = self.drag(pointer, context);
        match std::mem::replace(&mut self.state, State::Idle { hover: None }) {
            State::Pressed(Grip { on_click: Some(chosen), .. }) => {
                reaction.commands.push(Command::ActivateSeveral(chosen));
            }
            // A click on a part of the gizmo: a number may follow. The step begins with its first digit.
            State::Pressed(grip) if grip.taken() != GizmoPart::Free => self.state = State::Typing(grip),
            _ => {}
        }
        reaction.commands.push(Command::Commit);
        reaction
    }

    /// A digit, a sign, an axis: what it does to the drag under way, or to the part that waits for a number.
    fn type_key(&mut self, key: ToolKey, context: &Context<'_>) -> Reaction {
        let is_waiting = matches!(self.state, State::Typing(_));
        let (State::Pressed(grip) | State::Dragging(grip) | State::Typing(grip)) = &mut self.state else {
            return Reaction::default();
        };
        let was_typed = grip.is_typed();
        match key {
            ToolKey::Axis(axis) => grip.lock(axis),
            ToolKey::Sign(sign) if !grip.type_sign(sign) => return Reaction::default(),
            ToolKey::Erase => grip.erase(),
            _ => {}
        }
        if !is_waiting {
            return self.moved(context);
        }
        match (was_typed, grip.is_typed()) {
            (false, false) => Reaction::default(),
            (true, false) => vec![Command::Cancel].into(),
            (was_typed, true) => {
                let begin = (!was_typed).then(|| Command::Begin(grip.step_name()));
                begin.into_iter().chain(grip.motions(context)).collect::<Vec<_>>().into()
            }
        }
    }

    /// Keeps what was typed or dragged so far.
    fn finish(&mut self) -> Reaction {
        match std::mem::replace(&mut self.state, State::Idle { hover: None }) {
            State::Typing(grip) if !grip.is_typed() => Reaction::default(),
            State::Typing(_) | State::Pressed(_) | State::Dragging(_) => vec![Command::Commit].into(),
            State::Idle { .. } | State::PickingPivot => Reaction::default(),
        }
    }

    /// Takes back what is under way, or else works on nothing.
    fn escape(&mut self) -> Reaction {
        match std::mem::replace(&mut self.state, State::Idle { hover: None }) {
            State::Idle { .. } => vec![Command::Activate(None)].into(),
            State::PickingPivot => Reaction::default(),
            State::Typing(grip) if !grip.is_typed() => Reaction::default(),
            State::Pressed(_) | State::Dragging(_) | State::Typing(_) => vec![Command::Cancel].into(),
        }
    }

    /// The surface under the pointer becomes the pivot; if the pointer is elsewhere, the next click tells.
    fn pick_pivot(&mut self, px: Option<Vec2>, context: &mut Context<'_>) -> Reaction {
        match px.and_then(|px| context.surface.pick(px, &context.view)) {
            Some(pick) => {
                self.rest();
                let pivot = context.document.model().origin + pick.position.as_dvec3();
                Reaction { pivot: Some(pivot), ..Reaction::default() }
            }
            None => {
                self.state = State::PickingPivot;
                Reaction::default()
            }
        }
    }

    /// What the pointer would take: gizmo first, then groups, then the surface.
    fn target(&self, px: Vec2, context: &mut Context<'_>) -> Option<Target> {
        let view = context.view;
        if let Some(part) = self.gizmo(context).and_then(|(gizmo, _)| gizmo.hit(px, &view)) {
            return Some(Target::Gizmo(part));
        }
        let pick = context.surface.pick(px, &view);
        let (scene, model) = (context.document.scene(), context.document.model());
        if let Some(group) = pick.and_then(|pick| scene.group_holding(pick.vertex)) {
            return Some(Target::Group(group.id));
        }
        // Anchors are taken by their vertices: their middle may lie in the open.
        let handles = scene.groups.iter().filter(|group| group.kind == GroupKind::Handle && group.dots);
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

    /// The gizmo of the active handles and where it stands in the world, if it is shown.
    fn gizmo(&self, context: &Context<'_>) -> Option<(Gizmo, DVec3)> {
        if self.kind != GroupKind::Handle || !context.options.show_gizmo {
            return None;
        }
        let (scene, settings) = (context.document.scene(), &context.options.gizmo);
        let place = settings.place(scene)?;
        let center = context.document.model().to_view(place);
        Some((Gizmo::new(center, settings.axes(scene, &context.view), settings.shown, &context.view), place))
    }

    fn delete(&mut self, context: &Context<'_>) -> Reaction {
        let hovered = match self.state {
            State::Idle { hover: Some(Target::Group(id)) } => Some(id),
            _ => None,
        };
        self.rest();
        let active = &context.document.scene().active;
        match hovered {
            Some(id) if !active.contains(id) => vec![Command::Release(vec![id])].into(),
            _ if active.is_empty() => Reaction::default(),
            _ => vec![Command::Release(active.ids().to_vec())].into(),
        }
    }
}

impl Tool for PlaceTool {
    fn handle(&mut self, input: Input, context: &mut Context<'_>) -> Reaction {
        match (input, &self.state) {
            (Input::Hover(pointer), State::Idle { .. }) => {
                self.hover(pointer.px, context);
                Reaction::default()
            }
            (Input::Hover(pointer), _) => {
                self.pointer = Some(pointer.px);
                Reaction::default()
            }
            (Input::Leave, state) => {
                self.pointer = None;
                if matches!(state, State::Idle { .. }) {
                    self.rest();
                }
                Reaction::default()
            }
            (Input::Press(pointer), State::PickingPivot) => self.pick_pivot(Some(pointer.px), context),
            (Input::Press(pointer), State::Idle { .. } | State::Typing(_)) => {
                let mut reaction = self.finish();
                reaction.commands.extend(self.press(pointer, context).commands);
                reaction
            }
            (Input::Drag(pointer), _) => self.drag(pointer, context),
            (Input::Release(pointer), State::Pressed(_) | State::Dragging(_)) => self.release(pointer, context),
            (Input::Key(ToolKey::Escape), _) => self.escape(),
            (Input::Key(ToolKey::Enter), _) => self.finish(),
            (Input::Key(key @ (ToolKey::Sign(_) | ToolKey::Erase | ToolKey::Axis(_))), _) => {
                self.type_key(key, context)
            }
            (Input::Key(ToolKey::Delete), State::Idle { .. }) => self.delete(context),
            (Input::Key(ToolKey::Pivot), State::Idle { .. } | State::PickingPivot) => {
                self.pick_pivot(self.pointer, context)
            }
            _ => Reaction::default(),
        }
    }

    fn hint(&self, context: &Context<'_>) -> String {
        self.words(context)
    }

    fn marks(&self, context: &Context<'_>) -> Marks {
        let mut marks = Marks::default();
        let grip = match &self.state {
            State::Pressed(grip) | State::Dragging(grip) | State::Typing(grip) => Some(grip),
            State::Idle { .. } | State::PickingPivot => None,
        };
        let hot = match (&self.state, grip) {
            (State::Idle { hover: Some(Target::Gizmo(part)) }, _) => Some(*part),
            (_, grip) => grip.map(Grip::taken),
        };
        if let Some((gizmo, _)) = self.gizmo(context) {
            marks.lines = gizmo.lines(hot, &context.view);
            marks.lines.extend(grip.and_then(|grip| grip.axis_line(&gizmo, &context.view)));
        }
        if let Some(grip) = grip.filter(|_| !matches!(self.state, State::Pressed(_))) {
            marks.lines.extend(grip.target().into_iter().flat_map(|target| target.lines(&context.view)));
            marks.label = Some(Label { px: grip.place(), text: grip.reading(context) });
        }
        let positions = &context.surface.frame().positions;
        let dot = |v: &VertexId| Dot { position: positions[v.index()], color: PREVIEW_COLOR, radius_px: 2.5 };
        let some = |all: &[VertexId]| all.iter().step_by(all.len().div_ceil(MARKED_VERTICES).max(1)).map(dot).collect();
        match self.state {
            State::Idle { hover: Some(Target::Surface(pick)) } => {
                marks.dots = some(&self.previewed(pick.vertex, context));
            }
            State::Idle { hover: Some(Target::Group(id)) } => {
                marks.dots = context.document.scene().group(id).map(|group| some(&group.vertices)).unwrap_or_default();
            }
            _ => {}
        }
        marks
    }

    fn cursor(&self) -> Cursor {
        match self.state {
            State::Pressed(_) | State::Dragging(_) => Cursor::Grabbing,
            State::Idle { hover: Some(Target::Group(_) | Target::Gizmo(_)) } => Cursor::Grab,
            State::Idle { hover: Some(Target::Surface(_)) } | State::PickingPivot => Cursor::Cross,
            State::Idle { hover: None } | State::Typing(_) => Cursor::Arrow,
        }
    }

    fn is_active(&self) -> bool {
        !matches!(self.state, State::Idle { .. })
    }

    fn takes_numbers(&self) -> bool {
        matches!(self.state, State::Pressed(_) | State::Dragging(_) | State::Typing(_))
    }

    fn waits_for_number(&self) -> bool {
        matches!(self.state, State::Typing(_))
    }
}
