//! Selections kept under a name, to come back to.

use std::sync::Arc;

use super::{CommandError, Scene, SelectMode, Selection};

/// Names a stored set for as long as it is in the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SetId(pub u32);

/// A stored selection.
#[derive(Clone, Debug, PartialEq)]
pub struct StoredSet {
    /// For commands.
    pub id: SetId,
    /// For people; not empty.
    pub name: String,
    /// Its surface points.
    pub vertices: Selection,
}

/// What can be done with stored sets.
#[derive(Clone, Debug, PartialEq)]
pub enum SetChange {
    /// Stores the selection under a new name.
    Store,
    /// Makes the set what is selected now.
    Update(SetId),
    /// Brings the set into the selection.
    Recall(SetId, SelectMode),
    /// Gives the set another name; an empty one is ignored.
    Rename(SetId, String),
    /// Forgets the set.
    Delete(SetId),
}

impl SetChange {
    /// Name of the step in the history.
    pub fn name(&self) -> &'static str {
        match self {
            SetChange::Store => "Store selection",
            SetChange::Update(_) => "Update stored set",
            SetChange::Recall(..) => "Recall stored set",
            SetChange::Rename(..) => "Rename stored set",
            SetChange::Delete(_) => "Delete stored set",
        }
    }
}

/// Carries out a change.
pub(super) fn change_sets(scene: &mut Scene, change: SetChange) -> Result<(), CommandError> {
    match change {
        SetChange::Store if scene.selection.is_empty() => return Err(CommandError::NothingToStore),
        SetChange::Store => {
            let id = SetId(scene.sets.iter().map(|set| set.id.0).max().map_or(1, |largest| largest.saturating_add(1)));
            let set = StoredSet { id, name: free_name(&scene.sets), vertices: scene.selection.clone() };
            scene.sets = scene.sets.iter().cloned().chain([set]).collect();
        }
        SetChange::Update(_) if scene.selection.is_empty() => return Err(CommandError::NothingToStore),
        SetChange::Update(id) => {
            let selection = scene.selection.clone();
            edit(scene, id, |set| set.vertices = selection)?;
        }
        SetChange::Recall(id, mode) => {
            let set = scene.set(id).ok_or(CommandError::NoSuchSet)?;
            scene.selection = scene.selection.combined(set.vertices.clone(), mode);
        }
        SetChange::Rename(id, name) => {
            let name = name.trim();
            edit(scene, id, |set| {
                if !name.is_empty() {
                    set.name = name.to_owned();
                }
            })?;
        }
        SetChange::Delete(id) => {
            scene.set(id).ok_or(CommandError::NoSuchSet)?;
            scene.sets = scene.sets.iter().filter(|set| set.id != id).cloned().collect();
        }
    }
    Ok(())
}

fn edit(scene: &mut Scene, id: SetId, edit: impl FnOnce(&mut StoredSet)) -> Result<(), CommandError> {
    let mut sets = scene.sets.to_vec();
    edit(sets.iter_mut().find(|set| set.id == id).ok_or(CommandError::NoSuchSet)?);
    scene.sets = sets.into();
    Ok(())
}

/// The first of *Set 1*, *Set 2*, … that no set has.
fn free_name(sets: &[StoredSet]) -> String {
    let taken = |name: &String| sets.iter().any(|set| &set.name == name);
    (1..=sets.len() + 1).map(|k| format!("Set {k}")).find(|name| !taken(name)).unwrap_or_default()
}

/// Approximate size of the sets that are not in `others`, in bytes.
pub(super) fn bytes_beyond(sets: &Arc<[StoredSet]>, others: &Arc<[StoredSet]>) -> usize {
    if Arc::ptr_eq(sets, others) {
        return 0;
    }
    let is_shared =
        |set: &StoredSet| others.iter().any(|other| std::ptr::eq(other.vertices.vertices(), set.vertices.vertices()));
    let own = sets.iter().filter(|set| !is_shared(set)).map(|set| size_of_val(set.vertices.vertices()));
    size_of_val(&**sets) + own.sum::<usize>()
}
