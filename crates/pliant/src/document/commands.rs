//! The wishes that change a scene.

use glam::{DAffine3, DVec3};
use pliant_solver::{LooseComponents, Rigidity, RigidityError, VertexId, Weights};

use super::grouping::{add, hold, merge, remove};
use super::sets::change_sets;
use super::{
    ActiveGroups, Group, GroupColor, GroupId, GroupKind, Method, PoseChange, Scene, SelectMode, Selection, SetChange,
};

/// A wish. Tools, menus, keys and scripts all speak this language.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Opens a step that lasts until `Commit` or `Cancel`: a drag, a stroke.
    Begin(&'static str),
    /// Closes the open step. One that changed nothing leaves no trace.
    Commit,
    /// Takes back the open step.
    Cancel,
    /// Holds vertices where they are now; vertices of other groups change over.
    Hold {
        /// Handle or anchor.
        kind: GroupKind,
        /// At least one.
        vertices: Vec<VertexId>,
    },
    /// Lets vertices of some groups go.
    Release(Vec<GroupId>),
    /// Gives a group a new motion (of its base positions, world space).
    Move {
        /// Which.
        group: GroupId,
        /// Must be finite.
        motion: DAffine3,
    },
    /// Gives several groups new motions at once.
    MoveSeveral(Vec<(GroupId, DAffine3)>),
    /// Brings vertices into a group, held where they are now; vertices of other groups change over.
    AddToGroup(GroupId, Vec<VertexId>),
    /// Lets some vertices of a group go.
    RemoveFromGroup(GroupId, Vec<VertexId>),
    /// Makes one group of several: the last of them, where all are now.
    Merge(Vec<GroupId>),
    /// Changes the color of a group's dots.
    SetColor(GroupId, GroupColor),
    /// Shows or hides a group's dots.
    ShowDots(GroupId, bool),
    /// Puts a group back to the rest positions of its vertices.
    ReturnToRest(GroupId),
    /// Makes a handle an anchor or back.
    SetKind(GroupId, GroupKind),
    /// Gives a group another name.
    Rename(GroupId, String),
    /// Works on one group, or on none. Not a step of the history.
    Activate(Option<GroupId>),
    /// Works on several groups, the last of which leads. Not a step of the history.
    ActivateSeveral(Vec<GroupId>),
    /// Sets r of some vertices.
    Paint {
        /// Vertices and their new r ≥ 1.
        values: Vec<(VertexId, u16)>,
    },
    /// Sets r of some vertices to one value.
    Fill {
        /// Which.
        vertices: Vec<VertexId>,
        /// r ≥ 1.
        r: u16,
    },
    /// Sets r of every vertex.
    FillAll(u16),
    /// Sets r of every vertex to what was learned from poses: one r per surface point.
    Learn(Rigidity),
    /// Locks or unlocks vertices: while locked, their r stays whatever is painted, filled or learned.
    Lock(Vec<VertexId>, SelectMode),
    /// Changes the selection.
    Select(Vec<VertexId>, SelectMode),
    /// Stores, recalls or forgets a selection.
    Sets(SetChange),
    /// Changes the edge weights of the energy.
    SetWeights(Weights),
    /// Changes what parts without handles do.
    SetLoose(LooseComponents),
    /// Changes the method that bends the surface, or its parameters.
    SetMethod(Method),
    /// Every group back to rest, and the surface with them.
    ResetPose,
    /// Keeps, shows and arranges poses.
    Poses(PoseChange),
}

/// Why a command was refused. The scene is as it was.
#[derive(Debug, PartialEq, thiserror::Error)]
pub enum CommandError {
    /// The vertex does not exist.
    #[error("vertex {vertex} does not exist: the surface has {n_vertices}")]
    NoSuchVertex {
        /// Asked for.
        vertex: u32,
        /// There are.
        n_vertices: usize,
    },
    /// The group does not exist (any more).
    #[error("handle group {0} does not exist any more")]
    NoSuchGroup(u32),
    /// The kept pose does not exist (any more).
    #[error("this pose does not exist any more")]
    NoSuchPose,
    /// Nothing to hold.
    #[error("no vertex to hold: select some first")]
    NothingToHold,
    /// An empty selection cannot be stored.
    #[error("nothing is selected that could be stored")]
    NothingToStore,
    /// The stored set does not exist (any more).
    #[error("this stored set does not exist any more")]
    NoSuchSet,
    /// A motion with NaN or infinity.
    #[error("a handle cannot move to a position that is not finite")]
    NotFinite,
    /// r out of range.
    #[error("rigidity must be between 1 and {max}, not {r}")]
    BadRigidity {
        /// Asked for.
        r: u16,
        /// Largest allowed.
        max: u16,
    },
    /// A parameter of a method out of range.
    #[error("{what} must be {allowed}, not {value}")]
    BadParameter {
        /// Which.
        what: &'static str,
        /// Asked for.
        value: String,
        /// What it may be.
        allowed: String,
    },
    /// Learned from another surface.
    #[error("rigidity for {got} vertices does not fit this surface, which has {expected}: learn it from this mesh")]
    WrongLength {
        /// Given.
        got: usize,
        /// Vertices of the surface.
        expected: usize,
    },
    /// r out of range, found by the solver.
    #[error("{0}")]
    Rigidity(String),
}

impl From<RigidityError> for CommandError {
    fn from(error: RigidityError) -> CommandError {
        CommandError::Rigidity(error.to_string())
    }
}

impl Command {
    /// Name of the step in the history.
    pub fn name(&self) -> &'static str {
        match self {
            Command::Begin(name) => name,
            Command::Commit | Command::Cancel | Command::Activate(_) | Command::ActivateSeveral(_) => "",
            Command::Hold { kind: GroupKind::Handle, .. } => "Place handle",
            Command::Hold { kind: GroupKind::Anchor, .. } => "Place anchor",
            Command::Release(_) => "Delete handle",
            Command::Move { .. } => "Move handle",
            Command::MoveSeveral(_) => "Move handles",
            Command::AddToGroup(..) => "Add to handle",
            Command::RemoveFromGroup(..) => "Remove from handle",
            Command::Merge(_) => "Merge handles",
            Command::SetColor(..) => "Color handle",
            Command::ShowDots(_, true) => "Show dots",
            Command::ShowDots(_, false) => "Hide dots",
            Command::ReturnToRest(_) => "Return handle to rest",
            Command::SetKind(..) => "Change handle kind",
            Command::Rename(..) => "Rename handle",
            Command::Paint { .. } => "Paint rigidity",
            Command::Fill { .. } => "Fill rigidity",
            Command::FillAll(_) => "Set rigidity everywhere",
            Command::Learn(_) => "Learn rigidity",
            Command::Lock(_, SelectMode::Remove) => "Unlock rigidity",
            Command::Lock(..) => "Lock rigidity",
            Command::Select(..) => "Select",
            Command::Sets(change) => change.name(),
            Command::SetWeights(_) => "Change weights",
            Command::SetLoose(_) => "Change loose parts",
            Command::SetMethod(_) => "Change method",
            Command::ResetPose => "Reset pose",
            Command::Poses(change) => change.name(),
        }
    }
}

/// Where commands find what is not in the scene.
pub(super) struct Surroundings<'a> {
    /// Current world positions of all surface points.
    pub now: &'a [DVec3],
    /// Rest positions of all surface points.
    pub rest: &'a [DVec3],
    /// The next unused group id; a command that uses it counts it up.
    pub next_group: &'a mut u32,
}

/// The scene after `command`. Gesture commands and those of kept poses do not reach this.
pub(super) fn changed(scene: &Scene, command: Command, around: Surroundings<'_>) -> Result<Scene, CommandError> {
    let mut next = scene.clone();
    match command {
        Command::Begin(_) | Command::Commit | Command::Cancel | Command::Poses(_) => {}
        Command::Hold { kind, vertices } => {
            let held = some_of(vertices, around.rest.len())?;
            hold(&mut next, kind, &held, around);
        }
        Command::AddToGroup(id, vertices) => add(&mut next, id, &some_of(vertices, around.rest.len())?, around.now)?,
        Command::RemoveFromGroup(id, vertices) => remove(&mut next, id, &Selection::new(vertices))?,
        Command::Merge(ids) => merge(&mut next, &ids)?,
        Command::Release(ids) => {
            next.groups = scene.groups.iter().filter(|group| !ids.contains(&group.id)).cloned().collect();
            next.active.retain(|id| !ids.contains(&id));
        }
        Command::Move { group, motion } => set_motions(&mut next, &[(group, motion)])?,
        Command::MoveSeveral(motions) => set_motions(&mut next, &motions)?,
        Command::SetColor(id, color) => edit_group(&mut next, id, |group| group.color = color)?,
        Command::ShowDots(id, shown) => edit_group(&mut next, id, |group| group.dots = shown)?,
        Command::ReturnToRest(id) => edit_group(&mut next, id, |group| to_rest(group, around.rest))?,
        Command::SetKind(id, kind) => edit_group(&mut next, id, |group| set_kind(group, kind))?,
        Command::Rename(id, name) => edit_group(&mut next, id, |group| group.name = name)?,
        Command::Activate(id) => activate(&mut next, id.into_iter().collect()),
        Command::ActivateSeveral(ids) => activate(&mut next, ids),
        Command::Paint { values } => paint(&mut next, &values)?,
        Command::Fill { vertices, r } => {
            let values: Vec<_> = vertices.into_iter().map(|v| (v, r)).collect();
            paint(&mut next, &values)?;
        }
        Command::FillAll(r) => {
            check_rigidity(r)?;
            next.rigidity = keeping_locked(scene, Rigidity::uniform(around.rest.len(), r))?;
        }
        Command::Learn(rigidity) => {
            let (got, expected) = (rigidity.as_slice().len(), around.rest.len());
            if got != expected {
                return Err(CommandError::WrongLength { got, expected });
            }
            next.rigidity = keeping_locked(scene, rigidity)?;
        }
        Command::Lock(vertices, mode) => {
            check_vertices(&vertices, around.rest.len())?;
            next.locked = scene.locked.combined(Selection::new(vertices), mode);
        }
        Command::Select(vertices, mode) => {
            check_vertices(&vertices, around.rest.len())?;
            next.selection = scene.selection.combined(Selection::new(vertices), mode);
        }
        Command::Sets(change) => change_sets(&mut next, change)?,
        Command::SetWeights(weights) => next.weights = weights,
        Command::SetLoose(loose) => next.loose = loose,
        Command::SetMethod(method) => {
            if let Some((what, value, allowed)) = method.fault() {
                return Err(CommandError::BadParameter { what, value, allowed });
            }
            next.method = method;
        }
        Command::ResetPose => {
            let mut groups = scene.groups.to_vec();
            groups.iter_mut().for_each(|group| to_rest(group, around.rest));
            next.groups = groups.into();
        }
    }
    Ok(next)
}

fn activate(scene: &mut Scene, mut ids: Vec<GroupId>) {
    ids.retain(|&id| scene.group(id).is_some());
    let active = ActiveGroups::new(ids);
    if active != scene.active {
        scene.active = active;
    }
}

fn set_motions(scene: &mut Scene, motions: &[(GroupId, DAffine3)]) -> Result<(), CommandError> {
    let mut groups = scene.groups.to_vec();
    for &(id, motion) in motions {
        if !motion.is_finite() {
            return Err(CommandError::NotFinite);
        }
        groups.iter_mut().find(|group| group.id == id).ok_or(CommandError::NoSuchGroup(id.0))?.motion = motion;
    }
    scene.groups = groups.into();
    Ok(())
}

/// A group in the color of its old kind takes on the color of the new one.
fn set_kind(group: &mut Group, kind: GroupKind) {
    if group.color == GroupColor::of_kind(group.kind) {
        group.color = GroupColor::of_kind(kind);
    }
    group.kind = kind;
}

fn some_of(vertices: Vec<VertexId>, n_vertices: usize) -> Result<Selection, CommandError> {
    check_vertices(&vertices, n_vertices)?;
    let some = Selection::new(vertices);
    if some.is_empty() { Err(CommandError::NothingToHold) } else { Ok(some) }
}

fn to_rest(group: &mut Group, rest: &[DVec3]) {
    group.base = group.vertices.iter().map(|v| rest[v.index()]).collect();
    group.motion = DAffine3::IDENTITY;
}

fn edit_group(scene: &mut Scene, id: GroupId, edit: impl FnOnce(&mut Group)) -> Result<(), CommandError> {
    let mut groups = scene.groups.to_vec();
    let group = groups.iter_mut().find(|group| group.id == id).ok_or(CommandError::NoSuchGroup(id.0))?;
    edit(group);
    scene.groups = groups.into();
    Ok(())
}

/// Later values for a vertex replace earlier ones. Nothing is copied where nothing changes.
fn paint(scene: &mut Scene, values: &[(VertexId, u16)]) -> Result<(), CommandError> {
    let r = scene.rigidity.as_slice();
    let n_vertices = r.len();
    let mut changes = false;
    for &(v, value) in values {
        check_rigidity(value)?;
        let old = *r.get(v.index()).ok_or(CommandError::NoSuchVertex { vertex: v.0, n_vertices })?;
        changes |= old != value;
    }
    if changes {
        let locked = &scene.locked;
        let painted = scene.rigidity.edited(|r| {
            for &(v, value) in values.iter().filter(|(v, _)| !locked.contains(*v)) {
                r[v.index()] = value;
            }
        })?;
        if painted != scene.rigidity {
            scene.rigidity = painted;
        }
    }
    Ok(())
}

/// `new` with the old r where vertices are locked.
fn keeping_locked(scene: &Scene, new: Rigidity) -> Result<Rigidity, CommandError> {
    if scene.locked.is_empty() {
        return Ok(new);
    }
    let old = scene.rigidity.as_slice();
    Ok(new.edited(|r| scene.locked.vertices().iter().for_each(|v| r[v.index()] = old[v.index()]))?)
}

fn check_rigidity(r: u16) -> Result<(), CommandError> {
    if (1..=Rigidity::MAX).contains(&r) { Ok(()) } else { Err(CommandError::BadRigidity { r, max: Rigidity::MAX }) }
}

fn check_vertices(vertices: &[VertexId], n_vertices: usize) -> Result<(), CommandError> {
    match vertices.iter().find(|v| v.index() >= n_vertices) {
        Some(v) => Err(CommandError::NoSuchVertex { vertex: v.0, n_vertices }),
        None => Ok(()),
    }
}
