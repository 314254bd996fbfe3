//! Vertices into groups and out of them. Whatever is done, no vertex is in two groups and no group is empty.

use glam::{DAffine3, DVec3};
use pliant_solver::VertexId;

use super::commands::{CommandError, Surroundings};
use super::{ActiveGroups, Group, GroupColor, GroupId, GroupKind, Scene, Selection};

/// Motions that flatten space more than this (the ratio of volume to the cube of the longest axis) cannot be taken
/// back exactly enough: 1e-9 leaves seven digits of a double.
const FLAT: f64 = 1e-9;

/// A new group of `held` where the surface is now; vertices of other groups change over.
pub(super) fn hold(scene: &mut Scene, kind: GroupKind, held: &Selection, around: Surroundings<'_>) {
    let mut groups: Vec<Group> = scene.groups.iter().filter_map(|group| without(group, held)).collect();
    let id = GroupId(*around.next_group);
    *around.next_group += 1;
    let name = match kind {
        GroupKind::Handle => format!("Handle {}", id.0),
        GroupKind::Anchor => format!("Anchor {}", id.0),
    };
    groups.push(Group {
        id,
        name,
        kind,
        color: GroupColor::of_kind(kind),
        dots: true,
        vertices: held.vertices().into(),
        base: held.vertices().iter().map(|v| around.now[v.index()]).collect(),
        motion: DAffine3::IDENTITY,
    });
    put(scene, groups);
    scene.active = ActiveGroups::new(vec![id]);
}

/// Brings vertices into a group where the surface is now; those of other groups change over.
pub(super) fn add(scene: &mut Scene, id: GroupId, held: &Selection, now: &[DVec3]) -> Result<(), CommandError> {
    let into = scene.group(id).ok_or(CommandError::NoSuchGroup(id.0))?;
    let new: Vec<_> = held.vertices().iter().filter(|&&v| !into.holds(v)).map(|&v| (v, now[v.index()])).collect();
    let joined = join(into, new);
    let others = scene.groups.iter().filter_map(|group| match group.id == id {
        true => Some(joined.clone()),
        false => without(group, held),
    });
    put(scene, others.collect());
    Ok(())
}

/// Lets vertices of one group go; a group that loses all of them goes too.
pub(super) fn remove(scene: &mut Scene, id: GroupId, gone: &Selection) -> Result<(), CommandError> {
    scene.group(id).ok_or(CommandError::NoSuchGroup(id.0))?;
    let left = scene.groups.iter().filter_map(|group| match group.id == id {
        true => without(group, gone),
        false => Some(group.clone()),
    });
    put(scene, left.collect());
    Ok(())
}

/// All of `ids` into the last of them, whose name, kind and color stay. Nothing moves.
pub(super) fn merge(scene: &mut Scene, ids: &[GroupId]) -> Result<(), CommandError> {
    for id in ids {
        scene.group(*id).ok_or(CommandError::NoSuchGroup(id.0))?;
    }
    let Some((&last, others)) = ids.split_last() else { return Ok(()) };
    let is_other = |group: &Group| group.id != last && others.contains(&group.id);
    let members = scene.groups.iter().filter(|&group| is_other(group));
    let new: Vec<_> = members.flat_map(|group| group.vertices.iter().copied().zip(group.targets())).collect();
    let kept = scene.groups.iter().filter(|&group| !is_other(group));
    let groups = kept.map(|group| if group.id == last { join(group, new.clone()) } else { group.clone() }).collect();
    put(scene, groups);
    Ok(())
}

fn put(scene: &mut Scene, groups: Vec<Group>) {
    scene.groups = groups.into();
    let groups = &scene.groups;
    scene.active.retain(|id| groups.iter().any(|group| group.id == id));
}

/// `group` with more vertices, given with where they must be. Its motion is kept, so that it can still be read and taken
/// back, unless that motion has flattened it: then it begins anew where it is.
fn join(group: &Group, new: Vec<(VertexId, DVec3)>) -> Group {
    if new.is_empty() {
        return group.clone();
    }
    let old = group.vertices.iter().copied();
    let (mut all, motion): (Vec<_>, _) = match inverse(group.motion) {
        Some(back) => {
            let new = new.into_iter().map(|(v, target)| (v, back.transform_point3(target)));
            (old.zip(group.base.iter().copied()).chain(new).collect(), group.motion)
        }
        None => (old.zip(group.targets()).chain(new).collect(), DAffine3::IDENTITY),
    };
    all.sort_unstable_by_key(|&(v, _)| v);
    let (vertices, base): (Vec<_>, Vec<_>) = all.into_iter().unzip();
    Group { vertices: vertices.into(), base: base.into(), motion, ..group.clone() }
}

fn inverse(motion: DAffine3) -> Option<DAffine3> {
    if motion == DAffine3::IDENTITY {
        return Some(motion);
    }
    let axes = motion.matrix3;
    let longest = axes.x_axis.length().max(axes.y_axis.length()).max(axes.z_axis.length());
    let flatness = (axes * (1.0 / longest)).determinant().abs();
    (flatness > FLAT).then(|| motion.inverse()).filter(DAffine3::is_finite)
}

/// `group` without the vertices in `taken`, or nothing if none is left.
fn without(group: &Group, taken: &Selection) -> Option<Group> {
    if !group.vertices.iter().any(|&v| taken.contains(v)) {
        return Some(group.clone());
    }
    let kept = || group.vertices.iter().zip(group.base.iter()).filter(|&(&v, _)| !taken.contains(v));
    let vertices: std::sync::Arc<[VertexId]> = kept().map(|(&v, _)| v).collect();
    let base = kept().map(|(_, &p)| p).collect();
    (!vertices.is_empty()).then(|| Group { vertices, base, ..group.clone() })
}
