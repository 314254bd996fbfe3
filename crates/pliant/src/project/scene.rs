//! The scene and its pose as records, and back with every number checked.

use std::collections::HashSet;

use glam::DVec3;
use pliant_solver::Rigidity;
use serde::{Deserialize, Serialize};

use super::container::{Block, Reader, Writer};
use super::error::Flaw;
use super::poses::{self, PoseRecord};
use super::record::{self, LooseRecord, MethodRecord, WeightsRecord};
use crate::document::{ActiveGroups, Group, GroupColor, GroupId, GroupKind, Scene, Selection, SetId, StoredSet};

/// Bytes of a group's name; a longer one is cut.
const NAME_BYTES: usize = 1 << 10;

/// A scene in the header. Lists of all groups lie one after the other in shared blocks.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct SceneRecord {
    rigidity: Block,
    #[serde(flatten)]
    groups: GroupsRecord,
    #[serde(default)]
    selection: Option<Block>,
    #[serde(default)]
    locked: Option<Block>,
    #[serde(default)]
    sets: Vec<SetRecord>,
    /// Vertices of all stored sets.
    #[serde(default)]
    set_members: Option<Block>,
    /// Groups that are being worked on, the leading one last.
    #[serde(default)]
    active: Vec<u32>,
    #[serde(default)]
    weights: WeightsRecord,
    #[serde(default)]
    loose: LooseRecord,
    #[serde(default)]
    method: Option<MethodRecord>,
    #[serde(default)]
    poses: Vec<PoseRecord>,
}

/// Handles and anchors. Lists of all groups lie one after the other.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct GroupsRecord {
    groups: Vec<GroupRecord>,
    /// Held vertices of all groups.
    held: Block,
    /// Their base positions.
    bases: Block,
}

#[derive(Debug, Serialize, Deserialize)]
struct GroupRecord {
    id: u32,
    name: String,
    kind: KindRecord,
    /// How many of the held vertices are its own.
    count: u32,
    motion: [f64; 12],
    #[serde(default)]
    color: Option<String>,
    #[serde(default)]
    hides_dots: bool,
}

#[derive(Debug, Serialize, Deserialize)]
struct SetRecord {
    id: u32,
    name: String,
    /// How many of the members are its own.
    count: u32,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum KindRecord {
    Handle,
    Anchor,
}

impl SceneRecord {
    pub(super) fn put(writer: &mut Writer, scene: &Scene) -> SceneRecord {
        let (selection, locked) = (scene.selection.vertices(), scene.locked.vertices());
        SceneRecord {
            rigidity: record::put_rigidity(writer, scene.rigidity.as_slice()),
            groups: GroupsRecord::put(writer, &scene.groups),
            selection: (!selection.is_empty()).then(|| record::put_vertices(writer, selection.iter().copied())),
            locked: (!locked.is_empty()).then(|| record::put_vertices(writer, locked.iter().copied())),
            sets: scene.sets.iter().map(SetRecord::of).collect(),
            set_members: (!scene.sets.is_empty()).then(|| {
                let members = scene.sets.iter().flat_map(|set| set.vertices.vertices().iter().copied());
                record::put_vertices(writer, members)
            }),
            active: scene.active.ids().iter().map(|id| id.0).collect(),
            weights: scene.weights.into(),
            loose: scene.loose.into(),
            method: Some(MethodRecord::of(&scene.method)),
            poses: scene.poses.iter().map(|kept| PoseRecord::put(writer, kept)).collect(),
        }
    }

    /// The scene over a surface of `n_points`, as `fresh` says where an older project is silent.
    pub(super) fn scene(self, reader: &Reader, n_points: usize, fresh: Scene) -> Result<Scene, Flaw> {
        let r = record::rigidity(reader, self.rigidity)?;
        if r.len() != n_points {
            return Err(Flaw(format!("rigidity for {} vertices, the surface has {n_points}", r.len())));
        }
        let rigidity = Rigidity::new(r).map_err(|error| Flaw(error.to_string()))?;
        let groups = self.groups.groups(reader, n_points)?;
        let sets = self.sets(reader, n_points)?;
        let set = |block: Option<Block>, what: &str| match block {
            Some(block) => Ok(Selection::new(record::vertices(reader, block, n_points, what)?)),
            None => Ok(Selection::default()),
        };
        let ids: HashSet<GroupId> = groups.iter().map(|group| group.id).collect();
        let active = self.active.into_iter().map(GroupId).filter(|id| ids.contains(id)).collect();
        let mut scene = fresh;
        scene.sets = sets.into();
        (scene.rigidity, scene.groups, scene.active) = (rigidity, groups.into(), ActiveGroups::new(active));
        (scene.selection, scene.locked) = (set(self.selection, "selection")?, set(self.locked, "locked vertices")?);
        (scene.weights, scene.loose) = (self.weights.into(), self.loose.into());
        if let Some(method) = self.method {
            scene.method = method.method()?;
        }
        scene.poses = poses::poses(self.poses, reader, n_points)?.into();
        Ok(scene)
    }

    fn sets(&self, reader: &Reader, n_points: usize) -> Result<Vec<StoredSet>, Flaw> {
        let members = match self.set_members {
            Some(block) => record::vertices(reader, block, n_points, "stored sets")?,
            None => Vec::new(),
        };
        let (mut sets, mut ids, mut rest) = (Vec::new(), HashSet::new(), &members[..]);
        for set in &self.sets {
            let Some((own, others)) = rest.split_at_checked(set.count as usize) else {
                return Err(Flaw(format!("stored set {} lacks vertices", set.id)));
            };
            if !ids.insert(set.id) {
                return Err(Flaw(format!("two stored sets have the number {}", set.id)));
            }
            rest = others;
            let (id, name) = (SetId(set.id), cut(&set.name));
            sets.push(StoredSet { id, name, vertices: Selection::new(own.to_vec()) });
        }
        if rest.is_empty() { Ok(sets) } else { Err(Flaw::new("vertices are left over that are in no stored set")) }
    }
}

impl GroupsRecord {
    pub(super) fn put(writer: &mut Writer, groups: &[Group]) -> GroupsRecord {
        GroupsRecord {
            groups: groups.iter().map(GroupRecord::of).collect(),
            held: record::put_vertices(writer, groups.iter().flat_map(|group| group.vertices.iter().copied())),
            bases: record::put_points(writer, groups.iter().flat_map(|group| group.base.iter().copied())),
        }
    }

    pub(super) fn groups(&self, reader: &Reader, n_points: usize) -> Result<Vec<Group>, Flaw> {
        let held = record::vertices(reader, self.held, n_points, "held vertices")?;
        let bases = record::points(reader, self.bases, "base positions of held vertices")?;
        let counted: u64 = self.groups.iter().map(|group| u64::from(group.count)).sum();
        if bases.len() != held.len() || counted != held.len() as u64 {
            let text = format!("{} vertices are held at {} places by groups of {counted}", held.len(), bases.len());
            return Err(Flaw(text));
        }
        let mut seen = vec![false; n_points];
        for v in &held {
            if std::mem::replace(&mut seen[v.index()], true) {
                return Err(Flaw(format!("vertex {} is held twice", v.0)));
            }
        }
        let mut ids = HashSet::new();
        let mut groups = Vec::new();
        let mut at = 0;
        for group in &self.groups {
            let range = at..at + group.count as usize;
            at = range.end;
            if !ids.insert(group.id) {
                return Err(Flaw(format!("two groups have the number {}", group.id)));
            }
            let (vertices, base) = (&held[range.clone()], &bases[range]);
            if vertices.is_empty() || !vertices.is_sorted() {
                return Err(Flaw(format!("the vertices of group {} are not an ascending list", group.id)));
            }
            groups.push(group.group(vertices.into(), base.into())?);
        }
        Ok(groups)
    }
}

impl SetRecord {
    fn of(set: &StoredSet) -> SetRecord {
        SetRecord { id: set.id.0, name: set.name.clone(), count: set.vertices.len() as u32 }
    }
}

/// A name of bearable length.
pub(super) fn cut(name: &str) -> String {
    name[..name.floor_char_boundary(NAME_BYTES)].to_owned()
}

impl GroupRecord {
    fn of(group: &Group) -> GroupRecord {
        GroupRecord {
            id: group.id.0,
            name: group.name.clone(),
            kind: match group.kind {
                GroupKind::Handle => KindRecord::Handle,
                GroupKind::Anchor => KindRecord::Anchor,
            },
            count: group.vertices.len() as u32,
            motion: record::motion_numbers(&group.motion),
            color: Some(group.color.name().to_owned()),
            hides_dots: !group.dots,
        }
    }

    fn group(
        &self,
        vertices: std::sync::Arc<[pliant_solver::VertexId]>,
        base: std::sync::Arc<[DVec3]>,
    ) -> Result<Group, Flaw> {
        let motion = record::motion_of(&self.motion).ok_or_else(|| Flaw::new("a handle's motion is not finite"))?;
        let name = cut(&self.name);
        let kind = match self.kind {
            KindRecord::Handle => GroupKind::Handle,
            KindRecord::Anchor => GroupKind::Anchor,
        };
        let color = self.color.as_deref().and_then(GroupColor::named).unwrap_or(GroupColor::of_kind(kind));
        let group = Group { id: GroupId(self.id), name, kind, color, dots: !self.hides_dots, vertices, base, motion };
        // Large finite numbers can multiply to infinity.
        if group.targets().any(|target| !target.is_finite()) {
            return Err(Flaw::new("a handle is moved to a place that is not finite"));
        }
        Ok(group)
    }
}

/// The smallest number that no group of the scene or its poses has.
pub(super) fn next_group(scene: &Scene, stated: u32) -> Result<u32, Flaw> {
    let kept = scene.poses.iter().flat_map(|kept| kept.groups.iter());
    let largest = scene.groups.iter().chain(kept).map(|group| group.id.0).max().unwrap_or(0);
    let next = largest.checked_add(1).ok_or_else(|| Flaw::new("no number is left for a further handle"))?;
    // A project that states a number near the end would leave none.
    Ok(next.max(if stated < u32::MAX / 2 { stated } else { 1 }))
}

/// The pose of a surface of `n_points`.
pub(super) fn pose(reader: &Reader, block: Block, n_points: usize) -> Result<Vec<DVec3>, Flaw> {
    let positions = record::points(reader, block, "pose")?;
    if positions.len() != n_points {
        return Err(Flaw(format!("a pose of {} vertices, the surface has {n_points}", positions.len())));
    }
    Ok(positions)
}
