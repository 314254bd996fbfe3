//! What a drag holds: the handles as they were when it began, and how the pointer, the keys held and what is typed move
//! them.

use std::sync::Arc;

use glam::{DAffine3, DVec2, DVec3, Vec2};

use super::snap::{self, Target};
use crate::document::{Change, Command, Group, GroupId, GroupKind, Scene};
use crate::tools::{Context, Gizmo, GizmoPart, GizmoSettings, Pointer, View, length};
use crate::viewport::{Line, SurfaceFrame};

/// More digits than a number can use.
const LONGEST_NUMBER: usize = 20;

/// A handle that is being moved.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Member {
    id: GroupId,
    /// Its motion when the drag began.
    motion: DAffine3,
    /// The point that stays in place when it is turned, world space.
    pivot: DVec3,
}

/// A drag under way, as a value.
#[derive(Clone, Debug)]
pub(super) struct Grip {
    part: GizmoPart,
    gizmo: Gizmo,
    members: Vec<Member>,
    /// The middle of the handle that leads, world space, and the surface: both as they were when the drag began.
    lead: DVec3,
    frame: Arc<SurfaceFrame>,
    /// The vertex that the leading handle lies on.
    target: Option<Target>,
    /// The axis that a key has locked.
    lock: Option<usize>,
    typed: String,
    from_px: Vec2,
    last: Pointer,
    /// The groups to work on if nothing is moved.
    pub(super) on_click: Option<Vec<GroupId>>,
}

impl Grip {
    /// Nothing yet, taken by a part of the gizmo or as it is.
    pub(super) fn new(part: GizmoPart, gizmo: Gizmo, at: Pointer, frame: &Arc<SurfaceFrame>) -> Grip {
        Grip {
            part,
            gizmo,
            members: Vec::new(),
            lead: DVec3::ZERO,
            frame: frame.clone(),
            target: None,
            lock: None,
            typed: String::new(),
            from_px: at.px,
            last: at,
            on_click: None,
        }
    }

    /// With all active handles of a scene. `place` is where the gizmo stands, world space.
    pub(super) fn holding(self, scene: &Scene, settings: &GizmoSettings, place: DVec3) -> Grip {
        let handles = || scene.active_groups().filter(|group| group.kind == GroupKind::Handle);
        let lead = handles().last().map_or(place, Group::center);
        let member =
            |group: &Group| Member { id: group.id, motion: group.motion, pivot: settings.pivot_of(group, place) };
        Grip { members: handles().map(member).collect(), lead, ..self }
    }

    /// With a handle that is about to be placed.
    pub(super) fn holding_new(self, id: GroupId, pivot: DVec3) -> Grip {
        Grip { members: vec![Member { id, motion: DAffine3::IDENTITY, pivot }], lead: pivot, ..self }
    }

    /// How far the pointer is from where the drag began, in points.
    pub(super) fn distance(&self, px: Vec2) -> f32 {
        px.distance(self.from_px)
    }

    /// Follows the pointer; with Alt it looks for a vertex to lie on.
    pub(super) fn follow(&mut self, pointer: Pointer, context: &Context<'_>) {
        self.last = pointer;
        let moves = !self.part.turns() && !self.part.scales();
        self.target = if moves && pointer.modifiers.alt {
            let scene = context.document.scene();
            let own: Vec<&Group> = self.members.iter().filter_map(|member| scene.group(member.id)).collect();
            snap::target(&self.frame, pointer.px, &context.view, |v| own.iter().any(|group| group.holds(v)))
        } else {
            None
        };
    }

    /// The vertex that the handle lies on now, if it does.
    pub(super) fn target(&self) -> Option<&Target> {
        self.target.as_ref().filter(|_| !self.is_typed())
    }

    /// How far it is onto that vertex, as far as a part can go there.
    fn way_onto(&self, part: GizmoPart, context: &Context<'_>) -> Option<DVec3> {
        let position = context.document.model().to_world(self.target()?.position);
        self.gizmo.share(part, position - self.lead)
    }

    /// Locks to an axis, or frees what was locked to it.
    pub(super) fn lock(&mut self, axis: usize) {
        self.lock = (self.lock != Some(axis)).then_some(axis);
    }

    /// Takes a sign of a number. Returns whether it was one.
    pub(super) fn type_sign(&mut self, sign: char) -> bool {
        match sign {
            '-' if self.typed.starts_with('-') => drop(self.typed.remove(0)),
            '-' => self.typed.insert(0, '-'),
            '.' | ',' if self.typed.contains('.') => return false,
            '.' | ',' => self.typed.push('.'),
            '0'..='9' if self.typed.len() < LONGEST_NUMBER => self.typed.push(sign),
            _ => return false,
        }
        true
    }

    /// Takes back the last sign.
    pub(super) fn erase(&mut self) {
        self.typed.pop();
    }

    /// Whether anything has been typed.
    pub(super) fn is_typed(&self) -> bool {
        !self.typed.is_empty()
    }

    /// The part that acts, with locks and keys held.
    pub(super) fn part(&self, view: &View) -> GizmoPart {
        let is_plane = matches!(self.part, GizmoPart::Free | GizmoPart::MovePlane(_));
        match self.lock {
            Some(axis) => self.part.locked_to(axis),
            None if is_plane && self.last.modifiers.shift => {
                GizmoPart::Move(self.gizmo.main_axis(self.from_px, self.last.px, view))
            }
            None => self.part,
        }
    }

    /// The part as it was taken, for highlighting.
    pub(super) fn taken(&self) -> GizmoPart {
        self.part
    }

    /// What the drag comes to now: way, angle in radians, or factor.
    fn amount(&self, part: GizmoPart, context: &Context<'_>) -> Option<DVec2> {
        let measured = self.gizmo.measure(part, self.from_px, self.last.px, &context.view);
        match self.typed.parse::<f64>() {
            Ok(value) => Some(Gizmo::typed(part, value, measured)),
            Err(_) if self.is_typed() => None,
            Err(_) if self.last.modifiers.ctrl => Some(Gizmo::snap(part, measured?, context.options.gizmo.step)),
            Err(_) => measured,
        }
    }

    /// The motions that follow. `None` where the pointer says nothing, or a number is not yet one.
    pub(super) fn motions(&self, context: &Context<'_>) -> Option<Command> {
        let part = self.part(&context.view);
        let change = match self.way_onto(part, context) {
            Some(way) => Change::moved(way),
            None => self.gizmo.change(part, self.amount(part, context)?),
        };
        let moved = |member: &Member| (member.id, change.about(member.pivot) * member.motion);
        Some(Command::MoveSeveral(self.members.iter().map(moved).collect()))
    }

    /// The drag in a few words and numbers.
    pub(super) fn reading(&self, context: &Context<'_>) -> String {
        let part = self.part(&context.view);
        let axis = match part {
            GizmoPart::Move(axis) | GizmoPart::Rotate(axis) | GizmoPart::ScaleAxis(axis) => ["x ", "y ", "z "][axis],
            _ => "",
        };
        let unit = if part.turns() { "°" } else { "" };
        if self.is_typed() {
            return format!("{axis}{}{}{unit}", if part.scales() { "× " } else { "" }, self.typed);
        }
        let length = |x: f64| length(x, f64::from(context.document.model().diagonal()));
        if let Some(way) = self.way_onto(part, context) {
            return format!("{axis}{}, onto a vertex", length(way.length()));
        }
        let Some(amount) = self.amount(part, context) else { return axis.trim().to_owned() };
        match part {
            _ if part.turns() => format!("{axis}{:.1}°", amount.x.to_degrees()),
            _ if part.scales() => format!("{axis}× {:.3}", amount.x),
            GizmoPart::Free => length(amount.length()),
            GizmoPart::MovePlane(_) => format!("{}, {}", length(amount.x), length(amount.y)),
            _ => format!("{axis}{}", length(amount.x)),
        }
    }

    /// Where the reading is shown: at the pointer.
    pub(super) fn place(&self) -> Vec2 {
        self.last.px
    }

    /// The long line of the axis that was locked, through the gizmo where it is now.
    pub(super) fn axis_line(&self, gizmo: &Gizmo, view: &View) -> Option<Line> {
        let part = self.part(view);
        (part != self.part || self.lock.is_some()).then(|| gizmo.axis_line(part)).flatten()
    }

    /// Name of the step.
    pub(super) fn step_name(&self) -> &'static str {
        match self.part {
            part if part.turns() => "Turn handle",
            part if part.scales() => "Scale handle",
            _ => "Move handle",
        }
    }
}
