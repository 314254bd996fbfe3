//! Kept poses as records.

use std::collections::HashSet;

use serde::{Deserialize, Serialize};

use super::container::{Block, Reader, Writer};
use super::error::Flaw;
use super::record;
use super::scene::{GroupsRecord, cut, pose};
use crate::document::{KeptPose, PoseId};

/// A pose in the header.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct PoseRecord {
    id: u32,
    name: String,
    #[serde(flatten)]
    groups: GroupsRecord,
    positions: Block,
}

impl PoseRecord {
    pub(super) fn put(writer: &mut Writer, kept: &KeptPose) -> PoseRecord {
        PoseRecord {
            id: kept.id.0,
            name: kept.name.clone(),
            groups: GroupsRecord::put(writer, &kept.groups),
            positions: record::put_points(writer, kept.positions.iter().copied()),
        }
    }
}

/// The poses of a surface of `n_points`.
pub(super) fn poses(records: Vec<PoseRecord>, reader: &Reader, n_points: usize) -> Result<Vec<KeptPose>, Flaw> {
    let mut ids = HashSet::new();
    let mut poses = Vec::new();
    for record in records {
        // A further pose needs a number, too.
        if !ids.insert(record.id) || record.id >= u32::MAX / 2 {
            return Err(Flaw(format!("a pose has the number {}, which is taken or too large", record.id)));
        }
        poses.push(KeptPose {
            id: PoseId(record.id),
            name: cut(&record.name),
            groups: record.groups.groups(reader, n_points)?.into(),
            positions: pose(reader, record.positions, n_points)?.into(),
        });
    }
    Ok(poses)
}
