//! The truth about what is being edited, without a window: the opened [`Model`], the [`Scene`] laid over it, the
//! current [`Pose`], and the history of both.
//!
//! Everything that changes the scene is a [`Command`], applied by [`Document::apply`]. The solver's answers come in
//! through [`Document::accept`] and never make an undo step.

mod commands;
mod findings;
mod group;
mod grouping;
mod history;
mod method;
mod model;
mod motion;
mod palette;
mod polygons;
mod poses;
mod regions;
mod scene;
mod selection;
mod sets;

mod state;
mod textures;

pub use commands::{Command, CommandError};
pub use findings::{Finding, caution, findings};
pub use group::{ActiveGroups, Group, GroupId, GroupKind, held_by};
pub use history::{History, Snapshot};
pub use method::{Method, MethodKind};
pub(crate) use model::bounds_of;
pub use model::{Model, ModelError};
pub use motion::{Change, Placement, rotation_of};
pub use palette::GroupColor;
pub use poses::{KeptPose, PoseChange, PoseId};
pub use regions::{
    Alike, Part, alike, border, grown, inverted, of_parts, of_rigidity, part_of_triangle, region_by_selection,
    region_of_equal_rigidity, region_of_faces, region_of_part, region_of_piece, rim, shrunk,
};
pub use scene::Scene;
pub use selection::{SelectMode, Selection};
pub use sets::{SetChange, SetId, StoredSet};
pub use state::{Document, Pose};
